// See feature_network.h: what is wrong with a network.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>
#include <set>

#include "core/vectorize/feature_network.h"

namespace tessera {

namespace {

using Polyline = std::vector<glm::dvec2>;

constexpr double kApartPx = 1, kNodeZonePx = 4;
constexpr double kLeastAngle = 15 * std::numbers::pi / 180;

double distanceToPiece(glm::dvec2 p, glm::dvec2 a, glm::dvec2 b) {
    const glm::dvec2 d = b - a;
    const double dd = glm::dot(d, d);
    const double t = dd > 0 ? std::clamp(glm::dot(p - a, d) / dd, 0.0, 1.0) : 0;
    return glm::distance(p, a + t * d);
}

// Whether two pieces share a point, and the one where their lines meet.
bool meet(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c, glm::dvec2 d, glm::dvec2& where) {
    const double side = cross(b - a, d - c);
    if (side == 0) return false;  // along each other: too close, which is another check
    const double t = cross(c - a, d - c) / side, u = cross(c - a, b - a) / side;
    where = a + t * (b - a);
    return t >= 0 && t <= 1 && u >= 0 && u <= 1;
}

bool insidePolygon(glm::dvec2 p, const Polyline& polygon) {
    bool inside = false;
    for (size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
        const glm::dvec2 a = polygon[i], b = polygon[j];
        if ((a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x)
            inside = !inside;
    }
    return inside;
}

class Checker {
  public:
    explicit Checker(const FeatureNetwork& network) : mNetwork(network) {
        for (const FeatureSegment& s : network.segments) {
            const BezierCurve curve = curveOf(network, s);
            const int pieces = std::max(int(std::ceil(2 * curve.length())), 2);
            Polyline line{curve.p[0]};
            for (int i = 1; i < pieces; ++i) line.push_back(curve.at(double(i) / pieces));
            line.push_back(curve.p[3]);
            mLines.push_back(std::move(line));
        }
    }

    std::vector<NetworkViolation> run() {
        checkNodes();
        checkAngles();
        for (const auto& [a, b] : nearbyPairs()) checkPair(a, b);
        return std::move(mFound);
    }

  private:
    glm::dvec2 node(uint32_t n) const { return toPixels(mNetwork.nodes[n].position); }
    double importance(uint32_t s) const { return mNetwork.chains[mNetwork.segments[s].chain].importance; }
    void report(std::string what, uint32_t a, uint32_t b, bool split = false) {
        if (!split && importance(a) > importance(b)) std::swap(a, b);
        mFound.push_back({std::move(what), a, b, split});
    }

    void checkNodes() {
        const LatticePoint most{mNetwork.width * kLatticePerPixel, mNetwork.height * kLatticePerPixel};
        std::vector<uint32_t> segmentAt(mNetwork.nodes.size(), 0);
        for (uint32_t s = 0; s < mNetwork.segments.size(); ++s)
            segmentAt[mNetwork.segments[s].from] = segmentAt[mNetwork.segments[s].to] = s;
        std::map<std::pair<int, int>, std::vector<uint32_t>> cells;
        for (uint32_t n = 0; n < mNetwork.nodes.size(); ++n) {
            const LatticePoint p = mNetwork.nodes[n].position;
            const bool inside = p.x >= 0 && p.y >= 0 && p.x <= most.x && p.y <= most.y;
            const bool on = inside && (p.x == 0 || p.y == 0 || p.x == most.x || p.y == most.y);
            const uint32_t s = segmentAt[n];
            if (!inside) report("a node lies outside the picture", s, s);
            if (on != (mNetwork.nodes[n].kind == FeatureNodeKind::Border) && inside)
                report("a node's kind and the border disagree", s, s);
            const int cx = int(std::floor(node(n).x)), cy = int(std::floor(node(n).y));
            for (int y = cy - 1; y <= cy + 1; ++y)
                for (int x = cx - 1; x <= cx + 1; ++x)
                    for (const uint32_t other : cells[{x, y}])
                        if (glm::distance(node(n), node(other)) < kApartPx)
                            report("two nodes are closer than 1 px", s, segmentAt[other]);
            cells[{cx, cy}].push_back(n);
        }
    }

    void checkAngles() {
        struct Way {
            uint32_t segment;
            glm::dvec2 direction;
        };
        std::vector<std::vector<Way>> ways(mNetwork.nodes.size());
        for (uint32_t s = 0; s < mNetwork.segments.size(); ++s) {
            const BezierCurve c = curveOf(mNetwork, mNetwork.segments[s]);
            const glm::dvec2 out = c.p[1] - c.p[0], in = c.p[2] - c.p[3];
            ways[mNetwork.segments[s].from].push_back({s, out});
            ways[mNetwork.segments[s].to].push_back({s, in});
        }
        for (const auto& at : ways)
            for (size_t i = 0; i < at.size(); ++i)
                for (size_t j = i + 1; j < at.size(); ++j) {
                    const glm::dvec2 a = at[i].direction, b = at[j].direction;
                    if (std::abs(std::atan2(cross(a, b), glm::dot(a, b))) < kLeastAngle)
                        report("two segments leave a node at less than 15 degrees", at[i].segment,
                               at[j].segment);
                }
    }

    std::set<std::pair<uint32_t, uint32_t>> nearbyPairs() const {
        constexpr double kCellPx = 16;
        std::map<std::pair<int, int>, std::vector<uint32_t>> cells;
        std::set<std::pair<uint32_t, uint32_t>> pairs;
        for (uint32_t s = 0; s < mLines.size(); ++s) {
            glm::dvec2 low = mLines[s][0], high = low;
            for (const glm::dvec2 p : mLines[s])
                low = {std::min(low.x, p.x), std::min(low.y, p.y)},
                high = {std::max(high.x, p.x), std::max(high.y, p.y)};
            for (int y = int(std::floor((low.y - 1) / kCellPx)); y * kCellPx <= high.y + 1; ++y)
                for (int x = int(std::floor((low.x - 1) / kCellPx)); x * kCellPx <= high.x + 1; ++x) {
                    for (const uint32_t other : cells[{x, y}]) pairs.emplace(other, s);
                    cells[{x, y}].push_back(s);
                }
        }
        return pairs;
    }

    void checkPair(uint32_t a, uint32_t b) {
        const FeatureSegment &sa = mNetwork.segments[a], &sb = mNetwork.segments[b];
        std::vector<glm::dvec2> common;
        for (const uint32_t n : {sa.from, sa.to})
            if (n == sb.from || n == sb.to) common.push_back(node(n));
        if (common.size() > 1) return report("two segments join the same nodes", a, b, true);
        const auto atNode = [&](glm::dvec2 p, double px) {
            return std::any_of(common.begin(), common.end(),
                               [&](glm::dvec2 n) { return glm::distance(n, p) < px; });
        };
        constexpr double kTouchPx = .02;
        glm::dvec2 where;
        if (meet(node(sa.from), node(sa.to), node(sb.from), node(sb.to), where) && !atNode(where, kTouchPx))
            report("two chords cross", a, b, true);
        checkDistance(a, b, atNode);
        checkLens(a, b, atNode);
        checkLens(b, a, atNode);
    }

    template <class AtNode>
    void checkDistance(uint32_t a, uint32_t b, AtNode&& atNode) {
        bool close = false, crossing = false;
        for (size_t i = 0; i < mLines[a].size() && !crossing; ++i)
            for (size_t j = 0; j + 1 < mLines[b].size(); ++j) {
                const glm::dvec2 p = mLines[a][i], q = mLines[b][j], r = mLines[b][j + 1];
                close = close || (distanceToPiece(p, q, r) < kApartPx &&
                                  !(atNode(p, kNodeZonePx) && atNode(q, kNodeZonePx + 1)));
                glm::dvec2 where;
                if (i + 1 < mLines[a].size() && meet(p, mLines[a][i + 1], q, r, where) && !atNode(where, .05))
                    crossing = true;
            }
        if (crossing) report("two curves cross", a, b);
        if (close && !crossing) report("two curves are closer than 1 px", a, b);
    }

    // Between a's curve and its chord.
    template <class AtNode>
    void checkLens(uint32_t a, uint32_t b, AtNode&& atNode) {
        const FeatureSegment& sb = mNetwork.segments[b];
        for (const uint32_t n : {sb.from, sb.to})
            if (!atNode(node(n), 1e-9) && insidePolygon(node(n), mLines[a])) {
                report("a node lies between a curve and its chord", a, b, true);
                return;
            }
        for (size_t i = 0; i + 1 < mLines[a].size(); ++i) {
            glm::dvec2 where;
            if (meet(node(sb.from), node(sb.to), mLines[a][i], mLines[a][i + 1], where) &&
                !atNode(where, .05)) {
                report("a chord passes between a curve and its chord", a, b, true);
                return;
            }
        }
    }

    const FeatureNetwork& mNetwork;
    std::vector<Polyline> mLines;
    std::vector<NetworkViolation> mFound;
};

}  // namespace

BezierCurve curveOf(const FeatureNetwork& network, const FeatureSegment& s) {
    return {{toPixels(network.nodes[s.from].position), toPixels(s.inner[0]), toPixels(s.inner[1]),
             toPixels(network.nodes[s.to].position)}};
}

std::vector<NetworkViolation> networkViolations(const FeatureNetwork& network) {
    return Checker(network).run();
}

}  // namespace tessera
