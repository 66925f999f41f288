// Figures of a document that several commands print.
#pragma once

#include "app/cli_support.h"
#include "core/mesh/patch_mesh.h"

namespace tessera::cli {

// "patches", "vertices", "curves", "features".
Json countsOf(const PatchMesh& mesh);
// Numbers that describe the colours, all patches and channels together.
size_t coefficientCount(const PatchMesh& mesh);

}  // namespace tessera::cli
