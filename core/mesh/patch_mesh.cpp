// See patch_mesh.h.
#include "core/mesh/patch_mesh.h"

#include "core/base/check.h"
#include "core/mesh/edge_blur.h"

namespace tessera {

namespace {

// (2 a + b) / 3, rounded to the lattice.
int32_t third(int32_t a, int32_t b) {
    return int32_t(std::lround((2.0 * a + b) / 3.0));
}

}  // namespace

std::array<LatticePoint, 2> straightControlPoints(LatticePoint a, LatticePoint b) {
    return {LatticePoint{third(a.x, b.x), third(a.y, b.y)}, LatticePoint{third(b.x, a.x), third(b.y, a.y)}};
}

size_t PatchMesh::bytesBeyond(const PatchMesh& other) const {
    const auto ofVector = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
    const auto ofSpline = [&](const PatchSpline& spline, const PatchSpline* before) {
        const size_t sites = before && spline.sites.shares(before->sites) ? 0 : spline.sites.size();
        return sites + ofVector(spline.centres) + ofVector(spline.coefficients);
    };
    return mConnectivity.bytesBeyond(other.mConnectivity) + mPositions.bytesBeyond(other.mPositions) +
           mCurves.bytesBeyond(other.mCurves) + mInteriors.bytesBeyond(other.mInteriors) +
           mSplines.bytesBeyond(other.mSplines, ofSpline) + mAttributes.bytesBeyond(other.mAttributes) +
           ofVector(mSmoothJoins);
}

BezierCurve toPixels(const std::array<LatticePoint, 4>& c) {
    return {{toPixels(c[0]), toPixels(c[1]), toPixels(c[2]), toPixels(c[3])}};
}

PatchMesh::PatchMesh(int width, int height, int channels, HalfedgeMesh connectivity,
                     std::span<const LatticePoint> positions)
    : mWidth(width),
      mHeight(height),
      mChannels(channels),
      mConnectivity(std::move(connectivity)),
      mPositions(mConnectivity.vertexCapacity()),
      mCurves(mConnectivity.edgeCapacity()),
      mInteriors(mConnectivity.faceCapacity()),
      mSplines(mConnectivity.faceCapacity()),
      mAttributes(mConnectivity.faceCapacity()),
      mEdgeBlurCache(std::make_shared<EdgeBlurCache>()) {
    TESSERA_CHECK(positions.size() == mConnectivity.vertexCapacity());
    TESSERA_CHECK(channels == 3 || channels == 4);
    for (uint32_t v = 0; v < positions.size(); ++v) setPosition(VertexId(v), positions[v]);
    forEachEdge([&](EdgeId e) {
        const HalfedgeId h = HalfedgeMesh::halfedge(e);
        const auto inner =
            straightControlPoints(position(mConnectivity.origin(h)), position(mConnectivity.target(h)));
        setInnerControlPoints(h, inner[0], inner[1]);
    });
    const std::array<float, kMaxChannels> black{};
    forEachPatch([&](PatchId p) {
        setInterior(p, toLattice(defaultInterior(toPixels(controlPoints(p)))));
        setSpline(p, constantSpline({black.data(), size_t(channels)}));
    });
}

void PatchMesh::setConnectivity(HalfedgeMesh connectivity) {
    mConnectivity = std::move(connectivity);
    const auto grow = [](auto& elements, size_t count) {
        if (elements.size() < count) elements.resize(count);
    };
    grow(mPositions, mConnectivity.vertexCapacity());
    grow(mCurves, mConnectivity.edgeCapacity());
    grow(mInteriors, mConnectivity.faceCapacity());
    grow(mSplines, mConnectivity.faceCapacity());
    grow(mAttributes, mConnectivity.faceCapacity());
}

void PatchMesh::setSplines(std::span<const PatchId> patches, std::vector<PatchSpline> splines) {
    std::vector<size_t> indices;
    indices.reserve(patches.size());
    for (const PatchId p : patches) indices.push_back(p.index);
    mSplines.replace(indices, splines);
}

std::array<LatticePoint, 4> PatchMesh::controlPoints(HalfedgeId h) const {
    const EdgeCurve& c = curve(HalfedgeMesh::edge(h));
    const bool forward = HalfedgeMesh::halfedge(HalfedgeMesh::edge(h)) == h;
    return {position(mConnectivity.origin(h)), forward ? c.c1 : c.c2, forward ? c.c2 : c.c1,
            position(mConnectivity.target(h))};
}

LatticeTriangle PatchMesh::controlPoints(PatchId p) const {
    LatticeTriangle t;
    const auto sides = mConnectivity.sides(p);
    for (size_t s = 0; s < 3; ++s) {
        const auto c = controlPoints(sides[s]);
        t.p[3 * s] = c[0];
        t.p[3 * s + 1] = c[1];
        t.p[3 * s + 2] = c[2];
    }
    t.p[kInterior] = interior(p);
    return t;
}

void PatchMesh::setInnerControlPoints(HalfedgeId h, LatticePoint c1, LatticePoint c2) {
    const bool forward = HalfedgeMesh::halfedge(HalfedgeMesh::edge(h)) == h;
    EdgeCurve& c = mCurves.edit(HalfedgeMesh::edge(h).index);
    c.c1 = forward ? c1 : c2;
    c.c2 = forward ? c2 : c1;
}

}  // namespace tessera
