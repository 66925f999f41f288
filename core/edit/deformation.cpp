// See deformation.h.
#include "core/edit/deformation.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "core/mesh/jacobian.h"
#include "core/mesh/mesh_validate.h"

namespace tessera {

HalfedgeId leaving(const HalfedgeMesh& mesh, EdgeId e, VertexId v) {
    const HalfedgeId h = HalfedgeMesh::halfedge(e);
    return mesh.origin(h) == v ? h : HalfedgeMesh::twin(h);
}

namespace {

glm::dvec2 handleOf(const PatchMesh& mesh, HalfedgeId h) {
    const auto points = mesh.controlPoints(h);
    return toPixels(points[1] - points[0]);
}

}  // namespace

void alignHandle(PatchMesh& mesh, const SmoothJoin& join, EdgeId turned) {
    const HalfedgeMesh& c = mesh.connectivity();
    const HalfedgeId model = leaving(c, turned == join.first ? join.second : join.first, join.vertex);
    const HalfedgeId h = leaving(c, turned, join.vertex);
    const glm::dvec2 at = toPixels(mesh.position(join.vertex));
    const auto points = mesh.controlPoints(h);
    const glm::dvec2 across = at - toPixels(mesh.controlPoints(model)[1]), own = toPixels(points[1]) - at;
    const double length = glm::length(across);
    if (length <= 0 || glm::length(own) <= 0) return;
    mesh.setInnerControlPoints(h, toLattice(at + glm::length(own) / length * across), points[2]);
}

std::optional<SmoothJoin> impliedJoin(const PatchMesh& mesh, VertexId v) {
    std::vector<HalfedgeId> features;
    mesh.connectivity().forEachOutgoing(v, [&](HalfedgeId h) {
        if (mesh.curve(HalfedgeMesh::edge(h)).feature) features.push_back(h);
    });
    if (features.size() != 2) return std::nullopt;
    constexpr double kMostDegrees = 10;
    const glm::dvec2 a = handleOf(mesh, features[0]), b = handleOf(mesh, features[1]);
    const double lengths = glm::length(a) * glm::length(b);
    if (!(lengths > 0) || -glm::dot(a, b) < lengths * std::cos(glm::radians(kMostDegrees)))
        return std::nullopt;
    return SmoothJoin{v, HalfedgeMesh::edge(features[0]), HalfedgeMesh::edge(features[1])};
}

namespace {

// Turns a handle as another one has turned from the start.
void turnAlong(PatchMesh& mesh, const PatchMesh& start, HalfedgeId model, HalfedgeId turned) {
    const glm::dvec2 before = handleOf(start, model), after = handleOf(mesh, model);
    const double lengths = glm::length(before) * glm::length(after);
    if (!(lengths > 0)) return;
    const double cosine = glm::dot(before, after) / lengths, sine = cross(before, after) / lengths;
    const glm::dvec2 own = handleOf(start, turned);
    const auto points = mesh.controlPoints(turned);
    const glm::dvec2 to(cosine * own.x - sine * own.y, sine * own.x + cosine * own.y);
    mesh.setInnerControlPoints(turned, points[0] + toLattice(to), points[2]);
}

}  // namespace

Deformation::Deformation(PatchMesh start, std::span<const ControlPointRef> points,
                         std::vector<double> weights)
    : mStart(std::move(start)) {
    collect(points, weights);
    const HalfedgeMesh& c = mStart.connectivity();
    for (const EdgeId e : mEdges)
        for (const HalfedgeId h : {HalfedgeMesh::halfedge(e), HalfedgeMesh::twin(HalfedgeMesh::halfedge(e))})
            if (c.face(h).valid()) mPatches.push_back(c.face(h));
    for (const Point& point : mPoints)
        if (point.ref.kind == ControlPointHit::Kind::Interior) mPatches.push_back(point.ref.patch);
    mPatches = patchSet(std::move(mPatches));
    for (const PatchId p : mPatches) {
        if (!mLocked && mStart.attributes(p).locked) mLocked = p;
        mMovingPatches.push_back(
            {p, kNone, false, mStart.interior(p), defaultInterior(toPixels(mStart.controlPoints(p)))});
    }
    for (uint32_t i = 0; i < mPoints.size(); ++i) {
        if (mPoints[i].ref.kind != ControlPointHit::Kind::Interior) continue;
        const auto at = std::lower_bound(mPatches.begin(), mPatches.end(), mPoints[i].ref.patch);
        mMovingPatches[size_t(at - mPatches.begin())].point = i;
    }
    findRigid();
}

void Deformation::collect(std::span<const ControlPointRef> points, const std::vector<double>& weights) {
    const HalfedgeMesh& c = mStart.connectivity();
    mPointOfVertex.assign(c.vertexCapacity(), kNone);
    for (uint32_t i = 0; i < points.size(); ++i)
        if (alive(mStart, points[i])) mPoints.push_back({points[i], weights.empty() ? 1 : weights[i], i});
    for (uint32_t i = 0; i < mPoints.size(); ++i) {
        const ControlPointRef& ref = mPoints[i].ref;
        if (ref.kind == ControlPointHit::Kind::Vertex) {
            mVertexPoints.push_back(i);
            mPointOfVertex[ref.vertex.index] = i;
            mVertices.push_back(ref.vertex);
            c.forEachOutgoing(ref.vertex, [&](HalfedgeId h) { mEdges.push_back(HalfedgeMesh::edge(h)); });
        } else if (ref.kind == ControlPointHit::Kind::CurveInner) {
            mEdges.push_back(HalfedgeMesh::edge(ref.halfedge));
        }
    }
    collectJoins();
    std::vector<uint8_t> joined(c.edgeCapacity(), 0);
    for (const SmoothJoin& join : mStart.smoothJoins())
        joined[join.first.index] = joined[join.second.index] = 1;
    for (const SmoothJoin& join : mImplied) joined[join.first.index] = joined[join.second.index] = 1;
    for (const EdgeId e : mEdges) {
        const auto p = mStart.controlPoints(HalfedgeMesh::halfedge(e));
        const bool straight = !joined[e.index] && straightControlPoints(p[0], p[3]) == std::array{p[1], p[2]};
        mMovingEdges.push_back({e, straight, false, {kNone, kNone}, mStart.curve(e)});
    }
    for (uint32_t i = 0; i < mPoints.size(); ++i) {
        if (mPoints[i].ref.kind != ControlPointHit::Kind::CurveInner) continue;
        const HalfedgeId h = mPoints[i].ref.halfedge;
        const EdgeId e = HalfedgeMesh::edge(h);
        Edge& edge = mMovingEdges[size_t(std::lower_bound(mEdges.begin(), mEdges.end(), e) - mEdges.begin())];
        edge.handles[h == HalfedgeMesh::halfedge(e) ? 0 : 1] = i;
        edge.straight = false;
    }
}

// The joins of the edges that move, whose other edges then may move too.
void Deformation::collectJoins() {
    const HalfedgeMesh& c = mStart.connectivity();
    std::vector<uint8_t> moving(c.edgeCapacity(), 0);
    std::vector<VertexId> ends, known;
    for (const EdgeId e : mEdges) {
        moving[e.index] = 1;
        if (!mStart.curve(e).feature) continue;
        ends.push_back(c.origin(HalfedgeMesh::halfedge(e)));
        ends.push_back(c.target(HalfedgeMesh::halfedge(e)));
    }
    for (const SmoothJoin& join : mStart.smoothJoins()) {
        if (!moving[join.first.index] && !moving[join.second.index]) continue;
        mJoins.push_back(join);
        known.push_back(join.vertex);
    }
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    for (const VertexId v : ends)
        if (std::find(known.begin(), known.end(), v) == known.end())
            if (const auto join = impliedJoin(mStart, v)) mImplied.push_back(*join);
    for (const auto* joins : {&mJoins, &mImplied})
        for (const SmoothJoin& join : *joins) {
            mEdges.push_back(join.first);
            mEdges.push_back(join.second);
        }
    std::sort(mEdges.begin(), mEdges.end());
    mEdges.erase(std::unique(mEdges.begin(), mEdges.end()), mEdges.end());
}

// A patch moves as a whole where its three corners do, away from the border. Its sides' handles then do too.
void Deformation::findRigid() {
    const HalfedgeMesh& c = mStart.connectivity();
    if (std::any_of(mPoints.begin(), mPoints.end(), [](const Point& p) { return p.weight != 1; })) {
        mLooseVertices = mVertexPoints;
        return;
    }
    for (Patch& patch : mMovingPatches) {
        const auto corners = c.corners(patch.id);
        patch.rigid = std::all_of(corners.begin(), corners.end(), [&](VertexId v) {
            return mPointOfVertex[v.index] != kNone && !c.onBorder(v);
        });
    }
    const auto isRigid = [&](PatchId p) {
        const auto at = std::lower_bound(mPatches.begin(), mPatches.end(), p) - mPatches.begin();
        return p.valid() && mMovingPatches[size_t(at)].rigid;
    };
    for (Edge& edge : mMovingEdges) {
        const HalfedgeId h = HalfedgeMesh::halfedge(edge.id);
        edge.rigid = isRigid(c.face(h)) && isRigid(c.face(HalfedgeMesh::twin(h)));
    }
    for (const uint32_t i : mVertexPoints) {
        bool loose = false;
        c.forEachOutgoing(mPoints[i].ref.vertex, [&](HalfedgeId h) { loose = loose || !isRigid(c.face(h)); });
        if (loose) mLooseVertices.push_back(i);
    }
}

size_t Deformation::looseCount() const {
    return size_t(std::count_if(mMovingPatches.begin(), mMovingPatches.end(),
                                [](const Patch& patch) { return !patch.rigid; }));
}

LatticePoint Deformation::step(const Point& point, std::span<const glm::dvec2> ways) const {
    return toLattice(point.weight * ways[ways.size() == 1 ? 0 : point.index]);
}

// The place nearest to `to` that a point of the border may go to: along its side, corners nowhere.
LatticePoint Deformation::keptOnBorder(LatticePoint at, LatticePoint to) const {
    const int32_t right = mStart.width() * kLatticePerPixel, bottom = mStart.height() * kLatticePerPixel;
    if (at.x == 0 || at.x == right) to.x = at.x;
    if (at.y == 0 || at.y == bottom) to.y = at.y;
    return {std::clamp(to.x, 0, right), std::clamp(to.y, 0, bottom)};
}

void Deformation::moveVertex(PatchMesh& mesh, const Point& point, std::span<const glm::dvec2> ways) const {
    const VertexId v = point.ref.vertex;
    const LatticePoint at = mStart.position(v), to = at + step(point, ways);
    mesh.setPosition(v, mStart.connectivity().onBorder(v) ? keptOnBorder(at, to) : to);
}

void Deformation::moveCurve(PatchMesh& mesh, const Edge& edge, std::span<const glm::dvec2> ways) const {
    const HalfedgeMesh& c = mStart.connectivity();
    const HalfedgeId h = HalfedgeMesh::halfedge(edge.id);
    const VertexId ends[2] = {c.origin(h), c.target(h)};
    EdgeCurve curve = mesh.curve(edge.id);
    LatticePoint* const handles[2] = {&curve.c1, &curve.c2};
    const LatticePoint from[2] = {edge.curve.c1, edge.curve.c2};
    for (size_t k = 0; k < 2; ++k) {
        if (edge.handles[k] != kNone) {
            *handles[k] = from[k] + step(mPoints[edge.handles[k]], ways);
            if (c.onBorder(edge.id)) *handles[k] = keptOnBorder(from[k], *handles[k]);
        } else {
            *handles[k] = from[k] + (mesh.position(ends[k]) - mStart.position(ends[k]));
        }
    }
    if (edge.straight) {
        const auto inner = straightControlPoints(mesh.position(ends[0]), mesh.position(ends[1]));
        curve.c1 = inner[0];
        curve.c2 = inner[1];
    }
    mesh.setCurve(edge.id, curve);
}

void Deformation::alignJoins(PatchMesh& mesh, bool breakJoins) const {
    const auto hasTurned = [&](EdgeId e, VertexId v) {
        const HalfedgeId h = leaving(mStart.connectivity(), e, v);
        return mesh.controlPoints(h)[1] - mesh.position(v) != mStart.controlPoints(h)[1] - mStart.position(v);
    };
    std::vector<SmoothJoin> broken;
    for (const SmoothJoin& join : mJoins) {
        const bool first = hasTurned(join.first, join.vertex), second = hasTurned(join.second, join.vertex);
        if (!first && !second) continue;
        if (breakJoins)
            broken.push_back(join);
        else
            alignHandle(mesh, join, first ? join.second : join.first);
    }
    for (const SmoothJoin& join : mImplied) {
        const bool first = hasTurned(join.first, join.vertex), second = hasTurned(join.second, join.vertex);
        if (first == second || breakJoins) continue;
        const HalfedgeId one = leaving(mStart.connectivity(), join.first, join.vertex),
                         other = leaving(mStart.connectivity(), join.second, join.vertex);
        turnAlong(mesh, mStart, first ? one : other, first ? other : one);
    }
    // Joins only ever go, so that their number tells.
    if (broken.empty() && mesh.smoothJoins().size() == mStart.smoothJoins().size()) return;
    std::vector<SmoothJoin> joins = mStart.smoothJoins();
    std::erase_if(joins, [&](const SmoothJoin& j) {
        return std::find(broken.begin(), broken.end(), j) != broken.end();
    });
    mesh.setSmoothJoins(std::move(joins));
}

void Deformation::moveInterior(PatchMesh& mesh, const Patch& patch, std::span<const glm::dvec2> ways) const {
    LatticePoint to =
        patch.interior + toLattice(defaultInterior(toPixels(mesh.controlPoints(patch.id))) - patch.usual);
    if (patch.point != kNone) to = patch.interior + step(mPoints[patch.point], ways);
    mesh.setInterior(patch.id, to);
}

std::optional<PatchId> Deformation::apply(PatchMesh& mesh, std::span<const glm::dvec2> ways,
                                          bool breakJoins) const {
    return run(mesh, ways, breakJoins, true);
}

std::optional<PatchId> Deformation::probe(PatchMesh& mesh, std::span<const glm::dvec2> ways,
                                          bool breakJoins) const {
    return run(mesh, ways, breakJoins, ways.size() != 1);
}

std::optional<PatchId> Deformation::run(PatchMesh& mesh, std::span<const glm::dvec2> ways, bool breakJoins,
                                        bool everything) const {
    for (const uint32_t i : everything ? mVertexPoints : mLooseVertices) moveVertex(mesh, mPoints[i], ways);
    for (const Edge& edge : mMovingEdges)
        if (everything || !edge.rigid) moveCurve(mesh, edge, ways);
    alignJoins(mesh, breakJoins);
    for (const Patch& patch : mMovingPatches) {
        const bool whole = patch.rigid && ways.size() == 1;
        if (everything || !whole) moveInterior(mesh, patch, ways);
        if (!whole && !certified(mesh.controlPoints(patch.id))) return patch.id;
    }
    // A handle of no length has no tangent; given up are joins only where that is asked for.
    if (!breakJoins)
        for (const SmoothJoin& join : mJoins)
            if (!isSmooth(mesh, join))
                return mesh.connectivity().face(leaving(mesh.connectivity(), join.first, join.vertex));
    return std::nullopt;
}

}  // namespace tessera
