// See refine.h.
#include "core/vectorize/refine.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/mesh/jacobian.h"

namespace tessera {

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kGain = 1e-9;  // what a change must gain at least, of the error before

// Sides are moved outwards by this much before the fit: pixels across an edge count for both its patches, as
// they do in the fit of colours, and neighbours agree better.
constexpr double kOverlapPx = .3;
constexpr int kCurvePoints = 6;

// The squared sine of the smallest angle; negative for a triangle turned over.
double shape(LatticePoint a, LatticePoint b, LatticePoint c) {
    const auto area2 = double(cross(b - a, c - a));
    const auto squared = [](LatticePoint d) { return double(d.x) * d.x + double(d.y) * d.y; };
    std::array<double, 3> l{squared(b - a), squared(c - b), squared(a - c)};
    std::sort(l.begin(), l.end());
    if (area2 <= 0 || l[1] <= 0) return -1;
    return area2 * area2 / (l[1] * l[2]);
}

double leastShape() {
    const double s = std::sin(Refiner::kMinAngleDegrees * std::numbers::pi / 180);
    return s * s;
}

}  // namespace

void apply(const RecordedCollapse& collapse, CutMesh& cut) {
    const VertexId onto = cut.mesh.target(collapse.halfedge);
    cut.mesh.collapse(collapse.halfedge, collapse.kept);
    if (!collapse.curve) return;
    const CutCurve& curve = *collapse.curve;
    const HalfedgeId kept = cut.mesh.find(onto, curve.from == onto ? curve.to : curve.from);
    cut.curves[size_t(cut.curveOfEdge[HalfedgeMesh::edge(kept).index])] = curve;
}

Refiner::Refiner(CutMesh& cut, const PolynomialFit& fit, const VectorizeSettings& settings,
                 std::stop_token stop)
    : m(cut),
      mFit(fit),
      mTolerancePx(settings.featureTolerancePx),
      mStop(std::move(stop)),
      mError(cut.mesh.faceCapacity(), 0) {
    std::vector<FaceId> all;
    for (uint32_t f = 0; f < mError.size(); ++f)
        if (m.mesh.alive(FaceId(f))) all.push_back(FaceId(f));
    updateFaces(all);
}

double Refiner::totalError() const {
    double sum = 0;
    for (uint32_t f = 0; f < mError.size(); ++f)
        if (m.mesh.alive(FaceId(f))) sum += mError[f];
    return sum;
}

void Refiner::updateFaces(const std::vector<FaceId>& faces) {
    mError.resize(m.mesh.faceCapacity(), 0);
    parallelFor(faces.size(), 16, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end && !mStop.stop_requested(); ++i) updateFace(faces[i]);
    });
}

Refiner::Triangle Refiner::triangle(FaceId f) const {
    Triangle t;
    size_t k = 0;
    for (const HalfedgeId h : m.mesh.sides(f)) {
        t.vertices[k] = m.mesh.origin(h);
        t.corners[k] = at(t.vertices[k]);
        t.curves[k++] = m.curve(HalfedgeMesh::edge(h));
    }
    return t;
}

const CutCurve* Refiner::curveBetween(VertexId a, VertexId b) const {
    if (m.kinds[a.index] == VertexKind::Interior || m.kinds[b.index] == VertexKind::Interior) return nullptr;
    const HalfedgeId h = m.mesh.find(a, b);
    return h.valid() ? m.curve(HalfedgeMesh::edge(h)) : nullptr;
}

double Refiner::error(const Triangle& t) const {
    std::array<glm::dvec2, 3> p;
    for (size_t k = 0; k < 3; ++k) p[k] = toPixels(t.corners[k]);
    // Each corner goes to where the sides moved outwards meet, but not far beyond.
    std::array<glm::dvec2, 3> grown = p;
    for (size_t k = 0; k < 3; ++k) {
        const glm::dvec2 onward = unit(p[(k + 1) % 3] - p[k]), back = unit(p[(k + 2) % 3] - p[k]);
        const double sine = std::max(cross(onward, back), .5);
        const double beyondBack = t.curves[(k + 2) % 3] ? 0 : kOverlapPx;
        const double beyondOnward = t.curves[k] ? 0 : kOverlapPx;
        grown[k] -= onward * (beyondBack / sine) + back * (beyondOnward / sine);
    }
    if (!t.curves[0] && !t.curves[1] && !t.curves[2]) return mFit.error(grown);
    std::array<glm::dvec2, 3 * (1 + kCurvePoints)> outline;
    size_t n = 0;
    for (size_t k = 0; k < 3; ++k) {
        outline[n++] = grown[k];
        if (!t.curves[k]) continue;
        std::array<LatticePoint, 4> c = t.curves[k]->controlPoints(t.vertices[k], m.positions);
        c[0] = t.corners[k];
        c[3] = t.corners[(k + 1) % 3];
        const BezierCurve curve = toPixels(c);
        for (int i = 1; i <= kCurvePoints; ++i) outline[n++] = curve.at(double(i) / (kCurvePoints + 1));
    }
    return mFit.error(grown, {outline.data(), n});
}

bool Refiner::valid(const Triangle& t, double least) const {
    if (shape(t.corners[0], t.corners[1], t.corners[2]) < least) return false;
    if (!certifiedIfStraight(t.corners[0], t.corners[1], t.corners[2])) return false;
    if (!t.curves[0] && !t.curves[1] && !t.curves[2]) return true;
    LatticeTriangle patch;
    for (size_t k = 0; k < 3; ++k) {
        const LatticePoint a = t.corners[k], b = t.corners[(k + 1) % 3];
        const auto inner = straightControlPoints(a, b);
        std::array<LatticePoint, 4> side{a, inner[0], inner[1], b};
        if (t.curves[k]) side = t.curves[k]->controlPoints(t.vertices[k], m.positions);
        patch.p[3 * k] = a;
        patch.p[3 * k + 1] = side[1];
        patch.p[3 * k + 2] = side[2];
    }
    return certifiedDefaultInterior(patch).has_value();
}

// What changes around a vertex must be shaped like: well, or at least as the worst there is.
double Refiner::worstShapeAround(VertexId v) const {
    double worst = leastShape();
    m.mesh.forEachOutgoing(v, [&](HalfedgeId h) {
        if (!m.mesh.face(h).valid()) return;
        const auto c = m.mesh.corners(m.mesh.face(h));
        worst = std::min(worst, shape(at(c[0]), at(c[1]), at(c[2])));
    });
    return worst;
}

double Refiner::errorAround(VertexId v) const {
    double sum = 0;
    m.mesh.forEachOutgoing(v, [&](HalfedgeId h) {
        if (m.mesh.face(h).valid()) sum += mError[m.mesh.face(h).index];
    });
    return sum;
}

// Whether a border vertex that goes to `to` stays on its side of the picture.
bool Refiner::staysOnSide(VertexId v, LatticePoint to) const {
    bool stays = true;
    m.mesh.forEachOutgoing(v, [&](HalfedgeId h) {
        if (m.mesh.onBorder(HalfedgeMesh::edge(h)))
            stays = stays && cross(to - at(v), at(m.mesh.target(h)) - at(v)) == 0;
    });
    return stays;
}

bool Refiner::mayCollapse(HalfedgeId h) const {
    const VertexId u = m.mesh.origin(h);
    const EdgeId e = HalfedgeMesh::edge(h);
    switch (m.kinds[u.index]) {
        case VertexKind::Interior:
            break;
        case VertexKind::Border:
            if (!m.mesh.onBorder(e) || !staysOnSide(u, at(m.mesh.target(h)))) return false;
            break;
        case VertexKind::Feature:
            if (!m.curve(e)) return false;
            break;
        case VertexKind::FeatureEnd:
        case VertexKind::Corner:
            return false;
    }
    return m.mesh.canCollapse(h);
}

std::optional<Refiner::Merge> Refiner::merge(HalfedgeId h) const {
    const CutCurve* along = m.curve(HalfedgeMesh::edge(h));
    const VertexId u = m.mesh.origin(h), v = m.mesh.target(h);
    Merge result;
    m.mesh.forEachOutgoing(u, [&](HalfedgeId out) {
        if (out != h && m.curve(HalfedgeMesh::edge(out))) result.before = out;
    });
    if (!result.before.valid()) return std::nullopt;
    const CutCurve* other = m.curve(HalfedgeMesh::edge(result.before));
    result.beyond = m.mesh.target(result.before);
    if (other->chain != along->chain || result.beyond == v) return std::nullopt;
    const CutCurve& first = along->from == u ? *other : *along;
    const CutCurve& second = along->from == u ? *along : *other;
    if (first.to != u || second.from != u) return std::nullopt;
    const auto cubic = fitChainPart(m.chains[along->chain], first.first, second.last, mTolerancePx);
    if (!cubic) return std::nullopt;
    result.curve = {first.from,
                    second.to,
                    first.chain,
                    first.first,
                    second.last,
                    {toLattice(cubic->p[1]), toLattice(cubic->p[2])},
                    {first.sigma[0], second.sigma[1]}};
    return result;
}

// On which sides the feature edge takes the place of the edge that it falls together with.
std::array<bool, 2> Refiner::keptSides(HalfedgeId h, const Merge& merge) const {
    std::array<bool, 2> keep{false, false};
    for (size_t side = 0; side < 2; ++side) {
        const HalfedgeId s = side == 0 ? h : HalfedgeMesh::twin(h);
        if (m.mesh.face(s).valid()) keep[side] = m.mesh.target(m.mesh.next(s)) == merge.beyond;
    }
    return keep;
}

// The triangles that are there after the collapse of h; `before` is the error of those that go.
bool Refiner::fansAfter(HalfedgeId h, const std::optional<Merge>& merge, std::vector<Triangle>& fans,
                        double& before) const {
    const VertexId u = m.mesh.origin(h), v = m.mesh.target(h);
    const double least = worstShapeAround(u);
    fans.clear();
    bool good = true;
    const auto curveFrom = [&](VertexId w) -> const CutCurve* {
        if (merge && w == merge->beyond) return &merge->curve;
        return curveBetween(v, w);
    };
    m.mesh.forEachOutgoing(u, [&](HalfedgeId out) {
        if (!good || !m.mesh.face(out).valid()) return;
        const HalfedgeId across = m.mesh.next(out);
        const VertexId a = m.mesh.target(out), b = m.mesh.target(across);
        if (a == v || b == v) return;
        fans.push_back({{at(v), at(a), at(b)},
                        {curveFrom(a), m.curve(HalfedgeMesh::edge(across)), curveFrom(b)},
                        {v, a, b}});
        good = valid(fans.back(), least);
    });
    // A feature that moves onto an edge beside it gives the face beyond that edge a curved side.
    if (!merge || !good) return good;
    const auto keep = keptSides(h, *merge);
    for (size_t side = 0; side < 2; ++side) {
        if (!keep[side]) continue;
        const HalfedgeId s = side == 0 ? h : HalfedgeMesh::twin(h);
        const HalfedgeId beyond = HalfedgeMesh::twin(side == 0 ? m.mesh.next(s) : m.mesh.prev(s));
        if (!m.mesh.face(beyond).valid() || m.curve(HalfedgeMesh::edge(beyond))) return false;
        const HalfedgeId n1 = m.mesh.next(beyond), n2 = m.mesh.next(n1);
        const VertexId a = m.mesh.origin(beyond), b = m.mesh.origin(n1), c = m.mesh.origin(n2);
        if (c == u) continue;  // goes as well
        fans.push_back({{at(a), at(b), at(c)},
                        {&merge->curve, m.curve(HalfedgeMesh::edge(n1)), m.curve(HalfedgeMesh::edge(n2))},
                        {a, b, c}});
        if (!valid(fans.back(), -1)) return false;
        before += mError[m.mesh.face(beyond).index];
    }
    return true;
}

Refiner::Option Refiner::bestCollapse(VertexId u) const {
    Option best{kNever, {}};
    const double around = errorAround(u);
    std::vector<Triangle> fans;
    m.mesh.forEachOutgoing(u, [&](HalfedgeId h) {
        if (!mayCollapse(h)) return;
        std::optional<Merge> curve;
        if (m.kinds[u.index] == VertexKind::Feature && !(curve = merge(h))) return;
        double before = around;
        if (!fansAfter(h, curve, fans, before)) return;
        double after = 0;
        for (const Triangle& t : fans) {
            after += error(t);
            if (after - before >= best.cost) return;
        }
        best = {after - before, h};
    });
    return best;
}

void Refiner::collapse(HalfedgeId h, std::vector<FaceId>& changed) {
    const VertexId u = m.mesh.origin(h), v = m.mesh.target(h);
    RecordedCollapse record{h, {false, false}, {}};
    if (m.kinds[u.index] == VertexKind::Feature) {
        const auto curve = merge(h);
        TESSERA_CHECK(curve);
        record.kept = keptSides(h, *curve);
        record.curve = curve->curve;
    }
    apply(record, m);
    if (mRecord) mRecord->push_back(record);
    m.mesh.forEachOutgoing(v, [&](HalfedgeId out) {
        if (m.mesh.face(out).valid()) changed.push_back(m.mesh.face(out));
    });
}

bool Refiner::collapseTo(size_t faces, Progress& progress) {
    std::vector<Option> options(m.mesh.vertexCapacity(), {kNever, {}});
    std::vector<VertexId> dirty;
    for (uint32_t v = 0; v < options.size(); ++v)
        if (m.mesh.alive(VertexId(v))) dirty.push_back(VertexId(v));
    const size_t initial = m.mesh.faceCount();
    std::vector<uint8_t> touched(m.mesh.faceCapacity());
    // In batches: the cheapest sixteenth, as far as their stars do not touch.
    constexpr size_t kShare = 16;
    while (m.mesh.faceCount() > faces) {
        if (!progress.step(double(initial - m.mesh.faceCount()) / double(initial - faces))) return false;
        parallelFor(dirty.size(), 8, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end && !progress.stopRequested(); ++i)
                options[dirty[i].index] = bestCollapse(dirty[i]);
        });
        std::vector<VertexId> order;
        for (uint32_t v = 0; v < options.size(); ++v)
            if (m.mesh.alive(VertexId(v)) && options[v].cost < kNever) order.push_back(VertexId(v));
        std::sort(order.begin(), order.end(), [&](VertexId a, VertexId b) {
            const double ca = options[a.index].cost, cb = options[b.index].cost;
            return ca != cb ? ca < cb : a < b;
        });
        std::fill(touched.begin(), touched.end(), 0);
        dirty.clear();
        std::vector<FaceId> changed;
        const size_t batch = std::min((m.mesh.faceCount() - faces + 1) / 2, order.size() / kShare + 1);
        size_t done = 0;
        for (const VertexId u : order) {
            if (done >= batch) break;
            const HalfedgeId h = options[u.index].halfedge;
            bool free = m.mesh.alive(HalfedgeMesh::edge(h)) && m.mesh.origin(h) == u;
            m.mesh.forEachOutgoing(u, [&](HalfedgeId out) {
                for (const HalfedgeId side : {out, HalfedgeMesh::twin(m.mesh.next(out))})
                    if (m.mesh.face(side).valid()) free = free && !touched[m.mesh.face(side).index];
            });
            if (!free || !m.mesh.canCollapse(h)) {
                dirty.push_back(u);
                continue;
            }
            const size_t from = changed.size();
            collapse(h, changed);
            for (size_t i = from; i < changed.size(); ++i) touched[changed[i].index] = 1;
            ++done;
        }
        std::sort(changed.begin(), changed.end());
        changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
        std::erase_if(changed, [&](FaceId f) { return !m.mesh.alive(f); });
        updateFaces(changed);
        for (const FaceId f : changed) {
            for (const VertexId v : m.mesh.corners(f)) dirty.push_back(v);
            // A feature vertex beyond a side may move its feature onto that side.
            for (const HalfedgeId h : m.mesh.sides(f)) {
                const HalfedgeId beyond = HalfedgeMesh::twin(h);
                if (!m.mesh.face(beyond).valid()) continue;
                const VertexId opposite = m.mesh.target(m.mesh.next(beyond));
                if (m.kinds[opposite.index] == VertexKind::Feature) dirty.push_back(opposite);
            }
        }
        std::sort(dirty.begin(), dirty.end());
        dirty.erase(std::unique(dirty.begin(), dirty.end()), dirty.end());
        std::erase_if(dirty, [&](VertexId v) { return !m.mesh.alive(v); });
        if (done == 0) break;
    }
    return true;
}

double Refiner::flipCost(EdgeId e) const {
    if (m.curve(e) || !m.mesh.canFlip(e)) return kNever;
    const HalfedgeId h = HalfedgeMesh::halfedge(e), t = HalfedgeMesh::twin(h);
    const HalfedgeId h1 = m.mesh.next(h), h2 = m.mesh.next(h1), t1 = m.mesh.next(t), t2 = m.mesh.next(t1);
    const VertexId a = m.mesh.origin(h), b = m.mesh.origin(t), c = m.mesh.origin(h2), d = m.mesh.origin(t2);
    const auto curve = [&](HalfedgeId side) { return m.curve(HalfedgeMesh::edge(side)); };
    const Triangle first{{at(c), at(d), at(b)}, {nullptr, curve(t2), curve(h1)}, {c, d, b}};
    const Triangle second{{at(d), at(c), at(a)}, {nullptr, curve(h2), curve(t1)}, {d, c, a}};
    const double least = std::min({leastShape(), shape(at(a), at(b), at(c)), shape(at(b), at(a), at(d))});
    if (!valid(first, least) || !valid(second, least)) return kNever;
    const double before = mError[m.mesh.face(h).index] + mError[m.mesh.face(t).index];
    const double one = error(first);
    if (one >= before) return kNever;
    return one + error(second) - before * (1 - kGain);
}

template <class Cost>
std::vector<EdgeId> Refiner::edgesByCost(Cost&& cost) const {
    std::vector<double> costs(m.mesh.edgeCapacity(), kNever);
    parallelFor(costs.size(), 32, [&](size_t begin, size_t end) {
        for (size_t e = begin; e < end && !mStop.stop_requested(); ++e)
            if (m.mesh.alive(EdgeId(uint32_t(e)))) costs[e] = cost(EdgeId(uint32_t(e)));
    });
    std::vector<EdgeId> order;
    for (uint32_t e = 0; e < costs.size(); ++e)
        if (costs[e] < 0) order.emplace_back(e);
    std::stable_sort(order.begin(), order.end(),
                     [&](EdgeId a, EdgeId b) { return costs[a.index] < costs[b.index]; });
    return order;
}

size_t Refiner::flip() {
    const std::vector<EdgeId> order = edgesByCost([&](EdgeId e) { return flipCost(e); });
    std::vector<uint8_t> touched(m.mesh.faceCapacity(), 0);
    std::vector<FaceId> changed;
    for (const EdgeId e : order) {
        const HalfedgeId h = HalfedgeMesh::halfedge(e);
        const FaceId f = m.mesh.face(h), g = m.mesh.face(HalfedgeMesh::twin(h));
        if (touched[f.index] || touched[g.index] || !m.mesh.canFlip(e)) continue;
        m.mesh.flip(e);
        touched[f.index] = touched[g.index] = 1;
        changed.insert(changed.end(), {f, g});
    }
    updateFaces(changed);
    return changed.size() / 2;
}

LatticePoint Refiner::middle(EdgeId e) const {
    const HalfedgeId h = HalfedgeMesh::halfedge(e);
    const LatticePoint sum = at(m.mesh.origin(h)) + at(m.mesh.target(h));
    return {sum.x / 2, sum.y / 2};
}

double Refiner::splitCost(EdgeId e) const {
    if (m.curve(e)) return kNever;
    const HalfedgeId h = HalfedgeMesh::halfedge(e);
    const LatticePoint p = middle(e);
    double before = 0, after = 0;
    for (const HalfedgeId s : {h, HalfedgeMesh::twin(h)}) {
        if (!m.mesh.face(s).valid()) continue;
        const HalfedgeId s1 = m.mesh.next(s), s2 = m.mesh.next(s1);
        const VertexId a = m.mesh.origin(s), b = m.mesh.origin(s1), c = m.mesh.origin(s2);
        const Triangle first{
            {at(a), p, at(c)}, {nullptr, nullptr, m.curve(HalfedgeMesh::edge(s2))}, {a, VertexId(), c}};
        const Triangle second{
            {p, at(b), at(c)}, {nullptr, m.curve(HalfedgeMesh::edge(s1)), nullptr}, {VertexId(), b, c}};
        const double least = std::min(leastShape(), shape(at(a), at(b), at(c)));
        if (!valid(first, least) || !valid(second, least)) return kNever;
        before += mError[m.mesh.face(s).index];
        after += error(first) + error(second);
    }
    return after - before;
}

void Refiner::splitTo(size_t faces) {
    const std::vector<EdgeId> order = edgesByCost([&](EdgeId e) { return splitCost(e); });
    std::vector<uint8_t> touched(m.mesh.faceCapacity(), 0);
    std::vector<FaceId> changed;
    for (const EdgeId e : order) {
        if (m.mesh.faceCount() >= faces) break;
        const HalfedgeId h = HalfedgeMesh::halfedge(e);
        bool free = true;
        for (const HalfedgeId s : {h, HalfedgeMesh::twin(h)})
            if (m.mesh.face(s).valid()) free = free && !touched[m.mesh.face(s).index];
        if (!free) continue;
        const bool border = m.mesh.onBorder(e);
        m.positions.push_back(middle(e));
        m.kinds.push_back(border ? VertexKind::Border : VertexKind::Interior);
        const VertexId v = m.mesh.split(e);
        touched.resize(m.mesh.faceCapacity(), 0);
        m.mesh.forEachOutgoing(v, [&](HalfedgeId out) {
            if (!m.mesh.face(out).valid()) return;
            touched[m.mesh.face(out).index] = 1;
            changed.push_back(m.mesh.face(out));
        });
    }
    m.curveOfEdge.resize(m.mesh.edgeCapacity(), -1);
    updateFaces(changed);
}

bool Refiner::tryMove(VertexId v, double step) {
    constexpr double kDiagonal = .70710678118654752440;
    static constexpr double kDirections[8][2] = {{1, 0},
                                                 {0, 1},
                                                 {-1, 0},
                                                 {0, -1},
                                                 {kDiagonal, kDiagonal},
                                                 {-kDiagonal, kDiagonal},
                                                 {-kDiagonal, -kDiagonal},
                                                 {kDiagonal, -kDiagonal}};
    const double before = errorAround(v), least = worstShapeAround(v);
    double area = 0;
    std::vector<Triangle> star;
    m.mesh.forEachOutgoing(v, [&](HalfedgeId h) {
        if (!m.mesh.face(h).valid()) return;
        const HalfedgeId across = m.mesh.next(h);
        const VertexId a = m.mesh.target(h), b = m.mesh.target(across);
        star.push_back(
            {{at(v), at(a), at(b)}, {nullptr, m.curve(HalfedgeMesh::edge(across)), nullptr}, {v, a, b}});
        area += double(cross(at(a) - at(v), at(b) - at(v)));
    });
    const double length = step * std::sqrt(area / double(star.size()));
    const LatticePoint from = at(v);
    double best = before * (1 - 1e-6);
    LatticePoint to = from;
    for (const auto& d : kDirections) {
        const LatticePoint p{from.x + int32_t(std::lround(length * d[0])),
                             from.y + int32_t(std::lround(length * d[1]))};
        if (p == from || (m.kinds[v.index] == VertexKind::Border && !staysOnSide(v, p))) continue;
        bool good = true;
        for (Triangle& t : star) {
            t.corners[0] = p;
            good = good && valid(t, least);
        }
        double after = 0;
        for (size_t i = 0; good && i < star.size(); ++i) {
            after += error(star[i]);
            good = after < best;
        }
        if (!good) continue;
        best = after;
        to = p;
    }
    if (to == from) return false;
    m.positions[v.index] = to;
    m.mesh.forEachOutgoing(v, [&](HalfedgeId h) {
        if (m.mesh.face(h).valid()) updateFace(m.mesh.face(h));
    });
    return true;
}

size_t Refiner::move(double step) {
    // Vertices of one colour are no neighbours, so that their stars share no face.
    std::vector<uint8_t> colour(m.mesh.vertexCapacity(), 0);
    std::vector<std::vector<VertexId>> classes;
    for (uint32_t v = 0; v < colour.size(); ++v) {
        if (!m.mesh.alive(VertexId(v))) continue;
        if (m.kinds[v] != VertexKind::Interior && m.kinds[v] != VertexKind::Border) continue;
        std::array<bool, 256> used{};
        m.mesh.forEachOutgoing(VertexId(v),
                               [&](HalfedgeId h) { used[colour[m.mesh.target(h).index]] = true; });
        size_t c = 1;
        while (used[c] && c < 255) ++c;
        if (used[c]) continue;
        colour[v] = uint8_t(c);
        if (classes.size() < c) classes.resize(c);
        classes[c - 1].push_back(VertexId(v));
    }
    std::vector<uint8_t> moved(colour.size(), 0);
    for (const auto& vertices : classes)
        parallelFor(vertices.size(), 4, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end && !mStop.stop_requested(); ++i)
                moved[vertices[i].index] = tryMove(vertices[i], step);
        });
    return size_t(std::accumulate(moved.begin(), moved.end(), 0));
}

Result<CutMesh> refine(CutMesh cut, const PolynomialFit& fit, const VectorizeSettings& settings,
                       StageReport& report, std::string& shortfall, Progress& progress) {
    Refiner refiner(cut, fit, settings, progress.stopToken());
    const auto wanted = size_t(settings.patches);
    refiner.flip();
    refiner.move(.15);
    if (!refiner.collapseTo(wanted, progress)) return stopped();
    // Rounds of paired splits and collapses, flips and moves.
    const int rounds = settings.refineRounds;
    constexpr double kSurplus = .3;
    for (int round = 0; round < rounds; ++round) {
        if (round > 0) {
            refiner.splitTo(size_t(double(wanted) * (1 + kSurplus * (1 - double(round) / rounds))));
            refiner.flip();
            if (!refiner.collapseTo(wanted, progress)) return stopped();
        }
        for (const double step : {.2, .1}) {
            refiner.flip();
            refiner.move(step / (1 + .5 * round));
            if (!progress.step(double(round) / rounds)) return stopped();
        }
    }
    report.figures = {{"patches", double(refiner.faceCount())}};
    constexpr double kEnough = .9;  // of the patches wanted
    if (refiner.faceCount() > wanted)
        shortfall = "features pin the mesh at " + std::to_string(refiner.faceCount()) +
                    " patches; ask for fewer features to go below";
    else if (double(refiner.faceCount()) < kEnough * double(wanted))
        shortfall = "there is room for " + std::to_string(refiner.faceCount()) +
                    " patches only: smaller ones would hardly cover a pixel";
    return cut;
}

}  // namespace tessera
