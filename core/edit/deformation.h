// How control points move together: what goes along when some of them are dragged, and whether every patch
// stays certified.
#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/edit/reshape.h"

namespace tessera {

// A set of points of one state of a mesh that move; the rules are those of ShapeDrag (reshape.h).
class Deformation {
  public:
    // Of the points those that the mesh has; `weights` (none: all 1) multiply their ways.
    Deformation(PatchMesh start, std::span<const ControlPointRef> points, std::vector<double> weights = {});

    const PatchMesh& start() const { return mStart; }
    // All that may change; the patches ascend.
    Touched touched() const { return touchedOf(mVertices, mEdges, mPatches); }
    const PatchSet& patches() const { return mPatches; }
    // A locked patch that would change.
    std::optional<PatchId> locked() const { return mLocked; }
    size_t pointCount() const { return mPoints.size(); }
    // Patches that do not move as a whole.
    size_t looseCount() const;

    // Sets `mesh`, the start or what an earlier call made of it, to the start with point i moved by
    // weight * ways[i] px (or all by ways[0]). Returns a patch that is not certified then, if there is one.
    std::optional<PatchId> apply(PatchMesh& mesh, std::span<const glm::dvec2> ways, bool breakJoins) const;
    // The same answer, but patches that move as a whole are left as they are: for a search.
    std::optional<PatchId> probe(PatchMesh& mesh, std::span<const glm::dvec2> ways, bool breakJoins) const;

  private:
    static constexpr uint32_t kNone = 0xffffffff;
    struct Point {
        ControlPointRef ref;
        double weight = 1;
        uint32_t index = 0;  // among the points that were given
    };
    struct Edge {
        EdgeId id;
        bool straight = false;  // and to be kept so
        bool rigid = false;     // and so are the patches beside it
        std::array<uint32_t, 2> handles{kNone,
                                        kNone};  // dragged themselves: places in mPoints, from the start
        EdgeCurve curve;
    };
    struct Patch {
        PatchId id;
        uint32_t point = kNone;  // dragged itself
        bool rigid = false;      // all of it moves by one way, if all points do
        LatticePoint interior;
        glm::dvec2 usual{0};  // the default interior point of the start
    };

    void collect(std::span<const ControlPointRef> points, const std::vector<double>& weights);
    void collectJoins();
    void findRigid();
    LatticePoint step(const Point& point, std::span<const glm::dvec2> ways) const;
    LatticePoint keptOnBorder(LatticePoint at, LatticePoint to) const;
    std::optional<PatchId> run(PatchMesh& mesh, std::span<const glm::dvec2> ways, bool breakJoins,
                               bool everything) const;
    void moveVertex(PatchMesh& mesh, const Point& point, std::span<const glm::dvec2> ways) const;
    void moveCurve(PatchMesh& mesh, const Edge& edge, std::span<const glm::dvec2> ways) const;
    void alignJoins(PatchMesh& mesh, bool breakJoins) const;
    void moveInterior(PatchMesh& mesh, const Patch& patch, std::span<const glm::dvec2> ways) const;

    PatchMesh mStart;
    std::vector<Point> mPoints;
    std::vector<uint32_t> mVertexPoints;   // places in mPoints
    std::vector<uint32_t> mLooseVertices;  // of these those that are not in rigid patches alone
    std::vector<uint32_t> mPointOfVertex;
    std::vector<Edge> mMovingEdges;
    std::vector<Patch> mMovingPatches;
    std::vector<SmoothJoin> mJoins;    // that may have to turn
    std::vector<SmoothJoin> mImplied;  // likewise: features that go on nearly straight, not known as joins
    std::vector<VertexId> mVertices;
    std::vector<EdgeId> mEdges;
    PatchSet mPatches;
    std::optional<PatchId> mLocked;
};

// The halfedge of e that leaves v, one of its ends.
HalfedgeId leaving(const HalfedgeMesh& mesh, EdgeId e, VertexId v);

// The two features at a vertex that has exactly two, where they go on nearly straight: people take them for
// one curve, whether or not it is known as a join.
std::optional<SmoothJoin> impliedJoin(const PatchMesh& mesh, VertexId v);

// Turns the handle of `turned` at the join's vertex so that it lies straight across from that of the other
// edge, at its own length. Nothing where either has no length.
void alignHandle(PatchMesh& mesh, const SmoothJoin& join, EdgeId turned);

}  // namespace tessera
