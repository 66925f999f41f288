// Recolouring with a brush.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <utility>
#include <vector>

#include "core/edit/patch_set.h"
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

// The same for a gesture: a longer stroke costs what it covers beyond the one before.
class BrushStroke {
  public:
    // `query` is over the geometry of `start` and stays.
    BrushStroke(PatchMesh start, const PatchQuery& query, const BrushOptions& options);

    // Draws the stroke on a mesh that equals the start. A stroke begins with the points of the last call's.
    Touched draw(PatchMesh& mesh, std::span<const glm::dvec2> stroke);

  private:
    PatchMesh mStart, mPainted;
    const PatchQuery& mQuery;
    BrushOptions mOptions;
    std::vector<std::pair<glm::dvec2, glm::dvec2>> mSegments;
    PatchSet mTouched;
};

}  // namespace tessera
