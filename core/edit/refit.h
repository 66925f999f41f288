// Colours fitted anew to the photo, after a reshape.
#pragma once

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/edit/patch_set.h"
#include "core/edit/touched.h"
#include "core/image/image.h"

namespace tessera {

// Fits the colours of the editable patches of the set, and of one ring around them, to the photo, by the
// least squares of the stage "colours" (solve_colors.h) with all other patches held. `photo` has the mesh's
// size and channels. Features and colour breaks stay jumps. Fails with Stopped alone, the mesh then being as
// it was.
Result<Touched> refitColours(PatchMesh& mesh, const Image& photo, const PatchSet& set,
                             const ProgressPart& progress);
// The same to its end.
Touched refitColours(PatchMesh& mesh, const Image& photo, const PatchSet& set);

}  // namespace tessera
