// See spline_edit.h.
#include "core/edit/spline_edit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/base/check.h"
#include "core/base/round_up.h"
#include "core/base/vectors.h"

namespace tessera {

namespace {

constexpr int kPolynomials = 3;

// Shares of channels in channels, row by channel that is made; the last column is a constant.
using Mix = std::array<std::array<double, kMaxChannels + 1>, kMaxChannels>;

Mix mixOf(int channels, ColourBasis basis, const AffineColour& change) {
    constexpr double kThird = .57735026918962576451, kHalf = .70710678118654752440,
                     kSixth = .40824829046386301637;
    // Rows: the basis' channels from R, G, B. glm fills columns.
    const glm::dmat3 toBasis = basis == ColourBasis::Rgb ? glm::dmat3(1)
                                                         : glm::dmat3(kThird, kHalf, kSixth, kThird, 0,
                                                                      -2 * kSixth, kThird, -kHalf, kSixth);
    const glm::dmat3 matrix = toBasis * change.matrix * glm::transpose(toBasis);
    const glm::dvec3 offset = toBasis * change.offset;
    Mix mix{};
    // Shares that are rounding would give a channel terms that it does not need.
    constexpr double kNothing = 1e-9;
    const auto share = [&](double value) { return std::abs(value) < kNothing ? 0 : value; };
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
            mix[size_t(row)][size_t(column)] = share(matrix[column][row]);
        // Premultiplied: a constant is so much of alpha.
        mix[size_t(row)][channels == 4 ? 3 : kMaxChannels] = share(offset[row]);
    }
    mix[3][3] = 1;
    return mix;
}

// Coefficients of channels side by side, filled up with zeros.
constexpr size_t kLanes = 4;
constexpr size_t kMostCoefficients = roundUp(size_t(kPolynomials) + 255, kLanes);
using CoefficientPlanes = std::array<std::array<float, kMostCoefficients>, kMaxChannels>;

// The first `length` coefficients, a multiple of kLanes, of a channel that is made of `channels` others.
TESSERA_VECTOR_CLONES
void mixChannel(const CoefficientPlanes& from, size_t channels,
                const std::array<double, kMaxChannels + 1>& shares, size_t length, float* out) {
    Vector<double, kLanes> constant{shares[kMaxChannels]};
    for (size_t first = 0; first < length; first += kLanes) {
        Vector<double, kLanes> sum = constant;
        for (size_t c = 0; c < channels; ++c)
            sum += shares[c] * __builtin_convertvector(loadVector<kLanes>(from[c].data() + first),
                                                       Vector<double, kLanes>);
        storeVector<kLanes>(out + first, __builtin_convertvector(sum, Vector<float, kLanes>));
        constant = Vector<double, kLanes>{};
    }
}

}  // namespace

AffineColour tinted(glm::dvec3 colour, double strength) {
    constexpr glm::dvec3 kLuma(.2126, .7152, .0722);
    AffineColour tint;
    // colour + (luma of the old - luma of the colour), in each channel.
    const glm::dmat3 luma(glm::dvec3(kLuma.x), glm::dvec3(kLuma.y), glm::dvec3(kLuma.z));
    tint.matrix = (1 - strength) * glm::dmat3(1) + strength * luma;
    tint.offset = strength * (colour - glm::dvec3(glm::dot(kLuma, colour)));
    return tint;
}

PatchSpline mixed(const PatchSpline& spline, int channels, ColourBasis basis, const AffineColour& change) {
    const auto count = size_t(channels);
    TESSERA_CHECK(count <= kMaxChannels);
    const Mix mix = mixOf(channels, basis, change);
    const auto whole = [](size_t length) { return roundUp(length, kLanes); };
    PatchSpline result;
    result.sites = spline.sites;
    result.centres = spline.centres;
    for (size_t c = 0; c < count; ++c)
        for (size_t from = 0; from < count; ++from)
            if (mix[c][from] != 0) result.terms[c] = std::max(result.terms[c], spline.terms[from]);
    const size_t longest = whole(size_t(kPolynomials) + size_t(spline.maxTerms(channels)));
    CoefficientPlanes planes;
    const float* k = spline.coefficients.data();
    for (size_t c = 0; c < count; ++c) {
        const size_t own = size_t(kPolynomials) + spline.terms[c];
        std::fill(std::copy_n(k, own, planes[c].begin()), planes[c].begin() + ptrdiff_t(longest), 0.F);
        k += own;
    }
    result.coefficients.reserve(result.offset(channels));
    for (size_t c = 0; c < count; ++c) {
        std::array<float, kMostCoefficients> made;
        const size_t length = size_t(kPolynomials) + result.terms[c];
        mixChannel(planes, count, mix[c], whole(length), made.data());
        result.coefficients.insert(result.coefficients.end(), made.begin(), made.begin() + ptrdiff_t(length));
    }
    return result;
}

}  // namespace tessera
