// See reshape.h.
#include "core/edit/reshape.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "core/base/check.h"
#include "core/edit/deformation.h"
#include "core/edit/drag_colour.h"
#include "core/mesh/jacobian.h"
#include "core/mesh/mesh_validate.h"

namespace tessera {

ControlPointRef ControlPointRef::of(VertexId v) {
    return {ControlPointHit::Kind::Vertex, v, {}, {}};
}
ControlPointRef ControlPointRef::of(HalfedgeId h) {
    return {ControlPointHit::Kind::CurveInner, {}, h, {}};
}
ControlPointRef ControlPointRef::of(PatchId p) {
    return {ControlPointHit::Kind::Interior, {}, {}, p};
}
ControlPointRef ControlPointRef::of(const ControlPointHit& hit) {
    switch (hit.kind) {
        case ControlPointHit::Kind::Vertex:
            return of(hit.vertex);
        case ControlPointHit::Kind::CurveInner:
            return of(hit.halfedge);
        case ControlPointHit::Kind::Interior:
            break;
    }
    return of(hit.patch);
}

LatticePoint position(const PatchMesh& mesh, const ControlPointRef& point) {
    switch (point.kind) {
        case ControlPointHit::Kind::Vertex:
            return mesh.position(point.vertex);
        case ControlPointHit::Kind::CurveInner:
            return mesh.controlPoints(point.halfedge)[1];
        case ControlPointHit::Kind::Interior:
            break;
    }
    return mesh.interior(point.patch);
}

bool alive(const PatchMesh& mesh, const ControlPointRef& point) {
    const HalfedgeMesh& c = mesh.connectivity();
    switch (point.kind) {
        case ControlPointHit::Kind::Vertex:
            return point.vertex.index < c.vertexCapacity() && c.alive(point.vertex);
        case ControlPointHit::Kind::CurveInner: {
            const EdgeId e = HalfedgeMesh::edge(point.halfedge);
            return point.halfedge.valid() && e.index < c.edgeCapacity() && c.alive(e);
        }
        case ControlPointHit::Kind::Interior:
            break;
    }
    return point.patch.index < c.faceCapacity() && c.alive(point.patch);
}

std::vector<ControlPointRef> controlPointsOf(const PatchMesh& mesh, EdgeId e) {
    const HalfedgeId h = HalfedgeMesh::halfedge(e), t = HalfedgeMesh::twin(h);
    const HalfedgeMesh& c = mesh.connectivity();
    return {ControlPointRef::of(c.origin(h)), ControlPointRef::of(c.target(h)), ControlPointRef::of(h),
            ControlPointRef::of(t)};
}

namespace {

constexpr double kLatticeStep = 1.0 / kLatticePerPixel;

// The largest share of the way, in [0, 1], up to which bisection finds `good`; 0 counts as good.
template <class Good>
double largestShare(double lengthPx, Good&& good) {
    if (good(1.0)) return 1;
    double low = 0, high = 1;
    while ((high - low) * lengthPx > .5 * kLatticeStep) {
        const double middle = .5 * (low + high);
        (good(middle) ? low : high) = middle;
    }
    return low;
}

}  // namespace

struct ShapeDrag::State {
    Deformation deformation;
    State(PatchMesh start, std::span<const ControlPointRef> points, std::vector<double> weights)
        : deformation(std::move(start), points, std::move(weights)) {}

    std::optional<PatchId> tryOffset(PatchMesh& mesh, glm::dvec2 offset, bool breakJoins) const {
        return deformation.probe(mesh, std::span(&offset, 1), breakJoins);
    }
    glm::dvec2 slide(PatchMesh& mesh, glm::dvec2 from, glm::dvec2 goal, bool breakJoins) const;
};

// From a place at the limit on toward the goal, in the direction that brings it nearest, some times over.
glm::dvec2 ShapeDrag::State::slide(PatchMesh& mesh, glm::dvec2 from, glm::dvec2 goal, bool breakJoins) const {
    // With many patches at the limit a finer search would take longer than a frame.
    constexpr size_t kMany = 60;
    const bool coarse = deformation.looseCount() > kMany;
    const int turns = coarse ? 1 : 4, directions = coarse ? 3 : 8;
    const double degrees = 80.0 / directions;
    constexpr double kWorthPx = .02;
    for (int turn = 0; turn < turns; ++turn) {
        const glm::dvec2 rest = goal - from;
        glm::dvec2 best = from;
        for (int k = 1; k <= directions; ++k)
            for (const double side : {-1.0, 1.0}) {
                const double angle = glm::radians(side * degrees * k);
                const double cosine = std::cos(angle), sine = std::sin(angle);
                // As far as this direction leads nearer to the goal.
                const glm::dvec2 way =
                    cosine * glm::dvec2(cosine * rest.x - sine * rest.y, sine * rest.x + cosine * rest.y);
                const auto distanceAt = [&](double share) { return glm::distance(from + share * way, goal); };
                if (distanceAt(1) >= glm::distance(best, goal)) continue;
                const double share = largestShare(
                    glm::length(way), [&](double s) { return !tryOffset(mesh, from + s * way, breakJoins); });
                if (distanceAt(share) < glm::distance(best, goal)) best = from + share * way;
            }
        const bool worth = glm::distance(from, goal) - glm::distance(best, goal) > kWorthPx;
        from = best;
        if (!worth) break;
    }
    return from;
}

ShapeDrag::ShapeDrag(std::unique_ptr<State> state) : mState(std::move(state)) {}
ShapeDrag::ShapeDrag(PatchMesh start, std::vector<ControlPointRef> points)
    : mState(std::make_unique<State>(std::move(start), points, std::vector<double>{})) {}
ShapeDrag::~ShapeDrag() = default;
ShapeDrag::ShapeDrag(ShapeDrag&&) noexcept = default;
ShapeDrag& ShapeDrag::operator=(ShapeDrag&&) noexcept = default;

ShapeDrag ShapeDrag::bend(PatchMesh start, EdgeId edge, double t) {
    // The least motion of the two inner points that moves the curve's point at t all the way.
    constexpr double kNearEnd = .1;
    t = std::clamp(t, kNearEnd, 1 - kNearEnd);
    const double b1 = 3 * t * (1 - t) * (1 - t), b2 = 3 * t * t * (1 - t), squares = b1 * b1 + b2 * b2;
    const HalfedgeId h = HalfedgeMesh::halfedge(edge);
    const std::array points{ControlPointRef::of(h), ControlPointRef::of(HalfedgeMesh::twin(h))};
    return ShapeDrag(
        std::make_unique<State>(std::move(start), points, std::vector<double>{b1 / squares, b2 / squares}));
}

const PatchMesh& ShapeDrag::start() const {
    return mState->deformation.start();
}

const PatchSet& ShapeDrag::patches() const {
    return mState->deformation.patches();
}

DragResult ShapeDrag::drag(PatchMesh& mesh, glm::dvec2 offset, bool breakJoins) const {
    const Deformation& deformation = mState->deformation;
    mesh = deformation.start();
    if (deformation.pointCount() == 0) return {};
    DragResult result{deformation.touched(), 1, std::nullopt};
    if (deformation.locked()) return {result.touched, 0, deformation.locked()};
    result.fraction = largestShare(glm::length(offset), [&](double share) {
        const auto folded = mState->tryOffset(mesh, share * offset, breakJoins);
        if (folded) result.blocking = folded;
        return !folded;
    });
    glm::dvec2 reached = offset;
    if (result.fraction == 1)
        result.blocking.reset();
    else
        reached = mState->slide(mesh, result.fraction * offset, offset, breakJoins);
    if (deformation.apply(mesh, std::span(&reached, 1), breakJoins)) mesh = deformation.start();
    return result;
}

DragResult movePoints(PatchMesh& mesh, std::span<const PointMove> moves) {
    std::vector<ControlPointRef> points;
    std::vector<glm::dvec2> full;
    double longest = 0;
    for (const PointMove& move : moves) {
        points.push_back(move.point);
        full.push_back(alive(mesh, move.point) ? move.to - toPixels(position(mesh, move.point))
                                               : glm::dvec2(0));
        longest = std::max(longest, glm::length(full.back()));
    }
    // apply() takes a single way for one that is common to all points.
    const Deformation deformation(mesh, points);
    if (deformation.pointCount() == 0) return {};
    DragResult result{deformation.touched(), 1, std::nullopt};
    if (deformation.locked()) return {result.touched, 0, deformation.locked()};
    std::vector<glm::dvec2> ways(full.size());
    const auto tryShare = [&](double share) {
        for (size_t i = 0; i < full.size(); ++i) ways[i] = share * full[i];
        return deformation.apply(mesh, ways, false);
    };
    result.fraction = largestShare(longest, [&](double share) {
        const auto folded = tryShare(share);
        if (folded) result.blocking = folded;
        return !folded;
    });
    if (result.fraction < 1) {
        if (result.fraction == 0 || tryShare(result.fraction)) mesh = deformation.start();
    } else {
        result.blocking.reset();
    }
    return result;
}

namespace {

// The elements of patches that go back to another state, one by one kept where that would fold a patch.
class ShapeReset {
  public:
    ShapeReset(const PatchMesh& mesh, const PatchMesh& fitted, const PatchSet& set)
        : mNow(mesh), mFitted(fitted), mReached(mesh.connectivity().faceCapacity(), 0) {
        const HalfedgeMesh& c = mesh.connectivity();
        for (const PatchId p : editable(mesh, set)) {
            if (!hasFitted(mesh, fitted, p)) continue;
            mInteriors.push_back(p);
            for (const HalfedgeId side : c.sides(p)) {
                mEdges.push_back(HalfedgeMesh::edge(side));
                mVertices.push_back(c.origin(side));
            }
        }
        const Touched all = touchedOf(mVertices, mEdges, mInteriors);
        mVertices = all.vertices;
        mEdges = all.edges;
        mInteriors = all.patches;
        dropUnchanged();
        for (const VertexId v : mVertices) c.forEachOutgoing(v, [&](HalfedgeId h) { reach(h); });
        for (const EdgeId e : mEdges) reach(HalfedgeMesh::halfedge(e));
        for (const PatchId p : mInteriors) mReached[p.index] = 1;
    }

    Touched run(PatchMesh& mesh) {
        for (;;) {
            mesh = mNow;
            for (const VertexId v : mVertices) mesh.setPosition(v, mFitted.position(v));
            for (const EdgeId e : mEdges) setCurve(mesh, e, mFitted.curve(e));
            for (const PatchId p : mInteriors) mesh.setInterior(p, mFitted.interior(p));
            followInteriors(mesh);
            if (!keepWhatFolds(mesh)) break;
        }
        restoreJoins(mesh);
        std::vector<PatchId> patches;
        for (uint32_t p = 0; p < mReached.size(); ++p)
            if (mReached[p] && mesh.controlPoints(PatchId(p)).p != mNow.controlPoints(PatchId(p)).p)
                patches.push_back(PatchId(p));
        return touchedOf(mVertices, mEdges, std::move(patches));
    }

  private:
    void reach(HalfedgeId h) {
        const HalfedgeMesh& c = mNow.connectivity();
        for (const HalfedgeId side : {h, HalfedgeMesh::twin(h)})
            if (c.face(side).valid()) mReached[c.face(side).index] = 1;
    }
    void dropUnchanged() {
        std::erase_if(mVertices, [&](VertexId v) { return mNow.position(v) == mFitted.position(v); });
        std::erase_if(mEdges, [&](EdgeId e) {
            return mNow.curve(e).c1 == mFitted.curve(e).c1 && mNow.curve(e).c2 == mFitted.curve(e).c2;
        });
        std::erase_if(mInteriors, [&](PatchId p) { return mNow.interior(p) == mFitted.interior(p); });
    }
    static void setCurve(PatchMesh& mesh, EdgeId e, const EdgeCurve& shape) {
        EdgeCurve curve = mesh.curve(e);
        curve.c1 = shape.c1;
        curve.c2 = shape.c2;
        mesh.setCurve(e, curve);
    }
    // Interior points of patches that change only at their sides go along with them.
    void followInteriors(PatchMesh& mesh) const {
        for (uint32_t i = 0; i < mReached.size(); ++i) {
            const PatchId p(i);
            if (!mReached[i] || std::binary_search(mInteriors.begin(), mInteriors.end(), p)) continue;
            const glm::dvec2 way = defaultInterior(toPixels(mesh.controlPoints(p))) -
                                   defaultInterior(toPixels(mNow.controlPoints(p)));
            mesh.setInterior(p, mNow.interior(p) + toLattice(way));
        }
    }
    // The elements of patches that fold (or are locked) stay as they are now. Whether there were any.
    bool keepWhatFolds(const PatchMesh& mesh) {
        const HalfedgeMesh& c = mesh.connectivity();
        std::vector<uint8_t> keepVertex(c.vertexCapacity(), 0), keepEdge(c.edgeCapacity(), 0);
        bool any = false;
        for (uint32_t i = 0; i < mReached.size(); ++i) {
            const PatchId p(i);
            if (!mReached[i]) continue;
            const bool moved = mesh.controlPoints(p).p != mNow.controlPoints(p).p;
            if (!moved || (!mesh.attributes(p).locked && certified(mesh.controlPoints(p)))) continue;
            any = true;
            for (const HalfedgeId side : c.sides(p)) {
                keepVertex[c.origin(side).index] = keepEdge[HalfedgeMesh::edge(side).index] = 1;
            }
            std::erase(mInteriors, p);
        }
        std::erase_if(mVertices, [&](VertexId v) { return keepVertex[v.index] != 0; });
        std::erase_if(mEdges, [&](EdgeId e) { return keepEdge[e.index] != 0; });
        return any;
    }
    // Joins that hold again come back, joins that hold no more go.
    void restoreJoins(PatchMesh& mesh) const {
        std::vector<SmoothJoin> joins = mesh.smoothJoins();
        for (const SmoothJoin& join : mFitted.smoothJoins()) {
            const bool reset = std::binary_search(mEdges.begin(), mEdges.end(), join.first) ||
                               std::binary_search(mEdges.begin(), mEdges.end(), join.second);
            if (reset && std::find(joins.begin(), joins.end(), join) == joins.end()) joins.push_back(join);
        }
        std::erase_if(joins, [&](const SmoothJoin& join) { return !isSmooth(mesh, join); });
        mesh.setSmoothJoins(std::move(joins));
    }

    PatchMesh mNow;
    const PatchMesh& mFitted;
    std::vector<uint8_t> mReached;  // by patch
    std::vector<VertexId> mVertices;
    std::vector<EdgeId> mEdges;
    std::vector<PatchId> mInteriors;
};

}  // namespace

Touched resetShape(PatchMesh& mesh, const PatchMesh& fitted, const PatchSet& set) {
    return ShapeReset(mesh, fitted, set).run(mesh);
}

}  // namespace tessera
