// See enclosed_region.h. A watershed of the distance to the nearest feature: places join by falling clearance
// of the way between them, so that two regions meet where the passage between them is narrowest. Where its
// outline holds badly, colours say more (region_merging.h).
#include "core/edit/enclosed_region.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <tuple>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/edit/distance_grid.h"
#include "core/edit/flood.h"
#include "core/edit/region_merging.h"

namespace tessera {

namespace {

// A passage is a gap where it is narrower than this share of the regions that it joins.
constexpr double kGapShare = .5;
// An outline this strong (region_merging.h) holds what is in it, whatever the colours.
constexpr double kHolds = .88;
constexpr double kWallTolerancePx = .25;
constexpr Barycentric kCentre(1. / 3, 1. / 3, 1. / 3);

// A place where one may be: a patch's centre, the middle of an edge, a vertex that is not on a wall.
struct Place {
    glm::dvec2 at{0};
    double clearance = 0;  // the distance to the nearest wall, px
};

// The straight way between two places of a patch.
struct Way {
    uint32_t from = 0, to = 0;
    double clearance = 0;  // the least along it
    double wider = 0;      // the clearance of its wider end
};

// The least clearance along a straight way, to a third or so, but for those that have enough. It changes no
// faster than one walks.
double leastClearance(const DistanceGrid& walls, const Place& a, const Place& b, double enough) {
    constexpr double kNear = .7, kShortest = .25;
    const double least = std::min(a.clearance, b.clearance), way = glm::distance(a.at, b.at);
    const double bound = .5 * (a.clearance + b.clearance - way);
    if (bound >= std::min(enough, kNear * least) || way <= kShortest) return least;
    const glm::dvec2 at = .5 * (a.at + b.at);
    const Place middle{at, walls.distance(at)};
    if (way <= kNear * least) return std::min(least, middle.clearance);
    return std::min(leastClearance(walls, a, middle, enough), leastClearance(walls, middle, b, enough));
}

// The places of a set of patches and the ways between them.
class Ground {
  public:
    Ground(const PatchMesh& mesh, const PatchSet& patches, double gapPx)
        : mMesh(mesh),
          mConnectivity(mesh.connectivity()),
          mOnWall(mConnectivity.vertexCapacity(), 0),
          mOfPatch(mConnectivity.faceCapacity(), kNone),
          mOfEdge(mConnectivity.edgeCapacity(), kNone),
          mOfVertex(mConnectivity.vertexCapacity(), kNone) {
        // Wider than this, no passage is a gap.
        const DistanceGrid walls(wallsOf(patches), .5 * gapPx / kGapShare);
        for (const PatchId p : patches) addPlaces(p);
        forEach(mPlaces, [&](Place& place) { place.clearance = walls.distance(place.at); });
        for (const PatchId p : patches) addWays(p);
        forEach(mWays, [&](Way& way) {
            const Place &from = mPlaces[way.from], &to = mPlaces[way.to];
            way.clearance = leastClearance(walls, from, to, .5 * gapPx);
            way.wider = std::max(from.clearance, to.clearance);
        });
    }

    const std::vector<Place>& places() const { return mPlaces; }
    // By falling clearance, as far as it matters: those that are no gap first.
    std::vector<Way> takeWays(double gapPx) {
        const auto narrow = std::partition(mWays.begin(), mWays.end(),
                                           [&](const Way& way) { return 2 * way.clearance >= gapPx; });
        std::sort(narrow, mWays.end(), [](const Way& a, const Way& b) {
            return std::tuple(-a.clearance, -a.wider, a.from, a.to) <
                   std::tuple(-b.clearance, -b.wider, b.from, b.to);
        });
        return std::move(mWays);
    }
    uint32_t centreOf(PatchId p) const { return mOfPatch[p.index]; }

  private:
    static constexpr uint32_t kNone = ~0U;

    template <class T, class Work>
    static void forEach(std::vector<T>& values, Work&& work) {
        constexpr size_t kGrain = 1024;
        parallelFor(values.size(), kGrain, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i) work(values[i]);
        });
    }

    bool isWall(EdgeId e) const { return mMesh.curve(e).feature || mConnectivity.onBorder(e); }

    std::vector<LineSegment> wallsOf(const PatchSet& patches) {
        std::vector<EdgeId> walls;
        for (const PatchId p : patches)
            for (const HalfedgeId side : mConnectivity.sides(p)) {
                const EdgeId e = HalfedgeMesh::edge(side);
                if (!isWall(e)) continue;
                walls.push_back(e);
                mOnWall[mConnectivity.origin(side).index] = mOnWall[mConnectivity.target(side).index] = 1;
            }
        std::sort(walls.begin(), walls.end());
        walls.erase(std::unique(walls.begin(), walls.end()), walls.end());
        return segmentsOf(mMesh, walls, kWallTolerancePx);
    }

    uint32_t add(uint32_t& place, glm::dvec2 at) {
        if (place == kNone) {
            place = uint32_t(mPlaces.size());
            mPlaces.push_back({at});
        }
        return place;
    }

    void addPlaces(PatchId p) {
        add(mOfPatch[p.index], evaluate(toPixels(mMesh.controlPoints(p)), kCentre));
        for (const HalfedgeId side : mConnectivity.sides(p)) {
            const EdgeId e = HalfedgeMesh::edge(side);
            if (!isWall(e))
                add(mOfEdge[e.index], toPixels(mMesh.controlPoints(HalfedgeMesh::halfedge(e))).at(.5));
            const VertexId v = mConnectivity.origin(side);
            if (!mOnWall[v.index]) add(mOfVertex[v.index], toPixels(mMesh.position(v)));
        }
    }

    // From a patch's centre to its other places, and between its sides.
    void addWays(PatchId p) {
        const auto sides = mConnectivity.sides(p);
        for (size_t i = 0; i < 3; ++i) {
            const uint32_t side = mOfEdge[HalfedgeMesh::edge(sides[i]).index];
            const uint32_t next = mOfEdge[HalfedgeMesh::edge(sides[(i + 1) % 3]).index];
            addWay(centreOf(p), side);
            addWay(centreOf(p), mOfVertex[mConnectivity.origin(sides[i]).index]);
            addWay(side, next);
        }
    }

    void addWay(uint32_t from, uint32_t to) {
        if (from != kNone && to != kNone) mWays.push_back({.from = from, .to = to});
    }

    const PatchMesh& mMesh;
    const HalfedgeMesh& mConnectivity;
    std::vector<uint8_t> mOnWall;
    std::vector<uint32_t> mOfPatch, mOfEdge, mOfVertex;
    std::vector<Place> mPlaces;
    std::vector<Way> mWays;
};

// Regions as a forest of places.
class Regions {
  public:
    explicit Regions(const std::vector<Place>& places) : mParent(places.size()), mWidest(places.size()) {
        std::iota(mParent.begin(), mParent.end(), 0U);
        for (size_t i = 0; i < places.size(); ++i) mWidest[i] = places[i].clearance;
    }

    uint32_t of(uint32_t place) {
        while (mParent[place] != place) place = mParent[place] = mParent[mParent[place]];
        return place;
    }

    // Joins what a way leads to, unless the way is a gap.
    void walk(const Way& way, double gapPx) {
        uint32_t a = of(way.from), b = of(way.to);
        if (a == b) return;
        if (mWidest[a] < mWidest[b]) std::swap(a, b);
        if (2 * way.clearance < gapPx && way.clearance < kGapShare * mWidest[b]) return;
        mParent[b] = a;
    }

  private:
    std::vector<uint32_t> mParent;
    std::vector<double> mWidest;  // by root: the largest clearance
};

// The watershed around the seed of what features enclose.
PatchSet withoutGaps(const PatchMesh& mesh, const PatchSet& within, PatchId seed, double gapPx) {
    Ground ground(mesh, within, gapPx);
    Regions regions(ground.places());
    for (const Way& way : ground.takeWays(gapPx)) regions.walk(way, gapPx);
    const uint32_t home = regions.of(ground.centreOf(seed));
    PatchSet found;
    for (const PatchId p : within)
        if (regions.of(ground.centreOf(p)) == home) found.push_back(p);
    return found;
}

}  // namespace

PatchSet enclosedByFeatures(const PatchMesh& mesh, const PatchColours& colours, PatchId seed, double gapPx) {
    TESSERA_CHECK(gapPx >= 0 && gapPx <= kMostGapPx);
    const PatchSet within =
        flood(mesh, seed, [&](EdgeId e) { return !mesh.curve(e).feature; }, [](PatchId) { return true; });
    if (gapPx == 0) return selectableOf(mesh, within);
    PatchSet found;
    HeldRegion held;
    // Side by side: neither needs the other.
    parallelFor(2, 1, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i)
            if (i == 0)
                found = withoutGaps(mesh, within, seed, gapPx);
            else
                held = bestHeld(mesh, colours, within, seed);
    });
    const double strength = outlineStrength(mesh, colours, within, found);
    // Features leave out parts of outlines, so that too much is found; what they close off is meant.
    if (strength < kHolds && !held.patches.empty() && held.strength >= strength &&
        held.patches.size() < found.size())
        found = std::move(held.patches);
    return selectableOf(mesh, std::move(found));
}

PatchSet enclosedByFeatures(const PatchMesh& mesh, PatchId seed, double gapPx) {
    return enclosedByFeatures(mesh, PatchColours(mesh), seed, gapPx);
}

}  // namespace tessera
