// See feature_network.h.
#include "core/vectorize/feature_network.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "core/base/check.h"
#include "core/vectorize/feature_joins.h"
#include "core/vectorize/feature_separation.h"

namespace tessera {

namespace {

constexpr double kLeastSegmentPx = 4, kMostSegmentPx = 40;
constexpr double kMostTurn = 75 * std::numbers::pi / 180;
constexpr int kTangentPoints = 3;
// After so many rounds of mending parts of chains, whole chains go.
constexpr int kMendRounds = 8;

using Cuts = std::map<uint32_t, std::set<uint32_t>>;  // wanted nodes, by chain

int pointCount(const FeatureChain& chain) {
    return int(chain.points.size());
}
const glm::dvec2& pointAt(const FeatureChain& chain, int i) {
    const int n = pointCount(chain);
    return chain.points[size_t(((i % n) + n) % n)].position;
}
int stepsBetween(const FeatureChain& chain, uint32_t first, uint32_t last) {
    const int n = pointCount(chain), steps = int(last) - int(first);
    return chain.closed && steps <= 0 ? steps + n : steps;
}

// How many points there are from `at` on (forward or back) before a corner or the end, at most `most`.
int roomAt(const FeatureChain& chain, uint32_t at, int step, int most) {
    const int n = pointCount(chain);
    for (int k = 1; k <= most; ++k) {
        const int i = int(at) + step * k;
        if (!chain.closed && (i < 0 || i >= n)) return k - 1;
        if (std::binary_search(chain.corners.begin(), chain.corners.end(), uint32_t(((i % n) + n) % n)))
            return k;
    }
    return most;
}

bool hasOneSide(const FeatureChain& chain, uint32_t at) {
    if (!chain.closed && (at == 0 || int(at) + 1 == pointCount(chain))) return true;
    return std::binary_search(chain.corners.begin(), chain.corners.end(), at);
}

// Unit tangent at a point, in the direction `step` (1 or -1) of the chain's points: at corners and ends that
// of the side toward which it points.
glm::dvec2 tangentAt(const FeatureChain& chain, uint32_t at, int step, int most) {
    const int i = int(at);
    if (!hasOneSide(chain, at)) {
        const int k = std::max(
            std::min(roomAt(chain, at, 1, kTangentPoints), roomAt(chain, at, -1, kTangentPoints)), 1);
        return unit(double(step) * (pointAt(chain, i + k) - pointAt(chain, i - k)));
    }
    // The derivative at the end of the parabola through three points.
    const int half = std::min(roomAt(chain, at, step, 2 * kTangentPoints), most) / 2;
    if (half < 1) return unit(pointAt(chain, i + step) - pointAt(chain, i));
    return unit(4.0 * (pointAt(chain, i + step * half) - pointAt(chain, i)) -
                (pointAt(chain, i + 2 * step * half) - pointAt(chain, i)));
}

// Least squares for the lengths of the end tangents (Schneider 1990).
BezierCurve withTangents(const std::vector<glm::dvec2>& points, const std::vector<double>& at,
                         glm::dvec2 start, glm::dvec2 end) {
    const glm::dvec2 a = points.front(), b = points.back();
    double ss = 0, se = 0, ee = 0, rs = 0, re = 0;
    for (size_t i = 1; i + 1 < points.size(); ++i) {
        const double t = at[i], s = 1 - t;
        const glm::dvec2 u = 3 * s * s * t * start, v = 3 * s * t * t * end;
        const glm::dvec2 rest = points[i] - (s * s * s + 3 * s * s * t) * a - (3 * s * t * t + t * t * t) * b;
        ss += glm::dot(u, u), se += glm::dot(u, v), ee += glm::dot(v, v);
        rs += glm::dot(u, rest), re += glm::dot(v, rest);
    }
    const double chord = glm::distance(a, b), det = ss * ee - se * se;
    double p = chord / 3, q = chord / 3;
    if (det > 1e-9 * ss * ee) p = (ee * rs - se * re) / det, q = (ss * re - se * rs) / det;
    p = std::clamp(p, .15 * chord, .7 * chord);
    q = std::clamp(q, .15 * chord, .7 * chord);
    return {{a, a + p * start, b + q * end, b}};
}

double turnOf(const BezierCurve& c) {
    double turn = 0;
    for (size_t i = 0; i < 2; ++i) {
        const glm::dvec2 a = c.p[i + 1] - c.p[i], b = c.p[i + 2] - c.p[i + 1];
        turn += std::abs(std::atan2(cross(a, b), glm::dot(a, b)));
    }
    return turn;
}

BezierCurve withoutTangents(const FeatureChain& chain, uint32_t first, uint32_t last) {
    std::vector<glm::dvec2> points;
    for (int k = 0; k <= stepsBetween(chain, first, last); ++k)
        points.push_back(pointAt(chain, int(first) + k));
    const BezierCurve curve = fitCurve(points);
    return turnOf(curve) <= kMostTurn ? curve : straightCurve(points.front(), points.back());
}

class Builder {
  public:
    Builder(FeatureNetwork& network, const VectorizeSettings& settings, const Cuts& cuts)
        : mNetwork(network), mTolerance(settings.featureTolerancePx), mCuts(cuts) {}

    void build() {
        mNetwork.nodes.clear();
        mNetwork.segments.clear();
        for (uint32_t c = 0; c < mNetwork.chains.size(); ++c) addChain(c);
    }

  private:
    void addChain(uint32_t c) {
        FeatureChain& chain = mNetwork.chains[c];
        const auto n = uint32_t(chain.points.size());
        std::set<uint32_t> stops(chain.corners.begin(), chain.corners.end());
        if (const auto at = mCuts.find(c); at != mCuts.end())
            stops.insert(at->second.begin(), at->second.end());
        if (!chain.closed) stops.insert({0, n - 1});
        const uint32_t start = stops.empty() ? 0 : *stops.begin();
        mArc.assign(1, 0);  // from `start` on, once around
        for (uint32_t k = 1; k <= (chain.closed ? n : n - 1); ++k)
            mArc.push_back(mArc.back() +
                           glm::distance(pointAt(chain, int(start + k) - 1), pointAt(chain, int(start + k))));
        std::vector<uint32_t> ends;  // steps from `start`
        for (const uint32_t stop : stops)
            if (stop != start) ends.push_back(stop - start);
        if (chain.closed) ends.push_back(n);
        // Corners too close to another stop to make a segment are none.
        std::vector<uint32_t> kept;
        for (const uint32_t end : ends) {
            const bool final = end == ends.back();
            while (final && !kept.empty() && mArc[end] - mArc[kept.back()] < kLeastSegmentPx) kept.pop_back();
            if (final || mArc[end] - (kept.empty() ? 0 : mArc[kept.back()]) >= kLeastSegmentPx)
                kept.push_back(end);
        }
        uint32_t from = 0, node = addNode(c, start);
        const uint32_t firstNode = node;
        for (const uint32_t end : kept)
            while (from < end) {
                const uint32_t to = reach(chain, start, from, end);
                const bool closes = chain.closed && to == n;
                const uint32_t next = closes ? firstNode : addNode(c, (start + to) % n);
                addSegment(c, node, next, (start + from) % n, (start + to) % n);
                node = next;
                from = to;
            }
    }

    // How far a segment from step `from` goes, at most to `end`: as far as it fits, but leaving room for
    // another one.
    uint32_t reach(const FeatureChain& chain, uint32_t start, uint32_t from, uint32_t end) const {
        const auto n = uint32_t(chain.points.size());
        const auto length = [&](uint32_t to) { return mArc[to] - mArc[from]; };
        const auto fits = [&](uint32_t to) {
            return length(to) <= kMostSegmentPx &&
                   fitChainPart(chain, (start + from) % n, (start + to) % n, mTolerance).has_value();
        };
        if (fits(end) || length(end) < 2 * kLeastSegmentPx) return end;
        uint32_t good = from + 1;
        while (length(good) < kLeastSegmentPx) ++good;
        uint32_t step = 4;
        while (good + step < end && fits(good + step)) good += step, step *= 2;
        for (; step > 0; step /= 2)
            if (good + step < end && fits(good + step)) good += step;
        while (mArc[end] - mArc[good] < kLeastSegmentPx) --good;
        return std::max(good, from + 1);
    }

    uint32_t addNode(uint32_t c, uint32_t point) {
        FeatureChain& chain = mNetwork.chains[c];
        FeaturePoint& p = chain.points[point];
        const LatticePoint at = toLattice(p.position);
        p.position = toPixels(at);
        FeatureNodeKind kind = hasOneSide(chain, point) ? FeatureNodeKind::Corner : FeatureNodeKind::Smooth;
        const bool first = point == 0, last = point + 1 == chain.points.size();
        if (!chain.closed && (first || last)) {
            const ChainEnd end = chain.ends[last];
            kind = end == ChainEnd::Tip      ? FeatureNodeKind::Tip
                   : end == ChainEnd::Border ? FeatureNodeKind::Border
                                             : FeatureNodeKind::Junction;
            if (kind == FeatureNodeKind::Junction) {
                const auto [known, isNew] =
                    mJunctions.try_emplace({at.x, at.y}, uint32_t(mNetwork.nodes.size()));
                if (!isNew) return known->second;
            }
        }
        mNetwork.nodes.push_back({at, kind});
        return uint32_t(mNetwork.nodes.size() - 1);
    }

    void addSegment(uint32_t c, uint32_t from, uint32_t to, uint32_t first, uint32_t last) {
        const FeatureChain& chain = mNetwork.chains[c];
        // What is too short to be split further may be less exact, or turn at its nodes.
        std::optional<BezierCurve> curve = fitChainPart(chain, first, last, mTolerance);
        if (!curve) curve = fitChainPart(chain, first, last, 3 * mTolerance);
        const BezierCurve best = curve ? *curve : withoutTangents(chain, first, last);
        FeatureSegment s{from, to, c, first, last, {toLattice(best.p[1]), toLattice(best.p[2])}, {}};
        s.sigma = {chain.points[first].sigma, chain.points[last].sigma};
        if (!curve)
            for (const uint32_t node : {from, to})
                if (mNetwork.nodes[node].kind == FeatureNodeKind::Smooth)
                    mNetwork.nodes[node].kind = FeatureNodeKind::Corner;
        mNetwork.segments.push_back(s);
    }

    FeatureNetwork& mNetwork;
    double mTolerance;
    const Cuts& mCuts;
    std::vector<double> mArc;
    std::map<std::pair<int32_t, int32_t>, uint32_t> mJunctions;
};

// Splits or gives up what is wrong; whole chains where `whole`. Cuts of chains that change are forgotten.
void mend(FeatureNetwork& network, const std::vector<NetworkViolation>& violations, bool whole, Cuts& cuts) {
    std::vector<std::vector<bool>> drop(network.chains.size());
    for (const NetworkViolation& v : violations) {
        const FeatureSegment& s = network.segments[v.weaker];
        const FeatureChain& chain = network.chains[s.chain];
        const int steps = stepsBetween(chain, s.first, s.last), n = pointCount(chain);
        const double length = curveOf(network, s).length();
        if (v.mayNeedSplit && !whole && length >= 2 * kLeastSegmentPx + 1) {
            cuts[s.chain].insert(uint32_t((int(s.first) + steps / 2) % n));
            continue;
        }
        auto& gone = drop[s.chain];
        gone.resize(chain.points.size(), whole);
        for (int k = 0; k <= steps; ++k) gone[size_t((int(s.first) + k) % n)] = true;
    }
    std::vector<FeatureChain> kept;
    Cuts keptCuts;
    for (uint32_t c = 0; c < network.chains.size(); ++c) {
        if (drop[c].empty()) {
            if (const auto at = cuts.find(c); at != cuts.end()) keptCuts[uint32_t(kept.size())] = at->second;
            kept.push_back(std::move(network.chains[c]));
            continue;
        }
        for (FeatureChain& part : withoutPoints(std::move(network.chains[c]), drop[c]))
            if (lengthPx(part) >= kLeastSegmentPx) kept.push_back(std::move(part));
    }
    const bool changed = std::any_of(drop.begin(), drop.end(), [](const auto& d) { return !d.empty(); });
    if (changed) {
        kept = settleJunctions(std::move(kept));
        keptCuts.clear();
    }
    network.chains = std::move(kept);
    cuts = std::move(keptCuts);
}

}  // namespace

std::optional<BezierCurve> fitChainPart(const FeatureChain& chain, uint32_t first, uint32_t last,
                                        double tolerancePx) {
    const int steps = stepsBetween(chain, first, last);
    TESSERA_CHECK(steps >= 1);
    std::vector<glm::dvec2> points;
    std::vector<double> at(1, 0);
    for (int k = 0; k <= steps; ++k) {
        points.push_back(pointAt(chain, int(first) + k));
        if (k > 0) at.push_back(at.back() + glm::distance(points[size_t(k) - 1], points[size_t(k)]));
    }
    if (at.back() <= 0) return {};
    const double total = at.back();
    for (double& t : at) t /= total;
    const glm::dvec2 start = tangentAt(chain, first, 1, steps), end = tangentAt(chain, last, -1, steps);
    BezierCurve curve;
    constexpr int kRounds = 4, kLeastRounds = 2;  // of reparametrization
    for (int round = 0; round < kRounds; ++round) {
        curve = withTangents(points, at, start, end);
        double worst = 0;
        for (size_t i = 1; i + 1 < points.size(); ++i) {
            const glm::dvec2 d = curve.derivative(at[i]), r = points[i] - curve.at(at[i]);
            const double dd = glm::dot(d, d);
            if (dd > 0) at[i] = std::clamp(at[i] + glm::dot(r, d) / dd, 0.0, 1.0);
            worst = std::max(worst, glm::distance(points[i], curve.at(at[i])));
        }
        if (worst > 8 * tolerancePx) return {};
        if (round >= kLeastRounds && worst <= tolerancePx)
            return turnOf(curve) <= kMostTurn ? std::optional(curve) : std::nullopt;
    }
    return {};
}

FeatureNetwork buildFeatureNetwork(std::vector<FeatureChain> chains, int width, int height,
                                   const VectorizeSettings& settings, const std::stop_token& stop) {
    FeatureNetwork network{width, height, {}, {}, {}};
    network.chains = separated(std::move(chains), width, height, 1.5 * kLeastSegmentPx, stop);
    limitBlur(network.chains, stop);
    Cuts cuts;
    for (int round = 0; !stop.stop_requested(); ++round) {  // in the end each gives up a chain or more
        Builder(network, settings, cuts).build();
        const std::vector<NetworkViolation> violations = networkViolations(network);
        if (violations.empty()) return network;
        mend(network, violations, round >= kMendRounds, cuts);
    }
    return network;
}

}  // namespace tessera
