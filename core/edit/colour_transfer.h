// Colours carried over where patches have come to lie on what others showed before.
#pragma once

#include "core/edit/patch_set.h"
#include "core/mesh/bezier.h"

namespace tessera {

// The colours that the patches `from` of a mesh show on `shape`, as those of a patch of that shape, fitted
// (fittedLike) like the spline of `like`, which is one of them. Of `from` those count that are joined with
// `like` across edges other than features and colour breaks; where the shape reaches beyond them it gets the
// colours of their nearest points.
PatchSpline transferredColours(const PatchMesh& mesh, const PatchSet& from, PatchId like,
                               const BezierTriangle& shape);

}  // namespace tessera
