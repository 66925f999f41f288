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

// What is to be written, decided once.
struct Encoding {
    PictureFormat format;
    WriteOptions options;
    int bits = 8;  // of integers
    bool keepAlpha = false;
    std::optional<ProfileTarget> target;  // none: sRGB

    Encoding(const Image& image, PictureFormat f, const WriteOptions& o)
        : format(f), options(o), bits(f == PictureFormat::Jpeg ? 8 : o.bitsPerChannel) {
        if (format == PictureFormat::Jpeg && !options.background) options.background = {1, 1, 1};
        keepAlpha = image.hasAlpha() && !options.background;
        if (format != PictureFormat::Exr && !options.iccProfile.empty())
            target = ProfileTarget::of(options.iccProfile);
    }
    int channels() const { return keepAlpha ? 4 : 3; }
};

// The colour that a pixel of the file has, in gamma-encoded sRGB: of itself where alpha goes along, else over
// the background.
std::array<float, 3> fileColor(const Image& image, size_t at, float alpha, const Encoding& encoding) {
    if (encoding.keepAlpha) return straightColor(image, at, alpha);
    const std::array<float, 3> background = encoding.options.background.value_or(std::array<float, 3>{});
    std::array<float, 3> color{};
    for (size_t c = 0; c < 3; ++c) {
        const float value = image.plane(int(c))[at];
        color[c] = (std::isfinite(value) ? value : 0) + (1 - alpha) * background[c];
    }
    return color;
}

uint16_t fileSample(float value, const Encoding& encoding) {
    return uint16_t(std::lround(clamped(value) * (encoding.bits == 16 ? 65535.f : 255.f)));
}

// The samples of pixels `begin` to `end`.
void convertPixels(const Image& image, size_t begin, size_t end, const Encoding& encoding, uint16_t* out) {
    std::vector<float> colors;
    colors.reserve(3 * (end - begin));
    for (size_t i = begin; i < end; ++i)
        for (const float value : fileColor(image, i, clampedAlpha(image, i), encoding))
            colors.push_back(value);
    if (encoding.target) encoding.target->convert(colors);
    const size_t channels = size_t(encoding.channels());
    for (size_t i = begin; i < end; ++i, out += channels) {
        const float alpha = clampedAlpha(image, i);
        const float* color = &colors[3 * (i - begin)];
        if (encoding.format == PictureFormat::Exr) {
            constexpr float kMaxHalf = 65504;
            const float cover = encoding.keepAlpha ? alpha : 1;
            for (size_t c = 0; c < 3; ++c)
                out[c] = half(std::clamp(decodeSrgb(color[c]) * cover, -kMaxHalf, kMaxHalf)).bits();
            if (encoding.keepAlpha) out[3] = half(alpha).bits();
        } else {
            for (size_t c = 0; c < 3; ++c) out[c] = fileSample(color[c], encoding);
            if (encoding.keepAlpha) out[3] = fileSample(alpha, encoding);
        }
    }
}

Samples convert(const Image& image, const Encoding& encoding) {
    Samples samples;
    samples.channels = encoding.channels();
    samples.values.resize(image.planeSize() * size_t(samples.channels));
    constexpr size_t kGrain = 16384;
    parallelFor(image.planeSize(), kGrain, [&](size_t begin, size_t end) {
        convertPixels(image, begin, end, encoding, &samples.values[begin * size_t(samples.channels)]);
    });
    return samples;
}

OIIO::ImageSpec specFor(const Image& image, const Samples& samples, const Encoding& encoding) {
    const PictureFormat format = encoding.format;
    const OIIO::TypeDesc type = format == PictureFormat::Exr ? OIIO::TypeDesc::HALF
                                : encoding.bits == 16        ? OIIO::TypeDesc::UINT16
                                                             : OIIO::TypeDesc::UINT8;
    OIIO::ImageSpec spec(image.width(), image.height(), samples.channels, type);
    // Without these two some writers put the time of writing and a version into the file: the same picture
    // shall give the same bytes.
    spec.attribute("DateTime", "2000:01:01 00:00:00");
    spec.attribute("Software", "Tessera");
    if (format == PictureFormat::Png) spec.erase_attribute("DateTime");
    if (format == PictureFormat::Exr) spec.attribute("oiio:ColorSpace", "Linear");
    if (format != PictureFormat::Exr) spec.attribute("oiio:UnassociatedAlpha", 1);
    if (format != PictureFormat::Exr && encoding.options.embedProfile) {
        const std::vector<uint8_t> icc = encoding.target ? encoding.options.iccProfile : srgbProfile();
        spec.attribute("ICCProfile", OIIO::TypeDesc(OIIO::TypeDesc::UINT8, int(icc.size())), icc.data());
    } else if (format != PictureFormat::Exr && !encoding.target) {
        spec.attribute("oiio:ColorSpace", "sRGB");
    }
    if (format == PictureFormat::Jpeg) {
        spec.attribute("Compression", "jpeg:" + std::to_string(encoding.options.jpegQuality));
        spec.attribute("jpeg:subsampling", "4:4:4");
    }
    if (format == PictureFormat::Tiff) spec.attribute("Compression", "zip");
    return spec;
}

// Rows from y on, as the file wants them.
bool writeRows(OIIO::ImageOutput& output, const OIIO::ImageSpec& spec, const Samples& samples, int y,
               int end) {
    const size_t row = size_t(spec.width) * size_t(samples.channels);
    const std::span<const uint16_t> rows(&samples.values[size_t(y) * row], size_t(end - y) * row);
    if (spec.format != OIIO::TypeDesc::UINT8)
        return output.write_scanlines(y, end, 0, spec.format, rows.data());
    const std::vector<uint8_t> narrow(rows.begin(), rows.end());
    return output.write_scanlines(y, end, 0, OIIO::TypeDesc::UINT8, narrow.data());
}

// Where a file is written to: a path, or bytes where those are not null. `name` is for messages.
struct Destination {
    std::string name;
    std::string path;
    std::vector<uint8_t>* bytes = nullptr;
};

Result<void> writeSamples(const OIIO::ImageSpec& spec, const Samples& samples, const Encoding& encoding,
                          const Destination& to, Progress* progress) {
    const auto failed = [&](std::string why) {
        if (why.empty()) why = "the encoder gave up";
        return cannotWrite(to.name, why + "; check the disk and try again");
    };
    std::unique_ptr<OIIO::Filesystem::IOVecOutput> memory;
    const auto output = OIIO::ImageOutput::create(writerName(encoding.format));
    if (!output) return failed(OIIO::geterror());
    OIIO::ImageSpec opened = spec;
    if (to.bytes) {
        memory = std::make_unique<OIIO::Filesystem::IOVecOutput>(*to.bytes);
        OIIO::Filesystem::IOProxy* proxy = memory.get();
        opened.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    }
    bool ok = output->open(to.path, opened);
    constexpr int kRows = 64;
    for (int y = 0; ok && y < spec.height; y += kRows) {
        const int end = std::min(y + kRows, spec.height);
        ok = writeRows(*output, spec, samples, y, end);
        // Not before the first rows: libpng complains on stderr of files without any.
        if (progress && !progress->step(double(end) / spec.height)) {
            output->close();
            return stopped();
        }
    }
    ok = output->close() && ok;
    const std::string why = output->geterror();
    if (!ok) return failed(why);
    return {};
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

Result<void> writeTo(const Image& image, PictureFormat format, const WriteOptions& options,
                     const Destination& to, Progress* progress) {
    if (std::string why = optionsDefect(image, format, options); !why.empty())
        return cannotWrite(to.name, why);
    try {
        const Encoding encoding(image, format, options);
        const Samples samples = convert(image, encoding);
        return writeSamples(specFor(image, samples, encoding), samples, encoding, to, progress);
    } catch (const std::exception& e) {
        return cannotWrite(to.name, std::string(e.what()) + "; close other programs and try again");
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

Result<void> writeImage(const Image& image, const std::string& path, const WriteOptions& options,
                        Progress* progress) {
    const Result<PictureFormat> format = pictureFormatFor(path);
    if (!format) return tl::unexpected(format.error());
    return writeFileAtomically(path, [&](const std::string& temporary) {
        return writeTo(image, *format, options, {.name = path, .path = temporary}, progress);
    });
}

Result<std::vector<uint8_t>> encodePng(const Image& image) {
    std::vector<uint8_t> bytes;
    const WriteOptions options{.embedProfile = false};
    const Destination to{.name = "picture.png", .path = "picture.png", .bytes = &bytes};
    if (auto written = writeTo(image, PictureFormat::Png, options, to, nullptr); !written)
        return tl::unexpected(written.error());
    return bytes;
}

}  // namespace tessera
