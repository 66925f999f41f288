// The region around a place that features enclose, also where they have gaps.
#pragma once

#include "core/edit/patch_colours.h"
#include "core/edit/patch_set.h"

namespace tessera {

// The widest gap that can be asked for, image px.
constexpr double kMostGapPx = 100;

// What outlines enclose around the seed. Of the patches that can be reached from it without crossing a
// feature, those that can be without passing a gap: a passage between features (or a feature and the
// picture's border) that is narrower than gapPx (0..kMostGapPx) and than half of what lies on either side of
// it. So narrow regions and the corners of wide ones are whole. Where features hold too little of the outline
// of that, and a smaller region of the same patches has a stronger one, made of features and of edges where
// colours change, that region (bestHeld). With 0, features alone count.
PatchSet enclosedByFeatures(const PatchMesh& mesh, const PatchColours& colours, PatchId seed, double gapPx);
PatchSet enclosedByFeatures(const PatchMesh& mesh, PatchId seed, double gapPx);

}  // namespace tessera
