// Parameters of many points of one patch: Newton's method in single precision, all points side by side.
#pragma once

#include <cstddef>

#include "core/mesh/bezier.h"

namespace tessera {

// The inner loop's view of a patch. Coordinates relative to the patch, parameters to the domain's centroid.
struct PatchInverseMap {
    float start[2][3];         // the affine guess: constant, share of x, share of y; for v and for w
    float coefficients[2][9];  // x and y in powers of (v, w); their order is in patch_inverse.cpp
    int steps = 0;             // of Newton's method; 0 where the patch is affine
};

// Points in coordinates relative to the patch: (image point - centre()) * inverseSize().
class PatchInverse {
  public:
    // `tolerance` (px): how far the point of clamped parameters may lie from the point asked for.
    PatchInverse(const LatticeTriangle& patch, double tolerance);

    glm::dvec2 centre() const { return mCentre; }
    double inverseSize() const { return mInverseSize; }

    // (v, w) of each point, in the domain: parameters outside it, where the point is not quite in the patch,
    // are clamped. Each result depends on its own point alone, to the last bit. At most kMaxBatch points; the
    // arrays have room up to the next multiple of kVector, which is written.
    static constexpr size_t kVector = 8;
    static constexpr size_t kMaxBatch = 512;
    void solve(float* x, float* y, size_t count, float* v, float* w) const;

  private:
    void chooseSteps();
    void repair(float x, float y, float& v, float& w) const;

    BezierTriangle mPatch;
    double mTolerance;
    glm::dvec2 mCentre;
    double mInverseSize = 1;
    PatchInverseMap mMap;
};

}  // namespace tessera
