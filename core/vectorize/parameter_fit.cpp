// See parameter_fit.h.
#include "core/vectorize/parameter_fit.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/base/round_up.h"
#include "core/base/vector_clones.h"
#include "core/mesh/tps.h"

// No vector crosses a call, for whose conventions the compiler warns: what has vectors is inlined.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace tessera {

namespace {

constexpr int kTerms = ParameterFit::kTerms;
constexpr size_t kLanes = 8;
constexpr int kFewestPerSide = 6, kMostPerSide = 48;
constexpr size_t kMostPlaces = size_t(kMostPerSide) * kMostPerSide;
// Patches also serve pixels that they share, so they are measured a little beyond their sides.
constexpr double kGrowPx = .3, kMostGrowth = 1.5;
constexpr double kLeastArea = .5;  // of the base triangle: curved sides may span a patch over none

typedef float Vector __attribute__((vector_size(kLanes * sizeof(float))));

// Exponents of the second and third barycentric coordinate in the order of the rows.
struct Exponent {
    int v, w;
};
constexpr std::array<Exponent, 10> kCubic{
    {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {2, 1}, {1, 2}, {0, 3}, {0, 2}, {0, 1}, {1, 1}}};
constexpr std::array<Exponent, 6> kQuadratic{{{0, 0}, {1, 0}, {2, 0}, {1, 1}, {0, 2}, {0, 1}}};

// Eight floats in a row, as a vector.
typedef float LooseVector
    __attribute__((vector_size(kLanes * sizeof(float)), aligned(alignof(float)), may_alias));
inline __attribute__((always_inline)) const LooseVector& load(const float* from) {
    return *reinterpret_cast<const LooseVector*>(from);
}
inline __attribute__((always_inline)) LooseVector& lanes(float* to) {
    return *reinterpret_cast<LooseVector*>(to);
}

inline __attribute__((always_inline)) float total(Vector v) {
    return ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
}

// The patch's point with each of the three parameters in one factor (its blossom).
glm::dvec2 blossom(const BezierTriangle& t, const std::array<Barycentric, 3>& at) {
    const auto mix = [](const Barycentric& b, glm::dvec2 p, glm::dvec2 q, glm::dvec2 r) {
        return b.x * p + b.y * q + b.z * r;
    };
    std::array<glm::dvec2, 6> q;
    for (size_t i = 0; i < 6; ++i) {
        const auto [v, w] = kQuadratic[i];
        const int u = 2 - v - w;
        q[i] = mix(at[0], t.p[size_t(controlIndex(u + 1, v, w))], t.p[size_t(controlIndex(u, v + 1, w))],
                   t.p[size_t(controlIndex(u, v, w + 1))]);
    }
    return mix(at[2], mix(at[1], q[0], q[1], q[5]), mix(at[1], q[1], q[2], q[3]),
               mix(at[1], q[5], q[3], q[4]));
}

// The patch over its domain scaled by `growth` about the middle.
BezierTriangle grown(const BezierTriangle& t, double growth) {
    const double near = (1 + 2 * growth) / 3, far = (1 - growth) / 3;
    const std::array<Barycentric, 3> corners{{{near, far, far}, {far, near, far}, {far, far, near}}};
    BezierTriangle result;
    for (size_t i = 0; i < kCubic.size(); ++i) {
        const auto [v, w] = kCubic[i];
        std::array<Barycentric, 3> at;
        for (int k = 0; k < 3; ++k) at[size_t(k)] = corners[k < w ? 2 : k < v + w ? 1 : 0];
        result.p[i] = blossom(t, at);
    }
    return result;
}

// Coefficients as rows of floats, relative to `origin`, for the loops over places.
struct Coefficients {
    float x[10], y[10];
    float dv[6][2], dw[6][2];

    Coefficients(const BezierTriangle& t, glm::dvec2 origin) {
        for (size_t i = 0; i < 10; ++i) {
            x[i] = float(t.p[i].x - origin.x);
            y[i] = float(t.p[i].y - origin.y);
        }
        for (size_t i = 0; i < 6; ++i) {
            const auto [v, w] = kQuadratic[i];
            const int u = 2 - v - w;
            const glm::dvec2 a = t.p[size_t(controlIndex(u + 1, v, w))];
            const glm::dvec2 alongV = 3.0 * (t.p[size_t(controlIndex(u, v + 1, w))] - a);
            const glm::dvec2 alongW = 3.0 * (t.p[size_t(controlIndex(u, v, w + 1))] - a);
            for (int k = 0; k < 2; ++k) {
                dv[i][k] = float(alongV[k]);
                dw[i][k] = float(alongW[k]);
            }
        }
    }
};

// By place: its point, its share of the area, and the picture there.
struct Sampled {
    float x[kMostPlaces], y[kMostPlaces], area[kMostPlaces];
    float values[kMaxChannels][kMostPlaces];
};

TESSERA_VECTOR_CLONES void findPoints(const float* cubic, const float* quadratic, size_t padded,
                                      const Coefficients& c, Sampled& out) {
    for (size_t k = 0; k < padded; k += kLanes) {
        Vector x = {}, y = {}, vx = {}, vy = {}, wx = {}, wy = {};
        for (size_t i = 0; i < 10; ++i) {
            const Vector b = load(cubic + i * padded + k);
            x += b * c.x[i];
            y += b * c.y[i];
        }
        for (size_t i = 0; i < 6; ++i) {
            const Vector b = load(quadratic + i * padded + k);
            vx += b * c.dv[i][0];
            vy += b * c.dv[i][1];
            wx += b * c.dw[i][0];
            wy += b * c.dw[i][1];
        }
        lanes(out.x + k) = x;
        lanes(out.y + k) = y;
        lanes(out.area + k) = vx * wy - vy * wx;
    }
}

template <int kChannels>
inline __attribute__((always_inline)) double residual(const float* polynomial, size_t padded,
                                                      const Sampled& s) {
    float taken[kTerms][kChannels];
    for (size_t t = 0; t < size_t(kTerms); ++t) {
        Vector sum[kChannels] = {};
        for (size_t k = 0; k < padded; k += kLanes) {
            const Vector p = load(polynomial + t * padded + k);
            for (size_t c = 0; c < kChannels; ++c) sum[c] += p * load(s.values[c] + k);
        }
        for (size_t c = 0; c < kChannels; ++c) taken[t][c] = total(sum[c]);
    }
    Vector error = {};
    for (size_t k = 0; k < padded; k += kLanes) {
        Vector rest[kChannels];
        for (size_t c = 0; c < kChannels; ++c) rest[c] = load(s.values[c] + k);
        for (size_t t = 0; t < size_t(kTerms); ++t) {
            const Vector p = load(polynomial + t * padded + k);
            for (size_t c = 0; c < kChannels; ++c) rest[c] -= p * taken[t][c];
        }
        Vector squared = {};
        for (size_t c = 0; c < kChannels; ++c) squared += rest[c] * rest[c];
        error += squared * load(s.area + k);
    }
    return double(total(error));
}

TESSERA_VECTOR_CLONES double residual3(const float* polynomial, size_t padded, const Sampled& s) {
    return residual<3>(polynomial, padded, s);
}
TESSERA_VECTOR_CLONES double residual4(const float* polynomial, size_t padded, const Sampled& s) {
    return residual<4>(polynomial, padded, s);
}

}  // namespace

// The middles of the domain's perSide^2 small triangles.
ParameterFit::Places::Places(int perSide) {
    std::vector<glm::dvec2> at;
    for (int i = 0; i < perSide; ++i)
        for (int j = 0; i + j < perSide; ++j) {
            at.push_back(glm::dvec2(i + 1 / 3.0, j + 1 / 3.0) / double(perSide));
            if (i + j + 1 < perSide) at.push_back(glm::dvec2(i + 2 / 3.0, j + 2 / 3.0) / double(perSide));
        }
    const size_t count = at.size();
    padded = roundUp(count, kLanes);
    const auto bernstein = [&](const auto& exponents, int degree, std::vector<float>& rows) {
        rows.assign(exponents.size() * padded, 0);
        for (size_t i = 0; i < exponents.size(); ++i) {
            const auto [v, w] = exponents[i];
            const int u = degree - v - w;
            const double factor =
                std::tgamma(degree + 1) / (std::tgamma(u + 1) * std::tgamma(v + 1) * std::tgamma(w + 1));
            for (size_t k = 0; k < count; ++k)
                rows[i * padded + k] = float(factor * std::pow(1 - at[k].x - at[k].y, u) *
                                             std::pow(at[k].x, v) * std::pow(at[k].y, w));
        }
    };
    bernstein(kCubic, 3, cubic);
    bernstein(kQuadratic, 2, quadratic);

    // Modified Gram-Schmidt over the monomials about the middle.
    std::vector<std::vector<double>> rows;
    for (int d = 0; d <= kDegree; ++d)
        for (int j = 0; j <= d; ++j) {
            std::vector<double> row(count);
            for (size_t k = 0; k < count; ++k)
                row[k] = std::pow(at[k].x - 1 / 3.0, d - j) * std::pow(at[k].y - 1 / 3.0, j);
            const auto product = [&](const std::vector<double>& other) {
                double sum = 0;
                for (size_t k = 0; k < count; ++k) sum += row[k] * other[k];
                return sum;
            };
            for (const auto& other : rows) {
                const double along = product(other);
                for (size_t k = 0; k < count; ++k) row[k] -= along * other[k];
            }
            const double norm = std::sqrt(product(row));
            for (double& value : row) value /= norm;
            rows.push_back(std::move(row));
        }
    polynomial.assign(size_t(kTerms) * padded, 0);
    for (size_t t = 0; t < rows.size(); ++t)
        for (size_t k = 0; k < count; ++k) polynomial[t * padded + k] = float(rows[t][k]);
}

// The picture is smoothed because noise cannot be fitted, and because interpolation between pixels would take
// more of it away at some places than at others, which a bend could make use of.
ParameterFit::ParameterFit(const Image& picture, const std::stop_token& stop)
    : mWidth(picture.width()),
      mHeight(picture.height()),
      mChannels(picture.channels()),
      mPixels((size_t(mWidth) + 1) * (size_t(mHeight) + 1) * kMaxChannels) {
    TESSERA_CHECK(mChannels == 3 || mChannels == 4);
    const auto width = size_t(mWidth);
    parallelFor(size_t(mHeight) + 1, 16, [&](size_t begin, size_t end) {
        std::vector<float> column(width);
        for (size_t y = begin; y < end && !stop.stop_requested(); ++y)
            for (int c = 0; c < mChannels; ++c) {
                // Across the picture's border there is nothing to smooth with.
                const size_t last = size_t(mHeight) - 1, row = std::min(y, last);
                const size_t reach = row > 0 && row < last ? width : 0;
                const float* middle = picture.plane(c).data() + row * width;
                for (size_t x = 0; x < width; ++x)
                    column[x] = .25F * ((middle - reach)[x] + (middle + reach)[x]) + .5F * middle[x];
                float* out = mPixels.data() + y * (width + 1) * kMaxChannels + c;
                out[0] = column[0];
                for (size_t x = 1; x + 1 < width; ++x)
                    out[x * kMaxChannels] = .25F * (column[x - 1] + column[x + 1]) + .5F * column[x];
                out[(width - 1) * kMaxChannels] = out[width * kMaxChannels] = column[width - 1];
            }
    });
    for (int n = kFewestPerSide; n <= kMostPerSide && !stop.stop_requested(); n += 2) mPlaces.emplace_back(n);
}

template <int kChannels>
double ParameterFit::errorOf(const LatticeTriangle& patch, const Places& places, double growth) const {
    const BezierTriangle t = grown(toPixels(patch), growth);
    // Near the patch, so that floats carry it exactly enough; the middles of pixels at whole numbers.
    const int originX = int(t.p[0].x), originY = int(t.p[0].y);
    const Coefficients coefficients(t, {originX + .5, originY + .5});
    Sampled s;
    findPoints(places.cubic.data(), places.quadratic.data(), places.padded, coefficients, s);
    const float left = float(originX), top = float(originY);
    const float right = float(mWidth - 1), bottom = float(mHeight - 1);
    const float lastColumn = float(std::max(0, mWidth - 2)), lastRow = float(std::max(0, mHeight - 2));
    const size_t stride = (size_t(mWidth) + 1) * kMaxChannels;
    for (size_t k = 0; k < places.padded; ++k) {
        // Colours go on linearly from the outer pixels' middles.
        const float x = std::clamp(s.x[k] + left, -1.F, right + 1),
                    y = std::clamp(s.y[k] + top, -1.F, bottom + 1);
        if (x < -.5F || x > right + .5F || y < -.5F || y > bottom + .5F || s.area[k] < 0) s.area[k] = 0;
        const auto column = size_t(std::clamp(x, 0.F, lastColumn)), row = size_t(std::clamp(y, 0.F, lastRow));
        const float fx = x - float(column), fy = y - float(row);
        const float* upper = mPixels.data() + row * stride + column * kMaxChannels;
        const float* lower = upper + stride;
        for (size_t c = 0; c < kChannels; ++c) {
            const float a = upper[c] + fx * (upper[c + kMaxChannels] - upper[c]);
            const float b = lower[c] + fx * (lower[c + kMaxChannels] - lower[c]);
            s.values[c][k] = a + fy * (b - a);
        }
    }
    if constexpr (kChannels == 3) return residual3(places.polynomial.data(), places.padded, s);
    return residual4(places.polynomial.data(), places.padded, s);
}

double ParameterFit::error(const LatticeTriangle& patch) const {
    const glm::dvec2 a = toPixels(patch.corner(0)), b = toPixels(patch.corner(1)),
                     c = toPixels(patch.corner(2));
    const double area = std::max(.5 * cross(b - a, c - a), kLeastArea);
    // A triangle whose sides move outwards by kGrowPx grows by that over the radius of its inscribed circle.
    const double radius = 2 * area / (glm::length(b - a) + glm::length(c - b) + glm::length(a - c));
    const double growth = std::min(1 + kGrowPx / radius, kMostGrowth);
    const int perSide =
        std::clamp(2 * int(std::lround(std::sqrt(area) * growth / 2)), kFewestPerSide, kMostPerSide);
    const Places& places = mPlaces[size_t(perSide - kFewestPerSide) / 2];
    const double sum = mChannels == 3 ? errorOf<3>(patch, places, growth) : errorOf<4>(patch, places, growth);
    return sum / (2.0 * perSide * perSide);
}

}  // namespace tessera
