// Splines at many points with vector instructions: the fast twin of evaluateSpline (COLOUR.md; paper Eqs. 2
// and 3). (evaluateKernels, which fits use, is in tps_kernels.cpp.)
#include <algorithm>
#include <array>
#include <limits>

#include "core/base/check.h"
#include "core/base/vector_math.h"
#include "core/mesh/tps.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace tessera {

namespace {

// phi = s^2 log s = (log 2 / 2) q log2 q with q = s^2; the constant goes into the alphas. With q = 2^e m, 1
// <= m < 2, and r = m / c - 1, c being the middle of the eighth of [1, 2) that m is in, log2 q = e + log2 c +
// P(r): P interpolates log2(1 + r) at the Chebyshev nodes of the |r| <= 1 / 17 that there are, and the middle
// of what is left in each eighth goes into its log2 c, so that the sum is within 5.7e-7. At q = 0 the
// exponent bits give e = -127 and the product is the wanted 0, without a branch. Permutations look the
// eighths up.
constexpr float kHalfLog2 = .34657359f;
constexpr int kEighths = 8, kEighthShift = 20;  // the three highest bits of the mantissa
constexpr float kInverseMiddle[kEighths] = {.941176474f, .842105269f, .761904776f, .695652187f,
                                            .639999986f, .592592597f, .551724136f, .516129017f};
constexpr float kLogMiddle[kEighths] = {.0874633789f, .247928053f, .392317951f, .523562491f,
                                        .643856764f,  .754887998f, .857981503f, .954196811f};
constexpr float kLogPolynomial[3] = {1.44269466f, -.722598076f, .481898904f};  // times r, r^2, r^3

// Places of centres in single precision.
template <size_t kCount>
struct FloatCentres {
    explicit FloatCentres(const std::array<glm::dvec2, kCount>& centres) {
        for (size_t i = 0; i < kCount; ++i) {
            x[i] = float(centres[i].x);
            y[i] = float(centres[i].y);
        }
    }

    std::array<float, kCount> x, y;
};

// A spline with its centres side by side. The first `shared` terms are of all channels, the missing alphas 0;
// those beyond are of channel 0 alone, which mostly has the most.
struct Packed {
    static constexpr int kMaxTerms = 255;

    Packed(const PatchSpline& spline, int channels) : terms(spline.maxTerms(channels)) {
        TESSERA_CHECK(size_t(terms) <= spline.centreCount());
        placeCentres(spline);
        shared = spline.terms[0] < terms ? terms : 0;
        for (int c = 1; c < channels; ++c) shared = std::max<int>(shared, spline.terms[size_t(c)]);
        const float* k = spline.coefficients.data();
        for (int c = 0; c < channels; ++c) {
            const int own = spline.terms[size_t(c)];
            for (int i = 0; i < 3; ++i) affine[c][i] = k[i];
            for (int i = 0; i < own; ++i) alpha[c][i] = kHalfLog2 * k[3 + i];
            for (int i = own; i < shared; ++i) alpha[c][i] = 0;
            k += 3 + own;
        }
    }

    void placeCentres(const PatchSpline& spline) {
        const auto count = size_t(terms);
        if (!spline.sites.empty()) {
            static const FloatCentres places(centreSites());
            for (size_t i = 0; i < count; ++i) {
                centreX[i] = places.x[spline.sites[i]];
                centreY[i] = places.y[spline.sites[i]];
            }
        } else if (!spline.centres.empty()) {
            for (size_t i = 0; i < count; ++i) {
                centreX[i] = spline.centres[i].x;
                centreY[i] = spline.centres[i].y;
            }
        } else {
            static const FloatCentres places(defaultCentres());
            std::copy_n(places.x.begin(), count, centreX);
            std::copy_n(places.y.begin(), count, centreY);
        }
    }

    int terms, shared;
    float affine[kMaxChannels][3];
    float centreX[kMaxTerms];
    float centreY[kMaxTerms];
    float alpha[kMaxChannels][kMaxTerms];
};

// Loops over blocks of points, of which the compiler makes the vectors that every machine has. Those cannot
// look eighths up, hence another logarithm.
void evaluateBaseline(const Packed& s, int channels, const float* x, const float* y, size_t count,
                      float* const* out) {
    constexpr size_t kBlock = 32;
    float px[kBlock] = {}, py[kBlock] = {}, phi[kBlock], sum[kMaxChannels][kBlock];
    for (size_t first = 0; first < count; first += kBlock) {
        const size_t points = std::min(kBlock, count - first);
        std::copy_n(x + first, points, px);
        std::copy_n(y + first, points, py);
        for (int c = 0; c < channels; ++c)
            for (size_t i = 0; i < kBlock; ++i)
                sum[c][i] = s.affine[c][0] + s.affine[c][1] * px[i] + s.affine[c][2] * py[i];
        for (int k = 0; k < s.terms; ++k) {
            for (size_t i = 0; i < kBlock; ++i) {
                const float dx = px[i] - s.centreX[k], dy = py[i] - s.centreY[k], q = dx * dx + dy * dy;
                phi[i] = q * fastLog2(q);  // finite at 0
            }
            for (int c = 0; c < (k < s.shared ? channels : 1); ++c)
                for (size_t i = 0; i < kBlock; ++i) sum[c][i] += s.alpha[c][k] * phi[i];
        }
        for (int c = 0; c < channels; ++c) std::copy_n(sum[c], points, out[c] + first);
    }
}

#if defined(__x86_64__)

#define TESSERA_AVX2 __attribute__((target("avx2,fma")))

TESSERA_AVX2 inline __attribute__((always_inline)) __m256 scaledKernel(__m256 q) {
    const __m256i bits = _mm256_castps_si256(q);
    const __m256 e =
        _mm256_cvtepi32_ps(_mm256_sub_epi32(_mm256_srli_epi32(bits, 23), _mm256_set1_epi32(127)));
    const __m256 one = _mm256_set1_ps(1);
    const __m256 mantissa = _mm256_and_ps(q, _mm256_castsi256_ps(_mm256_set1_epi32(0x7fffff)));
    // A permutation minds the lowest three bits of each index alone.
    const __m256i eighth = _mm256_srli_epi32(bits, kEighthShift);
    const __m256 inverse = _mm256_permutevar8x32_ps(_mm256_loadu_ps(kInverseMiddle), eighth);
    const __m256 logarithm = _mm256_add_ps(e, _mm256_permutevar8x32_ps(_mm256_loadu_ps(kLogMiddle), eighth));
    const __m256 r = _mm256_fmsub_ps(_mm256_or_ps(mantissa, one), inverse, one);
    __m256 p = _mm256_fmadd_ps(_mm256_set1_ps(kLogPolynomial[2]), r, _mm256_set1_ps(kLogPolynomial[1]));
    p = _mm256_fmadd_ps(p, r, _mm256_set1_ps(kLogPolynomial[0]));
    return _mm256_mul_ps(q, _mm256_fmadd_ps(p, r, logarithm));
}

// Adds term k of the first kOf channels to the sums of kVectors vectors of points.
template <int kOf, int kVectors>
TESSERA_AVX2 inline __attribute__((always_inline)) void addTerm(const Packed& s, int k, const __m256* px,
                                                                const __m256* py, __m256 (*sum)[kVectors]) {
    const __m256 cx = _mm256_broadcast_ss(s.centreX + k), cy = _mm256_broadcast_ss(s.centreY + k);
    for (int v = 0; v < kVectors; ++v) {
        const __m256 dx = _mm256_sub_ps(px[v], cx), dy = _mm256_sub_ps(py[v], cy);
        const __m256 phi = scaledKernel(_mm256_fmadd_ps(dy, dy, _mm256_mul_ps(dx, dx)));
        for (int c = 0; c < kOf; ++c)
            sum[c][v] = _mm256_fmadd_ps(_mm256_broadcast_ss(s.alpha[c] + k), phi, sum[c][v]);
    }
}

// Points [first, first + 8 kVectors) of x and y. Two vectors at a time keep both multipliers busy over the
// latency of the polynomial.
template <int kChannels, int kVectors>
TESSERA_AVX2 inline __attribute__((always_inline)) void evaluateBlock(const Packed& s, const float* x,
                                                                      const float* y, float* const* out,
                                                                      size_t first) {
    __m256 px[kVectors], py[kVectors], sum[kChannels][kVectors];
    for (int v = 0; v < kVectors; ++v) {
        px[v] = _mm256_loadu_ps(x + first + 8 * v);
        py[v] = _mm256_loadu_ps(y + first + 8 * v);
        for (int c = 0; c < kChannels; ++c)
            sum[c][v] = _mm256_fmadd_ps(
                _mm256_set1_ps(s.affine[c][2]), py[v],
                _mm256_fmadd_ps(_mm256_set1_ps(s.affine[c][1]), px[v], _mm256_set1_ps(s.affine[c][0])));
    }
    for (int k = 0; k < s.shared; ++k) addTerm<kChannels, kVectors>(s, k, px, py, sum);
    for (int k = s.shared; k < s.terms; ++k) addTerm<1, kVectors>(s, k, px, py, sum);
    for (int v = 0; v < kVectors; ++v)
        for (int c = 0; c < kChannels; ++c) _mm256_storeu_ps(out[c] + first + 8 * v, sum[c][v]);
}

template <int kChannels>
TESSERA_AVX2 void evaluateAvx2(const Packed& s, const float* x, const float* y, size_t count,
                               float* const* out) {
    size_t i = 0;
    for (; i + 16 <= count; i += 16) evaluateBlock<kChannels, 2>(s, x, y, out, i);
    if (i == count) return;
    // The rest through padded copies by the same instructions: a point's colour does not depend on its
    // neighbours.
    alignas(32) float restX[16] = {}, restY[16] = {}, rest[kChannels][16];
    float* restOut[kChannels];
    for (int c = 0; c < kChannels; ++c) restOut[c] = rest[c];
    const size_t left = count - i;
    std::copy_n(x + i, left, restX);
    std::copy_n(y + i, left, restY);
    evaluateBlock<kChannels, 1>(s, restX, restY, restOut, 0);
    if (left > 8) evaluateBlock<kChannels, 1>(s, restX, restY, restOut, 8);
    for (int c = 0; c < kChannels; ++c) std::copy_n(rest[c], left, out[c] + i);
}

#define TESSERA_AVX512 __attribute__((target("avx512f")))

constexpr struct Twice {
    constexpr Twice() {
        for (int i = 0; i < 2 * kEighths; ++i) {
            inverse[i] = kInverseMiddle[i % kEighths];
            logarithm[i] = kLogMiddle[i % kEighths];
        }
    }

    float inverse[2 * kEighths]{}, logarithm[2 * kEighths]{};
} kTwice;

// The same operations as with 8 lanes, hence the same bits: getexp and getmant give the exponent and the
// mantissa that are taken from the bits there. The exponent of 0 has to be finite. (Masked, since GCC 12
// warns of its own headers' unmasked ones.)
TESSERA_AVX512 inline __attribute__((always_inline)) __m512 scaledKernel(__m512 q) {
    constexpr __mmask16 kAll = 0xffff;
    const __m512 one = _mm512_set1_ps(1), least = _mm512_set1_ps(std::numeric_limits<float>::min());
    const __m512 e = _mm512_maskz_getexp_ps(kAll, _mm512_maskz_max_ps(kAll, q, least));
    // A permutation of sixteen minds one bit more, hence the eighths twice.
    const __m512i eighth = _mm512_maskz_srli_epi32(kAll, _mm512_castps_si512(q), kEighthShift);
    const __m512 inverse = _mm512_maskz_permutexvar_ps(kAll, eighth, _mm512_loadu_ps(kTwice.inverse));
    const __m512 middle = _mm512_maskz_permutexvar_ps(kAll, eighth, _mm512_loadu_ps(kTwice.logarithm));
    const __m512 m = _mm512_maskz_getmant_ps(kAll, q, _MM_MANT_NORM_1_2, _MM_MANT_SIGN_src);
    const __m512 r = _mm512_fmsub_ps(m, inverse, one);
    __m512 p = _mm512_fmadd_ps(_mm512_set1_ps(kLogPolynomial[2]), r, _mm512_set1_ps(kLogPolynomial[1]));
    p = _mm512_fmadd_ps(p, r, _mm512_set1_ps(kLogPolynomial[0]));
    return _mm512_mul_ps(q, _mm512_fmadd_ps(p, r, _mm512_add_ps(e, middle)));
}

// addTerm for 16 lanes.
template <int kOf, int kVectors>
TESSERA_AVX512 inline __attribute__((always_inline)) void addWideTerm(const Packed& s, int k,
                                                                      const __m512* px, const __m512* py,
                                                                      __m512 (*sum)[kVectors]) {
    const __m512 cx = _mm512_set1_ps(s.centreX[k]), cy = _mm512_set1_ps(s.centreY[k]);
    for (int v = 0; v < kVectors; ++v) {
        const __m512 dx = _mm512_sub_ps(px[v], cx), dy = _mm512_sub_ps(py[v], cy);
        const __m512 phi = scaledKernel(_mm512_fmadd_ps(dy, dy, _mm512_mul_ps(dx, dx)));
        for (int c = 0; c < kOf; ++c)
            sum[c][v] = _mm512_fmadd_ps(_mm512_set1_ps(s.alpha[c][k]), phi, sum[c][v]);
    }
}

// evaluateBlock for 16 lanes; `mask` says which of the last vector's points there are.
template <int kChannels, int kVectors>
TESSERA_AVX512 inline __attribute__((always_inline)) void evaluateWideBlock(const Packed& s, const float* x,
                                                                            const float* y, float* const* out,
                                                                            size_t first, __mmask16 mask) {
    constexpr __mmask16 kAll = 0xffff;
    __m512 px[kVectors], py[kVectors], sum[kChannels][kVectors];
    for (int v = 0; v < kVectors; ++v) {
        const __mmask16 lanes = v + 1 < kVectors ? kAll : mask;
        px[v] = _mm512_maskz_loadu_ps(lanes, x + first + 16 * v);
        py[v] = _mm512_maskz_loadu_ps(lanes, y + first + 16 * v);
        for (int c = 0; c < kChannels; ++c)
            sum[c][v] = _mm512_fmadd_ps(
                _mm512_set1_ps(s.affine[c][2]), py[v],
                _mm512_fmadd_ps(_mm512_set1_ps(s.affine[c][1]), px[v], _mm512_set1_ps(s.affine[c][0])));
    }
    for (int k = 0; k < s.shared; ++k) addWideTerm<kChannels, kVectors>(s, k, px, py, sum);
    for (int k = s.shared; k < s.terms; ++k) addWideTerm<1, kVectors>(s, k, px, py, sum);
    for (int v = 0; v < kVectors; ++v)
        for (int c = 0; c < kChannels; ++c)
            _mm512_mask_storeu_ps(out[c] + first + 16 * v, v + 1 < kVectors ? kAll : mask, sum[c][v]);
}

template <int kChannels>
TESSERA_AVX512 void evaluateAvx512(const Packed& s, const float* x, const float* y, size_t count,
                                   float* const* out) {
    const auto lanes = [](size_t points) { return __mmask16((1u << std::min<size_t>(points, 16)) - 1); };
    size_t i = 0;
    for (; i + 16 < count; i += 32) evaluateWideBlock<kChannels, 2>(s, x, y, out, i, lanes(count - i - 16));
    if (i < count) evaluateWideBlock<kChannels, 1>(s, x, y, out, i, lanes(count - i));
}

#endif

template <int kChannels>
void evaluateChannels(SplineInstructions instructions, const Packed& s, const float* x, const float* y,
                      size_t count, float* const* out) {
#if defined(__x86_64__)
    if (instructions == SplineInstructions::Avx512) return evaluateAvx512<kChannels>(s, x, y, count, out);
    if (instructions == SplineInstructions::Avx2) return evaluateAvx2<kChannels>(s, x, y, count, out);
#endif
    evaluateBaseline(s, kChannels, x, y, count, out);
}

}  // namespace

const char* nameOf(SplineInstructions instructions) {
    switch (instructions) {
        case SplineInstructions::Avx512:
            return "avx512";
        case SplineInstructions::Avx2:
            return "avx2";
        default:
            return "baseline";
    }
}

const std::vector<SplineInstructions>& splineInstructions() {
    static const auto available = [] {
        std::vector<SplineInstructions> found{SplineInstructions::Baseline};
#if defined(__x86_64__)
        const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
        if (avx2) found.push_back(SplineInstructions::Avx2);
        if (avx2 && __builtin_cpu_supports("avx512f")) found.push_back(SplineInstructions::Avx512);
#endif
        return found;
    }();
    return available;
}

void evaluateSplines(const PatchSpline& spline, int channels, const float* x, const float* y, size_t count,
                     float* const* out) {
    evaluateSplinesWith(splineInstructions().back(), spline, channels, x, y, count, out);
}

void evaluateSplinesWith(SplineInstructions instructions, const PatchSpline& spline, int channels,
                         const float* x, const float* y, size_t count, float* const* out) {
    TESSERA_CHECK(channels >= 1 && channels <= kMaxChannels);
    const Packed packed(spline, channels);
    switch (channels) {
        case 1:
            return evaluateChannels<1>(instructions, packed, x, y, count, out);
        case 2:
            return evaluateChannels<2>(instructions, packed, x, y, count, out);
        case 3:
            return evaluateChannels<3>(instructions, packed, x, y, count, out);
        default:
            return evaluateChannels<4>(instructions, packed, x, y, count, out);
    }
}

}  // namespace tessera
