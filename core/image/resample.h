// Smaller and larger versions of a picture, in the working space.
#pragma once

#include <stop_token>

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

// `image` magnified by a whole factor so that the means over factor x factor pixels are about its pixels
// again: bicubic, then by iterated back projection (Irani and Peleg 1991). Nearer to what a finer sensor
// would have seen than bicubic is. Incomplete where `stop` is asked for.
Image enlargedMeans(const Image& image, int factor, const std::stop_token& stop = {});

}  // namespace tessera
