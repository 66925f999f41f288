// Patch colour fitting (paper section 4.4): a thin-plate spline per patch and channel, by Eq. (5).
#pragma once

#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "core/mesh/patch_mesh.h"
#include "core/vectorize/settings.h"

namespace tessera {

// Where the constraints of Eq. (5) lie in a patch's domain: the corners and the middles of its n^2 small
// triangles, and for each corner within a side given in `pairedSides` (bit s for side s) a pair kPairOffset /
// n of the domain's height away from the side, one inside and one outside (Fig. 10); none at the domain's own
// corners.
constexpr double kPairOffset = .5;
std::vector<Barycentric> constraintPoints(int n, unsigned pairedSides);

// Fits every patch of `mesh` to the picture; `paths` by edge are the features' polylines (as in BaseDomain).
// Sides inside the picture that are no features have pairs. Variant "sampled"; variant "sampled-nowarp"
// leaves out the deformation of Fig. 11.
Result<PatchMesh> fitColors(PatchMesh mesh, std::span<const std::vector<glm::dvec2>> paths,
                            const Image& image, const VectorizeSettings& settings, StageReport& report,
                            Progress& progress);

}  // namespace tessera
