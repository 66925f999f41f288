// A patch's colour edited at a point, and the way back to the fitted colours.
#pragma once

#include <glm/vec3.hpp>

#include "core/edit/patch_set.h"
#include "core/edit/touched.h"

namespace tessera {

// Gives the patch `colour` (gamma-encoded sRGB, not premultiplied) at parameters `at`, before blur. The patch
// and those around its corners that no feature and no colour break separates from it change along: the
// difference and its slope fall to 0 on the outer edges of this ring, and seams rise by less than a level.
// Changes nothing where the patch is locked; locked patches of the ring stay, and so do the corners that they
// share (then the colour may not be reached).
Touched dragColour(PatchMesh& mesh, PatchId p, const Barycentric& at, glm::dvec3 colour);

// Whether `fitted` still has the patch: the same corners and sides, and colours.
bool hasFitted(const PatchMesh& mesh, const PatchMesh& fitted, PatchId p);

// Gives the editable patches of the set the colours that they have in `fitted`, the mesh as it was
// vectorized. Colour breaks between fitted patches go. Patches that `fitted` has no more (hasFitted) stay.
Touched resetColours(PatchMesh& mesh, const PatchMesh& fitted, const PatchSet& set);

}  // namespace tessera
