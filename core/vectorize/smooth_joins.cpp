// See smooth_joins.h.
#include "core/vectorize/smooth_joins.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "core/mesh/jacobian.h"

namespace tessera {

namespace {

// The two feature halfedges that leave a vertex inside a feature.
struct Join {
    VertexId vertex;
    HalfedgeId a, b;
};

std::vector<Join> featureJoins(const PatchMesh& mesh) {
    std::vector<Join> joins;
    mesh.forEachVertex([&](VertexId v) {
        std::vector<HalfedgeId> features;
        mesh.connectivity().forEachOutgoing(v, [&](HalfedgeId h) {
            if (mesh.curve(HalfedgeMesh::edge(h)).feature) features.push_back(h);
        });
        if (features.size() == 2) joins.push_back({v, features[0], features[1]});
    });
    return joins;
}

// Finds certified interior points for the given patches; false, with nothing changed, where one has none.
bool certifyPatches(PatchMesh& mesh, std::span<const PatchId> patches) {
    std::vector<std::pair<PatchId, LatticePoint>> interiors;
    for (const PatchId p : patches) {
        if (!p.valid()) continue;
        const auto interior = certifiedDefaultInterior(mesh.controlPoints(p));
        if (!interior) return false;
        interiors.emplace_back(p, *interior);
    }
    for (const auto& [p, interior] : interiors) mesh.setInterior(p, interior);
    return true;
}

// Whether the face of h (which leaves the vertex) has both curves as sides.
bool holdsBoth(const HalfedgeMesh& c, HalfedgeId h, HalfedgeId other) {
    return c.face(h).valid() && c.prev(h) == HalfedgeMesh::twin(other);
}

// Takes the third side of the patch between the two curves away by a flip.
bool flipAway(BaseDomain& base, HalfedgeId h) {
    const HalfedgeId third = base.mesh.connectivity().next(h);
    const EdgeId e = HalfedgeMesh::edge(third);
    if (base.mesh.curve(e).feature || !base.mesh.connectivity().canFlip(e)) return false;
    // The connectivity belongs to the mesh as a value: flip in a copy (pages are shared) and keep it if it is
    // sound.
    HalfedgeMesh flipped = base.mesh.connectivity();
    flipped.flip(e);
    PatchMesh trial = base.mesh;
    trial.setConnectivity(std::move(flipped));
    const HalfedgeId now = HalfedgeMesh::halfedge(e);
    const VertexId from = trial.connectivity().origin(now), to = trial.connectivity().target(now);
    const auto inner = straightControlPoints(trial.position(from), trial.position(to));
    trial.setInnerControlPoints(now, inner[0], inner[1]);
    const std::array patches{trial.connectivity().face(now),
                             trial.connectivity().face(HalfedgeMesh::twin(now))};
    if (!certifyPatches(trial, patches)) return false;
    base.mesh = std::move(trial);
    base.paths[e.index] = {toPixels(base.mesh.position(from)), toPixels(base.mesh.position(to))};
    return true;
}

bool makeSmooth(BaseDomain& base, const Join& join, const VectorizeSettings& settings) {
    const auto a = base.mesh.controlPoints(join.a), b = base.mesh.controlPoints(join.b);
    const glm::dvec2 at = toPixels(a[0]), handleA = toPixels(a[1]) - at, handleB = toPixels(b[1]) - at;
    const double lengthA = glm::length(handleA), lengthB = glm::length(handleB);
    const glm::dvec2 tangent = glm::normalize(handleB / lengthB - handleA / lengthA);
    PatchMesh trial = base.mesh;
    trial.setInnerControlPoints(join.a, toLattice(at - lengthA * tangent), a[2]);
    trial.setInnerControlPoints(join.b, toLattice(at + lengthB * tangent), b[2]);
    for (const HalfedgeId h : {join.a, join.b})
        if (maxDistance(toPixels(trial.controlPoints(h)), base.paths[HalfedgeMesh::edge(h).index]) >
            settings.curveTolerancePx)
            return false;
    const HalfedgeMesh& c = trial.connectivity();
    const std::array patches{c.face(join.a), c.face(HalfedgeMesh::twin(join.a)), c.face(join.b),
                             c.face(HalfedgeMesh::twin(join.b))};
    if (!certifyPatches(trial, patches)) return false;
    base.mesh = std::move(trial);
    return true;
}

}  // namespace

void smoothJoins(BaseDomain& base, const VectorizeSettings& settings, StageReport& report,
                 const std::stop_token& stop) {
    std::vector<SmoothJoin> smooth;
    size_t corners = 0, flips = 0, left = 0;
    for (const Join& join : featureJoins(base.mesh)) {
        if (stop.stop_requested()) break;
        const auto a = toPixels(base.mesh.controlPoints(join.a)),
                   b = toPixels(base.mesh.controlPoints(join.b));
        const glm::dvec2 handleA = a.p[1] - a.p[0], handleB = b.p[1] - b.p[0];
        const double lengths = glm::length(handleA) * glm::length(handleB);
        if (lengths <= 0 ||
            -glm::dot(handleA, handleB) < lengths * std::cos(glm::radians(settings.cornerDegrees))) {
            ++corners;
            continue;
        }
        bool free = true;
        for (const auto& [h, other] : {std::pair{join.a, join.b}, std::pair{join.b, join.a}}) {
            if (!holdsBoth(base.mesh.connectivity(), h, other)) continue;
            free = free && flipAway(base, h);
            flips += free;
        }
        if (free && makeSmooth(base, join, settings))
            smooth.push_back({join.vertex, HalfedgeMesh::edge(join.a), HalfedgeMesh::edge(join.b)});
        else
            ++left;
    }
    report.figures.emplace_back("smooth joins", double(smooth.size()));
    report.figures.emplace_back("corners", double(corners));
    report.figures.emplace_back("joins left G0", double(left));
    report.figures.emplace_back("flips for joins", double(flips));
    base.mesh.setSmoothJoins(std::move(smooth));
}

}  // namespace tessera
