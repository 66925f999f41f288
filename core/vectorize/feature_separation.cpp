// See feature_separation.h.
#include "core/vectorize/feature_separation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>

#include "core/base/parallel.h"
#include "core/vectorize/feature_joins.h"
#include "core/vectorize/point_grid.h"

namespace tessera {

namespace {

// Between points of two chains, so that their cubics are 1 px apart.
constexpr double kApartPx = 1.7, kBorderRoomPx = 1.5;
// Two chains that leave a junction at 20 degrees are kApartPx apart at this distance.
constexpr double kJunctionZonePx = 4, kBorderZonePx = 4;
constexpr double kMostCosine = .93;
constexpr double kOwnArcPx = 6;

double arcBetween(const FeatureChain& chain, const std::vector<double>& arc, uint32_t i, uint32_t j) {
    const double direct = std::abs(arc[i] - arc[j]);
    if (!chain.closed) return direct;
    const double total =
        arc.back() + glm::distance(chain.points.back().position, chain.points.front().position);
    return std::min(direct, total - direct);
}

// Whether points p of chain a and q of chain b are close only because they are near a junction of both, which
// the chains leave in different directions.
bool nearJunction(const FeatureChain& a, glm::dvec2 p, const FeatureChain& b, glm::dvec2 q) {
    if (a.closed || b.closed) return false;
    for (const bool endA : {false, true})
        for (const bool endB : {false, true}) {
            const glm::dvec2 at = endA ? a.points.back().position : a.points.front().position;
            if (at != (endB ? b.points.back().position : b.points.front().position)) continue;
            if (glm::distance(at, p) > kJunctionZonePx || glm::distance(at, q) > kJunctionZonePx + kApartPx)
                continue;
            if (glm::dot(outward(a, endA), outward(b, endB)) < kMostCosine) return true;
        }
    return false;
}

class Separation {
  public:
    Separation(const std::vector<FeatureChain>& chains, int width, int height)
        : mChains(chains), mSize(width, height), mGrid({}) {}

    // Which points of chain c are too close to chains added before, to the border or to points of c before
    // them.
    std::vector<bool> tooClose(uint32_t c) const {
        const FeatureChain& chain = mChains[c];
        const std::vector<double> arc = arcLengths(chain);
        const PointGrid own(std::vector<FeatureChain>{chain});
        std::vector<bool> drop(chain.points.size(), false);
        for (uint32_t i = 0; i < drop.size(); ++i) {
            const glm::dvec2 p = chain.points[i].position;
            bool close = atBorder(chain, p);
            mGrid.near(p, kApartPx, [&](PointGrid::Entry e) {
                const glm::dvec2 q = mChains[e.chain].points[e.point].position;
                close =
                    close || (glm::distance(p, q) < kApartPx && !nearJunction(chain, p, mChains[e.chain], q));
            });
            own.near(p, kApartPx, [&](PointGrid::Entry e) {
                if (e.point >= i || drop[e.point]) return;
                const glm::dvec2 q = chain.points[e.point].position;
                close = close || (glm::distance(p, q) < kApartPx &&
                                  arcBetween(chain, arc, i, e.point) > kOwnArcPx && !loopEnds(chain, p, q));
            });
            drop[i] = close;
        }
        return drop;
    }
    void add(const FeatureChain& chain, uint32_t number) { mGrid.add(chain, number); }

  private:
    bool atBorder(const FeatureChain& chain, glm::dvec2 p) const {
        if (std::min({p.x, p.y, mSize.x - p.x, mSize.y - p.y}) >= kBorderRoomPx) return false;
        for (const bool last : {false, true}) {
            const glm::dvec2 end = last ? chain.points.back().position : chain.points.front().position;
            if (!chain.closed && chain.ends[last] == ChainEnd::Border &&
                glm::distance(p, end) < kBorderZonePx)
                return false;
        }
        return true;
    }
    static bool loopEnds(const FeatureChain& chain, glm::dvec2 p, glm::dvec2 q) {
        const glm::dvec2 at = chain.points.front().position;
        return !chain.closed && at == chain.points.back().position &&
               glm::dot(outward(chain, false), outward(chain, true)) < kMostCosine &&
               glm::distance(p, at) < kJunctionZonePx && glm::distance(q, at) < kJunctionZonePx + kApartPx;
    }

    const std::vector<FeatureChain>& mChains;
    glm::dvec2 mSize;
    PointGrid mGrid;
};

}  // namespace

std::vector<FeatureChain> separated(std::vector<FeatureChain> chains, int width, int height,
                                    double minLengthPx, const std::stop_token& stop) {
    std::vector<uint32_t> order(chains.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(),
                     [&](uint32_t a, uint32_t b) { return chains[a].importance > chains[b].importance; });
    Separation separation(chains, width, height);
    std::vector<FeatureChain> kept;
    for (const uint32_t c : order) {
        if (stop.stop_requested()) break;
        const std::vector<bool> drop = separation.tooClose(c);
        // Its dropped points count too: another chain through the same place would be no better.
        separation.add(chains[c], c);
        for (FeatureChain& part : withoutPoints(FeatureChain(chains[c]), drop))
            if (lengthPx(part) >= minLengthPx) kept.push_back(std::move(part));
    }
    return settleJunctions(std::move(kept));
}

void limitBlur(std::vector<FeatureChain>& chains, const std::stop_token& stop) {
    const PointGrid grid(chains);
    std::vector<std::vector<float>> limits(chains.size());
    parallelFor(chains.size(), 8, [&](size_t begin, size_t end) {
        for (size_t c = begin; c < end && !stop.stop_requested(); ++c) {
            const FeatureChain& chain = chains[c];
            const std::vector<double> arc = arcLengths(chain);
            for (uint32_t i = 0; i < chain.points.size(); ++i) {
                const double sigma = chain.points[i].sigma, reach = 3 * sigma;
                const glm::dvec2 p = chain.points[i].position;
                double nearest = reach;
                grid.near(p, reach, [&](PointGrid::Entry e) {
                    const FeatureChain& other = chains[e.chain];
                    const glm::dvec2 q = other.points[e.point].position;
                    const double distance = glm::distance(p, q);
                    if (distance >= nearest) return;
                    const bool own = e.chain == c && arcBetween(chain, arc, i, e.point) < 3 * distance + 2;
                    // Toward a junction the blur fades out anyway.
                    if (!own && (e.chain == c || !nearJunction(chain, p, other, q))) nearest = distance;
                });
                limits[c].push_back(float(std::max(nearest / 3, double(kLeastBlurPx))));
            }
        }
    });
    if (stop.stop_requested()) return;
    for (size_t c = 0; c < chains.size(); ++c)
        for (size_t i = 0; i < chains[c].points.size(); ++i)
            chains[c].points[i].sigma = std::min(chains[c].points[i].sigma, limits[c][i]);
}

}  // namespace tessera
