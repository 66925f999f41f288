// Which patches still show the photo that they were made from.
#pragma once

#include "core/edit/patch_set.h"
#include "core/image/image.h"

namespace tessera {

// Those of the set whose own colours and whose neighbours' are the ones of `fitted`, the mesh as it was
// vectorized, or as near to the photo's as a refit's: so that refitting them and the ring around them takes
// back no recolouring. `photo` has the mesh's size.
PatchSet showingPhoto(const PatchMesh& mesh, const PatchMesh& fitted, const Image& photo,
                      const PatchSet& set);

}  // namespace tessera
