// JPEG files of four components, through libjpeg: OpenImageIO turns them into RGB by a rule of thumb and so
// loses what their colour profile needs.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/result.h"

namespace tessera {

// Row by row, 4 bytes a pixel: the amounts of cyan, magenta, yellow and black ink, 0 (none) to 255.
struct CmykPixels {
    int width = 0;
    int height = 0;
    std::vector<uint8_t> ink;
};

// Fails with CannotRead on damaged and truncated files; the message is only libjpeg's reason. The caller has
// checked the size that the header claims.
Result<CmykPixels> readCmykJpeg(std::span<const uint8_t> bytes);

// Whether a message of libjpeg's is about something that every viewer forgives: stray bytes between segments,
// and spectral selection given in a sequential scan. Both come from cameras and harm no pixel.
bool isHarmlessJpegWarning(const std::string& message);

}  // namespace tessera
