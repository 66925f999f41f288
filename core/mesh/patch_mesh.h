// The model: a picture as non-overlapping cubic triangles with a colour spline each (paper section 3).
//
// Connectivity, geometry and colour are apart: a HalfedgeMesh whose faces are the patches; vertices and
// control points on the lattice; a spline per patch. An edge has ONE curve, seen from both of its sides, so
// that patches cannot gap or overlap along it; a feature curve is one geometry with two colour sides, since
// each patch has its own colours. Copying a PatchMesh is a snapshot (paged_array.h).
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <memory>
#include <span>
#include <vector>

#include "core/mesh/bezier.h"
#include "core/mesh/colour_basis.h"
#include "core/mesh/halfedge_mesh.h"
#include "core/mesh/lattice.h"
#include "core/mesh/tps.h"

namespace tessera {

// The inner control points of an edge's cubic, in the direction of HalfedgeMesh::halfedge(edge), and what is
// known of the edge. Its ends are the vertices.
struct EdgeCurve {
    LatticePoint c1;
    LatticePoint c2;
    bool feature = false;              // a colour discontinuity lies on it
    std::array<float, 2> blurSigma{};  // px, at the curve's two ends; 0 is a hard edge
    // An edit left a jump of colours here: no feature, and no seam that should be narrow.
    bool colourBreak = false;

    bool operator==(const EdgeCurve&) const = default;
};

// Two curves that meet at a vertex with one common tangent (G1).
struct SmoothJoin {
    VertexId vertex;
    EdgeId first;
    EdgeId second;

    auto operator<=>(const SmoothJoin&) const = default;
};

// What an editor knows of a patch.
struct PatchAttributes {
    bool hidden = false;  // not drawn where people work; pictures of the mesh have it
    bool locked = false;  // tools neither select nor change it
    bool cutOut = false;  // transparent in every picture of the mesh

    bool operator==(const PatchAttributes&) const = default;
};

// What a mesh is but its colours and attributes: a snapshot to compare with.
struct MeshGeometry {
    HalfedgeMesh connectivity;
    PagedArray<LatticePoint> positions;
    PagedArray<EdgeCurve> curves;
    PagedArray<LatticePoint> interiors;

    bool operator==(const MeshGeometry&) const = default;
};

class EdgeBlurCache;  // edge_blur.h

class PatchMesh {
  public:
    PatchMesh() = default;

    // A mesh over `connectivity` with straight edges, default interior points and constant colour 0.
    // `positions` by vertex id; the picture is [0, width] x [0, height] pixels with `channels` (3 or 4)
    // channels.
    PatchMesh(int width, int height, int channels, HalfedgeMesh connectivity,
              std::span<const LatticePoint> positions);

    int width() const { return mWidth; }
    int height() const { return mHeight; }
    int channels() const { return mChannels; }
    const HalfedgeMesh& connectivity() const { return mConnectivity; }
    // That of the splines of all patches.
    ColourBasis colourBasis() const { return mColourBasis; }
    size_t patchCount() const { return mConnectivity.faceCount(); }

    LatticePoint position(VertexId v) const { return mPositions[v.index]; }
    const EdgeCurve& curve(EdgeId e) const { return mCurves[e.index]; }
    LatticePoint interior(PatchId p) const { return mInteriors[p.index]; }
    const PatchSpline& spline(PatchId p) const { return mSplines[p.index]; }
    const PatchAttributes& attributes(PatchId p) const { return mAttributes[p.index]; }
    const std::vector<SmoothJoin>& smoothJoins() const { return mSmoothJoins; }

    MeshGeometry geometry() const { return {mConnectivity, mPositions, mCurves, mInteriors}; }
    // That of this mesh and all copies of it; none where the mesh was made without patches.
    const std::shared_ptr<EdgeBlurCache>& edgeBlurCache() const { return mEdgeBlurCache; }

    // Another connectivity over the same elements (after a flip, say), and new ones (after a split), whose
    // geometry, colours and attributes are default values. The caller keeps the geometry consistent.
    void setConnectivity(HalfedgeMesh connectivity);
    // The values of the splines stay as they are and mean something else.
    void setColourBasis(ColourBasis basis) { mColourBasis = basis; }
    void setPosition(VertexId v, LatticePoint p) { mPositions.edit(v.index) = p; }
    void setCurve(EdgeId e, const EdgeCurve& curve) { mCurves.edit(e.index) = curve; }
    void setInterior(PatchId p, LatticePoint point) { mInteriors.edit(p.index) = point; }
    void setSpline(PatchId p, PatchSpline spline) { mSplines.edit(p.index) = std::move(spline); }
    // For many patches, by ascending id: what they share with other meshes is not copied first.
    void setSplines(std::span<const PatchId> patches, std::vector<PatchSpline> splines);
    void setAttributes(PatchId p, const PatchAttributes& a) { mAttributes.edit(p.index) = a; }
    void setSmoothJoins(std::vector<SmoothJoin> joins) { mSmoothJoins = std::move(joins); }

    // The four control points of a halfedge's curve, from its origin.
    std::array<LatticePoint, 4> controlPoints(HalfedgeId h) const;
    // The ten control points of a patch; corner a is the origin of the face's halfedge.
    LatticeTriangle controlPoints(PatchId p) const;
    // Sets the inner control points of a halfedge's curve, given from its origin.
    void setInnerControlPoints(HalfedgeId h, LatticePoint c1, LatticePoint c2);

    // The memory that this mesh takes and does not share with `other`, in bytes.
    size_t bytesBeyond(const PatchMesh& other) const;

    // Each live element, in order of its id.
    template <class Visit>
    void forEachPatch(Visit&& visit) const {
        for (uint32_t i = 0; i < mConnectivity.faceCapacity(); ++i)
            if (mConnectivity.alive(PatchId(i))) visit(PatchId(i));
    }
    template <class Visit>
    void forEachEdge(Visit&& visit) const {
        for (uint32_t i = 0; i < mConnectivity.edgeCapacity(); ++i)
            if (mConnectivity.alive(EdgeId(i))) visit(EdgeId(i));
    }
    template <class Visit>
    void forEachVertex(Visit&& visit) const {
        for (uint32_t i = 0; i < mConnectivity.vertexCapacity(); ++i)
            if (mConnectivity.alive(VertexId(i))) visit(VertexId(i));
    }

  private:
    int mWidth = 0;
    int mHeight = 0;
    int mChannels = 3;
    ColourBasis mColourBasis = ColourBasis::Rgb;
    HalfedgeMesh mConnectivity;
    PagedArray<LatticePoint> mPositions;
    PagedArray<EdgeCurve> mCurves;
    PagedArray<LatticePoint> mInteriors;
    PagedArray<PatchSpline, 6> mSplines;
    PagedArray<PatchAttributes> mAttributes;
    std::vector<SmoothJoin> mSmoothJoins;
    std::shared_ptr<EdgeBlurCache> mEdgeBlurCache;
};

BezierCurve toPixels(const std::array<LatticePoint, 4>& controlPoints);

// Inner control points of the straight edge between two lattice points, the same from both ends.
std::array<LatticePoint, 2> straightControlPoints(LatticePoint a, LatticePoint b);

}  // namespace tessera
