// The check of a whole PNG declared in image_probe.h; after the PNG specification, second edition (ISO/IEC
// 15948).
#include <zlib.h>

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include "core/image/byte_reader.h"
#include "core/image/image_probe.h"

namespace tessera {

namespace {

constexpr uint32_t kMaxSide = 1'000'000;  // libpng's own limit
constexpr size_t kSignatureSize = 8;
constexpr const char* kTruncated = "it ends too early";
constexpr const char* kDamaged = "it is damaged";

struct Header {
    uint32_t width = 0;
    uint32_t height = 0;
    uint32_t depth = 0;
    uint32_t colorType = 0;
    bool interlaced = false;

    bool palette() const { return colorType == 3; }
    uint32_t bitsPerPixel() const {
        constexpr std::array<uint32_t, 7> kChannels = {1, 0, 3, 1, 2, 0, 4};
        return kChannels[colorType] * depth;
    }
    bool valid() const {
        switch (colorType) {
            case 0:
                return depth == 1 || depth == 2 || depth == 4 || depth == 8 || depth == 16;
            case 3:
                return depth == 1 || depth == 2 || depth == 4 || depth == 8;
            case 2:
            case 4:
            case 6:
                return depth == 8 || depth == 16;
            default:
                return false;
        }
    }
};

// `count` rows of `bytes` bytes, the filter's byte with them.
struct Rows {
    uint64_t bytes;
    uint64_t count;
};

std::vector<Rows> rowsOf(const Header& header) {
    const auto rowBytes = [&](uint64_t width) { return 1 + (width * header.bitsPerPixel() + 7) / 8; };
    if (!header.interlaced) return {{rowBytes(header.width), header.height}};
    struct Pass {
        uint32_t x, y, stepX, stepY;
    };
    constexpr Pass kAdam7[] = {{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4},
                               {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2}};
    std::vector<Rows> rows;
    for (const Pass& pass : kAdam7) {
        if (header.width <= pass.x || header.height <= pass.y) continue;
        rows.push_back({rowBytes((header.width - pass.x + pass.stepX - 1) / pass.stepX),
                        (header.height - pass.y + pass.stepY - 1) / pass.stepY});
    }
    return rows;
}

// Follows the inflated stream from row to row to see each row's filter byte.
class RowWalk {
  public:
    explicit RowWalk(std::vector<Rows> rows) : mRows(std::move(rows)) {}

    bool complete() const { return mPass == mRows.size(); }

    // False on a filter that does not exist.
    bool feed(std::span<const uint8_t> bytes) {
        while (!bytes.empty() && !complete()) {
            constexpr uint8_t kFilters = 5;
            if (mInRow == 0 && bytes[0] >= kFilters) return false;
            const uint64_t step = std::min<uint64_t>(bytes.size(), mRows[mPass].bytes - mInRow);
            bytes = bytes.subspan(step);
            mInRow += step;
            if (mInRow < mRows[mPass].bytes) continue;
            mInRow = 0;
            if (++mRow < mRows[mPass].count) continue;
            mRow = 0;
            ++mPass;
        }
        return true;
    }

  private:
    std::vector<Rows> mRows;
    size_t mPass = 0;
    uint64_t mRow = 0;
    uint64_t mInRow = 0;
};

using Chunks = std::vector<std::span<const uint8_t>>;

std::string streamDefect(const Header& header, const Chunks& data) {
    z_stream stream{};
    if (inflateInit2(&stream, 0) != Z_OK) return "there is not enough memory for it";
    const std::unique_ptr<z_stream, int (*)(z_stream*)> closer(&stream, inflateEnd);
    RowWalk walk(rowsOf(header));
    std::vector<uint8_t> out(size_t{1} << 16);
    for (const std::span<const uint8_t> chunk : data) {
        stream.next_in = const_cast<uint8_t*>(chunk.data());  // zlib only reads there
        stream.avail_in = uInt(chunk.size());
        do {
            stream.next_out = out.data();
            stream.avail_out = uInt(out.size());
            const int status = inflate(&stream, Z_NO_FLUSH);
            const size_t produced = out.size() - stream.avail_out;
            if (!walk.feed({out.data(), produced})) return kDamaged;
            if (status == Z_STREAM_END) return walk.complete() ? "" : kDamaged;
            if (status == Z_BUF_ERROR && produced == 0) break;
            if (status != Z_OK && status != Z_BUF_ERROR) return kDamaged;
            // Whatever is compressed beyond the last row is no part of the picture.
            if (walk.complete() && produced == out.size()) return "";
        } while (stream.avail_in > 0 || stream.avail_out == 0);
    }
    return walk.complete() ? "" : kTruncated;
}

}  // namespace

std::string pngDefect(std::span<const uint8_t> bytes) {
    const ByteReader reader(bytes, true);
    Header header;
    Chunks data;
    bool dataEnded = false;
    bool palette = false;
    for (uint64_t at = kSignatureSize;;) {
        if (at + 12 > bytes.size()) return kTruncated;
        const uint64_t size = reader.u32(at);
        if (size > bytes.size() - at - 12) return kTruncated;
        const std::span<const uint8_t> body = bytes.subspan(at + 8, size);
        const bool critical = (bytes[at + 4] & 0x20) == 0;
        const bool first = at == kSignatureSize;
        if (first != reader.has(at + 4, "IHDR")) return kDamaged;
        if (critical && crc32(0, bytes.data() + at + 4, uInt(size + 4)) != reader.u32(at + 8 + size))
            return kDamaged;
        if (first) {
            if (size != 13) return kDamaged;
            header = {reader.u32(at + 8), reader.u32(at + 12), body[8], body[9], body[12] == 1};
            if (header.width == 0 || header.height == 0 || !header.valid()) return kDamaged;
            if (body[10] != 0 || body[11] != 0 || body[12] > 1) return kDamaged;
            if (header.width > kMaxSide || header.height > kMaxSide)
                return "it is more than a million pixels wide or high";
        } else if (reader.has(at + 4, "PLTE")) {
            if (palette || size == 0 || size % 3 != 0 || size > 768) return kDamaged;
            palette = true;
        } else if (reader.has(at + 4, "IDAT")) {
            if (header.palette() && !palette) return kDamaged;
            if (!dataEnded) data.push_back(body);
        } else if (reader.has(at + 4, "IEND")) {
            break;
        } else if (critical) {
            return kDamaged;
        }
        if (!data.empty() && !reader.has(at + 4, "IDAT")) dataEnded = true;
        at += 12 + size;
    }
    return data.empty() ? kTruncated : streamDefect(header, data);
}

}  // namespace tessera
