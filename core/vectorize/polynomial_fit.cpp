// See polynomial_fit.h.
#include "core/vectorize/polynomial_fit.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/base/check.h"
#include "core/mesh/tps.h"

// All of error() is built twice, with and without AVX2. Both do the same arithmetic, so that results do not
// depend on the machine.
#define TESSERA_INLINE inline __attribute__((always_inline))
#define TESSERA_CLONES __attribute__((target_clones("avx2", "default")))

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

struct Pixels {
    const float* first;
    size_t stride, plane;
    int width, height;
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
    Quad gram[(kGramTerms + kQuad - 1) / kQuad * kQuad];  // of the terms' values over j!
    Quad moments[kChannels][kTerms];                      // of the terms' values times the channel's
    Quad energy;
};

// The pixels top <= y < bottom of eight neighbouring columns, of which some may be empty.
struct Columns {
    int first;
    int32_t top[kLanes], bottom[kLanes];
};

TESSERA_INLINE Quad quad(double value) {
    return Quad{value, value, value, value};
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
    const Quad even[kPowers] = {
        n,
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
TESSERA_INLINE void addMoments(const float* pixel, size_t stride, int rows, float base, const Floats* ys,
                               const Ints* inside, const Quad* x, Quad* moments, Quad& energySum) {
    Floats sums[kPowers] = {}, energy = {};
    for (int r = 0; r < rows; ++r, pixel += stride) {
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
    addGram(f, c, 0, s.gram);
    addGram(f, c, 1, s.gram);
    int32_t top = p.height, bottom = 0;
    for (int k = 0; k < kLanes; ++k) {
        if (c.top[k] >= c.bottom[k]) continue;
        top = std::min(top, c.top[k]);
        bottom = std::max(bottom, c.bottom[k]);
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
            addMoments(p.first + size_t(k) * p.plane + size_t(y0) * p.stride + size_t(c.first), p.stride, rows,
                       f.base[k], ys, inside, x, s.moments[k], s.energy);
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
    for (int x = x0; x < x1; x += kLanes) {
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
    const Quad ab = __builtin_shufflevector(v[0], v[1], 0, 4, 2, 6) +
                    __builtin_shufflevector(v[0], v[1], 1, 5, 3, 7);
    const Quad cd = __builtin_shufflevector(v[2], v[3], 0, 4, 2, 6) +
                    __builtin_shufflevector(v[2], v[3], 1, 5, 3, 7);
    const Quad sum =
        __builtin_shufflevector(ab, cd, 0, 1, 4, 5) + __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
    std::memcpy(out, &sum, sizeof sum);
}

// The lower triangle of the normal equations by columns, below it a row of moments for each channel.
template <int kChannels>
struct Equations {
    static constexpr int kVectors = (kTerms + kChannels + kQuad - 1) / kQuad;
    static constexpr int kColumns = (kTerms + kQuad - 1) / kQuad * kQuad;

    alignas(sizeof(Quad)) double at[kColumns][kVectors * kQuad];
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
        }
}

// Energy less what the polynomials take, by L D L^T in blocks of four columns: each term takes the square of
// what is left of its moment over its pivot.
template <int kChannels>
TESSERA_INLINE double residual(const Sums<kChannels>& sums) {
    constexpr int kVectors = Equations<kChannels>::kVectors;
    Equations<kChannels> e;
    assemble(sums, e);
    double own[kTerms], taken = 0;
    for (int p = 0; p < kTerms; ++p) own[p] = e.at[p][p];
    for (int block = 0; block * kQuad < kTerms; ++block) {
        const int first = block * kQuad, end = std::min(first + kQuad, kTerms);
        double inverse[kQuad] = {};
        for (int p = first; p < end; ++p) {
            const double* const column = e.at[p];
            // A term that the pixels cannot tell from the ones before takes nothing.
            constexpr double kDependent = 1e-9;
            const double pivot = column[p];
            const double over = pivot > kDependent * own[p] && pivot > 0 ? 1 / pivot : 0;
            inverse[p - first] = over;
            for (int c = 0; c < kChannels; ++c)
                taken += column[kTerms + c] * column[kTerms + c] * over;
            for (int q = p + 1; q < end; ++q) {
                const double factor = column[q] * over;
                for (int r = block; r < kVectors; ++r) {
                    Quad a, b;
                    std::memcpy(&a, e.at[q] + r * kQuad, sizeof a);
                    std::memcpy(&b, column + r * kQuad, sizeof b);
                    a -= b * factor;
                    std::memcpy(e.at[q] + r * kQuad, &a, sizeof a);
                }
            }
        }
        if (end == kTerms) break;
        for (int q = end; q < kTerms; ++q) {
            double factor[kQuad];
            for (int k = 0; k < kQuad; ++k) factor[k] = e.at[first + k][q] * inverse[k];
            for (int r = q / kQuad; r < kVectors; ++r) {
                Quad a, b[kQuad];
                std::memcpy(&a, e.at[q] + r * kQuad, sizeof a);
                for (int k = 0; k < kQuad; ++k) std::memcpy(&b[k], e.at[first + k] + r * kQuad, sizeof a);
                a -= (b[0] * factor[0] + b[1] * factor[1]) + (b[2] * factor[2] + b[3] * factor[3]);
                std::memcpy(e.at[q] + r * kQuad, &a, sizeof a);
            }
        }
    }
    return std::max(0.0, e.energy - taken);
}

template <int kChannels>
TESSERA_INLINE double errorOf(const Pixels& p, const Frame& f, std::span<const glm::dvec2> outline) {
    Sums<kChannels> sums = {};
    addOutline(p, f, outline, sums);
    return residual(sums);
}

TESSERA_CLONES double error3(const Pixels& p, const Frame& f, std::span<const glm::dvec2> outline) {
    return errorOf<3>(p, f, outline);
}
TESSERA_CLONES double error4(const Pixels& p, const Frame& f, std::span<const glm::dvec2> outline) {
    return errorOf<4>(p, f, outline);
}

}  // namespace

PolynomialFit::PolynomialFit(const Image& picture)
    : mWidth(picture.width()),
      mHeight(picture.height()),
      mChannels(picture.channels()),
      mStride((size_t(mWidth) + 2 * kLanes - 1) / kLanes * kLanes),
      mPixels(mStride * size_t(mHeight) * size_t(mChannels)) {
    TESSERA_CHECK(mChannels == 3 || mChannels == 4);
    for (int c = 0; c < mChannels; ++c)
        for (int y = 0; y < mHeight; ++y)
            std::copy_n(picture.plane(c).data() + size_t(y) * size_t(mWidth), mWidth,
                        mPixels.data() + (size_t(c) * size_t(mHeight) + size_t(y)) * mStride);
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
    const Pixels pixels{mPixels.data(), mStride, mStride * size_t(mHeight), mWidth, mHeight};
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
    for (int c = 0; c < mChannels; ++c)
        frame.base[c] = pixels.first[size_t(c) * pixels.plane + size_t(py) * mStride + size_t(px)];
    return mChannels == 3 ? error3(pixels, frame, outline) : error4(pixels, frame, outline);
}

}  // namespace tessera
