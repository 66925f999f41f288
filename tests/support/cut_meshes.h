// Cut meshes of small pictures, and what has to hold of every cut mesh.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "core/mesh/jacobian.h"
#include "core/mesh/mesh_validate.h"
#include "core/vectorize/cut_mesh.h"
#include "core/vectorize/virtual_sharp.h"

namespace tessera::testing {

inline FeatureNetwork detectedNetwork(const Image& image, const VectorizeSettings& settings) {
    StageReport report;
    Progress progress;
    auto chains = detectSubpixelFeatures(image, settings, report, progress).value();
    chains = selectFeatures(std::move(chains), settings.featureBudget * settings.patches);
    return buildFeatureNetwork(std::move(chains), image.width(), image.height(), settings);
}

// The controls of a face as patches have them; the interior point is the default one.
inline LatticeTriangle patchOf(const CutMesh& cut, FaceId f) {
    LatticeTriangle t = sideControlPoints(cut, f);
    t.p[kInterior] = toLattice(defaultInterior(toPixels(t)));
    return t;
}

// The distance from a chain's points first..last to a curve, at most.
inline double furthest(const FeatureChain& chain, const CutCurve& c, const BezierCurve& curve) {
    double worst = 0;
    const size_t n = chain.points.size();
    for (size_t i = c.first;; i = (i + 1) % n) {
        double nearest = 1e9;
        for (int k = 0; k <= 200; ++k) {
            const glm::dvec2 d = curve.at(k / 200.0) - chain.points[i].position;
            nearest = std::min(nearest, std::hypot(d.x, d.y));
        }
        worst = std::max(worst, nearest);
        if (i == c.last) return worst;
    }
}

// Of all curves, in px.
inline double furthestOffChain(const CutMesh& cut) {
    double worst = 0;
    for (uint32_t e = 0; e < cut.mesh.edgeCapacity(); ++e) {
        const CutCurve* c = cut.mesh.alive(EdgeId(e)) ? cut.curve(EdgeId(e)) : nullptr;
        if (!c) continue;
        const BezierCurve curve = toPixels(c->controlPoints(c->from, cut.positions));
        worst = std::max(worst, furthest(cut.chains[c->chain], *c, curve));
    }
    return worst;
}

// Empty where connectivity is sound, faces are positive, not thin, certified and cover the picture, edges with curves
// are those between the curves' ends, and curves stay within tolerancePx of their chains.
inline std::vector<std::string> cutMeshViolations(const CutMesh& cut, double tolerancePx) {
    std::vector<std::string> found = connectivityViolations(cut.mesh);
    const auto say = [&](const std::string& what, uint32_t id) {
        found.push_back(what + " " + std::to_string(id));
    };
    int64_t area = 0;
    for (uint32_t f = 0; f < cut.mesh.faceCapacity(); ++f) {
        if (!cut.mesh.alive(FaceId(f))) continue;
        const auto c = cut.mesh.corners(FaceId(f));
        const LatticePoint a = cut.positions[c[0].index];
        const int64_t twice = cross(cut.positions[c[1].index] - a, cut.positions[c[2].index] - a);
        area += twice;
        if (twice <= 0) say("no area: face", f);
        if (!certifiedIfStraight(a, cut.positions[c[1].index], cut.positions[c[2].index]))
            say("too thin: face", f);
        if (!certifiedInterior(patchOf(cut, FaceId(f)))) say("no certificate: face", f);
    }
    constexpr int64_t kUnit = kLatticePerPixel;
    if (area != 2 * kUnit * kUnit * cut.width * cut.height) found.push_back("faces do not fill the picture");
    for (uint32_t e = 0; e < cut.mesh.edgeCapacity(); ++e) {
        const CutCurve* c = cut.mesh.alive(EdgeId(e)) ? cut.curve(EdgeId(e)) : nullptr;
        if (!c) continue;
        const VertexId a = cut.mesh.origin(HalfedgeMesh::halfedge(EdgeId(e)));
        const VertexId b = cut.mesh.target(HalfedgeMesh::halfedge(EdgeId(e)));
        if (!((c->from == a && c->to == b) || (c->from == b && c->to == a)))
            say("another edge's curve: edge", e);
        const BezierCurve curve = toPixels(c->controlPoints(c->from, cut.positions));
        if (furthest(cut.chains[c->chain], *c, curve) > tolerancePx) say("off its chain: edge", e);
    }
    return found;
}

// Degrees.
inline double smallestAngle(const CutMesh& cut) {
    double least = 180;
    for (uint32_t f = 0; f < cut.mesh.faceCapacity(); ++f) {
        if (!cut.mesh.alive(FaceId(f))) continue;
        const auto c = cut.mesh.corners(FaceId(f));
        for (size_t k = 0; k < 3; ++k) {
            const glm::dvec2 p = toPixels(cut.positions[c[k].index]);
            const glm::dvec2 u = toPixels(cut.positions[c[(k + 1) % 3].index]) - p;
            const glm::dvec2 v = toPixels(cut.positions[c[(k + 2) % 3].index]) - p;
            least = std::min(least, std::atan2(cross(u, v), u.x * v.x + u.y * v.y) * 57.295779513);
        }
    }
    return least;
}

}  // namespace tessera::testing
