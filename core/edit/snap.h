// Curves moved onto the edges of the photo that they miss.
#pragma once

#include <span>

#include "core/base/result.h"
#include "core/edit/touched.h"
#include "core/image/image.h"

namespace tessera {

// How far from a curve an edge of the photo is looked for, px.
constexpr double kSnapReachPx = 8;

// Moves curves onto the strongest edge of the photo within kSnapReachPx along their normals, as far as
// patches stay certified. `photo` has the mesh's size. Fails with Usage where there is no such edge.
Result<Touched> snapToFeature(PatchMesh& mesh, const Image& photo, std::span<const EdgeId> edges);

}  // namespace tessera
