// See region_merging.h.
#include "core/edit/region_merging.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>
#include <numeric>
#include <optional>
#include <tuple>

#include "core/base/check.h"

namespace tessera {

namespace {

constexpr uint32_t kNone = ~0U;
// Shading changes lightness within a thing more than hue and chroma, so it counts for less.
constexpr glm::dvec3 kWeights(.4, 1, 1);
// Colours this far apart, lightness weighted, hold as a feature does.
constexpr double kContrast = .12;
// Of the cost of a merge: the share of the contrast along the common side; the rest is that of the means.
constexpr double kLocalShare = .8;
constexpr double kLeastCost = .01;
// The length of the picture's border counts by this much, and holds nothing: a share of the whole picture
// has a stronger outline than the picture less one thing.
constexpr double kBorderShare = .3;
// An outline is one where it is no feature only with this mean contrast.
constexpr double kLeastContrast = .3;

struct Side {
    double length = 0;    // px
    double strength = 0;  // times the length
    double open = 0;      // of the length, what is no feature

    Side& operator+=(const Side& other) {
        length += other.length;
        strength += other.strength;
        open += other.open;
        return *this;
    }
};

struct Link {
    uint32_t to = 0;
    Side side;
};

struct Region {
    glm::dvec3 lab{0};  // the mean, lightness weighted
    double alpha = 0;
    double area = 0;
    double weight = 0;  // of what merging it costs: small regions merge early
    Side outside;       // towards what is not to be merged
    uint32_t version = 0;
    std::vector<Link> links;  // by ascending region
};

double contrast(const glm::dvec3& lab, double alpha) {
    return std::sqrt(glm::dot(lab, lab) + alpha * alpha) / kContrast;
}

double contrast(const PatchColour& a, const PatchColour& b) {
    return contrast(kWeights * (a.lab - b.lab), a.alpha - b.alpha);
}

double weightOf(double area) {
    return std::sqrt(std::sqrt(area));
}

auto position(std::vector<Link>& links, uint32_t to) {
    return std::lower_bound(links.begin(), links.end(), to,
                            [](const Link& link, uint32_t region) { return link.to < region; });
}

void addLink(std::vector<Link>& links, uint32_t to, const Side& side) {
    const auto at = position(links, to);
    if (at != links.end() && at->to == to)
        at->side += side;
    else
        links.insert(at, {to, side});
}

// What the sides of a set's patches are, seen from within it.
class Sides {
  public:
    Sides(const PatchMesh& mesh, const PatchColours& colours, const PatchSet& within)
        : mMesh(mesh), mColours(colours), mNumbers(mesh.connectivity().faceCapacity(), kNone) {
        for (uint32_t i = 0; i < within.size(); ++i) mNumbers[within[i].index] = i;
        reachFromBorder();
    }

    // That of a patch in the set, kNone for others and beyond the border.
    uint32_t numberOf(PatchId p) const { return p.valid() ? mNumbers[p.index] : kNone; }

    PatchId beyond(HalfedgeId h) const { return mMesh.connectivity().face(HalfedgeMesh::twin(h)); }

    // Nothing along a hole.
    Side of(HalfedgeId h) const {
        const HalfedgeMesh& c = mMesh.connectivity();
        const double length =
            glm::distance(toPixels(mMesh.position(c.origin(h))), toPixels(mMesh.position(c.target(h))));
        const PatchId other = beyond(h);
        if (!other.valid()) return {kBorderShare * length, 0, 0};
        if (mNumbers[other.index] == kNone && !mReached[other.index]) return {};
        const bool feature = mMesh.curve(HalfedgeMesh::edge(h)).feature;
        const double strength = feature ? 1 : std::min(1., contrast(mColours[c.face(h)], mColours[other]));
        return {length, length * strength, feature ? 0 : length};
    }

  private:
    // What is not a hole: what can be reached from the picture's border without the set.
    void reachFromBorder() {
        const HalfedgeMesh& c = mMesh.connectivity();
        mReached.resize(c.faceCapacity(), 0);
        std::vector<PatchId> front;
        const auto reach = [&](PatchId p) {
            if (!p.valid() || mNumbers[p.index] != kNone || mReached[p.index]) return;
            mReached[p.index] = 1;
            front.push_back(p);
        };
        for (uint32_t i = 0; i < c.faceCapacity(); ++i) {
            if (!c.alive(PatchId(i))) continue;
            for (const HalfedgeId side : c.sides(PatchId(i)))
                if (c.onBorder(HalfedgeMesh::edge(side))) reach(PatchId(i));
        }
        for (size_t i = 0; i < front.size(); ++i)
            for (const HalfedgeId side : c.sides(front[i])) reach(beyond(side));
    }

    const PatchMesh& mMesh;
    const PatchColours& mColours;
    std::vector<uint32_t> mNumbers;  // by patch id
    std::vector<uint8_t> mReached;   // by patch id
};

// Each patch of a set as a region.
std::vector<Region> regionsOf(const PatchMesh& mesh, const PatchColours& colours, const PatchSet& within) {
    const Sides sides(mesh, colours, within);
    std::vector<Region> regions(within.size());
    for (uint32_t i = 0; i < within.size(); ++i) {
        const PatchColour& own = colours[within[i]];
        Region& region = regions[i];
        region.area = own.area;
        region.weight = weightOf(own.area);
        region.lab = kWeights * own.lab;
        region.alpha = own.alpha;
        for (const HalfedgeId h : mesh.connectivity().sides(within[i])) {
            const uint32_t other = sides.numberOf(sides.beyond(h));
            if (other != kNone)
                addLink(region.links, other, sides.of(h));
            else
                region.outside += sides.of(h);
        }
    }
    return regions;
}

double meanStrength(const Side& outline) {
    return outline.length > 0 ? outline.strength / outline.length : 0;
}

class Merging {
  public:
    explicit Merging(std::vector<Region> regions) : mRegions(std::move(regions)) {
        for (uint32_t a = 0; a < mRegions.size(); ++a)
            if (const auto next = nextOf(a)) mQueue.push_back(*next);
        std::make_heap(mQueue.begin(), mQueue.end());
    }

    // The numbers of the best region's parts; raises `atLeast` to its strength.
    std::optional<std::vector<uint32_t>> best(uint32_t seed, double& atLeast) {
        std::vector<std::pair<uint32_t, uint32_t>> merges;
        std::optional<size_t> bestAt;
        uint32_t home = seed;
        const auto consider = [&] {
            const std::optional<double> strength = strengthOf(mRegions[home]);
            if (!strength || *strength < atLeast) return;
            atLeast = *strength;
            bestAt = merges.size();
        };
        consider();
        while (!mQueue.empty()) {
            std::pop_heap(mQueue.begin(), mQueue.end());
            auto [cost, a, b, versionA, versionB] = mQueue.back();
            mQueue.pop_back();
            if (versionA != mRegions[a].version) continue;
            if (versionB != mRegions[b].version) {
                push(a);
                continue;
            }
            if (mRegions[a].links.size() < mRegions[b].links.size()) std::swap(a, b);
            merge(a, b);
            merges.emplace_back(a, b);
            if (home == b) home = a;
            if (home == a) consider();
        }
        if (!bestAt) return {};
        merges.resize(*bestAt);
        return partsOf(seed, merges);
    }

  private:
    struct Candidate {
        double cost = 0;
        uint32_t a = 0, b = 0;
        uint32_t versionA = 0, versionB = 0;  // of the regions that the cost is for

        bool operator<(const Candidate& o) const { return std::tie(cost, a, b) > std::tie(o.cost, o.a, o.b); }
    };

    Candidate candidate(uint32_t from, const Link& link) const {
        const Region &a = mRegions[from], &b = mRegions[link.to];
        const double means = contrast(a.lab - b.lab, a.alpha - b.alpha);
        const double differ = kLocalShare * meanStrength(link.side) + (1 - kLocalShare) * means;
        const double cost = (kLeastCost + differ) * std::min(a.weight, b.weight);
        return {cost, from, link.to, a.version, b.version};
    }

    // The cheapest merge of a region. The queue has one for each: of any two that have changed since, the one
    // that changed last looked at both.
    std::optional<Candidate> nextOf(uint32_t region) const {
        std::optional<Candidate> next;
        for (const Link& link : mRegions[region].links) {
            const Candidate other = candidate(region, link);
            if (!next || *next < other) next = other;
        }
        return next;
    }

    void push(uint32_t region) {
        const auto next = nextOf(region);
        if (!next) return;
        mQueue.push_back(*next);
        std::push_heap(mQueue.begin(), mQueue.end());
    }

    // Of the outline; none where colours hold none of it.
    static std::optional<double> strengthOf(const Region& region) {
        Side outline = region.outside;
        double open = 0, held = 0;
        for (const Link& link : region.links) {
            outline += link.side;
            open += link.side.open;
            held += link.side.strength - (link.side.length - link.side.open);
        }
        if (open <= 0 || held < kLeastContrast * open) return {};
        return meanStrength(outline);
    }

    void merge(uint32_t into, uint32_t from) {
        Region &a = mRegions[into], &b = mRegions[from];
        const double share = b.area / (a.area + b.area);
        a.lab += share * (b.lab - a.lab);
        a.alpha += share * (b.alpha - a.alpha);
        a.area += b.area;
        a.weight = weightOf(a.area);
        a.outside += b.outside;
        ++a.version;
        ++b.version;
        a.links.erase(position(a.links, from));
        for (const Link& link : b.links) {
            if (link.to == into) continue;
            addLink(a.links, link.to, link.side);
            std::vector<Link>& back = mRegions[link.to].links;
            back.erase(position(back, from));
            addLink(back, into, link.side);
        }
        b.links = {};
        push(into);
    }

    // What the merges, each of a second region into a first, have joined with the seed.
    std::vector<uint32_t> partsOf(uint32_t seed,
                                  const std::vector<std::pair<uint32_t, uint32_t>>& merges) const {
        std::vector<uint32_t> root(mRegions.size());
        std::iota(root.begin(), root.end(), 0U);
        // What a region was merged into has its root by then.
        for (auto m = merges.rbegin(); m != merges.rend(); ++m) root[m->second] = root[m->first];
        std::vector<uint32_t> parts;
        for (uint32_t i = 0; i < root.size(); ++i)
            if (root[i] == root[seed]) parts.push_back(i);
        return parts;
    }

    std::vector<Region> mRegions;
    std::vector<Candidate> mQueue;  // a heap
};

}  // namespace

double outlineStrength(const PatchMesh& mesh, const PatchColours& colours, const PatchSet& within,
                       const PatchSet& region) {
    const Sides sides(mesh, colours, within);
    const std::vector<uint8_t> inside = membership(mesh, region);
    Side outline;
    for (const PatchId p : region)
        for (const HalfedgeId h : mesh.connectivity().sides(p)) {
            const PatchId beyond = sides.beyond(h);
            if (!beyond.valid() || !inside[beyond.index]) outline += sides.of(h);
        }
    return meanStrength(outline);
}

HeldRegion bestHeld(const PatchMesh& mesh, const PatchColours& colours, const PatchSet& within,
                    PatchId seed) {
    TESSERA_CHECK(contains(within, seed));
    const auto at = std::lower_bound(within.begin(), within.end(), seed);
    double strength = 0;
    const auto parts =
        Merging(regionsOf(mesh, colours, within)).best(uint32_t(at - within.begin()), strength);
    if (!parts) return {};
    HeldRegion held{{}, strength};
    for (const uint32_t part : *parts) held.patches.push_back(within[part]);
    return held;
}

}  // namespace tessera
