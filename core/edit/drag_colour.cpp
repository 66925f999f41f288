// See drag_colour.h.
#include "core/edit/drag_colour.h"

#include <algorithm>
#include <array>
#include <map>

#include "core/edit/colour_fan.h"
#include "core/edit/colour_samples.h"
#include "core/edit/site_fit.h"
#include "core/mesh/blur_profile.h"

namespace tessera {

namespace {

// How much of the change each corner gets; along an edge between two patches of the ring both have the same.
using Corners = std::array<double, 3>;

// The patches of the ring, each with its corners' shares: those around the patch's corners, where no locked
// patch is in the way, so that the share at `at` is 1.
std::map<PatchId, Corners> ringOf(const PatchMesh& mesh, PatchId p, const Barycentric& at) {
    const HalfedgeMesh& c = mesh.connectivity();
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
    std::map<PatchId, Corners> ring;
    for (int i = 0; i < 3; ++i)
        for (const HalfedgeId h : fans[size_t(i)]) {
            const PatchId q = c.face(h);
            const auto sides = c.sides(q);
            const auto corner = size_t(std::find(sides.begin(), sides.end(), h) - sides.begin());
            ring[q][corner] += at[i] / std::max(squares, kLeastSquares);
        }
    return ring;
}

// The spline with a change, of R, G and B premultiplied, laid on by a share that is even at 0 and at 1: so
// that no crease is seen where the ring ends.
PatchSpline changed(const PatchMesh& mesh, PatchId p, const Corners& shares, glm::dvec3 change) {
    float inBasis[3] = {float(change.x), float(change.y), float(change.z)};
    float* single[3] = {&inBasis[0], &inBasis[1], &inBasis[2]};
    fromWorking(mesh.colourBasis(), single, 1);
    SitePlanes added{};
    for (size_t i = 0; i < size_t(kCentreSites); ++i) {
        const Barycentric& b = sitePoints().barycentrics[i];
        const double share = smoothStep(0, 1, b.x * shares[0] + b.y * shares[1] + b.z * shares[2]);
        for (size_t c = 0; c < 3; ++c) added[c][i] = float(share) * inBasis[c];
    }
    return withAdded(mesh.spline(p), mesh.channels(), added);
}

}  // namespace

Touched dragColour(PatchMesh& mesh, PatchId p, const Barycentric& at, glm::dvec3 colour) {
    if (mesh.attributes(p).locked) return {};
    const auto ring = ringOf(mesh, p, at);
    Touched touched;
    if (!ring.contains(p)) return touched;
    // Once more with what the first fit left at the point itself.
    const PatchMesh start = mesh;
    glm::dvec3 change(0);
    for (int pass = 0; pass < 2; ++pass) {
        const ColourSample now = sampleColour(mesh, p, at);
        change += now.alpha * (colour - now.srgb);
        for (const auto& [q, shares] : ring) mesh.setSpline(q, changed(start, q, shares, change));
    }
    for (const auto& [q, shares] : ring)
        if (mesh.spline(q) != start.spline(q)) touched.patches.push_back(q);
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
