// Recolouring with a brush.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>

#include "core/edit/touched.h"
#include "core/mesh/patch_query.h"

namespace tessera {

struct BrushOptions {
    double radiusPx = 16;
    double hardness = .5;     // share of the radius that has full strength, 0..1
    glm::dvec3 colour{0};     // gamma-encoded sRGB
    double strength = 1;      // 0..1
    bool keepShading = true;  // as of Tint; else the colour itself is laid on
};

// Draws a stroke along image points. What the stroke covers twice has the strength of once. The patches under
// the stroke that are not locked are refitted; their splines gain terms where the brush is finer than they
// are. `query` is over a mesh of the same geometry. Features do not stop the brush.
Touched brush(PatchMesh& mesh, const PatchQuery& query, std::span<const glm::dvec2> stroke,
              const BrushOptions& options);

}  // namespace tessera
