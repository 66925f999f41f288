// Line drawings of a mesh: what `stages` shows of the pipeline (the paper's Fig. 2).
#pragma once

#include "core/image/image.h"
#include "core/mesh/patch_mesh.h"
#include "core/vectorize/feature_network.h"
#include "core/vectorize/features.h"
#include "core/vectorize/initial_mesh.h"

namespace tessera {

// All of them are opaque pictures of `scale` output pixels per image pixel, over `background` (a picture of
// the unscaled size, drawn pale; may be empty: white). Features are red, other edges dark blue, vertices
// dots.

Image drawFeatures(const std::vector<PixelChain>& chains, int width, int height, int scale,
                   const Image& background);
// The curves of a network; its nodes are dots.
Image drawFeatures(const FeatureNetwork& network, int scale, const Image& background);
// The square window of `windowPx` around the picture's middle (or as much of it as there is).
Image drawInitialMesh(const ChannelMeshes& meshes, int windowPx, int scale, const Image& background);
// Patch boundaries as curves, or as the straight lines between their ends.
enum class Outline { Curves, Chords };
Image drawPatches(const PatchMesh& mesh, Outline outline, int scale, const Image& background);

// `gain` times the difference of two pictures of equal size and channels, around mid-grey, clamped to 0..1.
Image residual(const Image& a, const Image& b, double gain);

}  // namespace tessera
