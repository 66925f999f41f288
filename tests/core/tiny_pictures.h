// Picture files of a few pixels put together byte by byte, so that tests of the reader do not lean on a
// writer.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tessera::test {

using Bytes = std::vector<uint8_t>;

inline void append(Bytes& bytes, std::string_view text) {
    for (const char c : text) bytes.push_back(uint8_t(c));
}

inline void append(Bytes& bytes, const Bytes& more) {
    bytes.insert(bytes.end(), more.begin(), more.end());
}

inline void appendBig(Bytes& bytes, uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(uint8_t(value >> shift));
}

inline void appendLittle(Bytes& bytes, uint64_t value, int count) {
    for (int i = 0; i < count; ++i) bytes.push_back(uint8_t(value >> (8 * i)));
}

inline uint32_t crc32(const Bytes& bytes) {
    uint32_t crc = ~0u;
    for (const uint8_t byte : bytes) {
        crc ^= byte;
        for (int i = 0; i < 8; ++i) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
    }
    return ~crc;
}

inline Bytes pngChunk(std::string_view type, const Bytes& body) {
    Bytes checked;
    append(checked, type);
    append(checked, body);
    Bytes chunk;
    appendBig(chunk, uint32_t(body.size()));
    append(chunk, checked);
    appendBig(chunk, crc32(checked));
    return chunk;
}

// A zlib stream of one stored block: at most 65535 bytes.
inline Bytes stored(const Bytes& raw) {
    Bytes bytes = {0x78, 0x01, 0x01};
    appendLittle(bytes, raw.size(), 2);
    appendLittle(bytes, ~raw.size(), 2);
    append(bytes, raw);
    uint32_t a = 1, b = 0;
    for (const uint8_t byte : raw) {
        a = (a + byte) % 65521;
        b = (b + a) % 65521;
    }
    appendBig(bytes, b << 16 | a);
    return bytes;
}

struct PngRecipe {
    uint32_t width = 1;
    uint32_t height = 1;
    uint8_t depth = 8;
    uint8_t colorType = 2;
    uint8_t interlace = 0;
    Bytes rows = {};        // each row after its filter byte
    Bytes beforeData = {};  // whole chunks between IHDR and IDAT
};

inline Bytes pngOf(const PngRecipe& recipe) {
    Bytes header;
    appendBig(header, recipe.width);
    appendBig(header, recipe.height);
    append(header, Bytes{recipe.depth, recipe.colorType, 0, 0, recipe.interlace});
    Bytes bytes;
    append(bytes, "\x89PNG\r\n\x1a\n");
    append(bytes, pngChunk("IHDR", header));
    append(bytes, recipe.beforeData);
    append(bytes, pngChunk("IDAT", stored(recipe.rows)));
    append(bytes, pngChunk("IEND", {}));
    return bytes;
}

struct TiffRecipe {
    uint32_t width = 1;
    uint32_t height = 1;
    uint16_t channels = 3;
    uint16_t photometric = 2;  // 1 grey, 2 RGB, 5 CMYK
    uint16_t orientation = 1;
    int extraSample = -1;  // of the last channel: 1 associated alpha, 2 unassociated; -1 no extra channel
    Bytes icc = {};
    Bytes samples = {};  // 8 bits each, interleaved
};

inline Bytes tiffOf(const TiffRecipe& recipe) {
    struct Tag {
        uint16_t id, type;
        uint32_t count;
        uint64_t value;
    };
    constexpr uint16_t kShort = 3, kLong = 4, kUndefined = 7;
    Bytes bytes;
    append(bytes, "II*");
    bytes.push_back(0);
    const auto bits = uint32_t(bytes.size() + 4);
    const uint32_t samples = bits + 2u * recipe.channels;
    const auto icc = uint32_t(samples + recipe.samples.size());
    const auto directory = uint32_t((icc + recipe.icc.size() + 1) & ~size_t{1});
    appendLittle(bytes, directory, 4);
    for (int c = 0; c < recipe.channels; ++c) appendLittle(bytes, 8, 2);
    append(bytes, recipe.samples);
    append(bytes, recipe.icc);
    bytes.resize(directory);
    std::vector<Tag> tags = {{256, kLong, 1, recipe.width},
                             {257, kLong, 1, recipe.height},
                             {258, kShort, recipe.channels, recipe.channels <= 2 ? 0x80008u : bits},
                             {259, kShort, 1, 1},
                             {262, kShort, 1, recipe.photometric},
                             {273, kLong, 1, samples},
                             {274, kShort, 1, recipe.orientation},
                             {277, kShort, 1, recipe.channels},
                             {278, kLong, 1, recipe.height},
                             {279, kLong, 1, recipe.samples.size()},
                             {284, kShort, 1, 1}};
    if (recipe.extraSample >= 0) tags.push_back({338, kShort, 1, uint64_t(recipe.extraSample)});
    if (!recipe.icc.empty()) tags.push_back({34675, kUndefined, uint32_t(recipe.icc.size()), icc});
    appendLittle(bytes, tags.size(), 2);
    for (const Tag& tag : tags) {
        appendLittle(bytes, tag.id, 2);
        appendLittle(bytes, tag.type, 2);
        appendLittle(bytes, tag.count, 4);
        appendLittle(bytes, tag.value, 4);
    }
    appendLittle(bytes, 0, 4);
    return bytes;
}

}  // namespace tessera::test
