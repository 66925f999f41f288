// See edge_blur.h.
#include "core/mesh/edge_blur.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/base/check.h"

namespace tessera {

namespace {

bool isFeature(const PatchMesh& mesh, EdgeId e) {
    return mesh.curve(e).feature && !mesh.connectivity().onBorder(e);
}

// The next halfedge of a chain, or none at its end.
HalfedgeId successor(const PatchMesh& mesh, HalfedgeId h, const std::vector<uint8_t>& featuresAt) {
    const HalfedgeMesh& c = mesh.connectivity();
    HalfedgeId next;
    if (featuresAt[c.target(h).index] != 2) return next;
    c.forEachOutgoing(c.target(h), [&](HalfedgeId g) {
        if (g != HalfedgeMesh::twin(h) && isFeature(mesh, HalfedgeMesh::edge(g))) next = g;
    });
    return next;
}

// Newton's method on (B(t) - at) . B'(t) = 0, inside [lo, hi].
double refined(const BezierCurve& curve, glm::dvec2 at, double t, double lo, double hi) {
    // The curve in powers of t costs a third of de Casteljau's algorithm.
    const auto& p = curve.p;
    const glm::dvec2 c1 = 3.0 * (p[1] - p[0]), c2 = 3.0 * (p[2] - 2.0 * p[1] + p[0]),
                     c3 = p[3] - 3.0 * (p[2] - p[1]) - p[0], c0 = p[0] - at;
    constexpr int kSteps = 5;
    constexpr double kEnough = 1e-4;  // the error left is about its square
    for (int i = 0; i < kSteps; ++i) {
        const glm::dvec2 r = c0 + t * (c1 + t * (c2 + t * c3)), d = c1 + t * (2.0 * c2 + 3.0 * t * c3),
                         d2 = 2.0 * c2 + 6.0 * t * c3;
        const double speed = glm::dot(d, d), slope = speed + glm::dot(r, d2);
        const double divisor = slope > .1 * speed ? slope : speed;
        if (divisor <= 0) return t;
        const double moved = std::clamp(t - glm::dot(r, d) / divisor, lo, hi);
        if (std::abs(moved - t) < kEnough) return moved;
        t = moved;
    }
    return t;
}

}  // namespace

double EdgeBlur::Feature::arcAt(double t) const {
    const double s = t * kSegments;
    const int i = std::min(int(s), kSegments - 1);
    return arc[size_t(i)] + (s - i) * (arc[size_t(i) + 1] - arc[size_t(i)]);
}

glm::vec2 EdgeBlur::Feature::domainAt(int side, double t) const {
    const int corner = sides[size_t(side)];
    Barycentric b(0);
    b[corner] = side == 0 ? 1 - t : t;
    b[(corner + 1) % 3] = side == 0 ? t : 1 - t;
    return glm::vec2(domainPoint(b));
}

EdgeBlur::EdgeBlur(const PatchMesh& mesh, double sharpen) {
    TESSERA_CHECK(sharpen >= 0);
    bool any = false;
    if (sharpen > 0)
        mesh.forEachEdge([&](EdgeId e) {
            const EdgeCurve& curve = mesh.curve(e);
            any = any || (curve.feature && (curve.blurSigma[0] > 0 || curve.blurSigma[1] > 0));
        });
    if (!any) return;
    collectChains(mesh, sharpen);
    collectReaches(mesh);
}

void EdgeBlur::collectChains(const PatchMesh& mesh, double sharpen) {
    const HalfedgeMesh& c = mesh.connectivity();
    std::vector<uint8_t> featuresAt(c.vertexCapacity(), 0);  // 3 stands for more, too
    mesh.forEachEdge([&](EdgeId e) {
        if (!isFeature(mesh, e)) return;
        const HalfedgeId h = HalfedgeMesh::halfedge(e);
        for (const VertexId v : {c.origin(h), c.target(h)})
            featuresAt[v.index] = uint8_t(std::min(3, featuresAt[v.index] + 1));
    });
    mFeatureOf.assign(c.edgeCapacity(), kNone);
    mesh.forEachEdge([&](EdgeId e) {
        if (mFeatureOf[e.index] != kNone || !isFeature(mesh, e)) return;
        HalfedgeId first = HalfedgeMesh::halfedge(e);
        bool closed = false;
        for (HalfedgeId back = successor(mesh, HalfedgeMesh::twin(first), featuresAt); back.valid();
             back = successor(mesh, back, featuresAt)) {
            first = HalfedgeMesh::twin(back);
            closed = HalfedgeMesh::edge(first) == e;
            if (closed) break;
        }
        std::vector<HalfedgeId> run{first};
        for (HalfedgeId h = successor(mesh, first, featuresAt); h.valid() && h != first;
             h = successor(mesh, h, featuresAt))
            run.push_back(h);
        addChain(mesh, run, closed, sharpen, featuresAt);
    });
}

void EdgeBlur::addChain(const PatchMesh& mesh, const std::vector<HalfedgeId>& run, bool closed,
                        double sharpen, const std::vector<uint8_t>& featuresAt) {
    const HalfedgeMesh& c = mesh.connectivity();
    const size_t first = mFeatures.size();
    Chain chain;
    for (const HalfedgeId h : run) {
        Feature f;
        f.halfedge = h;
        f.chain = uint32_t(mChains.size());
        f.curve = toPixels(mesh.controlPoints(h));
        const auto& p = f.curve.p;
        f.box = {glm::min(glm::min(p[0], p[1]), glm::min(p[2], p[3])),
                 glm::max(glm::max(p[0], p[1]), glm::max(p[2], p[3]))};
        const auto& sigma = mesh.curve(HalfedgeMesh::edge(h)).blurSigma;
        const bool forward = HalfedgeMesh::halfedge(HalfedgeMesh::edge(h)) == h;
        f.sigma = {sharpen * double(sigma[forward ? 0 : 1]), sharpen * double(sigma[forward ? 1 : 0])};
        const glm::dvec2 along = unit(p[3] - p[0]);
        const glm::dvec2 begin = unit(f.curve.derivative(0)), end = unit(f.curve.derivative(1));
        f.endTangents = {begin == glm::dvec2(0) ? along : begin, end == glm::dvec2(0) ? along : end};
        const HalfedgeId beside[] = {h, HalfedgeMesh::twin(h)};
        for (size_t k = 0; k < 2; ++k) {
            f.patches[k] = c.face(beside[k]);
            const auto sides = c.sides(f.patches[k]);
            f.sides[k] = uint8_t(std::find(sides.begin(), sides.end(), beside[k]) - sides.begin());
        }
        f.arc[0] = chain.length;
        for (size_t i = 0; i < kSegments; ++i) {
            f.chords[i] = {f.curve.at(double(i) / kSegments), f.curve.at(double(i + 1) / kSegments)};
            f.arc[i + 1] = chain.length += glm::length(f.chords[i].along);
        }
        // |B''| / 8 times the square of the step.
        f.flatness = .75 *
                     std::max(glm::length(p[0] - 2.0 * p[1] + p[2]), glm::length(p[1] - 2.0 * p[2] + p[3])) /
                     (kSegments * kSegments);
        f.base = {p[0], p[3]};
        f.bend = std::sqrt(std::max(f.base.nearest(p[1]).second, f.base.nearest(p[2]).second));
        const auto third = straightCurve(p[0], p[3]).p;
        constexpr double kEven = .1;
        f.even = std::max(glm::distance(p[1], third[1]), glm::distance(p[2], third[2])) <
                 kEven * glm::length(f.base.along);
        chain.reach = std::max(chain.reach, kBlurReach * std::max(f.sigma[0], f.sigma[1]));
        mFeatureOf[HalfedgeMesh::edge(h).index] = uint32_t(mFeatures.size());
        mFeatures.push_back(f);
    }
    joinTangents(first, closed);
    const auto fades = [&](VertexId v) { return !(c.onBorder(v) && featuresAt[v.index] == 1); };
    chain.fadesAtBegin = !closed && fades(c.origin(run.front()));
    chain.fadesAtEnd = !closed && fades(c.target(run.back()));
    mChains.push_back(chain);
}

void EdgeBlur::joinTangents(size_t first, bool closed) {
    for (size_t i = first; i < mFeatures.size(); ++i) {
        const bool last = i + 1 == mFeatures.size();
        if (last && !closed) break;
        Feature& a = mFeatures[i];
        Feature& b = mFeatures[last ? first : i + 1];
        a.endTangents[1] = b.endTangents[0] = a.endTangents[1] + b.endTangents[0];
    }
}

void EdgeBlur::collectReaches(const PatchMesh& mesh) {
    const HalfedgeMesh& c = mesh.connectivity();
    std::vector<Box> boxes(c.faceCapacity());
    mesh.forEachPatch([&](PatchId p) {
        const auto control = mesh.controlPoints(p).p;
        LatticePoint lo = control[0], hi = lo;
        for (const LatticePoint q : control) {
            lo = {std::min(lo.x, q.x), std::min(lo.y, q.y)};
            hi = {std::max(hi.x, q.x), std::max(hi.y, q.y)};
        }
        boxes[p.index] = {toPixels(lo), toPixels(hi)};
    });
    std::vector<std::pair<PatchId, Reach>> found;
    std::vector<uint8_t> sides(c.faceCapacity(), 0);  // of the feature at hand
    std::vector<PatchId> queue;
    for (uint32_t i = 0; i < mFeatures.size(); ++i) {
        const Feature& f = mFeatures[i];
        if (f.sigma[0] <= 0 && f.sigma[1] <= 0) continue;
        const double reach = mChains[f.chain].reach;
        const size_t begin = found.size();
        for (uint8_t side = 0; side < 2; ++side) {
            const auto bit = uint8_t(1 << side);
            const auto visit = [&](PatchId p) {
                if (sides[p.index] & bit) return;
                if (!sides[p.index]) found.push_back({p, {i, 0}});
                sides[p.index] |= bit;
                queue.push_back(p);
            };
            visit(f.patches[side]);
            while (!queue.empty()) {
                const PatchId p = queue.back();
                queue.pop_back();
                for (const HalfedgeId h : c.sides(p)) {
                    const PatchId q = c.face(HalfedgeMesh::twin(h));
                    if (!q.valid() || mesh.curve(HalfedgeMesh::edge(h)).feature) continue;
                    const Box& box = boxes[q.index];
                    const glm::dvec2 gap =
                        glm::max(glm::max(box.lo - f.box.hi, f.box.lo - box.hi), glm::dvec2(0));
                    if (glm::dot(gap, gap) <= reach * reach) visit(q);
                }
            }
        }
        for (size_t k = begin; k < found.size(); ++k) {
            auto& [p, r] = found[k];
            r.sides = sides[p.index];
            sides[p.index] = 0;
        }
    }
    mFirst.assign(c.faceCapacity() + 1, 0);
    for (const auto& [p, r] : found) ++mFirst[p.index + 1];
    for (size_t i = 1; i < mFirst.size(); ++i) mFirst[i] += mFirst[i - 1];
    std::vector<uint32_t> next(mFirst.begin(), mFirst.end() - 1);
    mReaches.resize(found.size());
    for (const auto& [p, r] : found) mReaches[next[p.index]++] = r;
}

EdgeBlur::Segment::Segment(glm::dvec2 a, glm::dvec2 b) : from(a), along(b - a) {
    const double squared = glm::dot(along, along);
    inverse = squared > 0 ? 1 / squared : 0;
}

std::pair<double, double> EdgeBlur::Segment::nearest(glm::dvec2 at) const {
    const glm::dvec2 to = at - from;
    const double s = std::clamp(glm::dot(to, along) * inverse, 0.0, 1.0);
    const glm::dvec2 off = to - s * along;
    return {s, glm::dot(off, off)};
}

// Whether the feature has a point nearer than foot.distance; then that is the new foot.
bool EdgeBlur::findFoot(const Feature& f, glm::dvec2 at, Foot& foot) {
    const auto square = [](double x) { return x * x; };
    const auto [share, fromBase] = f.base.nearest(at);
    if (fromBase >= square(foot.distance + f.bend)) return false;
    double t = share;
    if (!f.even) {
        double best = HUGE_VAL;
        for (size_t i = 0; i < kSegments; ++i) {
            const auto [s, squared] = f.chords[i].nearest(at);
            if (squared >= best) continue;
            best = squared;
            t = (double(i) + s) / kSegments;
        }
        if (best >= square(foot.distance + f.flatness)) return false;
    }
    const double span = f.even ? kEvenSpan : 1.0 / kSegments;
    Foot found{0, kNearer * foot.distance};
    bool nearer = false;  // The start, too: Newton's method may leave for a worse place.
    for (const double candidate :
         {refined(f.curve, at, t, std::max(0.0, t - span), std::min(1.0, t + span)), t}) {
        const double distance = glm::distance(f.curve.at(candidate), at);
        if (distance >= found.distance) continue;
        found = {candidate, distance};
        nearer = true;
    }
    if (nearer) foot = found;
    return nearer;
}

double EdgeBlur::fade(const Feature& f, double t, double sigma) const {
    const Chain& chain = mChains[f.chain];
    if (!chain.fadesAtBegin && !chain.fadesAtEnd) return 1;
    const double arc = f.arcAt(t);
    return blurFade(
        std::min(chain.fadesAtBegin ? arc : HUGE_VAL, chain.fadesAtEnd ? chain.length - arc : HUGE_VAL),
        sigma);
}

double EdgeBlur::strength(EdgeId e, double t) const {
    if (mFeatureOf.empty() || mFeatureOf[e.index] == kNone) return 0;
    const Feature& f = mFeatures[mFeatureOf[e.index]];
    const double along = f.halfedge == HalfedgeMesh::halfedge(e) ? t : 1 - t, sigma = f.sigmaAt(along);
    return sigma > 0 ? fade(f, along, sigma) : 0;
}

// 0 left, 1 right.
int EdgeBlur::sideOf(const Feature& f, const Reach& reach, PatchId p, glm::dvec2 at, double t) {
    if (p == f.patches[0]) return 0;
    if (p == f.patches[1]) return 1;
    if (reach.sides != 3) return reach.sides == 1 ? 0 : 1;
    const glm::dvec2 tangent = t <= 0 ? f.endTangents[0] : t >= 1 ? f.endTangents[1] : f.curve.derivative(t);
    return cross(tangent, at - f.curve.at(t)) > 0 ? 0 : 1;
}

int EdgeBlur::terms(PatchId p, glm::dvec2 at, std::array<BlurTerm, kMaxBlurTerms>& out) const {
    if (!inReach(p)) return 0;
    int count = 0;
    for (size_t i = mFirst[p.index], end = mFirst[p.index + 1]; i < end;) {
        const uint32_t chainIndex = mFeatures[mReaches[i].feature].chain;
        Foot foot{0, mChains[chainIndex].reach};
        const Reach* nearest = nullptr;
        for (; i < end && mFeatures[mReaches[i].feature].chain == chainIndex; ++i)
            if (findFoot(mFeatures[mReaches[i].feature], at, foot)) nearest = &mReaches[i];
        BlurTerm term;
        if (!nearest || !termAt(p, *nearest, at, foot, term, blurShare)) continue;
        if (count < kMaxBlurTerms) {
            out[size_t(count++)] = term;
        } else {
            const auto least = std::min_element(
                out.begin(), out.end(), [](const auto& a, const auto& b) { return a.weight < b.weight; });
            if (least->weight < term.weight) *least = term;
        }
    }
    return count;
}

std::shared_ptr<const EdgeBlur> EdgeBlurCache::get(const PatchMesh& mesh, double sharpen) {
    const std::lock_guard lock(mMutex);
    MeshGeometry geometry = mesh.geometry();
    if (!mBlur || mSharpen != sharpen || mGeometry != geometry) {
        mBlur = std::make_shared<const EdgeBlur>(mesh, sharpen);
        mSharpen = sharpen;
        mGeometry = std::move(geometry);
    }
    return mBlur;
}

std::shared_ptr<const EdgeBlur> edgeBlurOf(const PatchMesh& mesh, double sharpen) {
    if (const auto& cache = mesh.edgeBlurCache()) return cache->get(mesh, sharpen);
    return std::make_shared<const EdgeBlur>(mesh, sharpen);
}

void blurredColour(const PatchMesh& mesh, const EdgeBlur& blur, PatchId p, const Barycentric& at,
                   glm::dvec2 point, double* out) {
    std::array<BlurTerm, kMaxBlurTerms> terms;
    const int count = blur.terms(p, point, terms);
    for (int c = 0; c < mesh.channels(); ++c) {
        out[c] = evaluateSpline(mesh.spline(p), c, domainPoint(at));
        for (int i = 0; i < count; ++i) {
            const BlurTerm& t = terms[size_t(i)];
            out[c] += double(t.weight) * (evaluateSpline(mesh.spline(t.other), c, t.otherAt) -
                                          evaluateSpline(mesh.spline(t.own), c, t.ownAt));
        }
    }
}

}  // namespace tessera
