// Parameters of many points of one patch: Newton's method in single precision, all points side by side.
#pragma once

#include <cstddef>

#include "core/mesh/bezier.h"

namespace tessera {

// Points in coordinates relative to the patch: (image point - centre()) * inverseSize().
class PatchInverse {
  public:
    // `tolerance` (px): how far the point of clamped parameters may lie from the point asked for.
    PatchInverse(const LatticeTriangle& patch, double tolerance);

    glm::dvec2 centre() const { return mCentre; }
    double inverseSize() const { return mInverseSize; }

    // (v, w) of each point, in the domain: parameters outside it, where the point is not quite in the patch,
    // are clamped. Each result depends on its own point alone, to the last bit. At most kMaxBatch points.
    static constexpr size_t kMaxBatch = 512;
    void solve(const float* x, const float* y, size_t count, float* v, float* w) const;

  private:
    void chooseSteps();
    void repair(float x, float y, float& v, float& w) const;

    BezierTriangle mPatch;
    double mTolerance;
    glm::dvec2 mCentre;
    double mInverseSize = 1;
    float mStart[2][3];         // the affine guess: v and w as constant, x and y share
    float mCoefficients[2][9];  // the map in powers of (v - 1/3, w - 1/3); see patch_inverse.cpp
    int mSteps = 0;             // of Newton's method; 0 where the patch is affine
};

}  // namespace tessera
