// The region around a place that features enclose, also where they have gaps.
#pragma once

#include "core/edit/patch_set.h"

namespace tessera {

// The widest gap that can be asked for, image px.
constexpr double kMostGapPx = 100;

// The patches that can be reached from the seed without crossing a feature or passing a gap: a passage
// between features (or a feature and the picture's border) that is narrower than gapPx (0..kMostGapPx) and
// than half of what lies on either side of it. So narrow regions and the corners of wide ones are whole. With
// 0, features alone count.
PatchSet enclosedByFeatures(const PatchMesh& mesh, PatchId seed, double gapPx);

}  // namespace tessera
