// Stage "curves", variant "error": edges between patches become cubics where their two patches then follow
// the picture more closely (in the place of the paper's section 4.3).
#pragma once

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "core/mesh/patch_mesh.h"
#include "core/vectorize/settings.h"

namespace tessera {

// Bends edges of a certified mesh of `picture` whose edges are straight but for its features. An edge becomes
// a cubic only where the errors of its two patches (parameter_fit.h) fall by more than a curved edge is
// worth; features and the picture's border stay as they are, and so do the patches' splines. Every patch
// stays certified, and those beside a bent edge have the default interior point and an evenness of at least
// kLeastEvenness. The same bytes for any number of threads. Files the figures "curved edges", "edges" (that
// might have been), "error before" and "error after". Stopped within 50 ms of a request to stop.
Result<PatchMesh> bendEdges(PatchMesh mesh, const Image& picture, StageReport& report, Progress& progress);

// The smallest Bernstein coefficient of det J over the mean of all 15 (which is the patch's area over the
// base triangle's) that a bent edge may leave its patches: 1 in an affine patch, 0 at the brink of folding.
// The splines live in the parametric domain, so an uneven Jacobian costs them detail.
constexpr double kLeastEvenness = .2;

}  // namespace tessera
