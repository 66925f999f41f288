// Patch colours by area-weighted least squares over the cells of a picture, with centres and terms where they
// pay, and one joint solve in which neighbours agree along edges that are no features.
#pragma once

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "core/mesh/patch_mesh.h"
#include "core/vectorize/fit_picture.h"
#include "core/vectorize/settings.h"
#include "core/vectorize/site_pursuit.h"

namespace tessera {

// The picture with its first three channels in `basis`, as fits want it.
Image inBasis(Image picture, ColourBasis basis);

// Stage "colours", variant "joint": `picture` in the opponent basis, as the result is; `choices` by patch id.
Result<PatchMesh> solveColors(PatchMesh mesh, FitPicture picture, const std::vector<SiteChoice>& choices,
                              const VectorizeSettings& settings, StageReport& report,
                              const ProgressPart& progress);

// The same least squares for the patches alone whose choice has sites; the others are held, and seams toward
// them count as much. `picture` in the mesh's basis. The patches that were solved, by ascending id; where it
// is stopped the mesh stays as it was.
Result<std::vector<PatchId>> refitColors(PatchMesh& mesh, const FitPicture& picture,
                                         const std::vector<SiteChoice>& choices, double seamGradientWeight,
                                         double seamWeight, const ProgressPart& progress);

}  // namespace tessera
