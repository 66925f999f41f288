// See photo_patches.h.
#include "app/tools/photo_patches.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <unordered_map>

#include "core/edit/colour_samples.h"
#include "core/edit/drag_colour.h"
#include "core/image/oklab.h"

namespace tessera {

namespace {

// Of patches that an edit has given other colours: what a refit leaves of most textures. A finer recolouring
// than that is hard to see.
constexpr double kMostDistance = .03;  // mean, in OKLab
constexpr int kSamplesASide = 4;

bool showsPhoto(const PatchMesh& mesh, const Image& photo, PatchId p) {
    static const std::vector<Barycentric> kLattice = latticeOf(kSamplesASide);
    static const DomainPoints kPoints(kLattice);
    const std::vector<ColourSample> samples = sampleColours(mesh, p, kPoints);
    const BezierTriangle patch = toPixels(mesh.controlPoints(p));
    double sum = 0;
    for (size_t i = 0; i < samples.size(); ++i) {
        const glm::dvec2 at = evaluate(patch, kLattice[i]);
        // As it is composed: where nothing can be seen, colours do not count.
        glm::dvec3 seen;
        for (int c = 0; c < 3; ++c) seen[c] = double(bilinear(photo, c, at.x, at.y));
        sum += glm::distance(toOklab(samples[i].srgb * samples[i].alpha), toOklab(seen));
    }
    return sum <= kMostDistance * double(samples.size());
}

}  // namespace

PatchSet showingPhoto(const PatchMesh& mesh, const PatchMesh& fitted, const Image& photo,
                      const PatchSet& set) {
    const HalfedgeMesh& connectivity = mesh.connectivity();
    std::unordered_map<PatchId, bool> known;
    const auto shows = [&](PatchId p) {
        const auto [entry, isNew] = known.try_emplace(p, false);
        if (isNew)
            entry->second = (hasFitted(mesh, fitted, p) && mesh.spline(p) == fitted.spline(p)) ||
                            showsPhoto(mesh, photo, p);
        return entry->second;
    };
    PatchSet result = set;
    std::erase_if(result, [&](PatchId p) {
        bool all = true;
        for (const VertexId corner : connectivity.corners(p))
            connectivity.forEachOutgoing(corner, [&](HalfedgeId h) {
                if (connectivity.face(h).valid()) all = all && shows(connectivity.face(h));
            });
        return !all;
    });
    return result;
}

}  // namespace tessera
