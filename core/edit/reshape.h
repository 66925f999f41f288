// Dragging of control points and curves. Every patch stays certified free of folds (jacobian.h), exactly on
// the lattice, at every moment.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/edit/patch_set.h"
#include "core/edit/touched.h"
#include "core/mesh/patch_query.h"

namespace tessera {

// Which control point: the kind, and the id that belongs to it as in ControlPointHit; the others are none.
struct ControlPointRef {
    ControlPointHit::Kind kind = ControlPointHit::Kind::Vertex;
    VertexId vertex;
    HalfedgeId halfedge;
    PatchId patch;

    static ControlPointRef of(VertexId v);
    static ControlPointRef of(HalfedgeId h);  // the inner point next to the origin of h
    static ControlPointRef of(PatchId p);     // the interior point
    static ControlPointRef of(const ControlPointHit& hit);

    auto operator<=>(const ControlPointRef&) const = default;
};

LatticePoint position(const PatchMesh& mesh, const ControlPointRef& point);
bool alive(const PatchMesh& mesh, const ControlPointRef& point);

// A curve as control points: its two vertices and its two inner points.
std::vector<ControlPointRef> controlPointsOf(const PatchMesh& mesh, EdgeId e);

struct DragResult {
    Touched touched;
    double fraction = 1;              // of the way from the start toward the goal before anything slides
    std::optional<PatchId> blocking;  // the patch that would fold, or is locked, where fraction < 1
};

struct PointMove {
    ControlPointRef point;
    glm::dvec2 to{0};  // px
};

// One drag. What goes along with the points that are dragged:
// - the handles (inner control points) at a vertex go with it; straight edges without a smooth join stay
//   straight; interior points follow the sides of their patch;
// - where two curves join smoothly and one handle turns, the other one turns with it, also where two features
//   go on nearly straight without being known as a join;
// - vertices on the picture's border slide along it, its corners stay, and so do handles of border edges.
// Where the goal would fold a patch or move a locked one, the drag goes as far as is certified and slides
// along the limit.
class ShapeDrag {
  public:
    // Dead points are left out.
    ShapeDrag(PatchMesh start, std::vector<ControlPointRef> points);
    // Drags the curve itself by its point at t in (0, 1): both inner points move, the ends stay.
    static ShapeDrag bend(PatchMesh start, EdgeId edge, double t);
    ~ShapeDrag();
    ShapeDrag(ShapeDrag&&) noexcept;
    ShapeDrag& operator=(ShapeDrag&&) noexcept;

    const PatchMesh& start() const;
    // The patches that the drag may change.
    const PatchSet& patches() const;

    // Sets `mesh`, which is the start or a result of this drag, to the start with the points moved by
    // `offset` px as far as that goes. With breakJoins the joins of handles that turn are given up. The same
    // result for the same offset, whatever came before.
    DragResult drag(PatchMesh& mesh, glm::dvec2 offset, bool breakJoins = false) const;

  private:
    struct State;
    explicit ShapeDrag(std::unique_ptr<State> state);
    std::unique_ptr<State> mState;
};

// Moves points to places of their own, all by the same share of their ways: the largest that is certified.
DragResult movePoints(PatchMesh& mesh, std::span<const PointMove> moves);

// Gives the editable patches of the set, where `fitted` still has them (hasFitted), the shape that they had,
// joins included; points that would fold a patch together with what has been edited around them stay.
Touched resetShape(PatchMesh& mesh, const PatchMesh& fitted, const PatchSet& set);

}  // namespace tessera

template <>
struct std::hash<tessera::ControlPointRef> {
    size_t operator()(const tessera::ControlPointRef& r) const noexcept {
        const size_t id = size_t(r.vertex.index) ^ size_t(r.halfedge.index) ^ size_t(r.patch.index);
        return id * 4 + size_t(r.kind);
    }
};
