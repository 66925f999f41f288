// Pictures from and to files, through OpenImageIO and lcms2.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/image/image.h"

namespace tessera {

// Where a picture came from: kept in the document so that the source can be found, checked and written back
// in its own colour space.
struct SourceInfo {
    std::string fileName;   // without folders
    uint64_t byteSize = 0;  // of the file
    std::string sha256;     // of the file, 64 hex digits
    std::string format;     // as OpenImageIO names it: "png", "jpeg", "tiff", "openexr", ...
    int width = 0;          // after the EXIF orientation is applied
    int height = 0;
    int bitsPerChannel = 0;           // 8 (or fewer), 16 (integer or half) or 32
    std::vector<uint8_t> iccProfile;  // as embedded; empty where the file has none

    bool operator==(const SourceInfo&) const = default;
};

struct LoadedImage {
    Image image;
    SourceInfo source;
};

struct ReadLimits {
    uint64_t maxPixels = 400'000'000;
};

// Reads any picture that OpenImageIO knows and whose bytes tell its format (the name plays no part): grey,
// grey + alpha, RGB, RGBA, palette, CMYK; 8 and 16 bit, half and float; of several pictures in a file the
// first, of the channels of an EXR file R, G, B and A (or Y), of its windows the data window. EXIF
// orientation is applied; an embedded ICC profile is converted to sRGB by lcms2 (relative colorimetric,
// unbounded: what lies outside sRGB keeps values outside 0..1); one that does not fit the samples is kept in
// SourceInfo and otherwise ignored. Linear float pictures without a profile are encoded with sRGB's curve,
// odd-symmetric about 0. NaN and infinite samples become 0, and so does the colour of pixels whose alpha is
// 0. Fails with CannotRead on missing, foreign, damaged or truncated files and on pictures of more than
// limits.maxPixels pixels, before memory for the pixels is taken. Prints nothing.
Result<LoadedImage> readImage(const std::string& path, const ReadLimits& limits = {});

// The same from bytes in memory; `fileName` names them in errors and in SourceInfo.
Result<LoadedImage> readImage(const std::vector<uint8_t>& bytes, const std::string& fileName,
                              const ReadLimits& limits = {});

enum class PictureFormat { Png, Jpeg, Tiff, Exr };

struct WriteOptions {
    int bitsPerChannel = 8;  // 8 or 16 for PNG and TIFF; JPEG is 8, EXR is half float, linear
    int jpegQuality = 95;    // 1..100
    // The colour that the picture is composed over, gamma-encoded sRGB; where there is none, transparency is
    // kept (JPEG: composed over white).
    std::optional<std::array<float, 3>> background = {};
    bool embedProfile = true;  // EXR has none
    // Colours are converted to this profile's (relative colorimetric); sRGB where it is empty, is not one of
    // an RGB space that can be written to, and in an EXR.
    std::vector<uint8_t> iccProfile = {};
};

// The format that a path's suffix asks for; Usage where there is none that we write.
Result<PictureFormat> pictureFormatFor(const std::string& path);

// Writes a working-space image, un-premultiplied as the format wants it, clamped to the format's range,
// tagged with its colour space (EXR: linear, premultiplied). The file appears whole or not at all: a
// temporary beside it is synced and renamed. `progress`, where given, is stepped within the caller's stage.
// Fails with CannotWrite, or with Stopped.
Result<void> writeImage(const Image& image, const std::string& path, const WriteOptions& options = {},
                        Progress* progress = nullptr);

// The picture as the bytes of a PNG of 8 bits a channel, as writeImage would write it without a profile.
Result<std::vector<uint8_t>> encodePng(const Image& image);

}  // namespace tessera
