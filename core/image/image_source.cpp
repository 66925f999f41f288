// See image_source.h.
#include "core/image/image_source.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <memory>
#include <optional>

#include "core/image/cmyk_jpeg.h"
#include "core/image/image_probe.h"

namespace tessera {

namespace {

constexpr const char* kForeign =
    "it is no picture that Tessera knows; choose a PNG, JPEG, TIFF, WebP or OpenEXR file";
constexpr const char* kEmpty = "it is empty; get the file again from where it came";
constexpr const char* kDamaged = "it is damaged or cut off; get the file again from where it came";
constexpr const char* kGetAgain = "; get the file again from where it came";
constexpr const char* kSaveAgain = "; save it again as PNG or TIFF with the program that made it";

tl::unexpected<Error> cannotRead(const std::string& why) {
    return failure(ErrorCode::CannotRead, why);
}

// A file without a name, for the decoders that can only open paths.
class MemoryFile {
  public:
    explicit MemoryFile(std::span<const uint8_t> bytes) : mFd(::memfd_create("picture", MFD_CLOEXEC)) {
        while (mFd >= 0 && !bytes.empty()) {
            const ssize_t count = ::write(mFd, bytes.data(), bytes.size());
            if (count <= 0) break;
            bytes = bytes.subspan(size_t(count));
        }
    }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;
    ~MemoryFile() {
        if (mFd >= 0) ::close(mFd);
    }
    std::string path() const { return "/proc/self/fd/" + std::to_string(mFd); }

  private:
    int mFd;
};

// An open OpenImageIO reader with what it reads from.
struct Decoder {
    std::unique_ptr<OIIO::Filesystem::IOMemReader> memory;
    std::unique_ptr<MemoryFile> file;
    OIIO::ImageSpec spec;
    OIIO::ImageInput::unique_ptr input;

    Decoder() = default;
    Decoder(Decoder&&) = default;
    Decoder& operator=(Decoder&&) = default;
    // OpenImageIO prints errors that nobody has fetched when a reader goes.
    ~Decoder() { takeDefect(); }

    // What the reader has complained about since the last call, but for what every viewer forgives.
    std::string takeDefect() {
        if (!input || !input->has_error()) return {};
        const std::string text = input->geterror();
        for (size_t begin = 0; begin < text.size();) {
            const size_t end = std::min(text.find('\n', begin), text.size());
            const std::string line = text.substr(begin, end - begin);
            if (!line.empty() && !isHarmlessJpegWarning(line)) return line;
            begin = end + 1;
        }
        return {};
    }
};

// Null input where the file cannot be opened. `rawColor`: CMYK samples as they are, not by OpenImageIO's rule
// of thumb.
Decoder openDecoder(const std::vector<uint8_t>& bytes, const std::string& format, bool rawColor) {
    Decoder decoder;
    decoder.input = OIIO::ImageInput::create(format, false, nullptr, nullptr, "");
    if (!decoder.input) {
        OIIO::geterror();
        return decoder;
    }
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    if (rawColor) config.attribute("oiio:RawColor", 1);
    std::string path = "picture";
    if (decoder.input->supports("ioproxy")) {
        decoder.memory = std::make_unique<OIIO::Filesystem::IOMemReader>(bytes.data(), bytes.size());
        OIIO::Filesystem::IOProxy* proxy = decoder.memory.get();
        config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    } else {
        decoder.file = std::make_unique<MemoryFile>(bytes);
        path = decoder.file->path();
    }
    if (!decoder.input->open(path, decoder.spec, config)) {
        decoder.takeDefect();
        decoder.input.reset();
    }
    return decoder;
}

std::string lowerCase(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    return text;
}

// The channel that is called `wanted`, or in the first layer that has one "layer.wanted"; -1 for none.
int channelNamed(const OIIO::ImageSpec& spec, const std::string& wanted) {
    const std::string suffix = "." + wanted;
    int inLayer = -1;
    for (int c = 0; c < std::min(spec.nchannels, int(spec.channelnames.size())); ++c) {
        const std::string name = lowerCase(spec.channelnames[size_t(c)]);
        if (name == wanted) return c;
        if (inLayer < 0 && name.ends_with(suffix)) inLayer = c;
    }
    return inLayer;
}

struct Channels {
    ColorModel model = ColorModel::Rgb;
    std::vector<int> color;
    int alpha = -1;
};

// By name where names say something (OpenEXR's come in the order of the alphabet), else by position.
Channels chooseChannels(const OIIO::ImageSpec& spec, bool cmyk) {
    if (cmyk) return {ColorModel::Cmyk, {0, 1, 2, 3}, spec.nchannels > 4 ? 4 : -1};
    int alpha = channelNamed(spec, "a");
    if (alpha < 0 && spec.alpha_channel < spec.nchannels) alpha = spec.alpha_channel;
    const std::vector<int> rgb = {channelNamed(spec, "r"), channelNamed(spec, "g"), channelNamed(spec, "b")};
    if (rgb[0] >= 0 && rgb[1] >= 0 && rgb[2] >= 0) return {ColorModel::Rgb, rgb, alpha};
    const int luminance = channelNamed(spec, "y");
    if (luminance < 0 && spec.nchannels >= 3 && alpha != 0 && alpha != 1 && alpha != 2)
        return {ColorModel::Rgb, {0, 1, 2}, alpha};
    const int only = luminance >= 0 ? luminance : (alpha == 0 && spec.nchannels > 1 ? 1 : 0);
    return {ColorModel::Grey, {only}, alpha == only ? -1 : alpha};
}

std::vector<uint8_t> embeddedProfile(const OIIO::ImageSpec& spec) {
    const OIIO::ParamValue* value = spec.find_attribute("ICCProfile");
    if (!value || value->type().basesize() != 1) return {};
    const auto* data = static_cast<const uint8_t*>(value->data());
    return {data, data + value->type().size()};
}

ColorConverter untaggedConverter(const OIIO::ImageSpec& spec, ColorModel model) {
    if (model == ColorModel::Cmyk) return ColorConverter::plain(model);
    const std::string space = lowerCase(spec.get_string_attribute("oiio:ColorSpace"));
    const bool isFloat = spec.format.is_floating_point();
    // OpenImageIO says Rec709 of all portable maps, of which those of floats hold linear light.
    const bool untagged = space.empty() || space == "rec709";
    if (space == "linear" || space == "scene_linear" || space == "lin_srgb" || (untagged && isFloat)) {
        const OIIO::ParamValue* value = spec.find_attribute("chromaticities");
        if (!value || value->type() != OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8))
            return ColorConverter::power(model, 1);
        std::array<double, 8> chromaticities;
        const auto* data = static_cast<const float*>(value->data());
        std::copy_n(data, chromaticities.size(), chromaticities.begin());
        return ColorConverter::linearPrimaries(model, chromaticities);
    }
    // Files marked 2.2 mean sRGB: programs write that number for want of a better one.
    const float gamma = spec.get_float_attribute("oiio:Gamma", 2.2f);
    const bool marked =
        space.starts_with("gamma") && gamma > .1f && gamma < 10 && std::abs(gamma - 2.2f) > .05f;
    return marked ? ColorConverter::power(model, gamma) : ColorConverter::plain(model);
}

std::string tooLarge(uint64_t width, uint64_t height, const ReadLimits& limits) {
    if (width == 0 || height <= limits.maxPixels / width) return {};
    return "it claims to be " + std::to_string(width) + " x " + std::to_string(height) +
           " pixels, more than the limit of " + std::to_string(limits.maxPixels) +
           " pixels; scale it down with another program first";
}

// What speaks against decoding the picture although it could be opened; empty if nothing.
std::string refusal(const OIIO::ImageSpec& spec, const Channels& channels, const ReadLimits& limits) {
    if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0)
        return std::string("it holds no pixels") + kSaveAgain;
    if (std::string why = tooLarge(uint64_t(spec.width), uint64_t(spec.height), limits); !why.empty())
        return why;
    const bool outside = std::any_of(channels.color.begin(), channels.color.end(),
                                     [&](int c) { return c < 0 || c >= spec.nchannels; });
    if (spec.deep || outside) return std::string("its kind of channels is not supported") + kSaveAgain;
    // A band of rows is decoded with all channels between the chosen ones.
    constexpr uint64_t kMaxBandSamples = uint64_t{1} << 31;
    const uint64_t bandRows = spec.tile_height > 0 ? uint64_t(spec.tile_height) : 1;
    if (bandRows * uint64_t(spec.width) * uint64_t(spec.nchannels) > kMaxBandSamples)
        return std::string("it has too many channels") + kSaveAgain;
    return {};
}

// Decodes through OpenImageIO, in bands that fit the way in which the file is stored.
void readThrough(ImageSource& source, std::shared_ptr<Decoder> decoder, const Channels& chosen) {
    const OIIO::ImageSpec& spec = decoder->spec;
    std::vector<int> used = chosen.color;
    if (chosen.alpha >= 0) used.push_back(chosen.alpha);
    const int first = *std::min_element(used.begin(), used.end());
    const int last = *std::max_element(used.begin(), used.end());
    source.channels = size_t(last - first) + 1;
    for (const int c : chosen.color) source.color.push_back(size_t(c - first));
    source.alpha = chosen.alpha >= 0 ? chosen.alpha - first : -1;

    constexpr uint64_t kBandSamples = uint64_t{1} << 25;
    constexpr int kMaxRows = 256;  // a multiple of the rows in a block of every compression of OpenEXR
    const int tileRows = spec.tile_width > 0 ? std::max(1, spec.tile_height) : 1;
    const uint64_t rows = kBandSamples / (uint64_t(spec.width) * source.channels);
    const int wanted = int(std::clamp<uint64_t>(rows, 1, kMaxRows));
    source.rowStep = std::max(1, wanted / tileRows) * tileRows;

    source.readRows = [decoder, first, last](int begin, int end, std::span<float> samples) -> Result<void> {
        const OIIO::ImageSpec& s = decoder->spec;
        const auto type = OIIO::TypeDesc::FLOAT;
        bool ok = false;
        if (s.tile_width > 0)
            ok = decoder->input->read_tiles(0, 0, s.x, s.x + s.width, s.y + begin, s.y + end, s.z, s.z + 1,
                                            first, last + 1, type, samples.data());
        else
            ok = decoder->input->read_scanlines(0, 0, s.y + begin, s.y + end, s.z, first, last + 1, type,
                                                samples.data());
        // Some readers only mention damage and go on with grey or black.
        const std::string defect = decoder->takeDefect();
        return ok && defect.empty() ? Result<void>() : cannotRead(kDamaged);
    };
}

Result<void> readCmyk(ImageSource& source, const std::vector<uint8_t>& bytes) {
    Result<CmykPixels> pixels = readCmykJpeg(bytes);
    if (!pixels) return tl::unexpected(pixels.error());
    if (pixels->width != source.info.width || pixels->height != source.info.height)
        return cannotRead(kDamaged);
    source.channels = 4;
    source.color = {0, 1, 2, 3};
    source.rowStep = 256;
    const auto shared = std::make_shared<CmykPixels>(std::move(*pixels));
    source.readRows = [shared](int begin, int end, std::span<float> samples) -> Result<void> {
        const size_t rowSize = size_t(shared->width) * 4;
        const uint8_t* ink = shared->ink.data() + rowSize * size_t(begin);
        std::transform(ink, ink + rowSize * size_t(end - begin), samples.begin(),
                       [](uint8_t v) { return float(v) / 255; });
        return {};
    };
    return {};
}

}  // namespace

Result<ImageSource> openImageSource(const std::vector<uint8_t>& bytes, const ReadLimits& limits) {
    if (bytes.empty()) return cannotRead(kEmpty);
    ImageProbe probe = probeImage(bytes);
    if (probe.format.empty()) return cannotRead(kForeign);
    if (!probe.sound) return cannotRead(kDamaged);
    if (std::string why = tooLarge(probe.width, probe.height, limits); !why.empty()) return cannotRead(why);
    if (probe.format == "png")
        if (std::string defect = pngDefect(bytes); !defect.empty()) return cannotRead(defect + kGetAgain);

    auto decoder = std::make_shared<Decoder>(openDecoder(bytes, probe.format, false));
    if (!decoder->input) return cannotRead(kDamaged);
    constexpr int kSeparated = 5;
    bool cmyk = decoder->spec.get_int_attribute("tiff:PhotometricInterpretation") == kSeparated;
    if (cmyk) {
        *decoder = openDecoder(bytes, probe.format, true);
        if (!decoder->input) return cannotRead(kDamaged);
        cmyk = decoder->spec.nchannels >= 4;
    }
    const OIIO::ImageSpec& spec = decoder->spec;
    Channels channels = chooseChannels(spec, cmyk);
    if (std::string why = refusal(spec, channels, limits); !why.empty()) return cannotRead(why);

    ImageSource source;
    source.info.format = probe.format;
    source.info.width = spec.width;
    source.info.height = spec.height;
    const size_t bits = spec.format.size() * 8;
    source.info.bitsPerChannel = bits <= 8 ? 8 : bits <= 16 ? 16 : 32;
    source.info.iccProfile = probe.iccProfile.empty() ? embeddedProfile(spec) : std::move(probe.iccProfile);
    // libheif and LibRaw turn the pixels themselves and leave the tag.
    const bool turned = probe.format == "heif" || probe.format == "raw";
    source.orientation = probe.orientation > 0 ? probe.orientation : spec.get_int_attribute("Orientation", 1);
    if (turned || source.orientation < 1 || source.orientation > 8) source.orientation = 1;
    // This decoder delivers what is in the file, which is not multiplied by alpha, without saying so.
    const bool straight = probe.format == "jpeg2000";
    source.associated = !straight && spec.get_int_attribute("oiio:UnassociatedAlpha") == 0;

    const bool cmykJpeg = probe.format == "jpeg" && probe.jpegComponents == 4;
    if (cmykJpeg) channels.model = ColorModel::Cmyk;
    const std::vector<uint8_t>& icc = source.info.iccProfile;
    source.converter =
        icc.empty() ? untaggedConverter(spec, channels.model) : ColorConverter::profile(channels.model, icc);
    if (cmykJpeg) {
        if (Result<void> read = readCmyk(source, bytes); !read) return cannotRead(kDamaged);
    } else {
        readThrough(source, decoder, channels);
    }
    return source;
}

}  // namespace tessera
