// See drag_colour.h.
#include "core/edit/drag_colour.h"

#include <algorithm>
#include <array>
#include <map>

#include "core/edit/colour_fan.h"
#include "core/edit/colour_samples.h"

namespace tessera {

Touched dragColour(PatchMesh& mesh, PatchId p, const Barycentric& at, glm::dvec3 colour) {
    const HalfedgeMesh& c = mesh.connectivity();
    if (mesh.attributes(p).locked) return {};
    const ColourSample now = sampleColour(mesh, p, at);
    const glm::dvec3 change = now.alpha * (colour - now.srgb);
    std::array<std::vector<HalfedgeId>, 3> fans;
    double squares = 0;
    for (int i = 0; i < 3; ++i) {
        auto& fan = fans[size_t(i)];
        fan = fanOf(mesh, c.sides(p)[size_t(i)]);
        if (std::any_of(fan.begin(), fan.end(),
                        [&](HalfedgeId h) { return mesh.attributes(c.face(h)).locked; }))
            fan.clear();
        else
            squares += at[i] * at[i];
    }
    // Where only far corners are free they would have to move too much.
    constexpr double kLeastSquares = .1;
    std::map<PatchId, CornerValues> raised;
    for (int i = 0; i < 3; ++i) {
        const glm::dvec3 value = at[i] / std::max(squares, kLeastSquares) * change;
        for (const HalfedgeId h : fans[size_t(i)]) {
            const PatchId q = c.face(h);
            const auto sides = c.sides(q);
            const auto corner = size_t(std::find(sides.begin(), sides.end(), h) - sides.begin());
            for (int channel = 0; channel < 3; ++channel)
                raised[q][size_t(channel)][corner] += float(value[channel]);
        }
    }
    Touched touched;
    for (const auto& [q, values] : raised) {
        mesh.setSpline(q, withCornersRaised(mesh.spline(q), mesh.colourBasis(), values));
        touched.patches.push_back(q);
    }
    return touched;
}

bool hasFitted(const PatchMesh& mesh, const PatchMesh& fitted, PatchId p) {
    const HalfedgeMesh &now = mesh.connectivity(), &then = fitted.connectivity();
    return p.index < then.faceCapacity() && then.alive(p) && now.alive(p) && now.sides(p) == then.sides(p) &&
           now.corners(p) == then.corners(p) && mesh.channels() == fitted.channels() &&
           mesh.colourBasis() == fitted.colourBasis() && !fitted.spline(p).coefficients.empty();
}

Touched resetColours(PatchMesh& mesh, const PatchMesh& fitted, const PatchSet& set) {
    const HalfedgeMesh& c = mesh.connectivity();
    std::vector<PatchId> patches;
    std::vector<EdgeId> edges;
    const auto asFitted = [&](PatchId p) {
        return hasFitted(mesh, fitted, p) && mesh.spline(p) == fitted.spline(p);
    };
    for (const PatchId p : editable(mesh, set)) {
        if (!hasFitted(mesh, fitted, p) || asFitted(p)) continue;
        mesh.setSpline(p, fitted.spline(p));
        patches.push_back(p);
    }
    for (const PatchId p : patches)
        for (const HalfedgeId side : c.sides(p)) {
            const PatchId beyond = c.face(HalfedgeMesh::twin(side));
            EdgeCurve curve = mesh.curve(HalfedgeMesh::edge(side));
            if (!curve.colourBreak || !beyond.valid() || !asFitted(beyond)) continue;
            curve.colourBreak = false;
            mesh.setCurve(HalfedgeMesh::edge(side), curve);
            edges.push_back(HalfedgeMesh::edge(side));
        }
    return touchedOf({}, std::move(edges), std::move(patches));
}

}  // namespace tessera
