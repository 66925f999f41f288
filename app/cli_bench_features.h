// How well a mesh is cut along the edges of its picture.
#pragma once

#include "app/cli_support.h"
#include "core/image/image.h"
#include "core/mesh/patch_mesh.h"

namespace tessera::cli {

// The reference edges, the same for every method: Canny's thresholds for a Sobel gradient of 8-bit luma (a
// step of 25 levels has 100 where nothing is smoothed), and the shortest chain that counts. Outlines are
// those of the picture smoothed with Canny's sigma; without smoothing texture counts as well.
constexpr double kOutlineSigmaPx = 1.4;
constexpr double kReferenceLow = 100;
constexpr double kReferenceHigh = 200;
constexpr int kReferenceMinPixels = 20;
constexpr double kRecallReachPx = 1;
constexpr int kNearEdgePx = 2;

// "reference_px": length of the outlines of `picture`. "recall": the share of it within kRecallReachPx of a
// feature curve of `mesh`; null without any. "detail_px", "detail_recall": the same of all its edges.
// "cut_px": length of the feature curves. "feature_share": of all edges those that are features.
// "edge_error_ratio": mean |difference| of `rendering` from `picture` within kNearEdgePx of the outlines,
// over that of the whole picture; null where one of them is not defined. `rendering` has the picture's size.
Json measureFeatures(const Image& picture, const Image& rendering, const PatchMesh& mesh);

}  // namespace tessera::cli
