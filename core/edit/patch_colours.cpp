// See patch_colours.h.
#include "core/edit/patch_colours.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "core/base/parallel.h"
#include "core/edit/colour_samples.h"
#include "core/image/oklab.h"

namespace tessera {

namespace {

// The upright and inverted small triangles' middles of a domain cut into 4^2: points of equal shares.
const DomainPoints& meanPoints() {
    static const DomainPoints points = [] {
        constexpr int n = 4;
        std::vector<Barycentric> middles;
        const auto add = [&](double i, double j) { middles.emplace_back((n - i - j) / n, i / n, j / n); };
        for (int j = 0; j < n; ++j)
            for (int i = 0; i + j < n; ++i) {
                add(i + 1.0 / 3, j + 1.0 / 3);
                if (i + j + 1 < n) add(i + 2.0 / 3, j + 2.0 / 3);
            }
        return DomainPoints(middles);
    }();
    return points;
}

}  // namespace

double colourDistance(const PatchColour& a, const PatchColour& b) {
    const double opacity = a.alpha - b.alpha;
    const glm::dvec3 d = a.lab - b.lab;
    return std::sqrt(glm::dot(d, d) + opacity * opacity);
}

PatchColour meanColour(const PatchMesh& mesh, PatchId p) {
    PatchColour mean;
    const auto samples = sampleColours(mesh, p, meanPoints());
    double opacity = 0;
    for (const ColourSample& s : samples) {
        mean.srgb += s.alpha * s.srgb;
        opacity += s.alpha;
    }
    const auto count = double(samples.size());
    mean.alpha = opacity / count;
    mean.srgb /= std::max(opacity, kLeastAlpha * count);
    mean.lab = toOklab(mean.srgb);
    constexpr double kPerPixel = 20.0 * kLatticePerPixel * kLatticePerPixel;
    mean.area = double(signedArea20(mesh.controlPoints(p))) / kPerPixel;
    return mean;
}

PatchColours::PatchColours(const PatchMesh& mesh) : mColours(mesh.connectivity().faceCapacity()) {
    parallelFor(mColours.size(), 256, [&](size_t begin, size_t end) {
        for (auto p = uint32_t(begin); p < end; ++p)
            if (mesh.connectivity().alive(PatchId(p))) mColours[p] = meanColour(mesh, PatchId(p));
    });
}

void PatchColours::update(const PatchMesh& mesh, std::span<const PatchId> changed) {
    parallelFor(changed.size(), 256, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) mColours[changed[i].index] = meanColour(mesh, changed[i]);
    });
}

glm::dvec3 meanColour(const PatchMesh& mesh, const PatchSet& set) {
    std::vector<PatchColour> means(set.size());
    parallelFor(set.size(), 256, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) means[i] = meanColour(mesh, set[i]);
    });
    glm::dvec3 sum(0);
    double weight = 0;
    for (const PatchColour& m : means) {
        sum += m.area * m.alpha * m.srgb;
        weight += m.area * m.alpha;
    }
    return weight > 0 ? sum / weight : sum;
}

}  // namespace tessera
