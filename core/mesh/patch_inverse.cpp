// See patch_inverse.h.
#include "core/mesh/patch_inverse.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/base/check.h"
#include "core/base/round_up.h"
#include "core/mesh/patch_query.h"

namespace tessera {

namespace {

constexpr float kThird = 1.0f / 3;
constexpr int kMaxSteps = 6;
// A last step below this leaves an error of about its square.
constexpr float kLastStep = 1e-3f;

// Powers of (v, w) in the order of mCoefficients.
enum { kV, kW, kVV, kVW, kWW, kVVV, kVVW, kVWW, kWWW };

// One coordinate of the map at (s, t), and its derivatives there.
inline __attribute__((always_inline)) float value(const float* k, float s, float t) {
    return s * (k[kV] + s * (k[kVV] + s * k[kVVV]) + t * (k[kVW] + s * k[kVVW] + t * k[kVWW])) +
           t * (k[kW] + t * (k[kWW] + t * k[kWWW]));
}
inline __attribute__((always_inline)) float alongV(const float* k, float s, float t) {
    return k[kV] + s * (2 * k[kVV] + s * (3 * k[kVVV]) + t * (2 * k[kVVW])) + t * (k[kVW] + t * k[kVWW]);
}
inline __attribute__((always_inline)) float alongW(const float* k, float s, float t) {
    return k[kW] + t * (2 * k[kWW] + t * (3 * k[kWWW]) + s * (2 * k[kVWW])) + s * (k[kVW] + s * k[kVVW]);
}

// One Newton step for each point; `last` is the squared length of the step. Written so that the compiler
// makes vectors of it: no branch, no call, no overlap of the arrays.
inline __attribute__((always_inline)) void newtonStep(const float (*k)[9], const float* __restrict x,
                                                      const float* __restrict y, size_t count,
                                                      float* __restrict v, float* __restrict w,
                                                      float* __restrict last) {
    const float* a = k[0];
    const float* b = k[1];
    for (size_t i = 0; i < count; ++i) {
        const float s = v[i], t = w[i];
        const float fx = x[i] - value(a, s, t), fy = y[i] - value(b, s, t);
        const float xv = alongV(a, s, t), yv = alongV(b, s, t);
        const float xw = alongW(a, s, t), yw = alongW(b, s, t);
        const float inverse = 1 / (xv * yw - yv * xw);
        const float dv = (fx * yw - fy * xw) * inverse, dw = (xv * fy - yv * fx) * inverse;
        v[i] = s + dv;
        w[i] = t + dw;
        last[i] = dv * dv + dw * dw;
    }
}

// The affine guess, `steps` steps, and for each point whether its result can be trusted. Counts are whole
// vectors.
inline __attribute__((always_inline)) size_t solveInline(const PatchInverseMap& map,
                                                         const float* __restrict x, const float* __restrict y,
                                                         size_t count, float* __restrict v,
                                                         float* __restrict w, int32_t* __restrict bad) {
    float last[PatchInverse::kMaxBatch];
    for (size_t i = 0; i < count; ++i) {
        v[i] = map.start[0][0] + map.start[0][1] * x[i] + map.start[0][2] * y[i];
        w[i] = map.start[1][0] + map.start[1][1] * x[i] + map.start[1][2] * y[i];
        last[i] = 0;
    }
    for (int step = 0; step < map.steps; ++step) newtonStep(map.coefficients, x, y, count, v, w, last);
    int32_t sum = 0;
    for (size_t i = 0; i < count; ++i) {
        v[i] += kThird;
        w[i] += kThird;
        // Not the negation: NaN counts as bad.
        const int32_t good = int32_t(v[i] >= 0) & int32_t(w[i] >= 0) & int32_t(v[i] + w[i] <= 1) &
                             int32_t(last[i] <= kLastStep * kLastStep);
        bad[i] = good ^ 1;
        sum += bad[i];
    }
    return size_t(sum);
}

// The same operations in the same order in both, hence the same bits (contraction is off).
size_t solvePlain(const PatchInverseMap& map, const float* x, const float* y, size_t count, float* v,
                  float* w, int32_t* bad) {
    return solveInline(map, x, y, count, v, w, bad);
}

#if defined(__x86_64__)
__attribute__((target("avx2"))) size_t solveAvx2(const PatchInverseMap& map, const float* x, const float* y,
                                                 size_t count, float* v, float* w, int32_t* bad) {
    return solveInline(map, x, y, count, v, w, bad);
}
#endif

size_t solveBest(const PatchInverseMap& map, const float* x, const float* y, size_t count, float* v, float* w,
                 int32_t* bad) {
#if defined(__x86_64__)
    static const bool hasAvx2 = __builtin_cpu_supports("avx2");
    if (hasAvx2) return solveAvx2(map, x, y, count, v, w, bad);
#endif
    return solvePlain(map, x, y, count, v, w, bad);
}

}  // namespace

PatchInverse::PatchInverse(const LatticeTriangle& patch, double tolerance)
    : mPatch(toPixels(patch)), mTolerance(tolerance) {
    constexpr double s = 1.0 / 3;
    mCentre = evaluate(mPatch, Barycentric(s));
    double size = 0;
    for (const glm::dvec2& p : mPatch.p)
        size = std::max({size, std::abs(p.x - mCentre.x), std::abs(p.y - mCentre.y)});
    mInverseSize = size > 0 ? 1 / size : 1;
    std::array<glm::dvec2, 10> p;
    for (size_t i = 0; i < 10; ++i) p[i] = (mPatch.p[i] - mCentre) * mInverseSize;

    // Powers of (v, w) around corner a by differences of control points, then shifted to the centroid.
    const glm::dvec2 cv = 3.0 * (p[1] - p[0]), cw = 3.0 * (p[8] - p[0]);
    const glm::dvec2 cvv = 3.0 * (p[2] - 2.0 * p[1] + p[0]), cww = 3.0 * (p[7] - 2.0 * p[8] + p[0]);
    const glm::dvec2 cvw = 6.0 * (p[9] - p[1] - p[8] + p[0]);
    const glm::dvec2 cvvv = p[3] - 3.0 * p[2] + 3.0 * p[1] - p[0],
                     cwww = p[6] - 3.0 * p[7] + 3.0 * p[8] - p[0];
    const glm::dvec2 cvvw = 3.0 * (p[4] - 2.0 * p[9] + p[8] - p[2] + 2.0 * p[1] - p[0]);
    const glm::dvec2 cvww = 3.0 * (p[5] - 2.0 * p[9] + p[1] - p[7] + 2.0 * p[8] - p[0]);
    std::array<glm::dvec2, 9> shifted;
    shifted[kV] = cv + 2 * s * cvv + 3 * s * s * cvvv + s * cvw + 2 * s * s * cvvw + s * s * cvww;
    shifted[kW] = cw + 2 * s * cww + 3 * s * s * cwww + s * cvw + 2 * s * s * cvww + s * s * cvvw;
    shifted[kVV] = cvv + 3 * s * cvvv + s * cvvw;
    shifted[kVW] = cvw + 2 * s * cvvw + 2 * s * cvww;
    shifted[kWW] = cww + 3 * s * cwww + s * cvww;
    shifted[kVVV] = cvvv;
    shifted[kVVW] = cvvw;
    shifted[kVWW] = cvww;
    shifted[kWWW] = cwww;
    for (size_t i = 0; i < 9; ++i) {
        mMap.coefficients[0][i] = float(shifted[i].x);
        mMap.coefficients[1][i] = float(shifted[i].y);
    }

    const glm::dvec2 ab = p[3] - p[0], ac = p[6] - p[0];
    const double base = cross(ab, ac);
    const double inverse = base != 0 ? 1 / base : 0;
    const double start[2][3] = {{-cross(p[0], ac) * inverse - s, ac.y * inverse, -ac.x * inverse},
                                {cross(p[0], ab) * inverse - s, -ab.y * inverse, ab.x * inverse}};
    for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 3; ++j) mMap.start[i][j] = float(start[i][j]);
    chooseSteps();
}

// As many steps as bring the guess near the truth at 8 points over the patch, and one more.
void PatchInverse::chooseSteps() {
    // Affine up to the rounding of control points to the lattice: the guess is the answer.
    bool affine = true;
    for (int i = 0; i <= 3; ++i)
        for (int j = 0; i + j <= 3; ++j) {
            const int k = 3 - i - j;
            const glm::dvec2 even =
                (double(i) * mPatch.p[0] + double(j) * mPatch.p[3] + double(k) * mPatch.p[6]) / 3.0;
            const glm::dvec2 off = glm::abs(mPatch.p[size_t(controlIndex(i, j, k))] - even);
            affine = affine && std::max(off.x, off.y) <= 1.0 / kLatticePerPixel;
        }
    mMap.steps = 0;
    if (affine) return;

    // The thirds of the sides and two points inside; the guess is right at the corners.
    constexpr size_t kPoints = 8;
    constexpr float kTrueV[kPoints] = {0, kThird, kThird, 0, -kThird, -kThird, .25f - kThird, .5f - kThird};
    constexpr float kTrueW[kPoints] = {-kThird, -kThird, 0, kThird, kThird, 0, .25f - kThird, .25f - kThird};
    float x[kPoints], y[kPoints], v[kPoints], w[kPoints], last[kPoints];
    for (size_t i = 0; i < kPoints; ++i) {
        x[i] = value(mMap.coefficients[0], kTrueV[i], kTrueW[i]);
        y[i] = value(mMap.coefficients[1], kTrueV[i], kTrueW[i]);
        v[i] = mMap.start[0][0] + mMap.start[0][1] * x[i] + mMap.start[0][2] * y[i];
        w[i] = mMap.start[1][0] + mMap.start[1][1] * x[i] + mMap.start[1][2] * y[i];
    }
    for (mMap.steps = 1; mMap.steps < kMaxSteps; ++mMap.steps) {
        float worst = 0;
        for (size_t i = 0; i < kPoints; ++i)
            worst = std::max({worst, std::abs(v[i] - kTrueV[i]), std::abs(w[i] - kTrueW[i])});
        if (worst < .5f * kLastStep) break;
        newtonStep(mMap.coefficients, x, y, kPoints, v, w, last);
    }
}

void PatchInverse::solve(float* x, float* y, size_t count, float* v, float* w) const {
    TESSERA_CHECK(count <= kMaxBatch);
    const size_t padded = roundUp(count, kVector);
    std::fill(x + count, x + padded, 0.0f);
    std::fill(y + count, y + padded, 0.0f);
    int32_t bad[kMaxBatch];
    if (solveBest(mMap, x, y, padded, v, w, bad) == 0) return;
    for (size_t i = 0; i < count; ++i)
        if (bad[i] != 0) repair(x[i], y[i], v[i], w[i]);
}

void PatchInverse::repair(float x, float y, float& v, float& w) const {
    // Mostly converged, and outside by rounding: then the clamped parameters are near enough.
    Barycentric b = glm::max(Barycentric(1 - double(v) - double(w), v, w), Barycentric(0));
    b /= b.x + b.y + b.z;
    if (mMap.steps > 0) {
        const glm::dvec2 point = mCentre + glm::dvec2(x, y) / mInverseSize;
        constexpr double kSingle = 1e-6;  // what single precision leaves, of the patch's size
        const double tolerance = std::max(mTolerance, kSingle / mInverseSize);
        if (!(glm::distance(evaluate(mPatch, b), point) <= tolerance))
            b = nearestParameters(mPatch, point, tolerance);
    }
    v = float(b.y);
    w = float(b.z);
}

}  // namespace tessera
