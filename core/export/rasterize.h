// The CPU renderer: the oracle for every other one, and fast enough to draw the window with (paper section
// 5).
#pragma once

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "core/mesh/patch_mesh.h"
#include "core/mesh/view.h"

namespace tessera {

// What a renderer found at each pixel centre of a view: the patch that owns it and the point's barycentric
// parameters.
struct PixelOwner {
    PatchId patch;       // none outside the picture
    float v = 0, w = 0;  // u = 1 - v - w
};

struct RasterizeOptions {
    int samples = 1;     // per pixel: 1 (its centre), 4 or 16 (a regular grid, averaged)
    double sharpen = 1;  // multiplies the blur of every feature; 0 draws hard features
    // Hidden patches are drawn as any other, or left out as those that are cut out always are. Where any is
    // left out the picture has an alpha channel, and 0 in its place.
    bool showHidden = true;
};

// (a) Section 5 as it stands: every patch is subdivided 4-way until a piece's bounding box is smaller than an
// output pixel; pieces are triangles; a pixel centre in one gets its parameters by barycentric interpolation,
// then its colour by one evaluation of the spline. Slow and plain: the reference. Pixels that no piece covers
// stay 0: up to one in ten thousand falls into a crack between neighbouring pieces that were cut to different
// depths, also within a patch.
Image rasterizeReference(const PatchMesh& mesh, const View& view, double sharpen = 1);
std::vector<PixelOwner> locatePixelsReference(const PatchMesh& mesh, const View& view);

// (b) The fast path: each edge's curve meets the rows of pixel centres once, and both patches beside it use
// the same crossings, so that a pixel centre has one owner; parameters by Newton's method where a patch is
// not affine; splines evaluated a patch at a time with vector instructions; tiles in parallel. A pixel's
// value depends neither on threads nor on tiles, and views of one scale whose origins are whole output pixels
// apart agree on it. A pixel centre on a curve belongs to the patch on its right, or below. Output is in the
// working space, not clamped, transparent or 0 outside the picture. `progress`, where given, is stepped
// within the caller's stage. Fails only with Stopped.
Result<Image> rasterize(const PatchMesh& mesh, const View& view, const RasterizeOptions& options = {},
                        Progress* progress = nullptr);
// Owners of the pixel centres by the same scan conversion, row by row.
std::vector<PixelOwner> locatePixels(const PatchMesh& mesh, const View& view);

}  // namespace tessera
