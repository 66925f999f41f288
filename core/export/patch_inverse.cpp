// See patch_inverse.h.
#include "core/export/patch_inverse.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/base/check.h"
#include "core/mesh/patch_query.h"

namespace tessera {

namespace {

constexpr float kThird = 1.0f / 3;
constexpr int kMaxSteps = 6;
// A last step below this leaves an error of about its square.
constexpr float kLastStep = 1e-3f;

// Powers of (v, w) in the order of mCoefficients.
enum { kV, kW, kVV, kVW, kWW, kVVV, kVVW, kVWW, kWWW };

// One Newton step for each point; v and w relative to the domain's centroid, `last` the squared length of the
// step. Written so that the compiler makes vectors of it: no branch, no call. `x` and `y` and the others do
// not overlap.
inline __attribute__((always_inline)) void newtonStep(const float (*k)[9], const float* __restrict x,
                                                      const float* __restrict y, size_t count,
                                                      float* __restrict v, float* __restrict w,
                                                      float* __restrict last) {
    const float* a = k[0];
    const float* b = k[1];
    for (size_t i = 0; i < count; ++i) {
        const float s = v[i], t = w[i];
        const float ss = s * s, st = s * t, tt = t * t;
        // Value and derivatives, by rows of powers.
        const float fx =
            x[i] - (s * (a[kV] + s * (a[kVV] + s * a[kVVV]) + t * (a[kVW] + s * a[kVVW] + t * a[kVWW])) +
                    t * (a[kW] + t * (a[kWW] + t * a[kWWW])));
        const float fy =
            y[i] - (s * (b[kV] + s * (b[kVV] + s * b[kVVV]) + t * (b[kVW] + s * b[kVVW] + t * b[kVWW])) +
                    t * (b[kW] + t * (b[kWW] + t * b[kWWW])));
        const float xv =
            a[kV] + 2 * (s * a[kVV] + st * a[kVVW]) + 3 * ss * a[kVVV] + t * a[kVW] + tt * a[kVWW];
        const float yv =
            b[kV] + 2 * (s * b[kVV] + st * b[kVVW]) + 3 * ss * b[kVVV] + t * b[kVW] + tt * b[kVWW];
        const float xw =
            a[kW] + 2 * (t * a[kWW] + st * a[kVWW]) + 3 * tt * a[kWWW] + s * a[kVW] + ss * a[kVVW];
        const float yw =
            b[kW] + 2 * (t * b[kWW] + st * b[kVWW]) + 3 * tt * b[kWWW] + s * b[kVW] + ss * b[kVVW];
        const float inverse = 1 / (xv * yw - yv * xw);
        const float dv = (fx * yw - fy * xw) * inverse, dw = (xv * fy - yv * fx) * inverse;
        v[i] = s + dv;
        w[i] = t + dw;
        last[i] = dv * dv + dw * dw;
    }
}

inline __attribute__((always_inline)) void newtonSteps(int steps, const float (*k)[9], const float* x,
                                                       const float* y, size_t count, float* v, float* w,
                                                       float* last) {
    for (int step = 0; step < steps; ++step) newtonStep(k, x, y, count, v, w, last);
}

// The same operations in the same order in both, hence the same bits (contraction is off).
void runSteps(int steps, const float (*k)[9], const float* x, const float* y, size_t count, float* v,
              float* w, float* last) {
    newtonSteps(steps, k, x, y, count, v, w, last);
}

#if defined(__x86_64__)
__attribute__((target("avx2"))) void runStepsAvx2(int steps, const float (*k)[9], const float* x,
                                                  const float* y, size_t count, float* v, float* w,
                                                  float* last) {
    newtonSteps(steps, k, x, y, count, v, w, last);
}
#endif

using RunSteps = decltype(&runSteps);
RunSteps chooseRunSteps() {
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2")) return runStepsAvx2;
#endif
    return runSteps;
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
        mCoefficients[0][i] = float(shifted[i].x);
        mCoefficients[1][i] = float(shifted[i].y);
    }

    const glm::dvec2 ab = p[3] - p[0], ac = p[6] - p[0];
    const double base = cross(ab, ac);
    const double inverse = base != 0 ? 1 / base : 0;
    const double start[2][3] = {{-cross(p[0], ac) * inverse - s, ac.y * inverse, -ac.x * inverse},
                                {cross(p[0], ab) * inverse - s, -ab.y * inverse, ab.x * inverse}};
    for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 3; ++j) mStart[i][j] = float(start[i][j]);
    chooseSteps();
}

// As many steps as bring the guess near the truth at 15 points over the patch, and one more.
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
    mSteps = 0;
    if (affine) return;

    constexpr size_t kPoints = 15;
    float x[kPoints], y[kPoints], v[kPoints], w[kPoints], trueV[kPoints], trueW[kPoints], last[kPoints];
    size_t n = 0;
    for (int j = 0; j <= 4; ++j)
        for (int k = 0; j + k <= 4; ++k, ++n) {
            const Barycentric b(1 - (j + k) / 4.0, j / 4.0, k / 4.0);
            const glm::dvec2 at = (evaluate(mPatch, b) - mCentre) * mInverseSize;
            x[n] = float(at.x);
            y[n] = float(at.y);
            trueV[n] = float(b.y) - kThird;
            trueW[n] = float(b.z) - kThird;
            v[n] = mStart[0][0] + mStart[0][1] * x[n] + mStart[0][2] * y[n];
            w[n] = mStart[1][0] + mStart[1][1] * x[n] + mStart[1][2] * y[n];
        }
    for (mSteps = 1; mSteps < kMaxSteps; ++mSteps) {
        float worst = 0;
        for (size_t i = 0; i < kPoints; ++i)
            worst = std::max({worst, std::abs(v[i] - trueV[i]), std::abs(w[i] - trueW[i])});
        if (worst < .5f * kLastStep) break;
        runSteps(1, mCoefficients, x, y, kPoints, v, w, last);
    }
}

void PatchInverse::solve(const float* x, const float* y, size_t count, float* v, float* w) const {
    TESSERA_CHECK(count <= kMaxBatch);
    static const RunSteps run = chooseRunSteps();
    float last[kMaxBatch];
    for (size_t i = 0; i < count; ++i) {
        v[i] = mStart[0][0] + mStart[0][1] * x[i] + mStart[0][2] * y[i];
        w[i] = mStart[1][0] + mStart[1][1] * x[i] + mStart[1][2] * y[i];
        last[i] = 0;
    }
    run(mSteps, mCoefficients, x, y, count, v, w, last);
    for (size_t i = 0; i < count; ++i) {
        v[i] += kThird;
        w[i] += kThird;
        // Negated so that NaN counts as bad.
        const bool good = v[i] >= 0 && w[i] >= 0 && v[i] + w[i] <= 1 && last[i] <= kLastStep * kLastStep;
        if (!good) repair(x[i], y[i], v[i], w[i]);
    }
}

void PatchInverse::repair(float x, float y, float& v, float& w) const {
    const glm::dvec2 point = mCentre + glm::dvec2(x, y) / mInverseSize;
    // A little outside: clamped parameters, where their point is near enough.
    Barycentric b = glm::max(Barycentric(1 - double(v) - double(w), v, w), Barycentric(0));
    b /= b.x + b.y + b.z;
    if (!(glm::distance(evaluate(mPatch, b), point) <= mTolerance))
        b = nearestParameters(mPatch, point, mTolerance);
    v = float(b.y);
    w = float(b.z);
}

}  // namespace tessera
