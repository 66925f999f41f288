// Finding patches, control points and curves near a place: what a pointer on the canvas asks for.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/mesh/patch_mesh.h"

namespace tessera {

struct Rect {
    glm::dvec2 min{0, 0};
    glm::dvec2 max{0, 0};
};

// The bounding box of a patch's control points (which holds the patch), in pixels.
Rect controlBounds(const PatchMesh& mesh, PatchId p);

// The parameters of the patch's point at `point` (px) by Newton's method, whether inside or within about a
// patch's size outside; none where it does not converge to 1e-9 of the patch's size.
std::optional<Barycentric> invert(const BezierTriangle& patch, glm::dvec2 point);

// Parameters in the domain for any point: those of the point itself where it lies inside the patch; else the
// nearest parameters, whose point is within `tolerance` px of it; else those of the nearest point of the
// sides.
Barycentric nearestParameters(const BezierTriangle& patch, glm::dvec2 point, double tolerance);

struct PatchHit {
    PatchId patch;
    Barycentric at;
};

struct ControlPointHit {
    enum class Kind { Vertex, CurveInner, Interior };
    Kind kind = Kind::Vertex;
    VertexId vertex;      // Kind::Vertex
    HalfedgeId halfedge;  // Kind::CurveInner: the control point next to this halfedge's origin
    PatchId patch;        // Kind::Interior
    double distance = 0;  // px
};

struct CurveHit {
    EdgeId edge;
    double t = 0;         // along HalfedgeMesh::halfedge(edge)
    double distance = 0;  // px
};

// An index over one state of a mesh: a uniform grid of control boxes. Keeps a snapshot of the mesh.
class PatchQuery {
  public:
    explicit PatchQuery(PatchMesh mesh);

    const PatchMesh& mesh() const { return mMesh; }

    // The patch at an image point; none outside the picture. On a shared edge, the patch of smaller id.
    std::optional<PatchHit> patchAt(glm::dvec2 point) const;
    // Patches whose control box meets the rectangle, by ascending id (a superset of those that meet it
    // themselves).
    std::vector<PatchId> patchesIn(const Rect& rect) const;
    // Patches whose centre (the point at 1/3, 1/3, 1/3) lies in a closed polygon, even-odd, by ascending id.
    std::vector<PatchId> patchesInPolygon(std::span<const glm::dvec2> polygon) const;
    // The nearest of its kind within `radius` px; ties go to vertices, then curve points, then smaller ids.
    std::optional<ControlPointHit> nearestControlPoint(glm::dvec2 point, double radius) const;
    std::optional<CurveHit> nearestCurve(glm::dvec2 point, double radius) const;

  private:
    PatchMesh mMesh;
    int mColumns = 1;
    int mRows = 1;
    double mCellSize = 1;
    std::vector<uint32_t> mFirst;  // per cell: where its patches begin in mPatches
    std::vector<PatchId> mPatches;
};

}  // namespace tessera
