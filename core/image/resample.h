// Smaller and larger versions of a picture, for the x4 test of `tessera-cli bench`. In the working space.
#pragma once

#include "core/image/image.h"

namespace tessera {

// The means of factor x factor pixels, as a sensor with larger pixels would see them. Columns and rows at the
// right and the bottom that fill no whole pixel are left out; factor >= 1, at most the picture's sides.
Image boxDownsample(const Image& image, int factor);

// The upper left part of `image`: width x height pixels, at most its own.
Image cropped(const Image& image, int width, int height);

enum class ResampleFilter { Bicubic, Lanczos };

// `image` magnified by a whole factor with cv::resize's INTER_CUBIC (Keys 1981, a = -.75) or INTER_LANCZOS4.
// Not clamped.
Image upsample(const Image& image, int factor, ResampleFilter filter);

}  // namespace tessera
