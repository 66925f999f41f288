// See colour_transfer.h.
#include "core/edit/colour_transfer.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <vector>

#include "core/edit/colour_fan.h"
#include "core/edit/site_fit.h"
#include "core/mesh/patch_query.h"

namespace tessera {

namespace {

struct Source {
    PatchId patch;
    BezierTriangle shape;
    Rect bounds;
};

std::vector<Source> sourcesOf(const PatchMesh& mesh, const PatchSet& from, PatchId like) {
    const HalfedgeMesh& c = mesh.connectivity();
    PatchSet reached{like};
    for (size_t i = 0; i < reached.size(); ++i)
        for (const HalfedgeId side : c.sides(reached[i])) {
            const PatchId beyond = c.face(HalfedgeMesh::twin(side));
            if (!beyond.valid() || separatesColours(mesh, side) || !contains(from, beyond)) continue;
            if (std::find(reached.begin(), reached.end(), beyond) == reached.end()) reached.push_back(beyond);
        }
    std::vector<Source> sources;
    for (const PatchId p : patchSet(std::move(reached)))
        sources.push_back({p, toPixels(mesh.controlPoints(p)), controlBounds(mesh, p)});
    return sources;
}

// The source that has the point, or is nearest to it, and where.
PatchHit find(const std::vector<Source>& sources, glm::dvec2 point) {
    constexpr double kTolerance = 1e-3;  // px
    PatchHit best;
    double least = HUGE_VAL;
    // Those that cannot have the point are asked only where no other has it.
    for (const bool near : {true, false}) {
        for (const Source& source : sources) {
            const glm::dvec2 gap =
                glm::max(glm::max(source.bounds.min - point, point - source.bounds.max), glm::dvec2(0));
            const double away = glm::length(gap);
            if ((away <= kTolerance) != near || away >= least) continue;
            const Barycentric at = nearestParameters(source.shape, point, kTolerance);
            const double distance = glm::distance(evaluate(source.shape, at), point);
            if (distance >= least) continue;
            least = distance;
            best = {source.patch, at};
            if (least <= kTolerance) return best;
        }
    }
    return best;
}

}  // namespace

PatchSpline transferredColours(const PatchMesh& mesh, const PatchSet& from, PatchId like,
                               const BezierTriangle& shape) {
    const std::vector<Source> sources = sourcesOf(mesh, from, like);
    SitePlanes values{};
    for (size_t i = 0; i < size_t(kCentreSites); ++i) {
        const PatchHit hit = find(sources, evaluate(shape, sitePoints().barycentrics[i]));
        for (int c = 0; c < mesh.channels(); ++c)
            values[size_t(c)][i] = float(evaluateSpline(mesh.spline(hit.patch), c, domainPoint(hit.at)));
    }
    return fittedLike(mesh.spline(like), mesh.channels(), values);
}

}  // namespace tessera
