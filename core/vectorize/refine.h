// The true-error stage: the triangulation is changed by collapses, splits, flips and moves of vertices, each
// judged by the squared error of the best polynomials over the triangles that it touches.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/vectorize/cut_mesh.h"
#include "core/vectorize/polynomial_fit.h"
#include "core/vectorize/settings.h"

namespace tessera {

// A half-edge collapse: enough to do it again on the same mesh.
struct RecordedCollapse {
    HalfedgeId halfedge;
    std::array<bool, 2> kept;       // as HalfedgeMesh::collapse has it
    std::optional<CutCurve> curve;  // the one that two become where a feature's vertex goes
};
void apply(const RecordedCollapse& collapse, CutMesh& cut);

// Changes `cut` and keeps its invariants: faces stay certified, features stay on their chains within
// settings.featureTolerancePx, no angle falls below kMinAngleDegrees that was not below it before.
class Refiner {
  public:
    static constexpr double kMinAngleDegrees = 8;

    // Keeps references. `fit` over the picture with hard features. Where `stop` is asked for, the operations
    // end soon, with the mesh sound but its errors out of date.
    Refiner(CutMesh& cut, const PolynomialFit& fit, const VectorizeSettings& settings,
            std::stop_token stop = {});

    size_t faceCount() const { return m.mesh.faceCount(); }
    // Sum over pixels and channels, as the polynomials have it.
    double totalError() const;

    // Collapses, cheapest first, until at most `faces` are left or nothing more can go. False where progress
    // says stop.
    bool collapseTo(size_t faces, Progress& progress);
    // From now on, each collapse is appended to `collapses`.
    void recordTo(std::vector<RecordedCollapse>& collapses) { mRecord = &collapses; }
    // Splits the edges that gain most until there are `faces` faces or no split gains.
    void splitTo(size_t faces);
    // One pass each; returns how many changed.
    size_t flip();
    // Tries eight directions, `step` times the size of a face beside the vertex.
    size_t move(double step);

  private:
    // A triangle that is or could be: its corners, and for each side (from corner k) its curve.
    struct Triangle {
        std::array<LatticePoint, 3> corners;
        std::array<const CutCurve*, 3> curves{};
        std::array<VertexId, 3> vertices;
    };
    struct Option {
        double cost;  // growth of the error; infinite where it cannot be done
        HalfedgeId halfedge;
    };
    // The one curve that two become where a feature vertex goes.
    struct Merge {
        HalfedgeId before;  // leaves the vertex toward `beyond`
        VertexId beyond;
        CutCurve curve;
    };

    LatticePoint at(VertexId v) const { return m.positions[v.index]; }
    Triangle triangle(FaceId f) const;
    const CutCurve* curveBetween(VertexId a, VertexId b) const;
    double error(const Triangle& t) const;
    bool valid(const Triangle& t, double leastShape) const;
    double worstShapeAround(VertexId v) const;
    double errorAround(VertexId v) const;
    void updateFace(FaceId f) { mError[f.index] = error(triangle(f)); }
    void updateFaces(const std::vector<FaceId>& faces);
    bool staysOnSide(VertexId v, LatticePoint to) const;

    bool mayCollapse(HalfedgeId h) const;
    std::optional<Merge> merge(HalfedgeId h) const;
    std::array<bool, 2> keptSides(HalfedgeId h, const Merge& merge) const;
    bool fansAfter(HalfedgeId h, const std::optional<Merge>& merge, std::vector<Triangle>& fans,
                   double& before) const;
    Option bestCollapse(VertexId u) const;
    void collapse(HalfedgeId h, std::vector<FaceId>& changed);
    // The edges at which `cost` is below 0, the cheapest first.
    template <class Cost>
    std::vector<EdgeId> edgesByCost(Cost&& cost) const;
    double flipCost(EdgeId e) const;
    double splitCost(EdgeId e) const;
    LatticePoint middle(EdgeId e) const;
    bool tryMove(VertexId v, double step);

    CutMesh& m;
    const PolynomialFit& mFit;
    double mTolerancePx;
    std::stop_token mStop;
    std::vector<double> mError;  // by face
    std::vector<RecordedCollapse>* mRecord = nullptr;
};

// Stage "simplify", variant "true-error": from the initial triangulation to settings.patches faces.
Result<CutMesh> refine(CutMesh cut, const PolynomialFit& fit, const VectorizeSettings& settings,
                       StageReport& report, std::string& shortfall, Progress& progress);

}  // namespace tessera
