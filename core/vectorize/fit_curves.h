// Bezier patch optimization (paper section 4.3): from traced paths to patch boundaries that do not fold.
#pragma once

#include <array>
#include <functional>
#include <span>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/vectorize/simplify.h"

namespace tessera {

// Eq. (1) for one curve C between two patches. Unknowns: C's two inner control points and both interior
// control points. J is taken in the parameters (v, w) of tps.h's domain order, in pixels.
class BoundaryObjective {
  public:
    struct Weights {
        double positive = .2;  // w_p
        double negative = 1;   // w_n
        double distance = 5;   // w_d
    };
    static constexpr int kUnknowns = 8;  // c1, c2, interior of the first patch, of the second; x before y

    // `first` and `second` have C as their side `firstSide` and `secondSide`; C runs along the first's side
    // and against the second's. `initial` is C0, along the first's side.
    BoundaryObjective(const BezierTriangle& first, int firstSide, const BezierTriangle& second,
                      int secondSide, const BezierCurve& initial, const Weights& weights);

    std::array<double, kUnknowns> start() const { return mStart; }
    // The value of Eq. (1); its gradient where `gradient` is not null.
    double evaluate(const double* unknowns, double* gradient) const;

  private:
    // What the fixed control points contribute to the derivatives at a sample, and the derivatives' weights
    // of the three unknown ones (c1, c2, interior).
    struct Sample {
        glm::dvec2 dv, dw;
        std::array<double, 3> basisV, basisW;
    };
    struct Side {
        std::vector<Sample> samples;
        double baseJacobian = 0;  // |J^b|: twice the area of the base triangle
    };
    static Side makeSide(const BezierTriangle& t, int side, bool reversed);

    std::array<Side, 2> mSides;
    BezierCurve mInitial;
    Weights mWeights;
    std::array<double, kUnknowns> mStart{};
};

// Sets of edges of the same colour share no patch, so that they can be optimized at the same time; in order
// of colour.
std::vector<std::vector<EdgeId>> colourEdges(const HalfedgeMesh& mesh, std::span<const EdgeId> edges);

// Stage "curves". Variant "traced": each traced path is fitted with a cubic, then all are optimized by Eq.
// (1) with L-BFGS, curve by curve, until none moves; where that leaves a patch without certificate, its
// non-feature sides are pulled toward the straight ones until it has one (the base domain's patches all
// have). Variant "straight" leaves the base domain as it is. Every patch of the result is certified; feature
// curves are not moved. `observeInitial` sees the fitted curves before Eq. (1), whose patches may fold.
Result<PatchMesh> fitCurves(const BaseDomain& base, const VectorizeSettings& settings, StageReport& report,
                            Progress& progress,
                            const std::function<void(const PatchMesh&)>& observeInitial = {});

}  // namespace tessera
