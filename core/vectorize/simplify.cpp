// See simplify.h.
#include "core/vectorize/simplify.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "core/base/check.h"
#include "core/mesh/jacobian.h"
#include "core/mesh/quadric.h"
#include "core/vectorize/absorbed_lists.h"
#include "core/vectorize/candidate_queue.h"
#include "core/vectorize/smooth_joins.h"

namespace tessera {

CollapseRule collapseRule(VertexKind from, VertexKind to) {
    using enum CollapseRule;
    constexpr CollapseRule kRules[kVertexKinds][kVertexKinds] = {
        // to: Interior, Feature, FeatureEnd, Border, Corner
        {Free, Free, Free, Free, Free},                     // from Interior
        {Never, AlongFeature, AlongFeature, Never, Never},  // from Feature
        {Never, Never, Never, Never, Never},                // from FeatureEnd
        {Never, Never, Never, AlongBorder, AlongBorder},    // from Border
        {Never, Never, Never, Never, Never},                // from Corner
    };
    return kRules[size_t(from)][size_t(to)];
}

namespace {

// After this many failures an edge waits until a contraction beside it changes its surroundings.
constexpr uint8_t kMaxFailures = 4;
// Contractions below this error (a sixtieth of a level over a pixel) go on past the wanted number: a flat
// picture needs no more patches than its features do.
constexpr double kFreeError = 1e-7;

class Simplifier {
  public:
    Simplifier(ChannelMeshes meshes, const VectorizeSettings& settings)
        : m(std::move(meshes)), mSettings(settings), mQuadrics(m.copyCount(), m.channels) {}

    bool run(Progress& progress);
    // Unfinished where `stop` is asked for.
    BaseDomain baseDomain(const std::stop_token& stop) const;
    void describe(StageReport& report, std::string& shortfall) const;

  private:
    // The copies that fall together when the origin of a halfedge moves onto its target.
    struct CopyPair {
        uint32_t from, to;
    };
    // A new cubic for the feature through the origin of a contracted feature edge.
    struct Refit {
        HalfedgeId before;  // from the origin to the feature's other neighbour
        ChainPart part;
        std::array<LatticePoint, 2> inner;  // in the direction of the chain
    };

    bool accumulateQuadrics(Progress& progress);
    bool queueAll(Progress& progress);
    void queue(EdgeId e);
    void refresh(EdgeId e);
    bool allowed(HalfedgeId h) const;
    double cost(HalfedgeId h) const;
    int copyPairs(HalfedgeId h, CopyPair pairs[2]) const;
    bool tryCollapse(HalfedgeId h);
    void collapse(HalfedgeId h, const std::optional<Refit>& refit, std::array<bool, 2> keepOrigin);
    std::optional<Refit> refit(HalfedgeId h) const;
    bool facesStayValid(HalfedgeId h, const std::optional<Refit>& refit,
                        std::array<bool, 2> keepOrigin) const;
    bool faceValid(const std::array<VertexId, 3>& corners, const std::array<EdgeId, 3>& sides,
                   const Refit* refit) const;
    std::array<LatticePoint, 4> sideCurve(VertexId a, VertexId b, EdgeId e, const Refit* refit) const;
    std::vector<glm::dvec2> polyline(const ChainPart& part) const;
    VertexId chainVertex(const ChainPart& part, bool end) const {
        return m.chains[part.chain].vertices[end ? part.to : part.from];
    }
    AbsorbedLists::List listFrom(HalfedgeId h) const {  // the list of h's edge, from h's origin
        const AbsorbedLists::List list = mLists[HalfedgeMesh::edge(h).index];
        return HalfedgeMesh::halfedge(HalfedgeMesh::edge(h)) == h ? list : list.reversed();
    }
    void setListFrom(HalfedgeId h, AbsorbedLists::List list) {
        mLists[HalfedgeMesh::edge(h).index] =
            HalfedgeMesh::halfedge(HalfedgeMesh::edge(h)) == h ? list : list.reversed();
    }
    QuadricArray::Point pointOf(VertexId v, uint32_t copy) const {
        const glm::dvec2 p = toPixels(m.positions[v.index]);
        return {p.x, p.y, m.heightsOf(copy)};
    }

    ChannelMeshes m;
    const VectorizeSettings& mSettings;
    QuadricArray mQuadrics;
    AbsorbedLists mAbsorbed;
    std::vector<AbsorbedLists::List> mLists;          // by edge
    std::vector<std::array<LatticePoint, 2>> mInner;  // by part, in the direction of the chain
    CandidateQueue mQueue;
    std::vector<uint32_t> mStamps;   // by edge: older candidates are void
    std::vector<uint8_t> mFailures;  // by edge
    // By edge: whether it has a valid candidate, and whether that one's cost is out of date. Quadrics only
    // accumulate, so that an outdated cost is too low, and it is early enough to mend it when it comes to the
    // top.
    enum class Queued : uint8_t { No, Yes, Outdated };
    std::vector<Queued> mQueued;
    size_t mCollapses = 0, mRejected = 0, mRefitsRejected = 0;
};

bool Simplifier::accumulateQuadrics(Progress& progress) {
    for (uint32_t f = 0; f < m.mesh.faceCapacity(); ++f) {
        if (f % 4096 == 0 && !progress.step(0)) return false;
        const auto sides = m.mesh.sides(FaceId(f));
        size_t copies[3];
        QuadricArray::Point points[3];
        for (size_t k = 0; k < 3; ++k) {
            copies[k] = m.copyOfCorner[sides[k].index];
            points[k] = pointOf(m.mesh.origin(sides[k]), uint32_t(copies[k]));
        }
        mQuadrics.addTriangle(copies, points, mSettings.colourWeight);
    }
    return true;
}

bool Simplifier::allowed(HalfedgeId h) const {
    const VertexKind from = m.kinds[m.mesh.origin(h).index], to = m.kinds[m.mesh.target(h).index];
    const EdgeId e = HalfedgeMesh::edge(h);
    switch (collapseRule(from, to)) {
        case CollapseRule::Never:
            return false;
        case CollapseRule::Free:
            return true;
        case CollapseRule::AlongFeature:
            return m.isFeature(e);
        case CollapseRule::AlongBorder:
            return m.mesh.onBorder(e);
    }
    return false;
}

int Simplifier::copyPairs(HalfedgeId h, CopyPair pairs[2]) const {
    const HalfedgeId t = HalfedgeMesh::twin(h);
    int count = 0;
    if (m.mesh.face(h).valid())
        pairs[count++] = {m.copyOfCorner[h.index], m.copyOfCorner[m.mesh.next(h).index]};
    if (m.mesh.face(t).valid() && (count == 0 || m.isFeature(HalfedgeMesh::edge(h))))
        pairs[count++] = {m.copyOfCorner[m.mesh.next(t).index], m.copyOfCorner[t.index]};
    return count;
}

// Dual edges contract together; each has the mean of their errors (section 4.2, item 2).
double Simplifier::cost(HalfedgeId h) const {
    CopyPair pairs[2];
    const int count = copyPairs(h, pairs);
    const VertexId v = m.mesh.target(h);
    double sum = 0;
    for (int k = 0; k < count; ++k) {
        const QuadricArray::Point at = pointOf(v, pairs[k].to);
        sum += mQuadrics.error(pairs[k].from, at, mSettings.colourWeight) +
               mQuadrics.error(pairs[k].to, at, mSettings.colourWeight);
    }
    return sum / count;
}

void Simplifier::refresh(EdgeId e) {
    mFailures[e.index] = 0;
    if (mQueued[e.index] == Queued::No)
        queue(e);
    else
        mQueued[e.index] = Queued::Outdated;
}

// Makes the candidate of an edge anew; the older one is void.
void Simplifier::queue(EdgeId e) {
    ++mStamps[e.index];
    mQueued[e.index] = Queued::No;
    const uint8_t failures = mFailures[e.index];
    if (failures >= kMaxFailures) return;
    const HalfedgeId h = HalfedgeMesh::halfedge(e), t = HalfedgeMesh::twin(h);
    const bool there = allowed(h), back = allowed(t);
    if (!there && !back) return;
    double cheaper = there ? cost(h) : cost(t);
    HalfedgeId chosen = there ? h : t;
    if (there && back) {
        const double other = cost(t);
        // After a failure it is the other direction's turn.
        if ((other < cheaper) != (failures % 2 == 1)) {
            cheaper = other;
            chosen = t;
        }
    }
    // The penalty: each failure quadruples the error, and lifts it off zero.
    constexpr double kLeastPenalty = 1e-10;
    if (failures > 0) cheaper = (cheaper + kLeastPenalty) * std::pow(4.0, failures);
    mQueued[e.index] = Queued::Yes;
    mQueue.push({float(cheaper), chosen.index, mStamps[e.index]});
}

bool Simplifier::queueAll(Progress& progress) {
    mQueue.clear();
    for (uint32_t e = 0; e < m.mesh.edgeCapacity(); ++e) {
        if (e % 4096 == 0 && progress.stopRequested()) return false;
        mFailures[e] = 0;
        if (m.mesh.alive(EdgeId(e))) queue(EdgeId(e));
    }
    return true;
}

bool Simplifier::run(Progress& progress) {
    if (!accumulateQuadrics(progress)) return false;
    const size_t edges = m.mesh.edgeCapacity();
    mStamps.assign(edges, 0);
    mFailures.assign(edges, 0);
    mQueued.assign(edges, Queued::No);
    mLists.resize(edges);
    for (uint32_t e = 0; e < edges; ++e) {
        if (e % 4096 == 0 && progress.stopRequested()) return false;
        const HalfedgeId h = HalfedgeMesh::halfedge(EdgeId(e));
        mLists[e] = mAbsorbed.pair(m.mesh.origin(h), m.mesh.target(h));
    }
    for (const ChainPart& part : m.parts)
        mInner.push_back(straightControlPoints(m.positions[chainVertex(part, false).index],
                                               m.positions[chainVertex(part, true).index]));

    const auto wanted = size_t(std::max(2, mSettings.patches));
    const size_t initial = m.mesh.faceCount();
    const auto alive = [&](const Candidate& c) {
        const uint32_t e = c.halfedge >> 1;
        return e < mStamps.size() && mStamps[e] == c.stamp && m.mesh.alive(EdgeId(e));
    };
    // A rejected edge may become valid through contractions near but not beside it: begin again until none
    // does.
    bool again = false;
    do {
        const size_t before = m.mesh.faceCount();
        if (!queueAll(progress)) return false;
        for (size_t steps = 0; !mQueue.empty(); ++steps) {
            if (steps % 256 == 0 && !progress.step(double(initial - m.mesh.faceCount()) /
                                                   double(std::max(initial, wanted + 1) - wanted)))
                return false;
            const Candidate top = mQueue.pop(alive, progress.stopToken());
            if (!alive(top)) continue;
            if (m.mesh.faceCount() <= wanted && double(top.cost) > kFreeError) break;
            const HalfedgeId h(top.halfedge);
            const EdgeId e = HalfedgeMesh::edge(h);
            if (mQueued[e.index] == Queued::Outdated) {
                queue(e);
                continue;
            }
            if (tryCollapse(h)) continue;
            ++mRejected;
            ++mFailures[e.index];
            queue(e);
        }
        again = m.mesh.faceCount() < before;
    } while (again);
    return true;
}

std::vector<glm::dvec2> Simplifier::polyline(const ChainPart& part) const {
    const auto& vertices = m.chains[part.chain].vertices;
    std::vector<glm::dvec2> points;
    for (size_t k = part.from;; k = (k + 1) % vertices.size()) {
        points.push_back(toPixels(m.positions[vertices[k].index]));
        if (k == part.to) return points;
    }
}

// Section 4.2, item 4, and Fig. 6: one cubic for the two curves that meet at the origin of h.
std::optional<Simplifier::Refit> Simplifier::refit(HalfedgeId h) const {
    Refit result;
    const ChainPart& along = m.parts[size_t(m.partOfEdge[HalfedgeMesh::edge(h).index])];
    m.mesh.forEachOutgoing(m.mesh.origin(h), [&](HalfedgeId out) {
        if (out != h && m.isFeature(HalfedgeMesh::edge(out))) result.before = out;
    });
    TESSERA_CHECK(result.before.valid());
    const ChainPart& other = m.parts[size_t(m.partOfEdge[HalfedgeMesh::edge(result.before).index])];
    TESSERA_CHECK(other.chain == along.chain);
    if (m.mesh.target(result.before) == m.mesh.target(h)) return std::nullopt;
    const bool forward = chainVertex(along, false) == m.mesh.origin(h);
    result.part =
        forward ? ChainPart{along.chain, other.from, along.to} : ChainPart{along.chain, along.from, other.to};

    const std::vector<glm::dvec2> points = polyline(result.part);
    const BezierCurve curve = fitCurve(points);
    result.inner = {toLattice(curve.p[1]), toLattice(curve.p[2])};
    const BezierCurve rounded{
        {points.front(), toPixels(result.inner[0]), toPixels(result.inner[1]), points.back()}};
    if (maxDistance(rounded, points) > mSettings.curveTolerancePx) return std::nullopt;
    return result;
}

std::array<LatticePoint, 4> Simplifier::sideCurve(VertexId a, VertexId b, EdgeId e,
                                                  const Refit* refit) const {
    const LatticePoint pa = m.positions[a.index], pb = m.positions[b.index];
    std::array<LatticePoint, 2> inner;
    const ChainPart* part = nullptr;
    if (refit && e == HalfedgeMesh::edge(refit->before)) {
        part = &refit->part;
        inner = refit->inner;
    } else if (m.isFeature(e)) {
        part = &m.parts[size_t(m.partOfEdge[e.index])];
        inner = mInner[size_t(m.partOfEdge[e.index])];
    } else {
        inner = straightControlPoints(pa, pb);
    }
    if (part && chainVertex(*part, false) != a) std::swap(inner[0], inner[1]);
    return {pa, inner[0], inner[1], pb};
}

// Whether the face with these corners and sides (side k from corner k) is a patch that does not fold.
bool Simplifier::faceValid(const std::array<VertexId, 3>& corners, const std::array<EdgeId, 3>& sides,
                           const Refit* refit) const {
    const LatticePoint a = m.positions[corners[0].index], b = m.positions[corners[1].index],
                       c = m.positions[corners[2].index];
    if (!certifiedIfStraight(a, b, c)) return false;
    bool curved = false;
    for (const EdgeId e : sides)
        curved = curved || m.isFeature(e) || (refit && e == HalfedgeMesh::edge(refit->before));
    if (!curved) return true;
    LatticeTriangle t;
    for (size_t s = 0; s < 3; ++s) {
        const auto curve = sideCurve(corners[s], corners[(s + 1) % 3], sides[s], refit);
        for (size_t i = 0; i < 3; ++i) t.p[3 * s + i] = curve[i];
    }
    return certifiedDefaultInterior(t).has_value();
}

bool Simplifier::facesStayValid(HalfedgeId h, const std::optional<Refit>& refit,
                                std::array<bool, 2> keepOrigin) const {
    const VertexId u = m.mesh.origin(h), v = m.mesh.target(h);
    const Refit* with = refit ? &*refit : nullptr;
    // The two edges of u that fall together with edges of v give way to those, which may be features.
    std::array<std::pair<EdgeId, EdgeId>, 2> replaced;
    for (size_t side = 0; side < 2; ++side) {
        const HalfedgeId s = side == 0 ? h : HalfedgeMesh::twin(h);
        if (!m.mesh.face(s).valid() || keepOrigin[side]) continue;
        const EdgeId atTarget = HalfedgeMesh::edge(side == 0 ? m.mesh.next(s) : m.mesh.prev(s));
        const EdgeId atOrigin = HalfedgeMesh::edge(side == 0 ? m.mesh.prev(s) : m.mesh.next(s));
        replaced[side] = {atOrigin, atTarget};
    }
    const auto after = [&](HalfedgeId side) {
        const EdgeId e = HalfedgeMesh::edge(side);
        for (const auto& [gone, kept] : replaced)
            if (gone == e) return kept;
        return e;
    };
    bool valid = true;
    m.mesh.forEachOutgoing(u, [&](HalfedgeId out) {
        if (!valid || !m.mesh.face(out).valid()) return;
        const HalfedgeId across = m.mesh.next(out), back = m.mesh.next(across);
        const VertexId a = m.mesh.target(out), b = m.mesh.target(across);
        if (a == v || b == v) return;  // vanishes
        valid = faceValid({v, a, b}, {after(out), HalfedgeMesh::edge(across), after(back)}, with);
    });
    // A feature that moves onto an edge beside it gives the face beyond that edge a curved side.
    for (size_t side = 0; valid && side < 2; ++side) {
        if (!keepOrigin[side]) continue;
        const HalfedgeId s = side == 0 ? h : HalfedgeMesh::twin(h);
        const HalfedgeId atTarget = side == 0 ? m.mesh.next(s) : m.mesh.prev(s);
        const HalfedgeId beyond = HalfedgeMesh::twin(atTarget);
        if (!m.mesh.face(beyond).valid() || m.isFeature(HalfedgeMesh::edge(beyond))) return false;
        const HalfedgeId n1 = m.mesh.next(beyond), n2 = m.mesh.next(n1);
        valid = faceValid({m.mesh.origin(beyond), m.mesh.origin(n1), m.mesh.origin(n2)},
                          {HalfedgeMesh::edge(refit->before), HalfedgeMesh::edge(n1), HalfedgeMesh::edge(n2)},
                          with);
    }
    return valid;
}

bool Simplifier::tryCollapse(HalfedgeId h) {
    if (!m.mesh.canCollapse(h)) return false;
    std::optional<Refit> curve;
    std::array<bool, 2> keepOrigin{false, false};
    if (m.isFeature(HalfedgeMesh::edge(h))) {
        curve = refit(h);
        if (!curve) {
            ++mRefitsRejected;
            return false;
        }
        for (size_t side = 0; side < 2; ++side) {
            const HalfedgeId s = side == 0 ? h : HalfedgeMesh::twin(h);
            if (m.mesh.face(s).valid())
                keepOrigin[side] = m.mesh.target(m.mesh.next(s)) == m.mesh.target(curve->before);
        }
    }
    if (!facesStayValid(h, curve, keepOrigin)) return false;
    collapse(h, curve, keepOrigin);
    return true;
}

void Simplifier::collapse(HalfedgeId h, const std::optional<Refit>& curve, std::array<bool, 2> keepOrigin) {
    const VertexId u = m.mesh.origin(h), v = m.mesh.target(h);
    CopyPair pairs[2];
    const int pairCount = copyPairs(h, pairs);
    const AbsorbedLists::List contracted = listFrom(h);

    // Fig. 7: the surviving edges of u append the contracted edge's list to their own.
    const HalfedgeId t = HalfedgeMesh::twin(h);
    const VertexId opposite[2] = {m.mesh.face(h).valid() ? m.mesh.target(m.mesh.next(h)) : VertexId(),
                                  m.mesh.face(t).valid() ? m.mesh.target(m.mesh.next(t)) : VertexId()};
    m.mesh.forEachOutgoing(u, [&](HalfedgeId out) {
        const VertexId k = m.mesh.target(out);
        if (out == h || (k == opposite[0] && !keepOrigin[0]) || (k == opposite[1] && !keepOrigin[1])) return;
        setListFrom(HalfedgeMesh::twin(out), mAbsorbed.joined(listFrom(HalfedgeMesh::twin(out)), contracted));
    });
    if (curve) {
        const auto part = size_t(m.partOfEdge[HalfedgeMesh::edge(curve->before).index]);
        m.parts[part] = curve->part;
        mInner[part] = curve->inner;
    }

    // The edges that move with u get new candidates; those of v keep theirs for the time being.
    m.mesh.forEachOutgoing(u, [&](HalfedgeId out) { mQueued[HalfedgeMesh::edge(out).index] = Queued::No; });
    const auto done = m.mesh.collapse(h, keepOrigin);
    for (const HalfedgeMesh::Merge& merge : done.merges)
        if (merge.kept.valid()) m.copyOfCorner[merge.kept.index] = m.copyOfCorner[merge.replaced.index];
    for (int k = 0; k < pairCount; ++k) mQuadrics.accumulate(pairs[k].to, pairs[k].from);
    ++mCollapses;
    m.mesh.forEachOutgoing(v, [&](HalfedgeId out) {
        for (int k = 0; k < pairCount; ++k)
            if (m.copyOfCorner[out.index] == pairs[k].from) m.copyOfCorner[out.index] = pairs[k].to;
    });
    m.mesh.forEachOutgoing(v, [&](HalfedgeId out) { refresh(HalfedgeMesh::edge(out)); });
}

BaseDomain Simplifier::baseDomain(const std::stop_token& stop) const {
    const auto compact = m.mesh.compacted();
    std::vector<LatticePoint> positions;
    for (const VertexId v : compact.oldVertex) positions.push_back(m.positions[v.index]);
    BaseDomain base{PatchMesh(m.width, m.height, m.channels, compact.mesh, positions), {}};
    for (uint32_t e = 0; e < compact.oldEdge.size() && !stop.stop_requested(); ++e) {
        const EdgeId old = compact.oldEdge[e];
        if (!m.isFeature(old)) {
            std::vector<glm::dvec2> path;
            for (const VertexId v : mAbsorbed.prunedPath(mLists[old.index]))
                path.push_back(toPixels(m.positions[v.index]));
            base.paths.push_back(std::move(path));
            continue;
        }
        const ChainPart& part = m.parts[size_t(m.partOfEdge[old.index])];
        auto inner = mInner[size_t(m.partOfEdge[old.index])];
        std::vector<glm::dvec2> path = polyline(part);
        if (chainVertex(part, false) != m.mesh.origin(HalfedgeMesh::halfedge(old))) {
            std::swap(inner[0], inner[1]);
            std::reverse(path.begin(), path.end());
        }
        base.mesh.setCurve(EdgeId(e), {inner[0], inner[1], true, {}});
        base.paths.push_back(std::move(path));
    }
    base.mesh.forEachPatch([&](PatchId p) {
        if (stop.stop_requested()) return;
        const auto interior = certifiedDefaultInterior(base.mesh.controlPoints(p));
        TESSERA_CHECK(interior);  // kept at every contraction
        base.mesh.setInterior(p, *interior);
    });
    return base;
}

void Simplifier::describe(StageReport& report, std::string& shortfall) const {
    report.figures = {{"collapses", double(mCollapses)},
                      {"rejected", double(mRejected)},
                      {"curve fits rejected", double(mRefitsRejected)},
                      {"patches", double(m.mesh.faceCount())}};
    if (m.mesh.faceCount() <= size_t(std::max(2, mSettings.patches))) return;
    size_t held = 0;
    for (uint32_t f = 0; f < m.mesh.faceCapacity(); ++f) {
        if (!m.mesh.alive(FaceId(f))) continue;
        bool touches = false;
        for (const VertexId v : m.mesh.corners(FaceId(f)))
            touches = touches || m.kinds[v.index] == VertexKind::Feature ||
                      m.kinds[v.index] == VertexKind::FeatureEnd;
        held += touches;
    }
    shortfall = "features pin the mesh at " + std::to_string(m.mesh.faceCount()) + " patches, " +
                std::to_string(held) + " of which touch features; raise the feature thresholds to go below";
}

}  // namespace

Result<BaseDomain> simplify(ChannelMeshes meshes, const VectorizeSettings& settings, StageReport& report,
                            std::string& shortfall, Progress& progress) {
    Simplifier simplifier(std::move(meshes), settings);
    if (!simplifier.run(progress)) return stopped();
    BaseDomain base = simplifier.baseDomain(progress.stopToken());
    simplifier.describe(report, shortfall);
    smoothJoins(base, settings, report, progress.stopToken());
    if (progress.stopRequested()) return stopped();
    return base;
}

}  // namespace tessera
