// See spline_edit.h.
#include "core/edit/spline_edit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numeric>

#include "core/base/vector_clones.h"

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

// `length` coefficients of a channel that is made of a spline's.
TESSERA_VECTOR_CLONES
void mixChannel(const PatchSpline& spline, size_t channels,
                const std::array<double, kMaxChannels + 1>& shares, size_t length, float* out) {
    double sum[kPolynomials + 255];
    std::fill_n(sum, length, 0.0);
    sum[0] = shares[kMaxChannels];
    const float* k = spline.coefficients.data();
    for (size_t from = 0; from < channels; ++from) {
        const size_t own = size_t(kPolynomials) + spline.terms[from];
        const double share = shares[from];
        if (share != 0)
            for (size_t i = 0; i < own; ++i) sum[i] += share * double(k[i]);
        k += own;
    }
    for (size_t i = 0; i < length; ++i) out[i] = float(sum[i]);
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
    const Mix mix = mixOf(channels, basis, change);
    const auto count = size_t(channels);
    PatchSpline result;
    result.sites = spline.sites;
    result.centres = spline.centres;
    std::array<size_t, kMaxChannels> lengths{};
    for (size_t c = 0; c < count; ++c) {
        for (size_t from = 0; from < count; ++from)
            if (mix[c][from] != 0) result.terms[c] = std::max(result.terms[c], spline.terms[from]);
        lengths[c] = size_t(kPolynomials) + result.terms[c];
    }
    result.coefficients.resize(std::accumulate(lengths.begin(), lengths.end(), size_t{0}));
    float* out = result.coefficients.data();
    for (size_t c = 0; c < count; ++c) {
        mixChannel(spline, count, mix[c], lengths[c], out);
        out += lengths[c];
    }
    return result;
}

}  // namespace tessera
