// The x4 test of `tessera-cli bench`: how a vectorization of a small picture does as a magnifier.
#pragma once

#include "app/cli_support.h"
#include "core/image/image.h"
#include "core/vectorize/settings.h"

namespace tessera::cli {

constexpr int kMagnification = 4;

// Cuts `picture` to a multiple of kMagnification, shrinks it by box means, vectorizes that with `settings`
// but for the number of patches and terms, draws the patches at the first size with 4 samples a pixel, and
// compares. One rule for all pictures: 105 terms a patch (of the paper's method its 16 a channel), and as
// many patches as store no more coefficients than the small picture has samples; where features pin the mesh
// above that, "within_budget" is false. Figures: "psnr" and "ssim" of the patches and, with "_bicubic" and
// "_lanczos", of cv::resize from the same small picture; "advantage_db" over bicubic. Usage for a picture of
// less than kMagnification pixels a side.
Result<Json> measureMagnified(const Image& picture, VectorizeSettings settings);

}  // namespace tessera::cli
