// Which part of the picture an edit can have changed.
#pragma once

#include "core/edit/touched.h"
#include "core/mesh/patch_query.h"

namespace tessera {

// The box, in image px, of all that looks otherwise in `after` than in `before`, where the two have the same
// connectivity and differ by `touched`: of the patches touched, and as far beyond as their blur reaches.
// The whole picture where features or their blur are others, since they change their chain's other curves
// too.
Rect damagedArea(const PatchMesh& before, const PatchMesh& after, const Touched& touched);

}  // namespace tessera
