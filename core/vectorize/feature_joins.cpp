// See feature_joins.h.
#include "core/vectorize/feature_joins.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "core/vectorize/point_grid.h"

namespace tessera {

namespace {

constexpr double kTipGapPx = 4, kTouchPx = 2, kHeadingPx = 3;
constexpr double kContinues = .64;  // cosine of 50 degrees
constexpr double kHeads = .77;      // cosine of 40 degrees
// Junctions closer than this along a chain are one; a tip does not run into its own chain this near its end.
constexpr double kSamePlacePx = 2.5, kOwnTailPx = 8;
constexpr double kMostGapPx = 1;

void appendGap(std::vector<FeaturePoint>& points, const FeaturePoint& to) {
    const FeaturePoint from = points.back();
    const double gap = glm::distance(from.position, to.position);
    const int steps = int(std::ceil(gap / kMostGapPx));
    for (int i = 1; i < steps; ++i) {
        FeaturePoint p = 2 * i < steps ? from : to;
        p.position = from.position + (to.position - from.position) * (double(i) / steps);
        points.push_back(p);
    }
}

// Appends `next` to `chain`; where both have the same point at the join, once.
void append(FeatureChain& chain, const FeatureChain& next) {
    constexpr double kSamePx = .3;
    // Tips of different scales may overlap: the second gives way.
    const glm::dvec2 ahead = outward(chain, true), at = chain.points.back().position;
    size_t skip = 0;
    while (skip + 4 < next.points.size() && skip < 4 &&
           (glm::distance(next.points[skip].position, at) < kSamePx ||
            glm::dot(next.points[skip].position - at, ahead) < 0))
        ++skip;
    appendGap(chain.points, next.points[skip]);
    const size_t offset = chain.points.size() - skip;
    chain.points.insert(chain.points.end(), next.points.begin() + std::ptrdiff_t(skip), next.points.end());
    for (const uint32_t corner : next.corners)
        if (corner >= skip) chain.corners.push_back(uint32_t(corner + offset));
    chain.ends[1] = next.ends[1];
    chain.importance += next.importance;
}

void close(FeatureChain& chain) {
    if (glm::distance(chain.points.front().position, chain.points.back().position) < .3)
        chain.points.pop_back();
    std::erase_if(chain.corners, [&](uint32_t c) { return c >= chain.points.size(); });
    appendGap(chain.points, FeaturePoint(chain.points.front()));
    chain.closed = true;
    chain.ends = {ChainEnd::Tip, ChainEnd::Tip};
}

struct Candidate {
    double cost;
    uint32_t a, b;
    auto operator<=>(const Candidate&) const = default;
};

class DisjointSets {
  public:
    explicit DisjointSets(size_t count) : mParent(count) { std::iota(mParent.begin(), mParent.end(), 0U); }
    uint32_t add() {
        mParent.push_back(uint32_t(mParent.size()));
        return mParent.back();
    }
    uint32_t root(uint32_t i) {
        while (mParent[i] != i) i = mParent[i] = mParent[mParent[i]];
        return i;
    }
    void unite(uint32_t a, uint32_t b) {
        a = root(a), b = root(b);
        mParent[std::max(a, b)] = std::min(a, b);
    }

  private:
    std::vector<uint32_t> mParent;
};

// A place in the middle of a chain where another runs into it.
struct Cut {
    uint32_t point;
    uint32_t item;  // in the disjoint sets, after the ends
};

// What the tips of all chains run into, as sets of ends and cuts.
struct Meetings {
    DisjointSets sets;
    std::vector<std::vector<Cut>> cuts;  // by chain
};

struct Target {
    double cost = 1e9;
    uint32_t chain = 0, point = 0;
};

Target targetOf(const std::vector<FeatureChain>& chains, const std::vector<std::vector<double>>& arcs,
                const PointGrid& grid, uint32_t end) {
    const uint32_t own = end / 2;
    const glm::dvec2 at = endPoint(chains, end).position, ahead = outward(chains[own], end % 2);
    Target best;
    grid.near(at, kHeadingPx, [&](PointGrid::Entry e) {
        if (e.chain == own) {
            const double along = end % 2 ? arcs[own].back() - arcs[own][e.point] : arcs[own][e.point];
            if (along < kOwnTailPx) return;
        }
        const glm::dvec2 step = chains[e.chain].points[e.point].position - at;
        const double distance = glm::length(step);
        const double heading = distance > 0 ? glm::dot(step, ahead) / distance : 1;
        if (distance > kTouchPx && (distance > kHeadingPx || heading < kHeads)) return;
        const double cost = distance * (2 - heading);
        if (cost < best.cost) best = {cost, e.chain, e.point};
    });
    return best;
}

Meetings findMeetings(const std::vector<FeatureChain>& chains) {
    std::vector<std::vector<double>> arcs;
    for (const FeatureChain& chain : chains) arcs.push_back(arcLengths(chain));
    const PointGrid grid(chains);
    Meetings meetings{DisjointSets(2 * chains.size()), std::vector<std::vector<Cut>>(chains.size())};
    for (uint32_t end = 0; end < 2 * chains.size(); ++end) {
        const FeatureChain& chain = chains[end / 2];
        if (chain.closed || chain.ends[end % 2] != ChainEnd::Tip) continue;
        const Target target = targetOf(chains, arcs, grid, end);
        if (target.cost >= 1e9) continue;
        const uint32_t c = target.chain;
        const auto& arc = arcs[c];
        if (!chains[c].closed && arc[target.point] < kSamePlacePx) {
            meetings.sets.unite(end, 2 * c);
        } else if (!chains[c].closed && arc.back() - arc[target.point] < kSamePlacePx) {
            meetings.sets.unite(end, 2 * c + 1);
        } else {
            auto& cuts = meetings.cuts[c];
            const auto same = std::find_if(cuts.begin(), cuts.end(), [&](const Cut& cut) {
                return std::abs(arc[cut.point] - arc[target.point]) < kSamePlacePx;
            });
            const bool isNew = same == cuts.end();
            const uint32_t item = isNew ? meetings.sets.add() : same->item;
            if (isNew) cuts.push_back({target.point, item});
            meetings.sets.unite(end, item);
        }
    }
    return meetings;
}

// Makes `at` the chain's end: points closer to it than a regular step give way.
void moveEnd(FeatureChain& chain, bool last, glm::dvec2 at) {
    constexpr double kGivesWayPx = .6;
    if (!last) reverse(chain);
    FeaturePoint end = chain.points.back();
    while (chain.points.size() > 2 && glm::distance(chain.points.back().position, at) < kGivesWayPx)
        chain.points.pop_back();
    end.position = at;
    appendGap(chain.points, end);
    chain.points.push_back(end);
    chain.ends[1] = ChainEnd::Junction;
    if (!last) reverse(chain);
}

// The parts of a chain between its cuts.
std::vector<FeatureChain> cutApart(FeatureChain chain, std::vector<Cut> cuts) {
    if (cuts.empty()) return {std::move(chain)};
    std::sort(cuts.begin(), cuts.end(), [](const Cut& a, const Cut& b) { return a.point < b.point; });
    auto& points = chain.points;
    if (chain.closed) {
        const uint32_t turn = cuts.front().point;
        std::rotate(points.begin(), points.begin() + turn, points.end());
        points.push_back(FeaturePoint(points.front()));
        for (Cut& cut : cuts) cut.point -= turn;
        cuts.erase(cuts.begin());
        chain.closed = false;
        chain.ends = {ChainEnd::Junction, ChainEnd::Junction};
    }
    std::vector<FeatureChain> parts;
    uint32_t from = 0;
    for (size_t i = 0; i <= cuts.size(); ++i) {
        const uint32_t to = i < cuts.size() ? cuts[i].point : uint32_t(points.size() - 1);
        FeatureChain part;
        part.points.assign(points.begin() + from, points.begin() + to + 1);
        part.ends = {i == 0 ? chain.ends[0] : ChainEnd::Junction,
                     i == cuts.size() ? chain.ends[1] : ChainEnd::Junction};
        parts.push_back(std::move(part));
        from = to;
    }
    return parts;
}

// Ends by their position, those at the same one beside each other.
std::vector<uint32_t> endsByPlace(const std::vector<FeatureChain>& chains) {
    std::vector<uint32_t> ends;
    for (uint32_t end = 0; end < 2 * chains.size(); ++end)
        if (!chains[end / 2].closed) ends.push_back(end);
    const auto key = [&](uint32_t end) {
        const glm::dvec2 p = endPoint(chains, end).position;
        return std::tuple(p.x, p.y, end);
    };
    std::sort(ends.begin(), ends.end(), [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
    return ends;
}

}  // namespace

std::vector<double> arcLengths(const FeatureChain& chain) {
    std::vector<double> arc(chain.points.size(), 0);
    for (size_t i = 1; i < arc.size(); ++i)
        arc[i] = arc[i - 1] + glm::distance(chain.points[i - 1].position, chain.points[i].position);
    return arc;
}

glm::dvec2 outward(const FeatureChain& chain, bool last, double spanPx) {
    const auto& points = chain.points;
    const size_t n = points.size();
    const glm::dvec2 end = last ? points.back().position : points.front().position;
    glm::dvec2 step(0);
    for (size_t k = 1; k < n && glm::length(step) < spanPx; ++k)
        step = end - points[last ? n - 1 - k : k].position;
    const double length = glm::length(step);
    return length > 0 ? step / length : glm::dvec2(1, 0);
}

void reverse(FeatureChain& chain) {
    std::reverse(chain.points.begin(), chain.points.end());
    for (FeaturePoint& p : chain.points)
        for (float& j : p.jump) j = -j;
    std::swap(chain.ends[0], chain.ends[1]);
    const auto last = uint32_t(chain.points.size() - 1);
    for (uint32_t& corner : chain.corners) corner = last - corner;
    std::reverse(chain.corners.begin(), chain.corners.end());
}

std::vector<FeatureChain> withoutPoints(FeatureChain chain, std::vector<bool> drop) {
    const auto first = std::find(drop.begin(), drop.end(), true);
    if (first == drop.end()) return {std::move(chain)};
    const auto n = uint32_t(chain.points.size());
    if (chain.closed) {
        const auto turn = uint32_t(first - drop.begin());
        std::rotate(drop.begin(), first, drop.end());
        std::rotate(chain.points.begin(), chain.points.begin() + turn, chain.points.end());
        for (uint32_t& corner : chain.corners) corner = (corner + n - turn) % n;
        std::sort(chain.corners.begin(), chain.corners.end());
    }
    std::vector<FeatureChain> parts;
    for (uint32_t i = 0; i < n;) {
        uint32_t j = i;
        while (j < n && !drop[j]) ++j;
        if (j - i >= 2) {
            FeatureChain part;
            part.points.assign(chain.points.begin() + i, chain.points.begin() + j);
            if (!chain.closed && i == 0) part.ends[0] = chain.ends[0];
            if (!chain.closed && j == n) part.ends[1] = chain.ends[1];
            for (const uint32_t corner : chain.corners)
                if (corner > i && corner + 1 < j) part.corners.push_back(corner - i);
            part.importance = chain.importance * (j - i) / n;
            parts.push_back(std::move(part));
        }
        i = j + 1;
    }
    return parts;
}

std::vector<FeatureChain> connect(std::vector<FeatureChain> chains, const std::vector<uint32_t>& partner) {
    std::vector<FeatureChain> result;
    std::vector<bool> done(chains.size(), false);
    const auto walk = [&](uint32_t start) {  // in at end `start`, out at the other
        FeatureChain joined = std::move(chains[start / 2]);
        if (start % 2) reverse(joined);
        done[start / 2] = true;
        uint32_t next = partner[start ^ 1];
        while (next != kNoEnd && !done[next / 2]) {
            if (next % 2) reverse(chains[next / 2]);
            append(joined, chains[next / 2]);
            done[next / 2] = true;
            next = partner[next ^ 1];
        }
        if (next == start) close(joined);
        result.push_back(std::move(joined));
    };
    for (uint32_t c = 0; c < chains.size(); ++c) {
        if (done[c]) continue;
        if (partner[2 * c] == kNoEnd) {
            walk(2 * c);
        } else if (partner[2 * c + 1] == kNoEnd) {
            walk(2 * c + 1);
        }
    }
    for (uint32_t c = 0; c < chains.size(); ++c)
        if (!done[c]) walk(2 * c);
    return result;
}

std::vector<FeatureChain> joinTips(std::vector<FeatureChain> chains) {
    constexpr double kLeastLoopPx = 12;
    const PointGrid grid(chains);
    std::vector<Candidate> candidates;
    for (uint32_t end = 0; end < 2 * chains.size(); ++end) {
        if (chains[end / 2].closed || chains[end / 2].ends[end % 2] != ChainEnd::Tip) continue;
        const glm::dvec2 at = endPoint(chains, end).position, ahead = outward(chains[end / 2], end % 2);
        grid.near(at, kTipGapPx, [&](PointGrid::Entry e) {
            const FeatureChain& other = chains[e.chain];
            const bool last = e.point + 1 == other.points.size();
            const uint32_t to = 2 * e.chain + (last ? 1 : 0);
            if (other.closed || (e.point != 0 && !last) || to <= end) return;
            if (other.ends[to % 2] != ChainEnd::Tip) return;
            if (e.chain == end / 2 && lengthPx(other) < kLeastLoopPx) return;
            const glm::dvec2 gap = other.points[e.point].position - at, back = -outward(other, last);
            const double distance = glm::length(gap), along = glm::dot(ahead, back);
            if (distance > kTipGapPx || along < kContinues) return;
            const glm::dvec2 across = gap - ahead * glm::dot(gap, ahead);
            if (glm::length(across) > std::max(1.0, .5 * distance)) return;
            candidates.push_back({distance * (2 - along), end, to});
        });
    }
    std::sort(candidates.begin(), candidates.end());
    std::vector<uint32_t> partner(2 * chains.size(), kNoEnd);
    for (const Candidate& c : candidates)
        if (partner[c.a] == kNoEnd && partner[c.b] == kNoEnd) partner[c.a] = c.b, partner[c.b] = c.a;
    return connect(std::move(chains), partner);
}

std::vector<FeatureChain> joinJunctions(std::vector<FeatureChain> chains) {
    Meetings meetings = findMeetings(chains);
    struct Place {
        glm::dvec2 sum{};
        int count = 0;
        bool cut = false;
    };
    std::map<uint32_t, Place> places;  // by root
    for (uint32_t end = 0; end < 2 * chains.size(); ++end) {
        if (chains[end / 2].closed) continue;
        Place& place = places[meetings.sets.root(end)];
        place.sum += endPoint(chains, end).position;
        ++place.count;
    }
    for (size_t c = 0; c < chains.size(); ++c)
        for (const Cut& cut : meetings.cuts[c])
            places[meetings.sets.root(cut.item)] = {chains[c].points[cut.point].position, 1, true};
    std::vector<FeatureChain> parts;
    for (uint32_t c = 0; c < chains.size(); ++c) {
        const bool closed = chains[c].closed;
        std::vector<FeatureChain> cut = cutApart(std::move(chains[c]), meetings.cuts[c]);
        for (const bool last : {false, true}) {
            if (closed) break;
            const Place& place = places[meetings.sets.root(2 * c + (last ? 1 : 0))];
            if (place.count > 1 || place.cut)
                moveEnd(last ? cut.back() : cut.front(), last, place.sum / double(place.count));
        }
        for (FeatureChain& part : cut) parts.push_back(std::move(part));
    }
    return parts;
}

std::vector<FeatureChain> settleJunctions(std::vector<FeatureChain> chains) {
    const std::vector<uint32_t> ends = endsByPlace(chains);
    std::vector<uint32_t> partner(2 * chains.size(), kNoEnd);
    const auto place = [&](size_t i) { return endPoint(chains, ends[i]).position; };
    for (size_t i = 0; i < ends.size();) {
        size_t j = i + 1;
        while (j < ends.size() && place(j) == place(i)) ++j;
        for (size_t k = i; k < j; ++k) {
            ChainEnd& end = chains[ends[k] / 2].ends[ends[k] % 2];
            if (end != ChainEnd::Border) end = j - i > 1 ? ChainEnd::Junction : ChainEnd::Tip;
        }
        if (j - i == 2) {
            const uint32_t a = ends[i], b = ends[i + 1];
            const glm::dvec2 ahead = outward(chains[a / 2], a % 2), back = -outward(chains[b / 2], b % 2);
            const bool loop = a / 2 == b / 2;
            if (chains[a / 2].ends[a % 2] == ChainEnd::Junction &&
                (loop || glm::dot(ahead, back) > kContinues))
                partner[a] = b, partner[b] = a;
        }
        i = j;
    }
    return connect(std::move(chains), partner);
}

std::vector<uint32_t> throughLines(const std::vector<FeatureChain>& chains) {
    const std::vector<uint32_t> ends = endsByPlace(chains);
    DisjointSets lines(chains.size());
    for (size_t i = 0, j = 0; i < ends.size(); i = j) {
        const glm::dvec2 place = endPoint(chains, ends[i]).position;
        while (j < ends.size() && endPoint(chains, ends[j]).position == place) ++j;
        std::vector<Candidate> pairs;
        for (size_t a = i; a < j; ++a)
            for (size_t b = a + 1; b < j; ++b) {
                const double along = -glm::dot(outward(chains[ends[a] / 2], ends[a] % 2),
                                               outward(chains[ends[b] / 2], ends[b] % 2));
                if (along > kContinues) pairs.push_back({-along, ends[a], ends[b]});
            }
        std::sort(pairs.begin(), pairs.end());
        std::vector<uint32_t> taken;
        const auto isTaken = [&](uint32_t end) {
            return std::find(taken.begin(), taken.end(), end) != taken.end();
        };
        for (const Candidate& pair : pairs) {
            if (isTaken(pair.a) || isTaken(pair.b)) continue;
            taken.insert(taken.end(), {pair.a, pair.b});
            lines.unite(pair.a / 2, pair.b / 2);
        }
    }
    std::vector<uint32_t> result;
    for (uint32_t c = 0; c < chains.size(); ++c) result.push_back(lines.root(c));
    return result;
}

}  // namespace tessera
