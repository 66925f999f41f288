// What a JPEG file of a picture takes: the measure of bytes that everybody knows, for `tessera-cli bench`.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"

namespace tessera {

// The picture over white as a baseline JPEG of libjpeg's `quality` (1..100): 4:2:0, optimized Huffman tables,
// nothing but the JFIF header beside the image. Usage for an empty picture, one of more than 65500 pixels a
// side or another quality.
Result<std::vector<uint8_t>> encodeReferenceJpeg(const Image& image, int quality);

// The bytes of such a file at this PSNR from the picture (by compareImages): log bytes are interpolated
// between the two neighbouring qualities. Empty where no pair of qualities has the PSNR between them.
Result<std::optional<double>> referenceJpegBytes(const Image& image, double psnr);

}  // namespace tessera
