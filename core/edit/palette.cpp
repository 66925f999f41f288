// See palette.h.
#include "core/edit/palette.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>

#include "core/edit/recolour.h"
#include "core/image/oklab.h"

namespace tessera {

namespace {

// Colours nearer than this are one.
constexpr double kSameColour = .01;

struct Weighted {
    glm::dvec3 lab;
    double area;
    double weight;  // in the search
    PatchId patch;
};

// Colourful patches count for more than their area: an eye finds the red apple before a grey wall's third
// shade.
double liveliness(glm::dvec3 lab) {
    constexpr double kChroma = .07;  // twice the weight
    return 1 + (lab.y * lab.y + lab.z * lab.z) / (kChroma * kChroma);
}

double squaredDistance(glm::dvec3 a, glm::dvec3 b) {
    return glm::dot(a - b, a - b);
}

size_t nearestOf(const std::vector<glm::dvec3>& means, glm::dvec3 lab) {
    size_t best = 0;
    for (size_t k = 1; k < means.size(); ++k)
        if (squaredDistance(means[k], lab) < squaredDistance(means[best], lab)) best = k;
    return best;
}

// One after the other the colour that is worst served by those so far, by its weight; first the mean's
// nearest.
std::vector<glm::dvec3> firstMeans(const std::vector<Weighted>& colours, size_t count) {
    glm::dvec3 sum(0);
    double weight = 0;
    for (const Weighted& c : colours) {
        sum += c.weight * c.lab;
        weight += c.weight;
    }
    const glm::dvec3 mean = sum / weight;
    const auto middle = std::min_element(colours.begin(), colours.end(), [&](const auto& a, const auto& b) {
        return squaredDistance(a.lab, mean) < squaredDistance(b.lab, mean);
    });
    std::vector<glm::dvec3> means{middle->lab};
    std::vector<double> distance(colours.size(), std::numeric_limits<double>::infinity());
    while (means.size() < count) {
        size_t worst = 0;
        double most = -1;
        for (size_t i = 0; i < colours.size(); ++i) {
            distance[i] = std::min(distance[i], squaredDistance(colours[i].lab, means.back()));
            const double served =
                distance[i] > kSameColour * kSameColour ? colours[i].weight * distance[i] : 0;
            if (served <= most) continue;
            most = served;
            worst = i;
        }
        if (most <= 0) break;
        means.push_back(colours[worst].lab);
    }
    return means;
}

// Lloyd's iterations; means that lose all their colours stay.
void improve(const std::vector<Weighted>& colours, std::vector<glm::dvec3>& means) {
    constexpr int kIterations = 24;
    for (int i = 0; i < kIterations; ++i) {
        std::vector<glm::dvec3> sum(means.size(), glm::dvec3(0));
        std::vector<double> weight(means.size(), 0);
        for (const Weighted& c : colours) {
            const size_t k = nearestOf(means, c.lab);
            sum[k] += c.weight * c.lab;
            weight[k] += c.weight;
        }
        for (size_t k = 0; k < means.size(); ++k)
            if (weight[k] > 0) means[k] = sum[k] / weight[k];
    }
}

// A third of the mean distance from an entry to its nearest: of an entry's own colour a hundredth is the
// other's.
double spreadOf(const std::vector<glm::dvec3>& means) {
    if (means.size() < 2) return 1;
    double sum = 0;
    for (size_t a = 0; a < means.size(); ++a) {
        double nearest = std::numeric_limits<double>::infinity();
        for (size_t b = 0; b < means.size(); ++b)
            if (a != b) nearest = std::min(nearest, squaredDistance(means[a], means[b]));
        sum += std::sqrt(nearest);
    }
    return std::max(kSameColour, sum / (3 * double(means.size())));
}

}  // namespace

Palette palette(const PatchMesh& mesh, const PatchColours& colours, int count) {
    std::vector<Weighted> all;
    double total = 0;
    mesh.forEachPatch([&](PatchId p) {
        const double area = colours[p].area * colours[p].alpha;
        if (!(area > 0)) return;
        all.push_back({colours[p].lab, area, area * liveliness(colours[p].lab), p});
        total += area;
    });
    Palette result;
    result.nearest.assign(mesh.connectivity().faceCapacity(), Palette::kNone);
    if (all.empty()) return result;
    auto means = firstMeans(all, size_t(std::clamp(count, Palette::kLeast, Palette::kMost)));
    improve(all, means);
    result.spread = spreadOf(means);

    std::vector<PaletteEntry> entries(means.size());
    for (size_t k = 0; k < means.size(); ++k) entries[k].colour = fromOklab(means[k]);
    std::vector<size_t> nearest(all.size());
    for (size_t i = 0; i < all.size(); ++i) {
        nearest[i] = nearestOf(means, all[i].lab);
        entries[nearest[i]].weight += all[i].area / total;
        ++entries[nearest[i]].patches;
    }
    std::vector<size_t> order(entries.size()), rank(entries.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](size_t a, size_t b) { return entries[a].weight > entries[b].weight; });
    std::erase_if(order, [&](size_t k) { return entries[k].patches == 0; });
    for (size_t k = 0; k < order.size(); ++k) {
        rank[order[k]] = k;
        result.entries.push_back(entries[order[k]]);
    }
    for (size_t i = 0; i < all.size(); ++i) result.nearest[all[i].patch.index] = uint8_t(rank[nearest[i]]);
    return result;
}

double paletteShare(std::span<const glm::dvec3> entries, double spread, size_t entry, glm::dvec3 lab) {
    double least = std::numeric_limits<double>::infinity();
    for (const glm::dvec3& e : entries) least = std::min(least, squaredDistance(e, lab));
    const auto part = [&](const glm::dvec3& e) {
        return std::exp((least - squaredDistance(e, lab)) / (2 * spread * spread));
    };
    double sum = 0;
    for (const glm::dvec3& e : entries) sum += part(e);
    return part(entries[entry]) / sum;
}

PatchSet patchesOf(const Palette& palette, int entry) {
    PatchSet set;
    for (uint32_t p = 0; p < palette.nearest.size(); ++p)
        if (palette.nearest[p] == entry) set.push_back(PatchId(p));
    return set;
}

Touched recolourPalette(PatchMesh& mesh, const Palette& palette, int entry, glm::dvec3 newColour) {
    PatchSet all;
    mesh.forEachPatch([&](PatchId p) { all.push_back(p); });
    return recolour(mesh, all, PaletteShift{palette, entry, newColour});
}

}  // namespace tessera
