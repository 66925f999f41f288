// See fit_curves.h.
#include "core/vectorize/fit_curves.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <nlopt.hpp>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/mesh/jacobian.h"

namespace tessera {

namespace {

// Samples of a patch: the corners of its parametric domain cut into kGrid^2 triangles; of a curve: as many
// intervals.
constexpr int kGrid = 8;
constexpr int kMaxSweeps = 50;
constexpr int kMaxEvaluations = 60;
constexpr double kConvergedPx = .02;

// Weights of the ten control points in the derivatives along b - a and c - a.
struct DerivativeBasis {
    std::array<double, 10> v{}, w{};
};

DerivativeBasis derivativeBasis(const Barycentric& b) {
    // Degree-2 Bernstein polynomials at each index, spread to the points whose differences they weight.
    DerivativeBasis basis;
    for (int i = 0; i <= 2; ++i)
        for (int j = 0; i + j <= 2; ++j) {
            const int k = 2 - i - j;
            constexpr double kFactorial[] = {1, 1, 2};
            const double value = 3 * 2 / (kFactorial[i] * kFactorial[j] * kFactorial[k]) * std::pow(b.x, i) *
                                 std::pow(b.y, j) * std::pow(b.z, k);
            basis.v[size_t(controlIndex(i, j + 1, k))] += value;
            basis.v[size_t(controlIndex(i + 1, j, k))] -= value;
            basis.w[size_t(controlIndex(i, j, k + 1))] += value;
            basis.w[size_t(controlIndex(i + 1, j, k))] -= value;
        }
    return basis;
}

const std::vector<DerivativeBasis>& sampleBases() {
    static const auto bases = [] {
        std::vector<DerivativeBasis> all;
        for (int i = 0; i <= kGrid; ++i)
            for (int j = 0; i + j <= kGrid; ++j)
                all.push_back(
                    derivativeBasis({double(i) / kGrid, double(j) / kGrid, double(kGrid - i - j) / kGrid}));
        return all;
    }();
    return bases;
}

}  // namespace

BoundaryObjective::Side BoundaryObjective::makeSide(const BezierTriangle& t, int side, bool reversed) {
    Side result;
    result.baseJacobian = cross(t.corner(1) - t.corner(0), t.corner(2) - t.corner(0));
    std::array<size_t, 3> unknown{size_t(3 * side + 1), size_t(3 * side + 2), size_t(kInterior)};
    if (reversed) std::swap(unknown[0], unknown[1]);
    for (const DerivativeBasis& basis : sampleBases()) {
        Sample sample{};
        for (size_t k = 0; k < 10; ++k) {
            const auto found = std::find(unknown.begin(), unknown.end(), k);
            if (found == unknown.end()) {
                sample.dv += basis.v[k] * t.p[k];
                sample.dw += basis.w[k] * t.p[k];
            } else {
                sample.basisV[size_t(found - unknown.begin())] = basis.v[k];
                sample.basisW[size_t(found - unknown.begin())] = basis.w[k];
            }
        }
        result.samples.push_back(sample);
    }
    return result;
}

BoundaryObjective::BoundaryObjective(const BezierTriangle& first, int firstSide, const BezierTriangle& second,
                                     int secondSide, const BezierCurve& initial, const Weights& weights)
    : mSides{makeSide(first, firstSide, false), makeSide(second, secondSide, true)},
      mInitial(initial),
      mWeights(weights) {
    const auto c = first.side(firstSide);
    const glm::dvec2 points[] = {c[1], c[2], first.p[kInterior], second.p[kInterior]};
    for (size_t k = 0; k < 4; ++k) {
        mStart[2 * k] = points[k].x;
        mStart[2 * k + 1] = points[k].y;
    }
}

double BoundaryObjective::evaluate(const double* unknowns, double* gradient) const {
    if (gradient) std::fill(gradient, gradient + kUnknowns, 0.0);
    const auto point = [&](size_t k) { return glm::dvec2(unknowns[2 * k], unknowns[2 * k + 1]); };
    double sum = 0;
    for (size_t s = 0; s < 2; ++s) {
        const std::array<size_t, 3> index{0, 1, 2 + s};
        const std::array<glm::dvec2, 3> p{point(index[0]), point(index[1]), point(index[2])};
        for (const Sample& sample : mSides[s].samples) {
            glm::dvec2 dv = sample.dv, dw = sample.dw;
            for (size_t k = 0; k < 3; ++k) {
                dv += sample.basisV[k] * p[k];
                dw += sample.basisW[k] * p[k];
            }
            const double jacobian = cross(dv, dw);
            const double weight = jacobian > 0 ? mWeights.positive : mWeights.negative;
            const double residual = jacobian - mSides[s].baseJacobian;
            sum += weight * residual * residual;
            if (!gradient) continue;
            const double factor = 2 * weight * residual;
            for (size_t k = 0; k < 3; ++k) {
                gradient[2 * index[k]] += factor * (sample.basisV[k] * dw.y - sample.basisW[k] * dv.y);
                gradient[2 * index[k] + 1] += factor * (sample.basisW[k] * dv.x - sample.basisV[k] * dw.x);
            }
        }
    }
    for (int i = 1; i < kGrid; ++i) {
        const double t = double(i) / kGrid, r = 1 - t;
        const double b1 = 3 * r * r * t, b2 = 3 * r * t * t;
        const glm::dvec2 off = b1 * (point(0) - mInitial.p[1]) + b2 * (point(1) - mInitial.p[2]);
        sum += mWeights.distance * glm::dot(off, off);
        if (!gradient) continue;
        for (size_t axis = 0; axis < 2; ++axis) {
            const double d = 2 * mWeights.distance * off[int(axis)];
            gradient[axis] += b1 * d;
            gradient[2 + axis] += b2 * d;
        }
    }
    return sum;
}

std::vector<std::vector<EdgeId>> colourEdges(const HalfedgeMesh& mesh, std::span<const EdgeId> edges) {
    std::vector<std::vector<EdgeId>> sets;
    std::vector<int> colourOf(mesh.edgeCapacity(), -1);
    for (const EdgeId e : edges) {
        uint32_t taken = 0;
        for (const HalfedgeId h :
             {HalfedgeMesh::halfedge(e), HalfedgeMesh::twin(HalfedgeMesh::halfedge(e))}) {
            if (!mesh.face(h).valid()) continue;
            for (const HalfedgeId side : mesh.sides(mesh.face(h))) {
                const int colour = colourOf[HalfedgeMesh::edge(side).index];
                if (colour >= 0) taken |= 1U << colour;
            }
        }
        const int colour = std::countr_one(taken);
        colourOf[e.index] = colour;
        if (size_t(colour) >= sets.size()) sets.resize(size_t(colour) + 1);
        sets[size_t(colour)].push_back(e);
    }
    return sets;
}

namespace {

// The curves of a mesh in double precision while they are being optimized.
class CurveOptimizer {
  public:
    CurveOptimizer(const BaseDomain& base, const VectorizeSettings& settings);

    bool optimize(Progress& progress, StageReport& report);
    // The curves as they are, on the lattice, certified or not.
    PatchMesh roundedMesh() const;
    Result<PatchMesh> certifiedMesh(Progress& progress, StageReport& report) const;

  private:
    BezierCurve curveFrom(HalfedgeId h) const;
    BezierTriangle triangle(PatchId p) const;
    double optimizeEdge(EdgeId e);

    const BaseDomain& mBase;
    const HalfedgeMesh& mConnectivity;
    BoundaryObjective::Weights mWeights;
    std::vector<EdgeId> mFree;                   // edges with a patch on either side that are no features
    std::vector<BezierCurve> mInitial, mCurves;  // by edge
    std::vector<glm::dvec2> mInteriors;          // by patch
};

CurveOptimizer::CurveOptimizer(const BaseDomain& base, const VectorizeSettings& settings)
    : mBase(base),
      mConnectivity(base.mesh.connectivity()),
      mWeights{settings.weightPositive, settings.weightNegative, settings.weightDistance},
      mCurves(mConnectivity.edgeCapacity()),
      mInteriors(mConnectivity.faceCapacity()) {
    base.mesh.forEachEdge([&](EdgeId e) {
        const bool free = !base.mesh.curve(e).feature && !mConnectivity.onBorder(e);
        mCurves[e.index] = free ? fitCurve(base.paths[e.index])
                                : toPixels(base.mesh.controlPoints(HalfedgeMesh::halfedge(e)));
        if (free) mFree.push_back(e);
    });
    mInitial = mCurves;
    base.mesh.forEachPatch([&](PatchId p) { mInteriors[p.index] = defaultInterior(triangle(p)); });
}

BezierCurve CurveOptimizer::curveFrom(HalfedgeId h) const {
    const BezierCurve& curve = mCurves[HalfedgeMesh::edge(h).index];
    return HalfedgeMesh::halfedge(HalfedgeMesh::edge(h)) == h ? curve : curve.reversed();
}

BezierTriangle CurveOptimizer::triangle(PatchId p) const {
    BezierTriangle t;
    const auto sides = mConnectivity.sides(p);
    for (size_t s = 0; s < 3; ++s) {
        const BezierCurve curve = curveFrom(sides[s]);
        for (size_t i = 0; i < 3; ++i) t.p[3 * s + i] = curve.p[i];
    }
    t.p[kInterior] = mInteriors[p.index];
    return t;
}

// Minimizes Eq. (1) for one curve; how far its control points moved, in px.
double CurveOptimizer::optimizeEdge(EdgeId e) {
    const HalfedgeId h = HalfedgeMesh::halfedge(e), t = HalfedgeMesh::twin(h);
    const PatchId first = mConnectivity.face(h), second = mConnectivity.face(t);
    const auto sideOf = [&](PatchId p, HalfedgeId side) {
        const auto sides = mConnectivity.sides(p);
        return int(std::find(sides.begin(), sides.end(), side) - sides.begin());
    };
    const BoundaryObjective objective(triangle(first), sideOf(first, h), triangle(second), sideOf(second, t),
                                      mInitial[e.index], mWeights);
    const auto start = objective.start();
    std::vector<double> x(start.begin(), start.end());
    nlopt::opt solver(nlopt::LD_LBFGS, BoundaryObjective::kUnknowns);
    solver.set_min_objective(
        [](unsigned, const double* at, double* gradient, void* data) {
            return static_cast<const BoundaryObjective*>(data)->evaluate(at, gradient);
        },
        const_cast<BoundaryObjective*>(&objective));
    solver.set_ftol_rel(1e-6);
    solver.set_xtol_abs(kConvergedPx / 10);
    solver.set_maxeval(kMaxEvaluations);
    double value = objective.evaluate(start.data(), nullptr);
    const double before = value;
    try {
        solver.optimize(x, value);
    } catch (const std::exception&) {
        // L-BFGS reports a line search that rounding stopped as a failure; x is then the best point it saw,
        // or worse than the start, which the comparison below finds.
        value = objective.evaluate(x.data(), nullptr);
    }
    if (!(value < before)) return 0;
    const auto point = [&](size_t k) { return glm::dvec2(x[2 * k], x[2 * k + 1]); };
    BezierCurve& curve = mCurves[e.index];
    const double moved = std::max(glm::distance(curve.p[1], point(0)), glm::distance(curve.p[2], point(1)));
    curve.p[1] = point(0);
    curve.p[2] = point(1);
    mInteriors[first.index] = point(2);
    mInteriors[second.index] = point(3);
    return moved;
}

bool CurveOptimizer::optimize(Progress& progress, StageReport& report) {
    const auto sets = colourEdges(mConnectivity, mFree);
    std::vector<double> moved(mConnectivity.edgeCapacity(), HUGE_VAL);
    // An edge is worth solving again only if something around it has moved since.
    const auto disturbed = [&](EdgeId e) {
        double most = moved[e.index];
        for (const HalfedgeId h : {HalfedgeMesh::halfedge(e), HalfedgeMesh::twin(HalfedgeMesh::halfedge(e))})
            for (const HalfedgeId side : mConnectivity.sides(mConnectivity.face(h)))
                if (const EdgeId s = HalfedgeMesh::edge(side); std::isfinite(moved[s.index]))
                    most = std::max(most, moved[s.index]);
        return most >= kConvergedPx;
    };
    int sweep = 0;
    size_t left = mFree.size();
    for (; sweep < kMaxSweeps && left > 0; ++sweep) {
        std::vector<double> previous = moved;
        for (size_t s = 0; s < sets.size(); ++s) {
            if (!progress.step((sweep + double(s) / double(sets.size())) / kMaxSweeps)) return false;
            std::atomic<bool> stop{false};
            parallelFor(sets[s].size(), 16, [&](size_t begin, size_t end) {
                for (size_t i = begin; i < end && !stop; ++i) {
                    if (progress.stopRequested()) stop = true;
                    const EdgeId e = sets[s][i];
                    previous[e.index] = disturbed(e) ? optimizeEdge(e) : 0;
                }
            });
            if (stop) return false;
        }
        moved = std::move(previous);
        left = size_t(std::count_if(mFree.begin(), mFree.end(),
                                    [&](EdgeId e) { return moved[e.index] >= kConvergedPx; }));
    }
    report.figures.emplace_back("sweeps", sweep);
    report.figures.emplace_back("curves still moving", double(left));
    return true;
}

PatchMesh CurveOptimizer::roundedMesh() const {
    PatchMesh mesh = mBase.mesh;
    for (const EdgeId e : mFree) {
        const BezierCurve& curve = mCurves[e.index];
        mesh.setInnerControlPoints(HalfedgeMesh::halfedge(e), toLattice(curve.p[1]), toLattice(curve.p[2]));
    }
    mesh.forEachPatch([&](PatchId p) { mesh.setInterior(p, toLattice(mInteriors[p.index])); });
    return mesh;
}

Result<PatchMesh> CurveOptimizer::certifiedMesh(Progress& progress, StageReport& report) const {
    PatchMesh mesh = mBase.mesh;
    // How much of each curve's way from the straight edge is kept.
    std::vector<double> kept(mConnectivity.edgeCapacity(), 1);
    const auto place = [&](EdgeId e) {
        const HalfedgeId h = HalfedgeMesh::halfedge(e);
        const auto straight = mBase.mesh.controlPoints(h);
        const BezierCurve& curve = mCurves[e.index];
        const auto at = [&](size_t i) {
            return toLattice(glm::mix(toPixels(straight[i]), curve.p[i], kept[e.index]));
        };
        mesh.setInnerControlPoints(h, kept[e.index] > 0 ? at(1) : straight[1],
                                   kept[e.index] > 0 ? at(2) : straight[2]);
    };
    for (const EdgeId e : mFree) place(e);

    std::vector<PatchId> open;
    mesh.forEachPatch([&](PatchId p) { open.push_back(p); });
    size_t folded = 0, rounds = 0;
    while (!open.empty()) {
        std::vector<PatchId> bad;
        for (const PatchId p : open) {
            if (progress.stopRequested()) return stopped();
            LatticeTriangle t = mesh.controlPoints(p);
            t.p[kInterior] = toLattice(mInteriors[p.index]);
            if (const auto interior = certifiedInterior(t))
                mesh.setInterior(p, *interior);
            else
                bad.push_back(p);
        }
        if (rounds++ == 0) folded = bad.size();
        std::vector<EdgeId> pull;
        for (const PatchId p : bad) {
            const size_t before = pull.size();
            for (const HalfedgeId side : mConnectivity.sides(p)) {
                const EdgeId e = HalfedgeMesh::edge(side);
                if (!mBase.mesh.curve(e).feature && !mConnectivity.onBorder(e) && kept[e.index] > 0)
                    pull.push_back(e);
            }
            TESSERA_CHECK(pull.size() >
                          before);  // with its sides straight a patch is the base domain's, certified
        }
        std::sort(pull.begin(), pull.end());
        pull.erase(std::unique(pull.begin(), pull.end()), pull.end());
        std::vector<uint8_t> again(mConnectivity.faceCapacity(), 0);
        for (const EdgeId e : pull) {
            constexpr double kShrink = .7, kLeast = .05;
            kept[e.index] = kept[e.index] * kShrink < kLeast ? 0 : kept[e.index] * kShrink;
            place(e);
            for (const HalfedgeId h :
                 {HalfedgeMesh::halfedge(e), HalfedgeMesh::twin(HalfedgeMesh::halfedge(e))})
                again[mConnectivity.face(h).index] = 1;
        }
        open.clear();
        for (uint32_t p = 0; p < again.size(); ++p)
            if (again[p]) open.push_back(PatchId(p));
    }
    const auto pulledCurves =
        std::count_if(mFree.begin(), mFree.end(), [&](EdgeId e) { return kept[e.index] < 1; });
    double deviation = 0;
    mesh.forEachEdge([&](EdgeId e) {
        if (mesh.curve(e).feature)
            deviation = std::max(
                deviation,
                maxDistance(toPixels(mesh.controlPoints(HalfedgeMesh::halfedge(e))), mBase.paths[e.index]));
    });
    report.figures.emplace_back("curves", double(mFree.size()));
    report.figures.emplace_back("patches uncertified after Eq. 1", double(folded));
    report.figures.emplace_back("curves pulled", double(pulledCurves));
    report.figures.emplace_back("largest feature deviation px", deviation);
    return mesh;
}

}  // namespace

Result<PatchMesh> fitCurves(const BaseDomain& base, const VectorizeSettings& settings, StageReport& report,
                            Progress& progress, const std::function<void(const PatchMesh&)>& observeInitial) {
    if (report.variant == "straight") return base.mesh;
    CurveOptimizer optimizer(base, settings);
    if (observeInitial) observeInitial(optimizer.roundedMesh());
    if (!optimizer.optimize(progress, report)) return stopped();
    return optimizer.certifiedMesh(progress, report);
}

}  // namespace tessera
