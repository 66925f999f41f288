// What is known of edges: whether they are features, and how soft.
#pragma once

#include <array>
#include <span>

#include "core/base/result.h"
#include "core/edit/touched.h"
#include "core/mesh/blur_profile.h"

namespace tessera {

// Sets the blur of features. Where the edges, in this order, are a path, sigma (px, 0..kWidestBlurPx)
// goes from its value at the start of the first to that at the end of the last, by arc length; else both must
// be equal. `room`, where given, limits by edge what either end becomes, but takes nothing from one that is
// softer already. Fails with Usage where an edge is no feature.
Result<Touched> setBlur(PatchMesh& mesh, std::span<const EdgeId> edges, double sigmaStart, double sigmaEnd,
                        std::span<const std::array<double, 2>> room = {});

// Marks edges as features (hard ones) or unmarks them. A feature that is unmarked and has a jump of colours
// becomes a colour break; joins and blurs of unmarked edges go. Fails with Usage where an edge is on the
// picture's border.
Result<Touched> setFeature(PatchMesh& mesh, std::span<const EdgeId> edges, bool feature);

}  // namespace tessera
