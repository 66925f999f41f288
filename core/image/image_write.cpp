// Writing of image_io.h.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/half.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "core/base/atomic_file.h"
#include "core/base/parallel.h"
#include "core/image/color_management.h"
#include "core/image/image_io.h"

namespace tessera {

namespace {

struct FormatEntry {
    const char* suffix;
    PictureFormat format;
};

constexpr FormatEntry kSuffixes[] = {
    {".png", PictureFormat::Png},  {".jpg", PictureFormat::Jpeg},  {".jpeg", PictureFormat::Jpeg},
    {".tif", PictureFormat::Tiff}, {".tiff", PictureFormat::Tiff}, {".exr", PictureFormat::Exr},
};

const char* writerName(PictureFormat format) {
    switch (format) {
        case PictureFormat::Png:
            return "png";
        case PictureFormat::Jpeg:
            return "jpeg";
        case PictureFormat::Tiff:
            return "tiff";
        case PictureFormat::Exr:
            return "openexr";
    }
    return "";
}

tl::unexpected<Error> cannotWrite(const std::string& name, const std::string& why) {
    return failure(ErrorCode::CannotWrite, "cannot write \"" + name + "\": " + why);
}

// Interleaved samples of one whole picture, as the writer wants them.
struct Samples {
    int channels = 3;
    std::vector<uint16_t> values;  // integers of `bits` bits, or the bits of half floats
};

// The colour of a pixel not multiplied by its alpha; 0 where that is 0.
std::array<float, 3> straightColor(const Image& image, size_t at, float alpha) {
    std::array<float, 3> color{};
    for (int c = 0; c < 3; ++c) {
        const float value = image.plane(c)[at];
        if (alpha > 0 && std::isfinite(value)) color[size_t(c)] = alpha < 1 ? value / alpha : value;
    }
    return color;
}

float clampedAlpha(const Image& image, size_t at) {
    if (!image.hasAlpha()) return 1;
    const float alpha = image.plane(3)[at];
    return alpha > 0 ? std::min(alpha, 1.f) : 0;  // NaN is 0
}

float clamped(float value) {
    return value > 0 ? std::min(value, 1.f) : 0;
}

void convertPixel(const Image& image, size_t at, PictureFormat format, float scale, uint16_t* out) {
    const float alpha = clampedAlpha(image, at);
    const bool keepAlpha = image.hasAlpha() && format != PictureFormat::Jpeg;
    if (format == PictureFormat::Exr) {
        constexpr float kMaxHalf = 65504;
        const std::array<float, 3> color = straightColor(image, at, alpha);
        for (size_t c = 0; c < 3; ++c)
            out[c] = half(std::clamp(decodeSrgb(color[c]) * alpha, -kMaxHalf, kMaxHalf)).bits();
        if (keepAlpha) out[3] = half(alpha).bits();
        return;
    }
    const auto quantized = [&](float value) { return uint16_t(std::lround(clamped(value) * scale)); };
    if (keepAlpha) {
        const std::array<float, 3> color = straightColor(image, at, alpha);
        for (size_t c = 0; c < 3; ++c) out[c] = quantized(color[c]);
        out[3] = quantized(alpha);
    } else {
        for (size_t c = 0; c < 3; ++c) out[c] = quantized(image.plane(int(c))[at] + (1 - alpha));
    }
}

Samples convert(const Image& image, PictureFormat format, int bits) {
    Samples samples;
    samples.channels = image.hasAlpha() && format != PictureFormat::Jpeg ? 4 : 3;
    samples.values.resize(image.planeSize() * size_t(samples.channels));
    const float scale = bits == 16 ? 65535 : 255;
    constexpr size_t kGrain = 16384;
    parallelFor(image.planeSize(), kGrain, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i)
            convertPixel(image, i, format, scale, &samples.values[i * size_t(samples.channels)]);
    });
    return samples;
}

OIIO::ImageSpec specFor(const Image& image, const Samples& samples, PictureFormat format,
                        const WriteOptions& options) {
    const OIIO::TypeDesc type = format == PictureFormat::Exr   ? OIIO::TypeDesc::HALF
                                : options.bitsPerChannel == 16 ? OIIO::TypeDesc::UINT16
                                                               : OIIO::TypeDesc::UINT8;
    OIIO::ImageSpec spec(image.width(), image.height(), samples.channels, type);
    // Without these two some writers put the time of writing and a version into the file: the same picture
    // shall give the same bytes.
    spec.attribute("DateTime", "2000:01:01 00:00:00");
    spec.attribute("Software", "Tessera");
    if (format == PictureFormat::Png) spec.erase_attribute("DateTime");
    spec.attribute("oiio:ColorSpace", format == PictureFormat::Exr ? "Linear" : "sRGB");
    if (format != PictureFormat::Exr) spec.attribute("oiio:UnassociatedAlpha", 1);
    if (format == PictureFormat::Jpeg || format == PictureFormat::Tiff) {
        const std::vector<uint8_t> icc = srgbProfile();
        spec.attribute("ICCProfile", OIIO::TypeDesc(OIIO::TypeDesc::UINT8, int(icc.size())), icc.data());
    }
    if (format == PictureFormat::Jpeg) {
        spec.attribute("Compression", "jpeg:" + std::to_string(options.jpegQuality));
        spec.attribute("jpeg:subsampling", "4:4:4");
    }
    if (format == PictureFormat::Tiff) spec.attribute("Compression", "zip");
    return spec;
}

// Writes to `path`, or into `bytes` where that is not null. Returns the reason of a failure.
std::string writeSamples(const OIIO::ImageSpec& spec, const Samples& samples, PictureFormat format,
                         const std::string& path, std::vector<uint8_t>* bytes) {
    std::unique_ptr<OIIO::Filesystem::IOVecOutput> memory;
    const auto output = OIIO::ImageOutput::create(writerName(format));
    if (!output) return OIIO::geterror();
    OIIO::ImageSpec opened = spec;
    if (bytes) {
        memory = std::make_unique<OIIO::Filesystem::IOVecOutput>(*bytes);
        OIIO::Filesystem::IOProxy* proxy = memory.get();
        opened.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    }
    bool ok = output->open(path, opened);
    if (ok && spec.format == OIIO::TypeDesc::UINT8) {
        const std::vector<uint8_t> narrow(samples.values.begin(), samples.values.end());
        ok = output->write_image(OIIO::TypeDesc::UINT8, narrow.data());
    } else if (ok) {
        ok = output->write_image(spec.format, samples.values.data());
    }
    ok = output->close() && ok;
    const std::string why = output->geterror();
    if (ok) return {};
    return why.empty() ? "the encoder gave up" : why;
}

std::string optionsDefect(const Image& image, PictureFormat format, const WriteOptions& options) {
    if (image.empty() || image.channels() < 3) return "the picture is empty; there is nothing to write";
    const bool chooses = format == PictureFormat::Png || format == PictureFormat::Tiff;
    if (chooses && options.bitsPerChannel != 8 && options.bitsPerChannel != 16)
        return "the bits per channel must be 8 or 16";
    if (format == PictureFormat::Jpeg && (options.jpegQuality < 1 || options.jpegQuality > 100))
        return "the JPEG quality must be from 1 to 100";
    if (format == PictureFormat::Jpeg && std::max(image.width(), image.height()) > 65500)
        return "a JPEG cannot be more than 65500 pixels wide or high; choose PNG or TIFF";
    if (format == PictureFormat::Png && std::max(image.width(), image.height()) > 1'000'000)
        return "a PNG cannot be more than a million pixels wide or high; choose TIFF";
    return {};
}

// To `path`, or into `bytes` where that is not null; `name` is for messages.
Result<void> writeTo(const Image& image, PictureFormat format, const WriteOptions& options,
                     const std::string& name, const std::string& path, std::vector<uint8_t>* bytes) {
    if (std::string why = optionsDefect(image, format, options); !why.empty()) return cannotWrite(name, why);
    try {
        const int bits = format == PictureFormat::Jpeg ? 8 : options.bitsPerChannel;
        WriteOptions used = options;
        used.bitsPerChannel = bits;
        const Samples samples = convert(image, format, bits);
        const std::string why =
            writeSamples(specFor(image, samples, format, used), samples, format, path, bytes);
        if (!why.empty()) return cannotWrite(name, why + "; check the disk and try again");
        return {};
    } catch (const std::exception& e) {
        return cannotWrite(name, std::string(e.what()) + "; close other programs and try again");
    }
}

}  // namespace

Result<PictureFormat> pictureFormatFor(const std::string& path) {
    std::string suffix = std::filesystem::path(path).extension().string();
    std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
    for (const FormatEntry& entry : kSuffixes)
        if (suffix == entry.suffix) return entry.format;
    return failure(ErrorCode::Usage, "cannot tell the format of \"" + path +
                                         "\" from its name; end it with .png, .jpg, .tif or .exr");
}

Result<void> writeImage(const Image& image, const std::string& path, const WriteOptions& options) {
    const Result<PictureFormat> format = pictureFormatFor(path);
    if (!format) return tl::unexpected(format.error());
    return writeFileAtomically(path, [&](const std::string& temporary) {
        return writeTo(image, *format, options, path, temporary, nullptr);
    });
}

Result<std::vector<uint8_t>> encodePng(const Image& image) {
    std::vector<uint8_t> bytes;
    Result<void> written = writeTo(image, PictureFormat::Png, {}, "picture.png", "picture.png", &bytes);
    if (!written) return tl::unexpected(written.error());
    return bytes;
}

}  // namespace tessera
