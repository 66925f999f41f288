// Splines at many points with vector instructions: the fast twin of evaluateSpline (COLOUR.md; paper Eqs. 2
// and 3). (evaluateKernels, which fits use, is in tps_kernels.cpp.)
#include <algorithm>
#include <array>
#include <bit>

#include "core/base/check.h"
#include "core/mesh/tps.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace tessera {

namespace {

// phi = s^2 log s = (log 2 / 2) q log2 q with q = s^2; the constant goes into the alphas. With q = 2^e (1 +
// t), log2 q = e + P(t): P interpolates log2(1 + t) at the Chebyshev nodes of [0, 1], so that it is
// within 3.2e-7. At q = 0 the exponent bits give e = -127 and the product is the wanted 0, without a branch.
constexpr float kHalfLog2 = .34657359f;
constexpr float kLogPolynomial[8] = {3.19697829e-07f, 1.44265211f, -.720386612f, .472499525f,
                                     -.323115935f,    .190420831f, -.076848726f, .0147787208f};

// A spline with its centres side by side and the same number of terms for each channel, the missing alphas 0.
struct Packed {
    static constexpr int kMaxTerms = 255;

    Packed(const PatchSpline& spline, int channels) : terms(spline.maxTerms(channels)) {
        TESSERA_CHECK(size_t(terms) <= spline.centreCount());
        for (int i = 0; i < terms; ++i) {
            const glm::dvec2 c = spline.centre(i);
            centreX[i] = float(c.x);
            centreY[i] = float(c.y);
        }
        const float* k = spline.coefficients.data();
        for (int c = 0; c < channels; ++c) {
            const int own = spline.terms[size_t(c)];
            for (int i = 0; i < 3; ++i) affine[c][i] = k[i];
            for (int i = 0; i < own; ++i) alpha[c][i] = kHalfLog2 * k[3 + i];
            for (int i = own; i < terms; ++i) alpha[c][i] = 0;
            k += 3 + own;
        }
    }

    int terms;
    float affine[kMaxChannels][3];
    float centreX[kMaxTerms];
    float centreY[kMaxTerms];
    float alpha[kMaxChannels][kMaxTerms];
};

float scaledKernel(float q) {
    constexpr uint32_t kOne = 0x3f800000;
    const auto bits = std::bit_cast<uint32_t>(q);
    const auto e = float(int32_t(bits >> 23) - 127);
    const float t = std::bit_cast<float>((bits & 0x7fffff) | kOne) - 1;
    float p = kLogPolynomial[7];
    for (int i = 6; i >= 0; --i) p = p * t + kLogPolynomial[i];
    return q * (e + p);
}

void evaluateScalar(const Packed& s, int channels, const float* x, const float* y, size_t count,
                    float* const* out) {
    for (size_t i = 0; i < count; ++i) {
        float sum[kMaxChannels];
        for (int c = 0; c < channels; ++c)
            sum[c] = s.affine[c][0] + s.affine[c][1] * x[i] + s.affine[c][2] * y[i];
        for (int k = 0; k < s.terms; ++k) {
            const float dx = x[i] - s.centreX[k], dy = y[i] - s.centreY[k];
            const float phi = scaledKernel(dx * dx + dy * dy);
            for (int c = 0; c < channels; ++c) sum[c] += s.alpha[c][k] * phi;
        }
        for (int c = 0; c < channels; ++c) out[c][i] = sum[c];
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
    const __m256 t = _mm256_sub_ps(_mm256_or_ps(mantissa, one), one);
    __m256 p = _mm256_set1_ps(kLogPolynomial[7]);
    p = _mm256_fmadd_ps(p, t, _mm256_set1_ps(kLogPolynomial[6]));
    p = _mm256_fmadd_ps(p, t, _mm256_set1_ps(kLogPolynomial[5]));
    p = _mm256_fmadd_ps(p, t, _mm256_set1_ps(kLogPolynomial[4]));
    p = _mm256_fmadd_ps(p, t, _mm256_set1_ps(kLogPolynomial[3]));
    p = _mm256_fmadd_ps(p, t, _mm256_set1_ps(kLogPolynomial[2]));
    p = _mm256_fmadd_ps(p, t, _mm256_set1_ps(kLogPolynomial[1]));
    p = _mm256_fmadd_ps(p, t, _mm256_set1_ps(kLogPolynomial[0]));
    return _mm256_mul_ps(q, _mm256_add_ps(e, p));
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
    for (int k = 0; k < s.terms; ++k) {
        const __m256 cx = _mm256_broadcast_ss(s.centreX + k), cy = _mm256_broadcast_ss(s.centreY + k);
        for (int v = 0; v < kVectors; ++v) {
            const __m256 dx = _mm256_sub_ps(px[v], cx), dy = _mm256_sub_ps(py[v], cy);
            const __m256 phi = scaledKernel(_mm256_fmadd_ps(dy, dy, _mm256_mul_ps(dx, dx)));
            for (int c = 0; c < kChannels; ++c)
                sum[c][v] = _mm256_fmadd_ps(_mm256_broadcast_ss(s.alpha[c] + k), phi, sum[c][v]);
        }
    }
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

bool hasAvx2() {
    static const bool has = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    return has;
}

#else

bool hasAvx2() {
    return false;
}

#endif

}  // namespace

void evaluateSplines(const PatchSpline& spline, int channels, const float* x, const float* y, size_t count,
                     float* const* out) {
    TESSERA_CHECK(channels >= 1 && channels <= kMaxChannels);
    const Packed packed(spline, channels);
#if defined(__x86_64__)
    if (hasAvx2()) {
        switch (channels) {
            case 1:
                return evaluateAvx2<1>(packed, x, y, count, out);
            case 2:
                return evaluateAvx2<2>(packed, x, y, count, out);
            case 3:
                return evaluateAvx2<3>(packed, x, y, count, out);
            default:
                return evaluateAvx2<4>(packed, x, y, count, out);
        }
    }
#endif
    evaluateScalar(packed, channels, x, y, count, out);
}

void evaluateSplinesScalar(const PatchSpline& spline, int channels, const float* x, const float* y,
                           size_t count, float* const* out) {
    TESSERA_CHECK(channels >= 1 && channels <= kMaxChannels);
    evaluateScalar(Packed(spline, channels), channels, x, y, count, out);
}

const char* splineInstructionSet() {
    return hasAvx2() ? "avx2" : "scalar";
}

}  // namespace tessera
