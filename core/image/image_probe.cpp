// See image_probe.h.
#include "core/image/image_probe.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include "core/image/byte_reader.h"

namespace tessera {

namespace {

using namespace std::string_view_literals;

struct Signature {
    size_t offset;
    std::string_view bytes;
    const char* format;
};

// The first that matches wins: raw camera files that look like TIFF come before TIFF. Formats of OpenImageIO
// without a signature worth the name, or that hold no pictures (volumes, depth maps), are left out, and so
// are those whose decoders few people have tried to break.
constexpr Signature kSignatures[] = {
    {0, "\x89PNG\r\n\x1a\n"sv, "png"},
    {0, "\xff\xd8\xff"sv, "jpeg"},
    {8, "CR\x02"sv, "raw"},
    {0, "II*\0"sv, "tiff"},
    {0, "MM\0*"sv, "tiff"},
    {0, "II+\0"sv, "tiff"},
    {0, "MM\0+"sv, "tiff"},
    {0, "\x76\x2f\x31\x01"sv, "openexr"},
    {0, "GIF8"sv, "gif"},
    {8, "WEBP"sv, "webp"},
    {0, "#?RADIANCE"sv, "hdr"},
    {0, "#?RGBE"sv, "hdr"},
    {0, "8BPS"sv, "psd"},
    {0, "\0\0\0\x0cjP  \r\n\x87\n"sv, "jpeg2000"},
    {0, "\xff\x4f\xff\x51"sv, "jpeg2000"},
    {4, "ftypcrx "sv, "raw"},
    {4, "ftypheic"sv, "heif"},
    {4, "ftypheix"sv, "heif"},
    {4, "ftypmif1"sv, "heif"},
    {4, "ftypavif"sv, "heif"},
    {0, "FUJIFILMCCD-RAW"sv, "raw"},
    {0, "IIRO"sv, "raw"},
    {0, "IIRS"sv, "raw"},
    {0, "IIU\0"sv, "raw"},
    {0, "SDPX"sv, "dpx"},
    {0, "XPDS"sv, "dpx"},
    {0, "BM"sv, "bmp"},
    {0, "P1"sv, "pnm"},
    {0, "P2"sv, "pnm"},
    {0, "P3"sv, "pnm"},
    {0, "P4"sv, "pnm"},
    {0, "P5"sv, "pnm"},
    {0, "P6"sv, "pnm"},
    {0, "PF"sv, "pnm"},
    {0, "Pf"sv, "pnm"},
};

// The value of a short tag in the first directory of a TIFF or EXIF block, if it is there.
std::optional<uint32_t> firstDirectoryValue(std::span<const uint8_t> tiff, uint32_t wanted) {
    if (tiff.size() < 8) return {};
    const ByteReader reader(tiff, tiff[0] == 'M');
    const uint64_t directory = reader.u32(4);
    const uint32_t count = reader.u16(directory);
    for (uint32_t i = 0; i < count; ++i) {
        const uint64_t entry = directory + 2 + 12 * uint64_t(i);
        if (entry + 12 > tiff.size()) return {};
        if (reader.u16(entry) == wanted) return reader.u16(entry + 8);
    }
    return {};
}

// A digital negative is a TIFF whose first directory is often only a thumbnail.
bool isDigitalNegative(std::span<const uint8_t> bytes) {
    constexpr uint32_t kDngVersion = 50706;
    return firstDirectoryValue(bytes, kDngVersion).has_value();
}

// Targa has no signature: either the footer of its second version, or a header whose every field makes sense.
bool isTarga(std::span<const uint8_t> bytes) {
    constexpr std::string_view kFooter = "TRUEVISION-XFILE.\0"sv;
    if (bytes.size() < 18) return false;
    if (ByteReader(bytes).has(bytes.size() - kFooter.size(), kFooter)) return true;
    const uint8_t mapType = bytes[1];
    const uint8_t type = bytes[2] & 7;
    const uint8_t depth = bytes[16];
    const bool mapped = type == 1;
    return (bytes[2] & ~11) == 0 && type >= 1 && type <= 3 && mapType == (mapped ? 1 : 0) &&
           (depth == 8 || (!mapped && (depth == 16 || depth == 24 || depth == 32))) &&
           (mapped || std::all_of(bytes.begin() + 3, bytes.begin() + 8, [](uint8_t b) { return b == 0; })) &&
           (bytes[12] | bytes[13]) != 0 && (bytes[14] | bytes[15]) != 0 && (bytes[17] & 0xc0) == 0;
}

std::string recognize(std::span<const uint8_t> bytes) {
    const ByteReader reader(bytes);
    for (const Signature& signature : kSignatures) {
        if (!reader.has(signature.offset, signature.bytes)) continue;
        if (signature.format == "tiff"sv && isDigitalNegative(bytes)) return "raw";
        return signature.format;
    }
    return isTarga(bytes) ? "targa" : "";
}

// libjpeg takes memory for all coefficients of a progressive file as soon as it is opened.
void probeJpeg(std::span<const uint8_t> bytes, ImageProbe& probe) {
    const ByteReader reader(bytes, true);
    uint64_t at = 2;
    while (at + 4 <= bytes.size()) {
        if (bytes[at] != 0xff) return;
        const uint8_t marker = bytes[at + 1];
        if (marker == 0xff) {  // fill byte
            ++at;
            continue;
        }
        const bool frame =
            marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
        if (frame) {
            probe.height = reader.u16(at + 5);
            probe.width = reader.u16(at + 7);
            probe.jpegComponents = int(reader.u8(at + 9));
            return;
        }
        if (marker == 0xda || marker == 0xd9) return;
        const bool alone = marker == 0x01 || (marker >= 0xd0 && marker <= 0xd8);
        at += alone ? 2 : 2 + uint64_t(reader.u16(at + 2));
    }
}

void probeWebp(std::span<const uint8_t> bytes, ImageProbe& probe) {
    constexpr std::string_view kExifPrefix = "Exif\0\0"sv;
    const ByteReader reader(bytes);
    for (uint64_t at = 12; at + 8 <= bytes.size();) {
        const uint64_t size = reader.u32(at + 4);
        const uint64_t begin = at + 8;
        const std::span<const uint8_t> body = bytes.subspan(begin, std::min(size, bytes.size() - begin));
        if (reader.has(at, "VP8X")) {
            probe.width = (reader.u32(begin + 4) & 0xffffff) + 1;
            probe.height = (reader.u32(begin + 6) >> 8) + 1;
        } else if (reader.has(at, "ICCP")) {
            probe.iccProfile.assign(body.begin(), body.end());
        } else if (reader.has(at, "EXIF")) {
            const size_t skip =
                reader.has(begin, kExifPrefix) ? std::min(kExifPrefix.size(), body.size()) : 0;
            probe.orientation = int(firstDirectoryValue(body.subspan(skip), 0x112).value_or(0));
        }
        at = begin + size + (size & 1);
    }
}

// OpenJPEG decodes the whole picture as soon as it is opened: the size is in the SIZ segment of the code
// stream.
void probeJpeg2000(std::span<const uint8_t> bytes, ImageProbe& probe) {
    constexpr std::array<uint8_t, 4> kStart = {0xff, 0x4f, 0xff, 0x51};
    const ByteReader reader(bytes, true);
    // The largest wins, so that none hides behind a smaller one put before it.
    for (auto from = bytes.begin();;) {
        const auto found = std::search(from, bytes.end(), kStart.begin(), kStart.end());
        if (found == bytes.end()) return;
        const uint64_t at = uint64_t(found - bytes.begin());
        probe.width = std::max(probe.width, uint64_t(reader.u32(at + 8)));
        probe.height = std::max(probe.height, uint64_t(reader.u32(at + 12)));
        from = found + 1;
    }
}

// OpenEXR takes memory for attributes by the sizes that they claim. Attributes: name, type, size, value; a
// header ends with an empty name, and the headers of a file of several parts with an empty header.
void probeExr(std::span<const uint8_t> bytes, ImageProbe& probe) {
    constexpr uint32_t kMultiPart = 0x1000;
    const ByteReader reader(bytes);
    const bool several = (reader.u32(4) & kMultiPart) != 0;
    const auto textEnd = [&](uint64_t at) {
        while (at < bytes.size() && bytes[at] != 0) ++at;
        return at + 1;
    };
    for (uint64_t at = 8; at < bytes.size();) {
        if (bytes[at] == 0) {
            if (!several || reader.u8(at + 1) == 0) return;
            ++at;
            continue;
        }
        const uint64_t type = textEnd(at);
        const uint64_t size = textEnd(type);
        const uint64_t value = size + 4;
        const uint64_t length = reader.u32(size);
        if (value > bytes.size() || length > bytes.size() - value) break;
        if (reader.has(at, "dataWindow\0"sv)) {
            const auto side = [&](uint64_t low) {
                const int64_t first = int32_t(reader.u32(value + low));
                return uint64_t(
                    std::max<int64_t>(0, int64_t(int32_t(reader.u32(value + low + 8))) - first + 1));
            };
            probe.width = std::max(probe.width, side(0));
            probe.height = std::max(probe.height, side(4));
        }
        at = value + length;
    }
    probe.sound = false;
}

uint64_t magnitude(uint32_t value) {
    return value & 0x80000000u ? ~value + uint64_t{1} : value;
}

}  // namespace

ImageProbe probeImage(std::span<const uint8_t> bytes) {
    ImageProbe probe;
    probe.format = recognize(bytes);
    const ByteReader little(bytes);
    const ByteReader big(bytes, true);
    if (probe.format == "png") {
        probe.width = big.u32(16);
        probe.height = big.u32(20);
    } else if (probe.format == "jpeg") {
        probeJpeg(bytes, probe);
    } else if (probe.format == "openexr") {
        probeExr(bytes, probe);
    } else if (probe.format == "webp") {
        probeWebp(bytes, probe);
    } else if (probe.format == "jpeg2000") {
        probeJpeg2000(bytes, probe);
    } else if (probe.format == "gif") {
        probe.width = little.u16(6);
        probe.height = little.u16(8);
    } else if (probe.format == "psd") {
        probe.height = big.u32(14);
        probe.width = big.u32(18);
    } else if (probe.format == "bmp") {
        const bool old = little.u32(14) == 12;
        probe.width = old ? little.u16(18) : magnitude(little.u32(18));
        probe.height = old ? little.u16(20) : magnitude(little.u32(22));
    } else if (probe.format == "targa") {
        probe.width = little.u16(12);
        probe.height = little.u16(14);
    }
    return probe;
}

}  // namespace tessera
