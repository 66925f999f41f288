// Meshes to edit, as vectorizing makes them.
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "core/mesh/mesh_validate.h"
#include "core/vectorize/vectorize.h"
#include "tests/support/painted_image.h"

namespace tessera::testing {

// Soft waves of strong colours with a disc and a bar.
inline Image editScene(int width, int height, int channels = 3) {
    return paint(width, height, channels, [&](double x, double y, int c) {
        const double u = x / width, v = y / height;
        if (c == 3) return v > .8 ? .5 : 1.0;
        double value = .45 + .25 * std::sin(7 * u + 2 * c) * std::cos(5 * v + c);
        if (std::hypot(x - .4 * width, y - .45 * height) < .2 * height)
            value = .8 - .25 * c + .1 * std::sin(20 * u);
        if (std::abs(x - .75 * width - .2 * y) < .04 * width) value = .1 + .1 * c;
        return c < 3 && channels == 4 ? value * (v > .8 ? .5 : 1.0) : value;
    });
}

// The scene as patches: splines on sites in the opponent basis, features with blur and smooth joins.
inline PatchMesh sceneMesh(int width = 200, int height = 150, int patches = 220, int channels = 3) {
    VectorizeSettings settings;
    settings.patches = patches;
    Progress progress;
    auto result = vectorize(editScene(width, height, channels), settings, progress);
    EXPECT_TRUE(result.has_value());
    return result ? std::move(result->mesh) : PatchMesh{};
}

inline void expectValid(const PatchMesh& mesh) {
    const MeshValidation validation = validate(mesh);
    EXPECT_TRUE(validation.valid()) << (validation.violations.empty() ? "" : validation.violations.front());
}

// Whether two meshes have the same elements with the same values.
inline bool sameMesh(const PatchMesh& a, const PatchMesh& b) {
    const HalfedgeMesh &ca = a.connectivity(), &cb = b.connectivity();
    if (ca.faceCapacity() != cb.faceCapacity() || ca.edgeCapacity() != cb.edgeCapacity() ||
        ca.vertexCapacity() != cb.vertexCapacity() || a.smoothJoins() != b.smoothJoins())
        return false;
    bool same = true;
    for (uint32_t v = 0; v < ca.vertexCapacity(); ++v)
        same = same && ca.alive(VertexId(v)) == cb.alive(VertexId(v)) &&
               a.position(VertexId(v)) == b.position(VertexId(v));
    for (uint32_t e = 0; e < ca.edgeCapacity(); ++e)
        same = same && ca.alive(EdgeId(e)) == cb.alive(EdgeId(e)) && a.curve(EdgeId(e)) == b.curve(EdgeId(e));
    a.forEachPatch([&](PatchId p) {
        same = same && cb.alive(p) && ca.corners(p) == cb.corners(p) && a.interior(p) == b.interior(p) &&
               a.spline(p) == b.spline(p) && a.attributes(p) == b.attributes(p);
    });
    return same && ca.faceCount() == cb.faceCount();
}

// The patches that differ between two meshes of one connectivity.
inline std::vector<PatchId> changedPatches(const PatchMesh& a, const PatchMesh& b) {
    std::vector<PatchId> changed;
    a.forEachPatch([&](PatchId p) {
        if (a.controlPoints(p).p != b.controlPoints(p).p || a.spline(p) != b.spline(p) ||
            a.attributes(p) != b.attributes(p))
            changed.push_back(p);
    });
    return changed;
}

}  // namespace tessera::testing
