// See palette.h.
#include "core/edit/palette.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <numeric>

#include "core/base/check.h"
#include "core/base/vector_math.h"
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

// The colour that is nearest to the mean of all.
glm::dvec3 middleOf(const std::vector<Weighted>& colours) {
    glm::dvec3 sum(0);
    double weight = 0;
    for (const Weighted& c : colours) {
        sum += c.weight * c.lab;
        weight += c.weight;
    }
    const glm::dvec3 mean = sum / weight;
    return std::min_element(colours.begin(), colours.end(),
                            [&](const auto& a, const auto& b) {
                                return squaredDistance(a.lab, mean) < squaredDistance(b.lab, mean);
                            })
        ->lab;
}

// Those of the means that a colour is nearest to.
std::vector<glm::dvec3> present(const std::vector<Weighted>& colours, const std::vector<glm::dvec3>& means) {
    std::vector<bool> has(means.size(), false);
    for (const Weighted& c : colours) has[nearestOf(means, c.lab)] = true;
    std::vector<glm::dvec3> kept;
    for (size_t k = 0; k < means.size(); ++k)
        if (has[k]) kept.push_back(means[k]);
    return kept;
}

// To the means given (or the middle one) one after the other the colour that is worst served by those so far,
// by its weight.
std::vector<glm::dvec3> firstMeans(const std::vector<Weighted>& colours, std::vector<glm::dvec3> means,
                                   size_t count) {
    if (!means.empty()) means = present(colours, means);
    if (means.size() > count) means.resize(count);
    if (means.empty()) means.push_back(middleOf(colours));
    std::vector<double> distance(colours.size(), std::numeric_limits<double>::infinity());
    for (size_t k = 0; k + 1 < means.size(); ++k)
        for (size_t i = 0; i < colours.size(); ++i)
            distance[i] = std::min(distance[i], squaredDistance(colours[i].lab, means[k]));
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

Palette palette(const PatchMesh& mesh, const PatchColours& colours, int count,
                std::span<const glm::dvec3> like) {
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
    std::vector<glm::dvec3> likeThese;
    for (const glm::dvec3 colour : like) likeThese.push_back(toOklab(colour));
    auto means =
        firstMeans(all, std::move(likeThese), size_t(std::clamp(count, Palette::kLeast, Palette::kMost)));
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

TESSERA_VECTOR_CLONES
void paletteShares(std::span<const glm::dvec3> entries, double spread, size_t entry, const float* const* lab,
                   size_t count, float* shares) {
    TESSERA_CHECK(entries.size() <= size_t(Palette::kMost));
    // Of exp(-d^2 / (2 spread^2)), the nearest entry's being 1, so that no colour is too far from all.
    constexpr size_t kBlock = 32;
    constexpr float kLeast = -100;  // of the exponents
    const float *const *planes = lab, factor = float(-std::numbers::log2e / (2 * spread * spread));
    for (size_t first = 0; first < count; first += kBlock) {
        const size_t block = std::min(kBlock, count - first);
        float exponents[Palette::kMost][kBlock], most[kBlock], sum[kBlock] = {};
        std::fill_n(most, kBlock, -std::numeric_limits<float>::infinity());
        for (size_t k = 0; k < entries.size(); ++k) {
            const auto x = float(entries[k].x), y = float(entries[k].y), z = float(entries[k].z);
            for (size_t i = 0; i < block; ++i) {
                const float dx = planes[0][first + i] - x, dy = planes[1][first + i] - y,
                            dz = planes[2][first + i] - z;
                exponents[k][i] = factor * (dx * dx + dy * dy + dz * dz);
                most[i] = std::max(most[i], exponents[k][i]);
            }
        }
        for (size_t k = 0; k < entries.size(); ++k)
            for (size_t i = 0; i < block; ++i) {
                exponents[k][i] = fastExp2(std::max(exponents[k][i] - most[i], kLeast));
                sum[i] += exponents[k][i];
            }
        for (size_t i = 0; i < block; ++i) shares[first + i] = exponents[entry][i] / sum[i];
    }
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
