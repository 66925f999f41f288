// Connectivity of a triangulated region of the plane: one type for simplification and for editing.
//
// Invariants: halfedges come in pairs, twin = h ^ 1 and edge = h >> 1; every face is a triangle; a halfedge
// without a face lies outside the region, and those form closed loops; no edge joins a vertex to itself and
// no two edges join the same two vertices. Deleted elements keep their ids; copies are snapshots (see
// paged_array.h).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

#include "core/base/ids.h"
#include "core/base/paged_array.h"

namespace tessera {

class HalfedgeMesh {
  public:
    HalfedgeMesh() = default;

    // Whether every element, dead ones too, is the same.
    bool operator==(const HalfedgeMesh&) const = default;

    // Each triangle's corners in positive orientation. Fails a check where a directed edge appears twice. An
    // empty mesh where `stop` is asked for meanwhile.
    static HalfedgeMesh fromTriangles(size_t vertexCount, std::span<const std::array<uint32_t, 3>> triangles,
                                      const std::stop_token& stop = {});

    // Ids run over [0, capacity); the live ones are counted apart.
    size_t vertexCapacity() const { return mVertexHalfedge.size(); }
    size_t edgeCapacity() const { return mHalfedges.size() / 2; }
    size_t faceCapacity() const { return mFaceHalfedge.size(); }
    size_t vertexCount() const { return mVertexCount; }
    size_t edgeCount() const { return mEdgeCount; }
    size_t faceCount() const { return mFaceCount; }
    bool alive(VertexId v) const { return mVertexHalfedge[v.index].valid(); }
    bool alive(EdgeId e) const { return mHalfedges[e.index << 1].origin.valid(); }
    bool alive(FaceId f) const { return mFaceHalfedge[f.index].valid(); }

    static HalfedgeId twin(HalfedgeId h) { return HalfedgeId(h.index ^ 1); }
    static EdgeId edge(HalfedgeId h) { return EdgeId(h.index >> 1); }
    // The halfedge along which an edge's data run.
    static HalfedgeId halfedge(EdgeId e) { return HalfedgeId(e.index << 1); }

    HalfedgeId next(HalfedgeId h) const { return mHalfedges[h.index].next; }
    HalfedgeId prev(HalfedgeId h) const;
    VertexId origin(HalfedgeId h) const { return mHalfedges[h.index].origin; }
    VertexId target(HalfedgeId h) const { return origin(twin(h)); }
    FaceId face(HalfedgeId h) const { return mHalfedges[h.index].face; }
    HalfedgeId halfedge(FaceId f) const { return mFaceHalfedge[f.index]; }
    // An outgoing halfedge; for a vertex on the border that whose face is outside.
    HalfedgeId halfedge(VertexId v) const { return mVertexHalfedge[v.index]; }
    bool onBorder(VertexId v) const { return !face(halfedge(v)).valid(); }
    bool onBorder(EdgeId e) const { return !face(halfedge(e)).valid() || !face(twin(halfedge(e))).valid(); }
    // The next outgoing halfedge around the origin; comes back to the first after a full turn.
    HalfedgeId rotate(HalfedgeId h) const { return next(twin(h)); }

    // Corners of a face, from the origin of its halfedge.
    std::array<VertexId, 3> corners(FaceId f) const;
    // Sides of a face as halfedges, the first its own.
    std::array<HalfedgeId, 3> sides(FaceId f) const;
    // The halfedge from a to b, or none.
    HalfedgeId find(VertexId a, VertexId b) const;

    // Calls visit(h) for each halfedge that leaves v.
    template <class Visit>
    void forEachOutgoing(VertexId v, Visit&& visit) const {
        const HalfedgeId first = halfedge(v);
        HalfedgeId h = first;
        do {
            visit(h);
            h = rotate(h);
        } while (h != first);
    }

    // Whether moving the origin of h onto its target keeps the invariants (the link condition).
    bool canCollapse(HalfedgeId h) const;

    // What collapse() did: on either side of the edge, two edges became one. `kept` now lies where `replaced`
    // lay before (its face and its place around it); both invalid on a side without a face.
    struct Merge {
        HalfedgeId kept;
        HalfedgeId replaced;
    };
    struct Collapse {
        std::array<Merge, 2> merges;
    };

    // Moves the origin u of h onto its target v, deleting u, the edge and the faces beside it. Of the two
    // edges that fall together on a side the one at v survives, or the one at u where keepOrigin[side] is set
    // (side 0: the face of h). Needs canCollapse(h).
    Collapse collapse(HalfedgeId h, std::array<bool, 2> keepOrigin = {false, false});

    // Whether the edge between two faces can be turned to join their opposite corners.
    bool canFlip(EdgeId e) const;
    // Turns it; halfedge(e) then runs from the corner opposite its own face before to the other one.
    void flip(EdgeId e);

    // Puts a new vertex on an edge and joins it to the corners opposite. halfedge(e) then ends at the vertex,
    // from which the first of the new edges runs on to the old end.
    VertexId split(EdgeId e);
    // Puts a new vertex into a face and joins it to the corners; the face keeps its first side.
    VertexId split(FaceId f);

    // A new mesh of the live elements alone, in order; old ids by new id.
    struct Compacted;
    Compacted compacted() const;

    // The memory that this mesh takes and does not share with `other`, in bytes.
    size_t bytesBeyond(const HalfedgeMesh& other) const;

  private:
    struct Halfedge {
        HalfedgeId next;
        VertexId origin;
        FaceId face;

        bool operator==(const Halfedge&) const = default;
    };

    void setNext(HalfedgeId h, HalfedgeId to) { mHalfedges.edit(h.index).next = to; }
    VertexId addVertex();
    HalfedgeId addEdge(VertexId from, VertexId to);  // the halfedge that leaves `from`
    // Makes `f` the triangle of three halfedges in this order.
    void setFace(FaceId f, HalfedgeId a, HalfedgeId b, HalfedgeId c);
    FaceId addFace(HalfedgeId a, HalfedgeId b, HalfedgeId c);
    void remove(EdgeId e);
    void remove(FaceId f);
    void chooseVertexHalfedge(VertexId v, HalfedgeId any);
    void takePlace(HalfedgeId kept, HalfedgeId replaced);

    PagedArray<Halfedge> mHalfedges;
    PagedArray<HalfedgeId> mVertexHalfedge;
    PagedArray<HalfedgeId> mFaceHalfedge;
    size_t mVertexCount = 0;
    size_t mEdgeCount = 0;
    size_t mFaceCount = 0;
};

struct HalfedgeMesh::Compacted {
    HalfedgeMesh mesh;
    std::vector<VertexId> oldVertex;
    std::vector<EdgeId> oldEdge;
    std::vector<FaceId> oldFace;
};

}  // namespace tessera
