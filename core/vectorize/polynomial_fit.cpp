// See polynomial_fit.h.
#include "core/vectorize/polynomial_fit.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/base/check.h"
#include "core/mesh/tps.h"

namespace tessera {

namespace {

constexpr int kDegree = PolynomialFit::kDegree;
constexpr int kTerms = PolynomialFit::kTerms;
constexpr int kPowers = kDegree + 1;
constexpr int kGramPowers = 2 * kDegree + 1;
constexpr size_t kLanes = 8;

typedef float Vector __attribute__((vector_size(kLanes * sizeof(float))));
typedef int32_t IntVector __attribute__((vector_size(kLanes * sizeof(int32_t))));

constexpr IntVector kLaneIndex{0, 1, 2, 3, 4, 5, 6, 7};

// Sums along a run of pixels: of t^i times each channel's value, and of the squared values.
struct RowSums {
    float moments[kPowers][kMaxChannels];
    float energy;
};

inline __attribute__((always_inline)) float total(Vector v) {
    return ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
}

// t runs from t0 in steps of dt; `base` is subtracted from the values.
template <int kChannels>
inline __attribute__((always_inline)) void sumRow(const float* const* rows, int count, float t0, float dt,
                                                  const float* base, RowSums& out) {
    Vector moments[kPowers][kChannels] = {}, energy = {};
    for (int k = 0; k < count; k += int(kLanes)) {
        const IntVector lane = kLaneIndex + k;
        const IntVector inside = lane < count;
        const Vector t = t0 + dt * __builtin_convertvector(lane, Vector);
        for (int c = 0; c < kChannels; ++c) {
            Vector value;
            std::memcpy(&value, rows[c] + k, sizeof value);
            value = value - base[c];
            value = (Vector)((IntVector)value & inside);
            energy += value * value;
            moments[0][c] += value;
            for (int i = 1; i < kPowers; ++i) {
                value *= t;
                moments[i][c] += value;
            }
        }
    }
    out.energy = total(energy);
    for (int i = 0; i < kPowers; ++i) {
        for (int c = 0; c < kChannels; ++c) out.moments[i][c] = total(moments[i][c]);
        for (int c = kChannels; c < kMaxChannels; ++c) out.moments[i][c] = 0;
    }
}

// The same arithmetic with and without AVX2, so that results do not depend on the machine.
__attribute__((target_clones("avx2", "default"))) void sumRow3(const float* const* rows, int count, float t0,
                                                               float dt, const float* base, RowSums& out) {
    sumRow<3>(rows, count, t0, dt, base, out);
}
__attribute__((target_clones("avx2", "default"))) void sumRow4(const float* const* rows, int count, float t0,
                                                               float dt, const float* base, RowSums& out) {
    sumRow<4>(rows, count, t0, dt, base, out);
}

// Binomial coefficients by power and choice.
struct Binomials {
    int at[kGramPowers][kGramPowers];
    constexpr Binomials() : at() {
        for (int n = 0; n < kGramPowers; ++n)
            for (int k = 0; k <= n; ++k) at[n][k] = k == 0 || k == n ? 1 : at[n - 1][k - 1] + at[n - 1][k];
    }
};
constexpr Binomials kBinomials;

// Exponents of the terms by ascending degree.
struct Exponents {
    int x[kTerms], y[kTerms];
    constexpr Exponents() : x(), y() {
        int n = 0;
        for (int d = 0; d <= kDegree; ++d)
            for (int j = 0; j <= d; ++j, ++n) {
                x[n] = d - j;
                y[n] = j;
            }
    }
};
constexpr Exponents kExponents;

}  // namespace

// Sums over the pixels in coordinates in which the triangle is about as wide as high and not slanted: y' =
// (y - cy) / scaleY, x' = (x - cx - shear (y - cy)) / scaleX.
struct PolynomialFit::Sums {
    double cx, cy, shear, scaleX, scaleY;
    float base[kMaxChannels];
    double gram[kGramPowers][kGramPowers] = {};  // [power of x'][power of y']
    double moments[kPowers][kPowers][kMaxChannels] = {};
    double energy = 0;

    double residual() const;
};

PolynomialFit::PolynomialFit(const Image& picture)
    : mWidth(picture.width()),
      mHeight(picture.height()),
      mChannels(picture.channels()),
      mStride((size_t(mWidth) + 2 * kLanes - 1) / kLanes * kLanes),
      mPixels(mStride * size_t(mHeight) * size_t(mChannels)),
      mEvenPowers(size_t(mWidth) + 1) {
    TESSERA_CHECK(mChannels == 3 || mChannels == 4);
    for (int c = 0; c < mChannels; ++c)
        for (int y = 0; y < mHeight; ++y)
            std::copy_n(picture.plane(c).data() + size_t(y) * size_t(mWidth), mWidth,
                        mPixels.data() + (size_t(c) * size_t(mHeight) + size_t(y)) * mStride);
    // Sums over u = -(n - 1) / 2 .. (n - 1) / 2; two more of them make n from n - 2.
    for (size_t n = 0; n < mEvenPowers.size(); ++n) {
        auto& e = mEvenPowers[n];
        if (n >= 2) e = mEvenPowers[n - 2];
        if (n == 1) e[0] = 1;
        if (n < 2) continue;
        const double u2 = .25 * double(n - 1) * double(n - 1);
        double power = 2;
        for (double& sum : e) {
            sum += power;
            power *= u2;
        }
    }
}

void PolynomialFit::addRun(int y, int begin, int end, Sums& s) const {
    const float* rows[kMaxChannels] = {};
    for (int c = 0; c < mChannels; ++c)
        rows[c] = mPixels.data() + (size_t(c) * size_t(mHeight) + size_t(y)) * mStride + begin;
    const double dy = y + .5 - s.cy, inverse = 1 / s.scaleX;
    const double t0 = (begin + .5 - s.cx - s.shear * dy) * inverse;
    RowSums row;
    const int count = end - begin;
    if (mChannels == 3)
        sumRow3(rows, count, float(t0), float(inverse), s.base, row);
    else
        sumRow4(rows, count, float(t0), float(inverse), s.base, row);

    // Sums of t^i about the run's middle, where odd powers vanish.
    const double middle = t0 + .5 * (count - 1) * inverse;
    double middlePower[kGramPowers], even[kPowers], powers[kGramPowers];
    middlePower[0] = 1;
    for (int i = 1; i < kGramPowers; ++i) middlePower[i] = middlePower[i - 1] * middle;
    double scale = 1;
    for (int k = 0; k < kPowers; ++k, scale *= inverse * inverse)
        even[k] = mEvenPowers[size_t(count)][size_t(k)] * scale;
    for (int i = 0; i < kGramPowers; ++i) {
        powers[i] = 0;
        for (int k = 0; 2 * k <= i; ++k)
            powers[i] += kBinomials.at[i][2 * k] * middlePower[i - 2 * k] * even[k];
    }

    const double yScaled = dy / s.scaleY;
    double yPower = 1;
    for (int j = 0; j < kGramPowers; ++j, yPower *= yScaled) {
        for (int i = 0; i + j < kGramPowers; ++i) s.gram[i][j] += powers[i] * yPower;
        for (int i = 0; i + j < kPowers; ++i)
            for (int c = 0; c < kMaxChannels; ++c) s.moments[i][j][c] += double(row.moments[i][c]) * yPower;
    }
    s.energy += double(row.energy);
}

// Energy less what the polynomials take: with the Gram matrix L L^T and the moments b, |L^-1 b|^2.
double PolynomialFit::Sums::residual() const {
    double l[kTerms][kTerms], z[kTerms][kMaxChannels];
    double taken = 0;
    for (int p = 0; p < kTerms; ++p) {
        const int xp = kExponents.x[p], yp = kExponents.y[p];
        for (int q = 0; q <= p; ++q) {
            double sum = gram[xp + kExponents.x[q]][yp + kExponents.y[q]];
            for (int k = 0; k < q; ++k) sum -= l[p][k] * l[q][k];
            l[p][q] = p == q ? sum : sum * l[q][q];
        }
        // A term that the pixels cannot tell from the ones before takes nothing.
        constexpr double kDependent = 1e-9;
        const double pivot = l[p][p], own = gram[2 * xp][2 * yp];
        const bool used = pivot > kDependent * own && pivot > 0;
        l[p][p] = used ? 1 / std::sqrt(pivot) : 0;
        for (int c = 0; c < kMaxChannels; ++c) {
            double sum = moments[xp][yp][c];
            for (int k = 0; k < p; ++k) sum -= l[p][k] * z[k][c];
            z[p][c] = sum * l[p][p];
            taken += z[p][c] * z[p][c];
        }
    }
    return std::max(0.0, energy - taken);
}

double PolynomialFit::error(const std::array<glm::dvec2, 3>& corners,
                            std::span<const glm::dvec2> outline) const {
    const glm::dvec2 centre = (corners[0] + corners[1] + corners[2]) / 3.0;
    double xx = 0, xy = 0, yy = 0;
    for (const glm::dvec2& p : corners) {
        const glm::dvec2 d = p - centre;
        xx += d.x * d.x;
        xy += d.x * d.y;
        yy += d.y * d.y;
    }
    // Half the extent of an equilateral triangle of the same second moments, about; never below half a pixel.
    Sums sums;
    sums.cx = centre.x;
    sums.cy = centre.y;
    sums.shear = yy > 0 ? xy / yy : 0;
    sums.scaleX = std::max(.5, .7 * std::sqrt(std::max(0.0, xx - sums.shear * xy)));
    sums.scaleY = std::max(.5, .7 * std::sqrt(yy));
    const int px = std::clamp(int(centre.x), 0, mWidth - 1), py = std::clamp(int(centre.y), 0, mHeight - 1);
    for (int c = 0; c < mChannels; ++c)
        sums.base[c] = mPixels[(size_t(c) * size_t(mHeight) + size_t(py)) * mStride + size_t(px)];
    for (int c = mChannels; c < kMaxChannels; ++c) sums.base[c] = 0;

    double top = outline[0].y, bottom = top;
    for (const glm::dvec2& p : outline) {
        top = std::min(top, p.y);
        bottom = std::max(bottom, p.y);
    }
    const int y0 = std::max(0, int(std::ceil(top - .5))), y1 = std::min(mHeight, int(std::ceil(bottom - .5)));
    constexpr size_t kMaxCrossings = 16;
    for (int y = y0; y < y1; ++y) {
        double crossings[kMaxCrossings];
        size_t n = 0;
        const double centreY = y + .5;
        for (size_t k = 0, count = outline.size(); k < count && n < kMaxCrossings; ++k) {
            const glm::dvec2 &a = outline[k], &b = outline[k + 1 == count ? 0 : k + 1];
            if ((a.y <= centreY) == (b.y <= centreY)) continue;
            const double x = a.x + (b.x - a.x) * ((centreY - a.y) / (b.y - a.y));
            size_t i = n++;
            for (; i > 0 && crossings[i - 1] > x; --i) crossings[i] = crossings[i - 1];
            crossings[i] = x;
        }
        for (size_t i = 0; i + 1 < n; i += 2) {
            const int begin = std::max(0, int(std::ceil(crossings[i] - .5)));
            const int end = std::min(mWidth, int(std::ceil(crossings[i + 1] - .5)));
            if (begin < end) addRun(y, begin, end, sums);
        }
    }
    return sums.residual();
}

}  // namespace tessera
