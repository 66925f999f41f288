// The rounding of splines to nodal values; see colour_codec.h.
#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/document/colour_codec.h"

namespace tessera {

namespace {

// Of kColourBound, the part that rounding the values may take; the rest is for the floats of the
// coefficients, twice: the spline's own and those that come back.
constexpr double kRoundingShare = .96;
constexpr double kFloatShare = (1 - kRoundingShare) / 2;

// Between the n + 3 coefficients of a spline over the first n default centres and its values at them.
struct Layout {
    int n = 0;
    NodalBasis basis;               // coefficients from values
    std::vector<double> collocate;  // values from coefficients, n rows of n + 3
    double lebesgue = 1;

    // The n + 3 basis functions at a point.
    void basisFunctions(glm::dvec2 at, double* out) const {
        out[0] = 1;
        out[1] = at.x;
        out[2] = at.y;
        for (int i = 0; i < n; ++i) {
            const glm::dvec2 d = at - defaultCentres()[size_t(i)];
            out[3 + i] = tpsKernel(d.x * d.x + d.y * d.y);
        }
    }
};

double lebesgueOf(const Layout& layout) {
    constexpr int kGrid = 96;
    const auto size = size_t(layout.n);
    std::vector<double> functions(size + 3);
    double largest = 1;
    for (int j = 0; j <= kGrid; ++j)
        for (int k = 0; j + k <= kGrid; ++k) {
            const double v = double(j) / kGrid, w = double(k) / kGrid;
            layout.basisFunctions(domainPoint({1 - v - w, v, w}), functions.data());
            double sum = 0;
            for (size_t c = 0; c < size; ++c) {
                double cardinal = 0;
                for (size_t r = 0; r < size + 3; ++r)
                    cardinal += functions[r] * layout.basis.toCoefficients[r * size + c];
                sum += std::abs(cardinal);
            }
            largest = std::max(largest, sum);
        }
    return 1.002 * largest;  // between the points of the grid
}

// By the number of values, 3 to 16.
const Layout& layoutOf(int n) {
    static const auto layouts = [] {
        std::array<Layout, kDefaultCentreCount + 1> all;
        for (int count = 3; count <= kDefaultCentreCount; ++count) {
            Layout& layout = all[size_t(count)];
            layout.n = count;
            layout.basis = nodalBasis(std::span(defaultCentres()).first(size_t(count)));
            layout.collocate.resize(size_t(count * (count + 3)));
            for (int i = 0; i < count; ++i)
                layout.basisFunctions(defaultCentres()[size_t(i)],
                                      &layout.collocate[size_t(i * (count + 3))]);
            layout.lebesgue = lebesgueOf(layout);
        }
        return all;
    }();
    return layouts[size_t(n)];
}

int valueCount(int terms) {
    return std::max(terms, 3);
}

// A channel's coefficients (3 + terms), in double, from its values.
void toCoefficients(const std::vector<double>& values, int terms, double* out) {
    const Layout& layout = layoutOf(valueCount(terms));
    const auto n = size_t(layout.n);
    for (size_t r = 0; r < 3 + size_t(terms); ++r) {
        double sum = 0;
        for (size_t c = 0; c < n; ++c) sum += layout.basis.toCoefficients[r * n + c] * values[c];
        out[r] = sum;
    }
}

// A bound on |difference| of two splines over the domain by their coefficients. On a domain of side 1 the
// coordinates are at most 1 and |phi(d)| at most 1/(2e).
double distance(const double* a, const float* b, int terms) {
    constexpr double kLargestPhi = .1840;
    double sum = 0;
    for (int r = 0; r < 3 + terms; ++r) sum += std::abs(a[r] - double(b[r])) * (r < 3 ? 1 : kLargestPhi);
    return sum;
}

// One channel's values in steps; false where its floats, or its side conditions, are not good enough for
// them.
bool quantizeChannel(const float* coefficients, int terms, double step, std::vector<int64_t>& out) {
    const Layout& layout = layoutOf(valueCount(terms));
    const auto n = size_t(layout.n);
    if (.5 * step * layout.lebesgue > kRoundingShare * kColourBound * (1 + 1e-9)) return false;
    std::vector<double> values(n), back(n + 3);
    for (size_t i = 0; i < n; ++i) {
        double sum = 0;
        for (size_t r = 0; r < 3 + size_t(terms); ++r)
            sum += layout.collocate[i * (n + 3) + r] * double(coefficients[r]);
        values[i] = sum;
    }
    toCoefficients(values, terms, back.data());
    if (!(distance(back.data(), coefficients, terms) <= kFloatShare * kColourBound)) return false;
    out.resize(n);
    for (size_t i = 0; i < n; ++i) {
        if (!(std::abs(values[i] / step) < 1e9)) return false;
        out[i] = std::llround(values[i] / step);
        values[i] = double(out[i]) * step;
    }
    toCoefficients(values, terms, back.data());
    std::array<float, 3 + kDefaultCentreCount> rounded{};
    for (size_t r = 0; r < 3 + size_t(terms); ++r) rounded[r] = float(back[r]);
    return distance(back.data(), rounded.data(), terms) <= kFloatShare * kColourBound;
}

}  // namespace

double lebesgueConstant(int n) {
    TESSERA_CHECK(n >= 3 && n <= kDefaultCentreCount);
    return layoutOf(n).lebesgue;
}

double defaultColourStep() {
    double largest = 1;
    for (int n = 3; n <= kDefaultCentreCount; ++n) largest = std::max(largest, lebesgueConstant(n));
    return 2 * kRoundingShare * kColourBound / largest;
}

std::string splineViolation(const PatchSpline& spline, int channels) {
    for (int c = 0; c < kMaxChannels; ++c) {
        const int terms = spline.terms[size_t(c)];
        if (terms == 1 || terms == 2 || (c >= channels && terms != 0))
            return "has a number of terms that cannot be";
        if (size_t(terms) > spline.centreCount()) return "has fewer centres than terms";
    }
    std::array<bool, kCentreSites> listed{};
    for (const uint8_t site : spline.sites) {
        if (site >= kCentreSites || listed[site]) return "has a list of sites that cannot be";
        listed[site] = true;
    }
    if (!spline.sites.empty() && !spline.centres.empty()) return "has both sites and centres";
    if (spline.centres.size() > 255) return "has more than 255 centres";
    if (spline.coefficients.size() != spline.offset(channels)) return "has the wrong number of coefficients";
    const auto finite = [](float f) { return std::isfinite(f); };
    if (!std::all_of(spline.coefficients.begin(), spline.coefficients.end(), finite) ||
        !std::all_of(spline.centres.begin(), spline.centres.end(),
                     [&](glm::vec2 p) { return finite(p.x) && finite(p.y); }))
        return "has a number that is not finite";
    return {};
}

FileColour quantized(const PatchSpline& spline, int channels, double step) {
    FileColour colour;
    colour.terms = spline.terms;
    const auto quantize = [&](const PatchSpline& from, auto& values) {
        bool good = from.centres.empty();
        for (int c = 0; c < channels && good; ++c)
            good = quantizeChannel(&from.coefficients[from.offset(c)], from.terms[size_t(c)], step,
                                   values[size_t(c)]);
        return good;
    };
    // Values only where what comes back from them gives them again: by that, and by nothing else, is storing
    // a second time known to give the same bytes.
    if (quantize(spline, colour.values)) {
        auto again = colour.values;
        if (quantize(dequantized(colour, channels, step), again) && again == colour.values) return colour;
    }
    colour.exact = true;
    colour.values = {};
    colour.centres = spline.centres;
    colour.coefficients = spline.coefficients;
    return colour;
}

PatchSpline dequantized(const FileColour& colour, int channels, double step) {
    PatchSpline spline;
    spline.terms = colour.terms;
    if (colour.exact) {
        spline.centres = colour.centres;
        spline.coefficients = colour.coefficients;
        return spline;
    }
    for (int c = 0; c < channels; ++c) {
        const int terms = colour.terms[size_t(c)];
        std::vector<double> values;
        for (const int64_t value : colour.values[size_t(c)]) values.push_back(double(value) * step);
        std::array<double, 3 + kDefaultCentreCount> coefficients{};
        toCoefficients(values, terms, coefficients.data());
        for (size_t r = 0; r < 3 + size_t(terms); ++r) spline.coefficients.push_back(float(coefficients[r]));
    }
    return spline;
}

}  // namespace tessera
