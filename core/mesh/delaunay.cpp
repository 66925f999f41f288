// See delaunay.h.
#include "core/mesh/delaunay.h"

#include <array>
#include <deque>

#include "core/base/check.h"

namespace tessera {

namespace {

__extension__ typedef __int128 Wide;

// Whether d lies inside the circle through a, b, c (in positive orientation).
bool insideCircle(LatticePoint a, LatticePoint b, LatticePoint c, LatticePoint d) {
    const LatticePoint p = a - d, q = b - d, r = c - d;
    const auto lift = [](LatticePoint v) { return int64_t(v.x) * v.x + int64_t(v.y) * v.y; };
    const Wide determinant =
        Wide(lift(p)) * cross(q, r) - Wide(lift(q)) * cross(p, r) + Wide(lift(r)) * cross(p, q);
    return determinant > 0;
}

}  // namespace

Delaunay::Delaunay(LatticePoint extent)
    : mPositions{{0, 0}, {extent.x, 0}, {extent.x, extent.y}, {0, extent.y}} {
    constexpr std::array<std::array<uint32_t, 3>, 2> kHalves{{{0, 1, 2}, {0, 2, 3}}};
    mMesh = HalfedgeMesh::fromTriangles(4, kHalves);
    mConstrained.assign(mMesh.edgeCapacity(), 0);
}

int64_t Delaunay::orientation(VertexId a, VertexId b, LatticePoint p) const {
    return cross(at(b) - at(a), p - at(a));
}

FaceId Delaunay::locate(LatticePoint p) {
    // In a Delaunay triangulation a walk cannot go round in circles; constraints could make it, so that the
    // side at which it starts to look changes from step to step.
    FaceId f = mLast;
    for (size_t step = 0; step <= 4 * mMesh.faceCount() + 16; ++step) {
        const auto sides = mMesh.sides(f);
        HalfedgeId out;
        for (size_t k = 0; k < 3 && !out.valid(); ++k) {
            const HalfedgeId h = sides[(k + step) % 3];
            if (orientation(mMesh.origin(h), mMesh.target(h), p) < 0) out = h;
        }
        if (!out.valid()) return mLast = f;
        f = mMesh.face(HalfedgeMesh::twin(out));
        TESSERA_CHECK(f.valid());  // p lies in the rectangle
    }
    TESSERA_CHECK(false);
}

bool Delaunay::flippable(EdgeId e) const {
    if (mConstrained[e.index] || !mMesh.canFlip(e)) return false;
    const HalfedgeId h = HalfedgeMesh::halfedge(e), t = HalfedgeMesh::twin(h);
    const VertexId a = mMesh.origin(h), b = mMesh.origin(t);
    const VertexId c = mMesh.target(mMesh.next(h)), d = mMesh.target(mMesh.next(t));
    return orientation(c, d, at(b)) > 0 && orientation(d, c, at(a)) > 0;
}

bool Delaunay::wantsFlip(EdgeId e) const {
    if (!flippable(e)) return false;
    const HalfedgeId h = HalfedgeMesh::halfedge(e), t = HalfedgeMesh::twin(h);
    return insideCircle(at(mMesh.origin(h)), at(mMesh.origin(t)), at(mMesh.target(mMesh.next(h))),
                        at(mMesh.target(mMesh.next(t))));
}

void Delaunay::legalize(std::vector<EdgeId>& stack) {
    while (!stack.empty()) {
        const EdgeId e = stack.back();
        stack.pop_back();
        if (!wantsFlip(e)) continue;
        mMesh.flip(e);
        const HalfedgeId h = HalfedgeMesh::halfedge(e), t = HalfedgeMesh::twin(h);
        for (const HalfedgeId side : {mMesh.next(h), mMesh.prev(h), mMesh.next(t), mMesh.prev(t)})
            stack.push_back(HalfedgeMesh::edge(side));
    }
}

VertexId Delaunay::insert(LatticePoint p) {
    const FaceId f = locate(p);
    HalfedgeId on;
    for (const HalfedgeId h : mMesh.sides(f)) {
        if (at(mMesh.origin(h)) == p) return mMesh.origin(h);
        if (orientation(mMesh.origin(h), mMesh.target(h), p) == 0) on = h;
    }
    if (on.valid() && mConstrained[HalfedgeMesh::edge(on).index]) return {};
    const VertexId v = on.valid() ? mMesh.split(HalfedgeMesh::edge(on)) : mMesh.split(f);
    mPositions.push_back(p);
    mConstrained.resize(mMesh.edgeCapacity(), 0);
    std::vector<EdgeId> stack;
    mMesh.forEachOutgoing(v, [&](HalfedgeId h) {
        if (mMesh.face(h).valid()) stack.push_back(HalfedgeMesh::edge(mMesh.next(h)));
    });
    legalize(stack);
    return v;
}

EdgeId Delaunay::constrain(VertexId a, VertexId b) {
    HalfedgeId edge = mMesh.find(a, b);
    std::deque<EdgeId> crossing;
    if (!edge.valid()) {
        // The side of a's fan through which the segment leaves, then from triangle to triangle.
        HalfedgeId h;
        mMesh.forEachOutgoing(a, [&](HalfedgeId out) {
            if (!mMesh.face(out).valid()) return;
            const HalfedgeId across = mMesh.next(out);
            if (orientation(a, b, at(mMesh.origin(across))) < 0 &&
                orientation(a, b, at(mMesh.target(across))) > 0)
                h = across;
        });
        while (true) {
            if (!h.valid() || mConstrained[HalfedgeMesh::edge(h).index]) return {};
            crossing.push_back(HalfedgeMesh::edge(h));
            const HalfedgeId t = HalfedgeMesh::twin(h);
            if (!mMesh.face(t).valid()) return {};
            const VertexId beyond = mMesh.target(mMesh.next(t));
            if (beyond == b) break;
            const int64_t side = orientation(a, b, at(beyond));
            if (side == 0) return {};
            h = side > 0 ? mMesh.next(t) : mMesh.prev(t);
        }
    }
    std::vector<EdgeId> made;
    for (size_t left = 64 * crossing.size() * crossing.size() + 64; !crossing.empty(); --left) {
        TESSERA_CHECK(left > 0);
        const EdgeId e = crossing.front();
        crossing.pop_front();
        if (!flippable(e)) {
            crossing.push_back(e);
            continue;
        }
        mMesh.flip(e);
        const VertexId p = mMesh.origin(HalfedgeMesh::halfedge(e)),
                       q = mMesh.target(HalfedgeMesh::halfedge(e));
        const bool atEnd = p == a || p == b || q == a || q == b;
        const int64_t sp = orientation(a, b, at(p)), sq = orientation(a, b, at(q));
        if (!atEnd && ((sp < 0 && sq > 0) || (sp > 0 && sq < 0)))
            crossing.push_back(e);
        else
            made.push_back(e);
    }
    edge = mMesh.find(a, b);
    TESSERA_CHECK(edge.valid());
    mConstrained[HalfedgeMesh::edge(edge).index] = 1;
    legalize(made);
    return HalfedgeMesh::edge(edge);
}

}  // namespace tessera
