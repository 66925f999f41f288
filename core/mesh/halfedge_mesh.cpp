// See halfedge_mesh.h.
#include "core/mesh/halfedge_mesh.h"

#include <algorithm>

#include "core/base/check.h"

namespace tessera {

HalfedgeMesh HalfedgeMesh::fromTriangles(size_t vertexCount,
                                         std::span<const std::array<uint32_t, 3>> triangles,
                                         const std::stop_token& stop) {
    const auto stopAt = [&stop](size_t i) { return i % 4096 == 0 && stop.stop_requested(); };
    HalfedgeMesh mesh;
    mesh.mVertexHalfedge.resize(vertexCount);
    mesh.mFaceHalfedge.resize(triangles.size());
    mesh.mVertexCount = vertexCount;
    mesh.mFaceCount = triangles.size();

    // Triangle sides bucketed by their smaller vertex (counting sort): the two sides of an edge meet in one
    // bucket.
    struct Side {
        uint32_t larger;
        uint32_t side;  // 3 * triangle + corner
    };
    std::vector<uint32_t> first(vertexCount + 1, 0);
    for (const auto& t : triangles)
        for (int c = 0; c < 3; ++c) ++first[std::min(t[size_t(c)], t[size_t((c + 1) % 3)]) + 1];
    for (size_t v = 0; v < vertexCount; ++v) first[v + 1] += first[v];
    std::vector<Side> sides(3 * triangles.size());
    std::vector<uint32_t> fill(first.begin(), first.end() - 1);
    for (uint32_t f = 0; f < triangles.size(); ++f) {
        if (stopAt(f)) return {};
        for (uint32_t c = 0; c < 3; ++c) {
            const uint32_t a = triangles[f][c], b = triangles[f][(c + 1) % 3];
            TESSERA_CHECK(a != b && a < vertexCount && b < vertexCount);
            sides[fill[std::min(a, b)]++] = {std::max(a, b), 3 * f + c};
        }
    }

    std::vector<HalfedgeId> halfedgeOfSide(3 * triangles.size());
    for (size_t v = 0; v < vertexCount; ++v) {
        if (stopAt(v)) return {};
        const auto begin = sides.begin() + first[v], end = sides.begin() + first[v + 1];
        std::sort(begin, end, [](const Side& a, const Side& b) {
            return a.larger != b.larger ? a.larger < b.larger : a.side < b.side;
        });
        for (auto s = begin; s != end;) {
            const auto originOf = [&](uint32_t side) { return triangles[side / 3][side % 3]; };
            const uint32_t a = originOf(s->side), b = a == v ? s->larger : uint32_t(v);
            const auto index = uint32_t(mesh.mHalfedges.size());
            mesh.mHalfedges.pushBack({HalfedgeId(), VertexId(a), FaceId(s->side / 3)});
            mesh.mHalfedges.pushBack({HalfedgeId(), VertexId(b), FaceId()});
            halfedgeOfSide[s->side] = HalfedgeId(index);
            const auto other = s + 1;
            if (other != end && other->larger == s->larger) {
                TESSERA_CHECK(originOf(other->side) == b);  // the same direction twice: not a manifold
                mesh.mHalfedges.edit(index + 1).face = FaceId(other->side / 3);
                halfedgeOfSide[other->side] = HalfedgeId(index + 1);
                s = other + 1;
                TESSERA_CHECK(s == end || s->larger != other->larger);
            } else {
                s = other;
            }
        }
    }
    mesh.mEdgeCount = mesh.mHalfedges.size() / 2;

    for (uint32_t f = 0; f < triangles.size(); ++f) {
        if (stopAt(f)) return {};
        mesh.mFaceHalfedge.edit(f) = halfedgeOfSide[3 * f];
        for (uint32_t c = 0; c < 3; ++c) {
            const HalfedgeId h = halfedgeOfSide[3 * f + c];
            mesh.setNext(h, halfedgeOfSide[3 * f + (c + 1) % 3]);
            mesh.mVertexHalfedge.edit(triangles[f][c]) = h;
        }
    }
    // A halfedge outside runs on to the one that leaves its target; a border vertex has exactly one of those.
    for (uint32_t h = 0; h < mesh.mHalfedges.size(); ++h) {
        if (stopAt(h)) return {};
        if (!mesh.face(HalfedgeId(h)).valid()) {
            const HalfedgeId known = mesh.mVertexHalfedge[mesh.origin(HalfedgeId(h)).index];
            TESSERA_CHECK(!known.valid() || mesh.face(known).valid());
            mesh.mVertexHalfedge.edit(mesh.origin(HalfedgeId(h)).index) = HalfedgeId(h);
        }
    }
    for (uint32_t h = 0; h < mesh.mHalfedges.size(); ++h)
        if (!mesh.face(HalfedgeId(h)).valid())
            mesh.setNext(HalfedgeId(h), mesh.mVertexHalfedge[mesh.target(HalfedgeId(h)).index]);
    for (size_t v = 0; v < vertexCount; ++v)
        if (!mesh.mVertexHalfedge[v].valid()) --mesh.mVertexCount;
    return mesh;
}

HalfedgeId HalfedgeMesh::prev(HalfedgeId h) const {
    if (face(h).valid()) return next(next(h));
    // Around the origin to the halfedge that enters it from outside.
    HalfedgeId into = twin(h);
    while (next(into) != h) into = twin(next(into));
    return into;
}

std::array<VertexId, 3> HalfedgeMesh::corners(FaceId f) const {
    const auto s = sides(f);
    return {origin(s[0]), origin(s[1]), origin(s[2])};
}

std::array<HalfedgeId, 3> HalfedgeMesh::sides(FaceId f) const {
    const HalfedgeId a = halfedge(f), b = next(a);
    return {a, b, next(b)};
}

HalfedgeId HalfedgeMesh::find(VertexId a, VertexId b) const {
    HalfedgeId found;
    forEachOutgoing(a, [&](HalfedgeId h) {
        if (target(h) == b) found = h;
    });
    return found;
}

bool HalfedgeMesh::canCollapse(HalfedgeId h) const {
    const VertexId u = origin(h), v = target(h);
    const bool inside = face(h).valid() && face(twin(h)).valid();
    if (inside && onBorder(u) && onBorder(v)) return false;  // would pinch the region
    if (!inside && mFaceCount < 3) return false;

    VertexId opposite[2];
    for (int side = 0; side < 2; ++side) {
        const HalfedgeId s = side == 0 ? h : twin(h);
        if (!face(s).valid()) continue;
        const HalfedgeId s1 = next(s), s2 = next(s1);
        opposite[side] = target(s1);
        // The face's two other edges fall together: one of them needs a face beyond.
        if (!face(twin(s1)).valid() && !face(twin(s2)).valid()) return false;
    }
    // Link condition: u and v have no common neighbour but the corners opposite the edge.
    bool linked = true;
    forEachOutgoing(u, [&](HalfedgeId a) {
        const VertexId neighbour = target(a);
        if (neighbour == v || neighbour == opposite[0] || neighbour == opposite[1]) return;
        forEachOutgoing(v, [&](HalfedgeId b) { linked = linked && target(b) != neighbour; });
    });
    return linked;
}

void HalfedgeMesh::remove(EdgeId e) {
    mHalfedges.edit(e.index << 1) = {};
    mHalfedges.edit(e.index << 1 | 1) = {};
    --mEdgeCount;
}

void HalfedgeMesh::remove(FaceId f) {
    mFaceHalfedge.edit(f.index) = HalfedgeId();
    --mFaceCount;
}

// `kept`, of a face that vanishes, takes the place of `replaced`, of the face beyond.
void HalfedgeMesh::takePlace(HalfedgeId kept, HalfedgeId replaced) {
    setNext(prev(replaced), kept);
    const FaceId f = face(replaced);
    mHalfedges.edit(kept.index).next = next(replaced);
    mHalfedges.edit(kept.index).face = f;
    if (f.valid()) mFaceHalfedge.edit(f.index) = kept;
}

void HalfedgeMesh::chooseVertexHalfedge(VertexId v, HalfedgeId any) {
    mVertexHalfedge.edit(v.index) = any;
    forEachOutgoing(v, [&](HalfedgeId h) {
        if (!face(h).valid()) mVertexHalfedge.edit(v.index) = h;
    });
}

HalfedgeMesh::Collapse HalfedgeMesh::collapse(HalfedgeId h, std::array<bool, 2> keepOrigin) {
    const VertexId u = origin(h), v = target(h);
    const bool border = onBorder(u) || onBorder(v);
    Collapse result;

    std::array<HalfedgeId, 32> ringBuffer;
    size_t ringSize = 0;
    std::vector<HalfedgeId> ringOverflow;
    forEachOutgoing(u, [&](HalfedgeId out) {
        if (ringSize < ringBuffer.size())
            ringBuffer[ringSize++] = out;
        else
            ringOverflow.push_back(out);
    });
    for (size_t i = 0; i < ringSize; ++i) mHalfedges.edit(ringBuffer[i].index).origin = v;
    for (const HalfedgeId out : ringOverflow) mHalfedges.edit(out.index).origin = v;

    // The edge goes first, on both sides while the ways around its ends are whole: outside, the border closes
    // over the gap; a face is left with two sides, `lost` and `kept`, until `kept` takes the place of lost's
    // twin.
    const HalfedgeId before = prev(h), beforeTwin = prev(twin(h));
    setNext(before, next(h));
    setNext(beforeTwin, next(twin(h)));

    std::array<VertexId, 2> opposite;
    std::array<HalfedgeId, 2> outOfOpposite;  // a surviving halfedge that leaves the opposite corner
    HalfedgeId outOfV;
    for (size_t side = 0; side < 2; ++side) {
        const HalfedgeId s = side == 0 ? h : twin(h);
        if (!face(s).valid()) continue;
        const HalfedgeId s1 = next(s), s2 = next(s1);
        // Side 0: s = u -> v, s1 = v -> a, s2 = a -> u. Side 1: s = v -> u, s1 = u -> b, s2 = b -> v.
        const HalfedgeId atTarget = side == 0 ? s1 : s2, atOrigin = side == 0 ? s2 : s1;
        const HalfedgeId kept = keepOrigin[side] ? atOrigin : atTarget;
        const HalfedgeId lost = keepOrigin[side] ? atTarget : atOrigin;
        opposite[side] = target(s1);
        result.merges[side] = {kept, twin(lost)};
        remove(face(s));
        takePlace(kept, twin(lost));
        outOfOpposite[side] = origin(kept) == opposite[side] ? kept : twin(kept);
        outOfV = origin(kept) == v ? kept : twin(kept);
        remove(edge(lost));
    }
    remove(edge(h));
    mVertexHalfedge.edit(u.index) = HalfedgeId();
    --mVertexCount;
    for (size_t side = 0; side < 2; ++side)
        if (opposite[side].valid()) chooseVertexHalfedge(opposite[side], outOfOpposite[side]);
    if (border)
        chooseVertexHalfedge(v, outOfV);
    else
        mVertexHalfedge.edit(v.index) = outOfV;
    return result;
}

bool HalfedgeMesh::canFlip(EdgeId e) const {
    const HalfedgeId h = halfedge(e), t = twin(h);
    if (!face(h).valid() || !face(t).valid()) return false;
    return !find(target(next(h)), target(next(t))).valid();
}

void HalfedgeMesh::flip(EdgeId e) {
    TESSERA_CHECK(canFlip(e));
    const HalfedgeId h = halfedge(e), t = twin(h);
    const HalfedgeId h1 = next(h), h2 = next(h1), t1 = next(t), t2 = next(t1);
    const VertexId a = origin(h), b = origin(t), c = origin(h2), d = origin(t2);
    const FaceId f = face(h), g = face(t);
    // (a, b, c) and (b, a, d) become (c, d, b) and (d, c, a).
    mHalfedges.edit(h.index) = {t2, c, f};
    mHalfedges.edit(t2.index) = {h1, d, f};
    mHalfedges.edit(h1.index) = {h, b, f};
    mHalfedges.edit(t.index) = {h2, d, g};
    mHalfedges.edit(h2.index) = {t1, c, g};
    mHalfedges.edit(t1.index) = {t, a, g};
    mFaceHalfedge.edit(f.index) = h;
    mFaceHalfedge.edit(g.index) = t;
    if (halfedge(a) == h) mVertexHalfedge.edit(a.index) = t1;
    if (halfedge(b) == t) mVertexHalfedge.edit(b.index) = h1;
}

VertexId HalfedgeMesh::addVertex() {
    mVertexHalfedge.pushBack(HalfedgeId());
    ++mVertexCount;
    return VertexId(uint32_t(mVertexHalfedge.size() - 1));
}

HalfedgeId HalfedgeMesh::addEdge(VertexId from, VertexId to) {
    const HalfedgeId h(uint32_t(mHalfedges.size()));
    mHalfedges.pushBack({HalfedgeId(), from, FaceId()});
    mHalfedges.pushBack({HalfedgeId(), to, FaceId()});
    ++mEdgeCount;
    return h;
}

void HalfedgeMesh::setFace(FaceId f, HalfedgeId a, HalfedgeId b, HalfedgeId c) {
    setNext(a, b);
    setNext(b, c);
    setNext(c, a);
    for (const HalfedgeId h : {a, b, c}) mHalfedges.edit(h.index).face = f;
    mFaceHalfedge.edit(f.index) = a;
}

FaceId HalfedgeMesh::addFace(HalfedgeId a, HalfedgeId b, HalfedgeId c) {
    mFaceHalfedge.pushBack(HalfedgeId());
    ++mFaceCount;
    const FaceId f(uint32_t(mFaceHalfedge.size() - 1));
    setFace(f, a, b, c);
    return f;
}

VertexId HalfedgeMesh::split(EdgeId e) {
    const HalfedgeId h = halfedge(e), t = twin(h);
    const VertexId b = origin(t), m = addVertex();
    const HalfedgeId beforeT = prev(t), h1 = next(h), t1 = next(t);
    const FaceId f = face(h), g = face(t);
    const HalfedgeId onward = addEdge(m, b), back = twin(onward);
    mHalfedges.edit(t.index).origin = m;
    if (halfedge(b) == t) mVertexHalfedge.edit(b.index) = back;
    mVertexHalfedge.edit(m.index) = g.valid() ? onward : t;

    if (f.valid()) {
        const HalfedgeId h2 = next(h1), toOpposite = addEdge(m, origin(h2));
        setFace(f, h, toOpposite, h2);
        addFace(onward, h1, twin(toOpposite));
    } else {
        setNext(h, onward);
        setNext(onward, h1);
    }
    if (g.valid()) {
        const HalfedgeId t2 = next(t1), toOpposite = addEdge(m, origin(t2));
        setFace(g, t, t1, twin(toOpposite));
        addFace(back, toOpposite, t2);
    } else {
        setNext(beforeT, back);
        setNext(back, t);
    }
    return m;
}

VertexId HalfedgeMesh::split(FaceId f) {
    const auto [ab, bc, ca] = sides(f);
    const VertexId m = addVertex();
    const HalfedgeId toA = addEdge(m, origin(ab)), toB = addEdge(m, origin(bc)), toC = addEdge(m, origin(ca));
    mVertexHalfedge.edit(m.index) = toA;
    setFace(f, ab, twin(toB), toA);
    addFace(bc, twin(toC), toB);
    addFace(ca, twin(toA), toC);
    return m;
}

HalfedgeMesh::Compacted HalfedgeMesh::compacted() const {
    Compacted result;
    std::vector<uint32_t> newVertex(vertexCapacity(), 0), newEdge(edgeCapacity(), 0),
        newFace(faceCapacity(), 0);
    const auto number = [&]<class IdType>(std::vector<uint32_t>& to, std::vector<IdType>& old,
                                          size_t capacity) {
        for (uint32_t i = 0; i < capacity; ++i)
            if (alive(IdType(i))) {
                to[i] = uint32_t(old.size());
                old.push_back(IdType(i));
            }
    };
    number(newVertex, result.oldVertex, vertexCapacity());
    number(newEdge, result.oldEdge, edgeCapacity());
    number(newFace, result.oldFace, faceCapacity());

    const auto mapped = [&](HalfedgeId h) { return HalfedgeId(newEdge[h.index >> 1] << 1 | (h.index & 1)); };
    HalfedgeMesh& mesh = result.mesh;
    for (const EdgeId e : result.oldEdge)
        for (uint32_t side = 0; side < 2; ++side) {
            const HalfedgeId h(e.index << 1 | side);
            const FaceId f = face(h);
            mesh.mHalfedges.pushBack({mapped(next(h)), VertexId(newVertex[origin(h).index]),
                                      f.valid() ? FaceId(newFace[f.index]) : FaceId()});
        }
    for (const VertexId v : result.oldVertex) mesh.mVertexHalfedge.pushBack(mapped(halfedge(v)));
    for (const FaceId f : result.oldFace) mesh.mFaceHalfedge.pushBack(mapped(halfedge(f)));
    mesh.mVertexCount = result.oldVertex.size();
    mesh.mEdgeCount = result.oldEdge.size();
    mesh.mFaceCount = result.oldFace.size();
    return result;
}

size_t HalfedgeMesh::bytesBeyond(const HalfedgeMesh& other) const {
    return mHalfedges.bytesBeyond(other.mHalfedges) + mVertexHalfedge.bytesBeyond(other.mVertexHalfedge) +
           mFaceHalfedge.bytesBeyond(other.mFaceHalfedge);
}

}  // namespace tessera
