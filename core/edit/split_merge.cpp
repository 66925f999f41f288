// See split_merge.h.
#include "core/edit/split_merge.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/parallel.h"
#include "core/edit/colour_samples.h"
#include "core/edit/colour_transfer.h"
#include "core/edit/deformation.h"
#include "core/edit/site_fit.h"
#include "core/mesh/jacobian.h"
#include "core/mesh/mesh_validate.h"
#include "core/mesh/patch_query.h"

namespace tessera {

namespace {

tl::unexpected<Error> refused(const char* message) {
    return failure(ErrorCode::Usage, message);
}

// A part of a patch: its shape, and its corners in the parameters of the whole.
struct Part {
    PatchId id;
    BezierTriangle shape;
    std::array<Barycentric, 3> corners;
};

// The control points with side s first.
BezierTriangle turned(const BezierTriangle& t, size_t s) {
    BezierTriangle result = t;
    for (size_t i = 0; i < 9; ++i) result.p[i] = t.p[(i + 3 * s) % 9];
    return result;
}

size_t sideIndex(const HalfedgeMesh& c, HalfedgeId h) {
    const auto sides = c.sides(c.face(h));
    return size_t(std::find(sides.begin(), sides.end(), h) - sides.begin());
}

// The colours of the whole on a part.
PatchSpline partSpline(const PatchSpline& whole, int channels, const std::array<Barycentric, 3>& corners) {
    std::vector<Barycentric> points;
    for (const Barycentric& b : sitePoints().barycentrics)
        points.push_back(b.x * corners[0] + b.y * corners[1] + b.z * corners[2]);
    const DomainPoints at(points);
    SitePlanes values{};
    evaluateSplines(whole, channels, at.x.data(), at.y.data(), at.size(), pointersTo(values).data());
    return fittedLike(whole, channels, values);
}

// A patch is about to be cut into parts around a new vertex: sets the parts' edges there, interior points,
// colours and attributes. False where a part cannot be certified.
bool setParts(PatchMesh& mesh, const PatchMesh& before, PatchId whole, VertexId middle,
              std::span<const Part> parts) {
    const HalfedgeMesh& c = mesh.connectivity();
    for (const Part& part : parts) {
        const auto sides = c.sides(part.id);
        for (size_t s = 0; s < 3; ++s) {
            const bool fresh = HalfedgeMesh::edge(sides[s]).index >= before.connectivity().edgeCapacity();
            const auto inner = part.shape.side(int(s));
            // The rest of an edge that is cut has its curve already.
            const bool inside = c.face(HalfedgeMesh::twin(sides[s])).valid() &&
                                std::any_of(parts.begin(), parts.end(), [&](const Part& other) {
                                    return other.id == c.face(HalfedgeMesh::twin(sides[s]));
                                });
            const bool atMiddle = c.origin(sides[s]) == middle || c.target(sides[s]) == middle;
            if (fresh && inside && atMiddle)
                mesh.setInnerControlPoints(sides[s], toLattice(inner[1]), toLattice(inner[2]));
        }
    }
    for (const Part& part : parts) {
        LatticeTriangle t = mesh.controlPoints(part.id);
        t.p[kInterior] = toLattice(part.shape.p[kInterior]);
        const auto interior = certifiedInterior(t);
        if (!interior) return false;
        mesh.setInterior(part.id, *interior);
        mesh.setSpline(part.id, partSpline(before.spline(whole), before.channels(), part.corners));
        mesh.setAttributes(part.id, before.attributes(whole));
    }
    return true;
}

// The triangle with its corners moved on by `turns`.
Part partOf(PatchId id, const BezierTriangle& shape, std::array<Barycentric, 3> corners, size_t turns) {
    std::rotate(corners.begin(), corners.begin() + int(turns), corners.end());
    return {id, turned(shape, turns), corners};
}

// What is beside an edge: the face of a halfedge with the halfedge's side first.
struct Beside {
    PatchId patch;
    BezierTriangle shape;
    std::array<Barycentric, 3> corners;  // in the patch's own parameters
};

Beside besideOf(const PatchMesh& mesh, HalfedgeId h) {
    const HalfedgeMesh& c = mesh.connectivity();
    const size_t s = sideIndex(c, h);
    Beside result{c.face(h), turned(toPixels(mesh.controlPoints(c.face(h))), s), {}};
    for (size_t i = 0; i < 3; ++i) {
        result.corners[i] = Barycentric(0);
        result.corners[i][int((i + s) % 3)] = 1;
    }
    return result;
}

// Both halves of a curve, and what is known of them.
void setHalves(PatchMesh& mesh, const EdgeCurve& whole, const BezierCurve& curve, EdgeId first, EdgeId second,
               double t) {
    const float middle = whole.blurSigma[0] + float(t) * (whole.blurSigma[1] - whole.blurSigma[0]);
    const auto half = [&](EdgeId e, double from, double to, std::array<float, 2> sigma) {
        EdgeCurve part = whole;
        const BezierCurve points = curve.part(from, to);
        part.c1 = toLattice(points.p[1]);
        part.c2 = toLattice(points.p[2]);
        part.blurSigma = sigma;
        mesh.setCurve(e, part);
    };
    half(first, 0, t, {whole.blurSigma[0], middle});
    half(second, t, 1, {middle, whole.blurSigma[1]});
}

// Joins of a split curve: those at its end go over to its second half; a feature's halves join.
void splitJoins(PatchMesh& mesh, EdgeId first, EdgeId second, VertexId middle) {
    const HalfedgeMesh& c = mesh.connectivity();
    const VertexId end = c.target(HalfedgeMesh::halfedge(second));
    std::vector<SmoothJoin> joins = mesh.smoothJoins();
    for (SmoothJoin& join : joins) {
        if (join.first != first && join.second != first) continue;
        const bool atEnd = join.vertex == end;
        if (atEnd) (join.first == first ? join.first : join.second) = second;
        alignHandle(mesh, join, atEnd ? second : first);
    }
    if (mesh.curve(first).feature) {
        joins.push_back({middle, first, second});
        alignHandle(mesh, joins.back(), second);
    }
    std::erase_if(joins, [&](const SmoothJoin& join) { return !isSmooth(mesh, join); });
    mesh.setSmoothJoins(std::move(joins));
}

Touched topologyTouched(std::vector<VertexId> vertices, std::vector<EdgeId> edges,
                        std::vector<PatchId> patches) {
    Touched touched = touchedOf(std::move(vertices), std::move(edges), std::move(patches));
    touched.topology = true;
    return touched;
}

std::vector<EdgeId> edgesAt(const HalfedgeMesh& c, VertexId v) {
    std::vector<EdgeId> edges;
    c.forEachOutgoing(v, [&](HalfedgeId h) { edges.push_back(HalfedgeMesh::edge(h)); });
    return edges;
}

std::vector<PatchId> patchesAt(const HalfedgeMesh& c, VertexId v) {
    std::vector<PatchId> patches;
    c.forEachOutgoing(v, [&](HalfedgeId h) {
        if (c.face(h).valid()) patches.push_back(c.face(h));
    });
    return patches;
}

constexpr double kLeastShare = .02;
const char* const kTooSmall =
    "there is no room for another vertex here; choose a place farther from the ends";
const char* const kLocked = "a patch here is locked; unlock it first";

}  // namespace

Result<Touched> splitEdge(PatchMesh& mesh, EdgeId e, double t) {
    const PatchMesh before = mesh;
    const HalfedgeMesh& c = before.connectivity();
    if (e.index >= c.edgeCapacity() || !c.alive(e)) return refused("this curve is not there any more");
    if (!(t >= kLeastShare && t <= 1 - kLeastShare)) return refused(kTooSmall);
    const HalfedgeId h = HalfedgeMesh::halfedge(e), twin = HalfedgeMesh::twin(h);
    for (const HalfedgeId side : {h, twin})
        if (c.face(side).valid() && before.attributes(c.face(side)).locked) return refused(kLocked);

    const BezierCurve curve = toPixels(before.controlPoints(h));
    HalfedgeMesh connectivity = c;
    const VertexId m = connectivity.split(e);
    PatchMesh result = before;
    result.setConnectivity(std::move(connectivity));
    const HalfedgeMesh& now = result.connectivity();
    const EdgeId rest = HalfedgeMesh::edge(now.find(m, c.target(h)));
    result.setPosition(m, toLattice(curve.at(t)));
    setHalves(result, before.curve(e), curve, e, rest, t);
    splitJoins(result, e, rest, m);

    const HalfedgeId restSide = HalfedgeMesh::halfedge(rest);
    for (const bool reversed : {false, true}) {
        const HalfedgeId side = reversed ? twin : h;
        if (!c.face(side).valid()) continue;
        const Beside whole = besideOf(before, side);  // corners: from, to, opposite
        const double s = reversed ? 1 - t : t;
        const auto pieces = deCasteljau(whole.shape, {1 - s, s, 0});
        const Barycentric middle = (1 - s) * whole.corners[0] + s * whole.corners[1];
        // At the start of this side, and at its end.
        const HalfedgeId atFrom = reversed ? HalfedgeMesh::twin(restSide) : h;
        const HalfedgeId atTo = reversed ? twin : restSide;
        const auto part = [&](HalfedgeId first, const BezierTriangle& shape,
                              std::array<Barycentric, 3> corners) {
            return partOf(now.face(first), shape, corners, (3 - sideIndex(now, first)) % 3);
        };
        const std::array parts{part(atFrom, pieces[1], {whole.corners[0], middle, whole.corners[2]}),
                               part(atTo, pieces[0], {middle, whole.corners[1], whole.corners[2]})};
        if (!setParts(result, before, whole.patch, m, parts)) return refused(kTooSmall);
    }
    mesh = std::move(result);
    return topologyTouched({m}, edgesAt(mesh.connectivity(), m), patchesAt(mesh.connectivity(), m));
}

Result<Touched> splitPatch(PatchMesh& mesh, PatchId p, const Barycentric& at) {
    const PatchMesh before = mesh;
    const HalfedgeMesh& c = before.connectivity();
    if (p.index >= c.faceCapacity() || !c.alive(p)) return refused("this patch is not there any more");
    if (before.attributes(p).locked) return refused(kLocked);
    if (!(std::min({at.x, at.y, at.z}) >= kLeastShare)) return refused(kTooSmall);

    const BezierTriangle shape = toPixels(before.controlPoints(p));
    const auto sides = c.sides(p);
    HalfedgeMesh connectivity = c;
    const VertexId m = connectivity.split(p);
    PatchMesh result = before;
    result.setConnectivity(std::move(connectivity));
    result.setPosition(m, toLattice(evaluate(shape, at)));
    const auto pieces = deCasteljau(shape, at);
    std::vector<Part> parts;
    for (size_t s = 0; s < 3; ++s) {
        // The piece at side s has the new vertex in the place of the corner opposite.
        std::array<Barycentric, 3> corners{Barycentric(1, 0, 0), Barycentric(0, 1, 0), Barycentric(0, 0, 1)};
        corners[(s + 2) % 3] = at;
        const HalfedgeMesh& now = result.connectivity();
        const size_t place = sideIndex(now, sides[s]);
        parts.push_back(partOf(now.face(sides[s]), pieces[(s + 2) % 3], corners, (s + 3 - place) % 3));
    }
    if (!setParts(result, before, p, m, parts)) return refused(kTooSmall);
    mesh = std::move(result);
    return topologyTouched({m}, edgesAt(mesh.connectivity(), m), patchesAt(mesh.connectivity(), m));
}

namespace {

// One way to take an edge away: the origin of h moves onto its target.
class Merge {
  public:
    Merge(const PatchMesh& mesh, HalfedgeId h)
        : mBefore(mesh),
          mEdge(h),
          mGone(mesh.connectivity().origin(h)),
          mKept(mesh.connectivity().target(h)) {}

    VertexId kept() const { return mKept; }

    // Features at the vertex that would move.
    int features() const {
        int count = 0;
        mBefore.connectivity().forEachOutgoing(
            mGone, [&](HalfedgeId h) { count += mBefore.curve(HalfedgeMesh::edge(h)).feature; });
        return count;
    }

    bool keepsOutline() const {
        const HalfedgeMesh& c = mBefore.connectivity();
        if (!c.canCollapse(mEdge)) return false;
        if (!c.onBorder(mGone)) return true;
        const LatticePoint at = mBefore.position(mGone);
        const bool corner = (at.x == 0 || at.x == mBefore.width() * kLatticePerPixel) &&
                            (at.y == 0 || at.y == mBefore.height() * kLatticePerPixel);
        return !corner && c.onBorder(HalfedgeMesh::edge(mEdge));
    }

    bool run(PatchMesh& mesh) {
        collapse();
        moveCurves();
        if (!moveInteriors()) return false;
        dropJoins();
        transferColours();
        mesh = std::move(mResult);
        return true;
    }

  private:
    // Which of two edges that fall together goes on: the border, a feature, a colour break.
    int importance(HalfedgeId h) const {
        const EdgeId e = HalfedgeMesh::edge(h);
        const EdgeCurve& curve = mBefore.curve(e);
        return mBefore.connectivity().onBorder(e) ? 3 : curve.feature ? 2 : curve.colourBreak ? 1 : 0;
    }

    void collapse() {
        const HalfedgeMesh& c = mBefore.connectivity();
        mResult = mBefore;
        std::array<bool, 2> keepOrigin{};
        for (size_t side = 0; side < 2; ++side) {
            const HalfedgeId s = side == 0 ? mEdge : HalfedgeMesh::twin(mEdge);
            if (!c.face(s).valid()) continue;
            const HalfedgeId s1 = c.next(s), s2 = c.next(s1);
            const HalfedgeId atTarget = side == 0 ? s1 : s2, atOrigin = side == 0 ? s2 : s1;
            keepOrigin[side] = importance(atOrigin) > importance(atTarget);
        }
        HalfedgeMesh connectivity = c;
        connectivity.collapse(mEdge, keepOrigin);
        mResult.setConnectivity(std::move(connectivity));
    }

    // The handles of curves that had their end at the vertex that is gone move along.
    void moveCurves() {
        const HalfedgeMesh &then = mBefore.connectivity(), &now = mResult.connectivity();
        const LatticePoint way = mBefore.position(mKept) - mBefore.position(mGone);
        then.forEachOutgoing(mGone, [&](HalfedgeId h) {
            if (!now.alive(HalfedgeMesh::edge(h))) return;
            const auto p = mBefore.controlPoints(h);
            const bool straight = straightControlPoints(p[0], p[3]) == std::array{p[1], p[2]};
            const auto inner = straightControlPoints(mBefore.position(mKept), p[3]);
            if (straight && !joined(HalfedgeMesh::edge(h)))
                mResult.setInnerControlPoints(h, inner[0], inner[1]);
            else
                mResult.setInnerControlPoints(h, p[1] + way, p[2]);
        });
    }
    bool joined(EdgeId e) const {
        return std::any_of(mBefore.smoothJoins().begin(), mBefore.smoothJoins().end(),
                           [&](const SmoothJoin& j) { return j.first == e || j.second == e; });
    }

    bool moveInteriors() {
        const HalfedgeMesh& now = mResult.connectivity();
        // Where an edge of the vertex that is gone took the place of one at the other, patches beyond change.
        mChanged = patchSet(patchesAt(now, mKept));
        for (const PatchId p : mChanged) {
            if (mResult.controlPoints(p).p == mBefore.controlPoints(p).p) continue;
            if (mBefore.attributes(p).locked) return false;
            LatticeTriangle t = mResult.controlPoints(p);
            t.p[kInterior] =
                mBefore.interior(p) +
                toLattice(defaultInterior(toPixels(t)) - defaultInterior(toPixels(mBefore.controlPoints(p))));
            const auto interior = certifiedInterior(t);
            if (!interior) return false;
            mResult.setInterior(p, *interior);
        }
        return true;
    }

    void dropJoins() {
        std::vector<SmoothJoin> joins = mResult.smoothJoins();
        std::erase_if(joins, [&](const SmoothJoin& join) { return !isSmooth(mResult, join); });
        mResult.setSmoothJoins(std::move(joins));
    }

    // Patches of another shape show what was there before.
    void transferColours() {
        std::vector<PatchId> around = patchesAt(mBefore.connectivity(), mGone);
        for (const PatchId p : patchesAt(mBefore.connectivity(), mKept)) around.push_back(p);
        const PatchSet from = patchSet(std::move(around));
        for (const PatchId p : mChanged) {
            const LatticeTriangle shape = mResult.controlPoints(p);
            if (shape.p == mBefore.controlPoints(p).p) continue;
            mResult.setSpline(p, transferredColours(mBefore, from, p, toPixels(shape)));
        }
    }

    PatchMesh mBefore;
    HalfedgeId mEdge;
    VertexId mGone, mKept;
    PatchMesh mResult;
    PatchSet mChanged;
};

}  // namespace

Result<Touched> mergeEdge(PatchMesh& mesh, EdgeId e) {
    const HalfedgeMesh& c = mesh.connectivity();
    if (e.index >= c.edgeCapacity() || !c.alive(e)) return refused("this curve is not there any more");
    const HalfedgeId h = HalfedgeMesh::halfedge(e);
    for (const HalfedgeId end : {h, HalfedgeMesh::twin(h)})
        for (const PatchId p : patchesAt(c, c.origin(end)))
            if (mesh.attributes(p).locked) return refused(kLocked);
    const PatchMesh before = mesh;
    std::vector<Merge> ways{Merge(before, h), Merge(before, HalfedgeMesh::twin(h))};
    if (ways[1].features() < ways[0].features()) std::swap(ways[0], ways[1]);
    bool possible = false;
    for (Merge& way : ways) {
        if (!way.keepsOutline()) continue;
        possible = true;
        const VertexId kept = way.kept();
        if (way.run(mesh))
            return topologyTouched({kept}, edgesAt(mesh.connectivity(), kept),
                                   patchesAt(mesh.connectivity(), kept));
    }
    return refused(possible ? "merging here would fold a patch; move its corners first"
                            : "merging here would change the picture's outline or tear the mesh");
}

PatchSet carriedOver(const PatchMesh& before, const PatchMesh& after, const PatchSet& set) {
    PatchSet result = alive(after, set);
    std::vector<PatchId> fresh;
    const HalfedgeMesh& c = before.connectivity();
    after.forEachPatch([&](PatchId p) {
        if (p.index >= c.faceCapacity() || !c.alive(p)) fresh.push_back(p);
    });
    if (fresh.empty() || set.empty()) return result;
    const std::vector<uint8_t> member = membership(before, set);
    const auto isMember = [&](PatchId p) { return member[p.index] != 0; };
    const PatchQuery query(before);
    // A part lies where the whole was. Most have none near but patches in the set, or none of those.
    std::vector<uint8_t> within(fresh.size(), 0);
    parallelFor(fresh.size(), 256, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            const glm::dvec2 centre = evaluate(toPixels(after.controlPoints(fresh[i])), Barycentric(1.0 / 3));
            const std::vector<PatchId> near = query.patchesIn({centre, centre});
            if (std::none_of(near.begin(), near.end(), isMember)) continue;
            const bool all = std::all_of(near.begin(), near.end(), isMember);
            const auto whole = all ? std::nullopt : query.patchAt(centre);
            within[i] = all || (whole && isMember(whole->patch));
        }
    });
    for (size_t i = 0; i < fresh.size(); ++i)
        if (within[i]) result.push_back(fresh[i]);
    return patchSet(std::move(result));
}

}  // namespace tessera
