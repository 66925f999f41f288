// See mesh_damage.h.
#include "app/mesh_damage.h"

#include <algorithm>
#include <glm/common.hpp>

namespace tessera {

namespace {

// Beyond so many sigmas a blurred step is flat to less than a level.
constexpr double kReachSigmas = 4;

void include(Rect& area, const PatchMesh& mesh, PatchId p) {
    double sigma = 0;
    for (const HalfedgeId h : mesh.connectivity().sides(p))
        for (const float blur : mesh.curve(HalfedgeMesh::edge(h)).blurSigma)
            sigma = std::max(sigma, double(blur));
    const Rect box = controlBounds(mesh, p);
    area.min = glm::min(area.min, box.min - kReachSigmas * sigma);
    area.max = glm::max(area.max, box.max + kReachSigmas * sigma);
}

}  // namespace

Rect damagedArea(const PatchMesh& before, const PatchMesh& after, const Touched& touched) {
    const Rect whole{{0, 0}, {after.width(), after.height()}};
    const auto featureChanged = [&](EdgeId e) {
        const EdgeCurve &a = before.curve(e), &b = after.curve(e);
        return a.feature != b.feature || a.blurSigma != b.blurSigma;
    };
    if (touched.topology || std::any_of(touched.edges.begin(), touched.edges.end(), featureChanged))
        return whole;
    Rect area{whole.max, whole.min};
    for (const PatchId p : touched.patches) {
        include(area, before, p);
        include(area, after, p);
    }
    return {glm::max(area.min, whole.min), glm::min(area.max, whole.max)};
}

}  // namespace tessera
