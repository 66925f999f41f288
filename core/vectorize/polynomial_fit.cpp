// See polynomial_fit.h.
#include "core/vectorize/polynomial_fit.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/base/round_up.h"
#include "core/base/vector_clones.h"
#include "core/mesh/tps.h"

// No vector crosses a call, for whose conventions the compiler warns: what has vectors is inlined.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace tessera {

namespace {

constexpr int kDegree = PolynomialFit::kDegree;
constexpr int kTerms = PolynomialFit::kTerms;
constexpr int kPowers = kDegree + 1;
constexpr int kGramDegree = 2 * kDegree;
constexpr int kGramTerms = (kGramDegree + 1) * (kGramDegree + 2) / 2;

constexpr int kLanes = 8;  // columns that are summed at once
constexpr int kQuad = 4;
typedef float Floats __attribute__((vector_size(kLanes * sizeof(float))));
typedef int32_t Ints __attribute__((vector_size(kLanes * sizeof(int32_t))));
typedef double Quad __attribute__((vector_size(kQuad * sizeof(double))));
typedef float HalfFloats __attribute__((vector_size(kQuad * sizeof(float))));
typedef int32_t HalfInts __attribute__((vector_size(kQuad * sizeof(int32_t))));

// Terms x^(d-j) y^j come by ascending degree d, then by j.
constexpr int term(int degree, int j) {
    return degree * (degree + 1) / 2 + j;
}

// One over the factorials.
struct InverseFactorials {
    double at[kGramDegree + 1];
    constexpr InverseFactorials() : at() {
        double factorial = 1;
        for (int n = 0; n <= kGramDegree; factorial *= ++n) at[n] = 1 / factorial;
    }
};
constexpr InverseFactorials kInverseFactorial;

// Strips eight pixels wide from top to bottom; a row of a strip holds its channels one after the other. What
// a triangle needs lies close together.
struct Pixels {
    const float* first;
    int width, height;

    template <int kChannels>
    TESSERA_INLINE const float* row(int x, int y) const {
        return first + (size_t(x / kLanes) * size_t(height) + size_t(y)) * size_t(kChannels * kLanes);
    }
};

// Coordinates in which the triangle is about as wide as high and not slanted: x' = (x - cx) / scaleX,
// y' = (y - cy - shear (x - cx)) / scaleY.
struct Frame {
    double cx, cy, shear, inverseX, inverseY;
    // Of the sums of y'^2k / (2k)! along a column of n pixels about its middle: those that stand before the
    // integer polynomials in n (see addGram).
    double even[kPowers];
    float base[kMaxChannels];  // is subtracted from the values
};

// Sums over the pixels; what the lanes hold is added up at the end.
template <int kChannels>
struct Sums {
    Quad gram[roundUp(kGramTerms, kQuad)];  // of the terms' values over j!
    Quad moments[kChannels][kTerms];        // of the terms' values times the channel's
    Quad energy;
};

// The pixels top <= y < bottom of the columns of a strip, of which some may be empty.
struct Columns {
    int first;
    int32_t top[kLanes], bottom[kLanes];
};

TESSERA_INLINE Quad quad(double value) {
    return Quad{value, value, value, value};
}

TESSERA_INLINE Quad load(const double* from) {
    Quad value;
    std::memcpy(&value, from, sizeof value);
    return value;
}

TESSERA_INLINE void store(const Quad& value, double* to) {
    std::memcpy(to, &value, sizeof value);
}

TESSERA_INLINE void convertHalf(const Floats& from, int half, Quad& to) {
    HalfFloats part;
    std::memcpy(&part, reinterpret_cast<const float*>(&from) + half * kQuad, sizeof part);
    to = __builtin_convertvector(part, Quad);
}

// Sums along half of the columns in closed form. With everything over factorials, moving the sums of even
// powers about the middles (the odd ones vanish) to the origin is a product of polynomials.
TESSERA_INLINE void addGram(const Frame& f, const Columns& c, int half, Quad* gram) {
    HalfInts topInts, bottomInts;
    std::memcpy(&topInts, c.top + half * kQuad, sizeof topInts);
    std::memcpy(&bottomInts, c.bottom + half * kQuad, sizeof bottomInts);
    const Quad top = __builtin_convertvector(topInts, Quad);
    const Quad bottom = __builtin_convertvector(bottomInts, Quad);
    const Quad dx = quad(c.first + half * kQuad + .5 - f.cx) + Quad{0, 1, 2, 3};
    const Quad x = dx * f.inverseX;
    const Quad middle = ((top + bottom) * .5 - f.cy - f.shear * dx) * f.inverseY;
    const Quad n = bottom - top, n2 = n * n, cubic = n * (n2 - 1);
    const Quad even[kPowers] = {n,
                                cubic * f.even[1],
                                cubic * (3 * n2 - 7) * f.even[2],
                                cubic * ((3 * n2 - 18) * n2 + 31) * f.even[3],
                                cubic * (((5 * n2 - 55) * n2 + 239) * n2 - 381) * f.even[4],
                                cubic * ((((3 * n2 - 52) * n2 + 410) * n2 - 1636) * n2 + 2555) * f.even[5]};
    Quad power[kGramDegree + 1], xPower[kGramDegree + 1];
    power[0] = xPower[0] = quad(1);
    for (int i = 1; i <= kGramDegree; ++i) {
        power[i] = power[i - 1] * middle;
        xPower[i] = xPower[i - 1] * x;
    }
    for (int i = 2; i <= kGramDegree; ++i) power[i] *= kInverseFactorial.at[i];
#pragma GCC unroll 11
    for (int j = 0; j <= kGramDegree; ++j) {
        Quad sum = power[j] * even[0];
#pragma GCC unroll 5
        for (int k = 1; 2 * k <= j; ++k) sum += power[j - 2 * k] * even[k];
#pragma GCC unroll 11
        for (int i = 0; i + j <= kGramDegree; ++i) gram[term(i + j, j)] += sum * xPower[i];
    }
}

// Rows that are summed as floats before they are added to the doubles.
constexpr int kChunk = 64;

// Of one channel: along the columns over y, then times powers of x.
template <int kChannels>
TESSERA_INLINE void addMoments(const float* pixel, int rows, float base, const Floats* ys, const Ints* inside,
                               const Quad* x, Quad* moments, Quad& energySum) {
    Floats sums[kPowers] = {}, energy = {};
    for (int r = 0; r < rows; ++r, pixel += kChannels * kLanes) {
        Floats value;
        std::memcpy(&value, pixel, sizeof value);
        value = (Floats)((Ints)(value - base) & inside[r]);
        const Floats y = ys[r];
        energy += value * value;
        sums[0] += value;
#pragma GCC unroll 5
        for (int j = 1; j < kPowers; ++j) {
            value *= y;
            sums[j] += value;
        }
    }
    for (int half = 0; half < 2; ++half) {
        Quad part;
        convertHalf(energy, half, part);
        energySum += part;
#pragma GCC unroll 6
        for (int j = 0; j < kPowers; ++j) {
            convertHalf(sums[j], half, part);
            moments[term(j, j)] += part;
#pragma GCC unroll 5
            for (int i = 1; i + j < kPowers; ++i) {
                part *= x[half];
                moments[term(i + j, j)] += part;
            }
        }
    }
}

template <int kChannels>
TESSERA_INLINE void addColumns(const Pixels& p, const Frame& f, const Columns& c, Sums<kChannels>& s) {
    int32_t top = p.height, bottom = 0;
    for (int half = 0; half < 2; ++half) {
        bool any = false;
        for (int k = half * kQuad; k < (half + 1) * kQuad; ++k) {
            if (c.top[k] >= c.bottom[k]) continue;
            any = true;
            top = std::min(top, c.top[k]);
            bottom = std::max(bottom, c.bottom[k]);
        }
        if (any) addGram(f, c, half, s.gram);
    }
    Quad x[2], start[2];
    for (int half = 0; half < 2; ++half) {
        const Quad dx = quad(c.first + half * kQuad + .5 - f.cx) + Quad{0, 1, 2, 3};
        x[half] = dx * f.inverseX;
        start[half] = (.5 - f.cy - f.shear * dx) * f.inverseY;
    }
    Ints tops, bottoms;
    std::memcpy(&tops, c.top, sizeof tops);
    std::memcpy(&bottoms, c.bottom, sizeof bottoms);
    const float step = float(f.inverseY);
    for (int y0 = top; y0 < bottom; y0 += kChunk) {
        const int rows = std::min(kChunk, bottom - y0);
        Floats ys[kChunk];
        Ints inside[kChunk];
        HalfFloats starts[2];
        for (int half = 0; half < 2; ++half)
            starts[half] = __builtin_convertvector(start[half] + y0 * f.inverseY, HalfFloats);
        Floats first;
        std::memcpy(&first, starts, sizeof first);
        for (int r = 0; r < rows; ++r) {
            ys[r] = first + float(r) * step;
            inside[r] = (tops <= y0 + r) & (bottoms > y0 + r);
        }
        for (int k = 0; k < kChannels; ++k)
            addMoments<kChannels>(p.row<kChannels>(c.first, y0) + k * kLanes, rows, f.base[k], ys, inside, x,
                                  s.moments[k], s.energy);
    }
}

// The least integer that is not below v, for small v.
TESSERA_INLINE int ceiling(double v) {
    const int i = int(v);
    return i + (v > i);
}

// Cuts the outline into columns.
template <int kChannels>
TESSERA_INLINE void addOutline(const Pixels& p, const Frame& f, std::span<const glm::dvec2> outline,
                               Sums<kChannels>& sums) {
    double left = outline[0].x, right = left;
    for (const glm::dvec2& q : outline) {
        left = std::min(left, q.x);
        right = std::max(right, q.x);
    }
    const int x0 = std::max(0, ceiling(left - .5)), x1 = std::min(p.width, ceiling(right - .5));
    constexpr int kMaxCrossings = 16;
    for (int x = x0 / kLanes * kLanes; x < x1; x += kLanes) {
        const int end = std::min(x + kLanes, x1);
        double crossings[kLanes][kMaxCrossings];
        int counts[kLanes] = {};
        for (size_t k = 0, count = outline.size(); k < count; ++k) {
            const glm::dvec2 &a = outline[k], &b = outline[k + 1 == count ? 0 : k + 1];
            const int from = std::max(x, ceiling(std::min(a.x, b.x) - .5));
            const int to = std::min(end, ceiling(std::max(a.x, b.x) - .5));
            if (from >= to) continue;
            const double slope = (b.y - a.y) / (b.x - a.x);
            for (int column = from; column < to; ++column) {
                double* const sorted = crossings[column - x];
                int& n = counts[column - x];
                if (n == kMaxCrossings) continue;
                const double y = a.y + slope * (column + .5 - a.x);
                int i = n++;
                for (; i > 0 && sorted[i - 1] > y; --i) sorted[i] = sorted[i - 1];
                sorted[i] = y;
            }
        }
        bool more = true;
        for (int run = 0; more; run += 2) {
            Columns columns{x, {}, {}};
            more = false;
            bool any = false;
            for (int k = 0; k < kLanes; ++k) {
                if (run + 1 >= counts[k]) continue;
                const int top = std::max(0, ceiling(crossings[k][run] - .5));
                const int bottom = std::min(p.height, ceiling(crossings[k][run + 1] - .5));
                more = more || run + 3 < counts[k];
                if (top >= bottom) continue;
                any = true;
                columns.top[k] = top;
                columns.bottom[k] = bottom;
            }
            if (any) addColumns(p, f, columns, sums);
        }
    }
}

// The sums of four vectors' lanes.
TESSERA_INLINE void total(const Quad* v, double* out) {
    const Quad ab =
        __builtin_shufflevector(v[0], v[1], 0, 4, 2, 6) + __builtin_shufflevector(v[0], v[1], 1, 5, 3, 7);
    const Quad cd =
        __builtin_shufflevector(v[2], v[3], 0, 4, 2, 6) + __builtin_shufflevector(v[2], v[3], 1, 5, 3, 7);
    const Quad sum =
        __builtin_shufflevector(ab, cd, 0, 1, 4, 5) + __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
    std::memcpy(out, &sum, sizeof sum);
}

// The lower triangle of the normal equations by columns, below it a row of moments for each channel.
template <int kChannels>
struct Equations {
    static constexpr int kVectors = (kTerms + kChannels + kQuad - 1) / kQuad;
    static constexpr int kRows = kVectors * kQuad;

    alignas(sizeof(Quad)) double at[kTerms][kRows];
    double own[kTerms];  // the diagonal as it was
    double energy;
};

template <int kChannels>
TESSERA_INLINE void assemble(const Sums<kChannels>& s, Equations<kChannels>& e) {
    // Rows of a degree are copied as eight values, of which the next ones are overwritten later.
    constexpr int kCopied = 8;
    double gram[kGramTerms + kCopied + 1] = {};
    static_assert(sizeof s.gram / sizeof(Quad) <= kGramTerms + kCopied);
    for (int i = 0; i < kGramTerms; i += kQuad) total(s.gram + i, gram + i);
    for (int d = 0; d <= kGramDegree; ++d)
        for (int j = 2; j <= d; ++j) gram[term(d, j)] /= kInverseFactorial.at[j];
    double moments[kChannels][kTerms + kQuad];
    for (int c = 0; c < kChannels; ++c) {
        for (int i = 0; i + kQuad <= kTerms; i += kQuad) total(s.moments[c] + i, moments[c] + i);
        const Quad last = s.moments[c][kTerms - 1];
        moments[c][kTerms - 1] = (last[0] + last[1]) + (last[2] + last[3]);
    }
    e.energy = (s.energy[0] + s.energy[1]) + (s.energy[2] + s.energy[3]);
    for (int degree = 0; degree <= kDegree; ++degree)
        for (int j = 0; j <= degree; ++j) {
            double* const column = e.at[term(degree, j)];
            for (int d = degree; d <= kDegree; ++d)
                std::memcpy(column + term(d, 0), gram + term(degree + d, j), kCopied * sizeof(double));
            for (int c = 0; c < kChannels; ++c) column[kTerms + c] = moments[c][term(degree, j)];
            e.own[term(degree, j)] = gram[term(2 * degree, 2 * j)];
        }
}

// The pivots of the four terms of a block, one after the other: what they take, and what the terms of the
// block after them keep. Leaves each column's rows over its pivot in `factors`.
template <int kChannels, int kBlock>
TESSERA_INLINE double takeBlock(Equations<kChannels>& e, double (*factors)[Equations<kChannels>::kRows]) {
    constexpr int kVectors = Equations<kChannels>::kVectors;
    constexpr int kFirst = kBlock * kQuad, kEnd = std::min(kFirst + kQuad, kTerms);
    double taken = 0;
#pragma GCC unroll 4
    for (int p = kFirst; p < kEnd; ++p) {
        const double* const column = e.at[p];
        double* const factor = factors[p - kFirst];
        // A term that the pixels cannot tell from the ones before takes nothing.
        constexpr double kDependent = 1e-9;
        const double pivot = column[p];
        const double inverse = pivot > kDependent * e.own[p] && pivot > 0 ? 1 / pivot : 0;
        Quad below[kVectors - kBlock];
#pragma GCC unroll 7
        for (int r = kBlock; r < kVectors; ++r) {
            below[r - kBlock] = load(column + r * kQuad);
            store(below[r - kBlock] * inverse, factor + r * kQuad);
        }
        for (int c = 0; c < kChannels; ++c) taken += column[kTerms + c] * factor[kTerms + c];
#pragma GCC unroll 3
        for (int q = p + 1; q < kEnd; ++q)
#pragma GCC unroll 7
            for (int r = kBlock; r < kVectors; ++r)
                store(load(e.at[q] + r * kQuad) - below[r - kBlock] * factor[q], e.at[q] + r * kQuad);
    }
    return taken;
}

// Takes a block's share from the columns after it, then goes on with those; returns the energy taken.
template <int kChannels, int kBlock>
TESSERA_INLINE double takeFrom(Equations<kChannels>& e) {
    constexpr int kVectors = Equations<kChannels>::kVectors;
    constexpr int kFirst = kBlock * kQuad, kEnd = kFirst + kQuad;
    double factors[kQuad][Equations<kChannels>::kRows];
    const double taken = takeBlock<kChannels, kBlock>(e, factors);
    if constexpr (kEnd < kTerms) {
#pragma GCC unroll 7
        for (int r = kBlock + 1; r < kVectors; ++r) {
            Quad b[kQuad];
            for (int k = 0; k < kQuad; ++k) b[k] = load(e.at[kFirst + k] + r * kQuad);
            for (int q = kEnd; q < std::min((r + 1) * kQuad, kTerms); ++q) {
                double* const a = e.at[q] + r * kQuad;
                store(load(a) - ((b[0] * factors[0][q] + b[1] * factors[1][q]) +
                                 (b[2] * factors[2][q] + b[3] * factors[3][q])),
                      a);
            }
        }
        return taken + takeFrom<kChannels, kBlock + 1>(e);
    }
    return taken;
}

// Energy less what the polynomials take, by L D L^T in blocks of four columns: each term takes the square of
// what is left of its moment over its pivot.
template <int kChannels>
TESSERA_INLINE double residual(const Sums<kChannels>& sums) {
    Equations<kChannels> e;
    assemble(sums, e);
    return std::max(0.0, e.energy - takeFrom<kChannels, 0>(e));
}

template <int kChannels>
TESSERA_INLINE double errorOf(const Pixels& p, const Frame& f, std::span<const glm::dvec2> outline) {
    Sums<kChannels> sums = {};
    addOutline(p, f, outline, sums);
    return residual(sums);
}

TESSERA_VECTOR_CLONES double error3(const Pixels& p, const Frame& f, std::span<const glm::dvec2> outline) {
    return errorOf<3>(p, f, outline);
}
TESSERA_VECTOR_CLONES double error4(const Pixels& p, const Frame& f, std::span<const glm::dvec2> outline) {
    return errorOf<4>(p, f, outline);
}

}  // namespace

PolynomialFit::PolynomialFit(const Image& picture)
    : mWidth(picture.width()),
      mHeight(picture.height()),
      mChannels(picture.channels()),
      mPixels(size_t(roundUp(mWidth, kLanes)) * size_t(mHeight) * size_t(mChannels)) {
    TESSERA_CHECK(mChannels == 3 || mChannels == 4);
    parallelFor(size_t(mHeight), 64, [&](size_t begin, size_t end) {
        for (int c = 0; c < mChannels; ++c)
            for (int y = int(begin); y < int(end); ++y)
                for (int x = 0; x < mWidth; ++x) mPixels[index(x, y, c)] = picture.at(x, y, c);
    });
}

size_t PolynomialFit::index(int x, int y, int c) const {
    const size_t row = size_t(x / kLanes) * size_t(mHeight) + size_t(y);
    return (row * size_t(mChannels) + size_t(c)) * kLanes + size_t(x % kLanes);
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
    const Pixels pixels{mPixels.data(), mWidth, mHeight};
    // Half the extent of an equilateral triangle of the same second moments, about; never below half a pixel.
    Frame frame;
    frame.cx = centre.x;
    frame.cy = centre.y;
    frame.shear = xx > 0 ? xy / xx : 0;
    frame.inverseX = 1 / std::max(.5, .7 * std::sqrt(xx));
    frame.inverseY = 1 / std::max(.5, .7 * std::sqrt(std::max(0.0, yy - frame.shear * xy)));
    // Sums of u^2k over u = -(n - 1) / 2 .. (n - 1) / 2 are integer polynomials in n over these.
    constexpr double kDivisors[kPowers] = {1, 12, 240, 1344, 11520, 33792};
    double power = 1;
    for (int k = 0; k < kPowers; ++k, power *= frame.inverseY * frame.inverseY)
        frame.even[k] = power * kInverseFactorial.at[2 * k] / kDivisors[k];
    const int px = std::clamp(int(centre.x), 0, mWidth - 1), py = std::clamp(int(centre.y), 0, mHeight - 1);
    for (int c = 0; c < mChannels; ++c) frame.base[c] = mPixels[index(px, py, c)];
    return mChannels == 3 ? error3(pixels, frame, outline) : error4(pixels, frame, outline);
}

}  // namespace tessera
