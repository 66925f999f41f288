// The samples of a picture in the order and form in which its file has them: what decoders do, and no colour
// science.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/image/color_management.h"
#include "core/image/image_io.h"

namespace tessera {

// A picture that has been opened and found acceptable; its pixels are not decoded yet.
struct ImageSource {
    SourceInfo info;      // complete but for byteSize, sha256 and fileName; width and height as stored
    int orientation = 1;  // EXIF's, 1..8
    ColorConverter converter = ColorConverter::plain(ColorModel::Rgb);

    // A pixel as `readRows` delivers it: `channels` floats, of which those at `color` are the converter's
    // samples.
    size_t channels = 0;
    std::vector<size_t> color;
    int alpha = -1;           // its channel, or -1
    bool associated = false;  // colours are multiplied by alpha

    // Fills rows [begin, end); called with increasing ranges whose bounds are multiples of rowStep (or the
    // end). CannotRead on damage; the message is the end of a sentence, as below.
    std::function<Result<void>(int begin, int end, std::span<float> samples)> readRows;
    int rowStep = 1;
};

// Opens the picture in `bytes`, which must outlive the source. The message of an Error is the end of a
// sentence: the reason and what to do. May throw what OpenImageIO throws.
Result<ImageSource> openImageSource(const std::vector<uint8_t>& bytes, const ReadLimits& limits);

}  // namespace tessera
