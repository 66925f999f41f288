// See chunk_file.h; the layout is specified in FORMAT.md.
#include "core/document/chunk_file.h"

#include <zstd.h>

#include <algorithm>

#include "core/document/byte_stream.h"
#include "core/document/xxhash64.h"

namespace tessera {

namespace {

// As in PNG: a byte above 127 shows transports of 7 bits, the line ends show text modes, ^Z stops `type`.
constexpr std::array<uint8_t, 8> kMagic{0x89, 'T', 'S', 'R', '\r', '\n', 0x1A, '\n'};
constexpr size_t kFixedHeadSize = kMagic.size() + 4 + 4;  // magic, version, number of chunks
constexpr size_t kChecksumSize = 8;
constexpr uint32_t kSafeToCopyFlag = 1;
// The strong level takes seconds a megabyte: it is for what is small, and only where the quick one finds
// something.
constexpr int kQuickLevel = 1, kStrongLevel = 19, kFastLevel = 6;
constexpr size_t kStrongUpTo = size_t{4} << 20;

enum Packing : uint8_t { Plain = 0, Zstd = 1 };

tl::unexpected<Error> damaged(const std::string& what) {
    return failure(ErrorCode::DamagedDocument, what);
}

}  // namespace

std::string tagText(const ChunkTag& tag) {
    std::string text(tag.begin(), tag.end());
    for (char& c : text)
        if (c < ' ' || c > '~') c = '?';
    return text;
}

std::vector<uint8_t> packChunks(uint32_t version, std::span<const Chunk> chunks) {
    ByteWriter head;
    head.raw(kMagic);
    head.u32(version);
    head.u32(uint32_t(chunks.size()));
    uint64_t offset = kFixedHeadSize + kChunkEntrySize * chunks.size() + kChecksumSize;
    for (const Chunk& chunk : chunks) {
        for (const char c : chunk.tag) head.u8(uint8_t(c));
        head.u32(chunk.safeToCopy ? kSafeToCopyFlag : 0);
        head.u64(offset);
        head.u64(chunk.bytes.size());
        head.u64(xxhash64(chunk.bytes));
        offset += chunk.bytes.size();
    }
    head.u64(xxhash64(head.bytes()));
    for (const Chunk& chunk : chunks) head.raw(chunk.bytes);
    return head.take();
}

uint32_t chunkFileVersion(std::span<const uint8_t> bytes) {
    ByteReader head(bytes);
    head.raw(kMagic.size());
    return head.u32();
}

bool startsLikeChunkFile(std::span<const uint8_t> bytes) {
    return bytes.size() >= kMagic.size() && std::equal(kMagic.begin(), kMagic.end(), bytes.begin());
}

Result<std::vector<Chunk>> unpackChunks(std::span<const uint8_t> bytes, uint32_t newestVersion) {
    if (!startsLikeChunkFile(bytes)) {
        const std::array<uint8_t, 3> name{'T', 'S', 'R'};
        const auto start = bytes.first(std::min<size_t>(bytes.size(), 8));
        if (std::search(start.begin(), start.end(), name.begin(), name.end()) != start.end())
            return damaged("its first bytes were changed, as by a transfer in text mode; copy it again");
        return damaged("it does not begin like a Tessera document");
    }
    ByteReader head(bytes);
    head.raw(kMagic.size());
    const uint32_t version = head.u32(), count = head.u32();
    if (head.failed()) return damaged("it ends within its head");
    if (version == 0) return damaged("its version is 0");
    if (version > newestVersion)
        return damaged("it has format version " + std::to_string(version) +
                       ", this program reads up to version " + std::to_string(newestVersion) +
                       "; open it with a newer Tessera");
    if (count > head.left() / kChunkEntrySize) return damaged("it ends within its table of chunks");

    std::vector<Chunk> chunks(count);
    std::vector<uint64_t> checksums(count);
    uint64_t expected = kFixedHeadSize + kChunkEntrySize * uint64_t(count) + kChecksumSize;
    for (uint32_t i = 0; i < count; ++i) {
        Chunk& chunk = chunks[i];
        for (char& c : chunk.tag) c = char(head.u8());
        const uint32_t flags = head.u32();
        chunk.safeToCopy = (flags & kSafeToCopyFlag) != 0;
        chunk.offset = head.u64();
        const uint64_t size = head.u64();
        checksums[i] = head.u64();
        const std::string name = "the table's entry for chunk " + tagText(chunk.tag);
        if (flags > kSafeToCopyFlag) return damaged(name + " has flags that no version knows");
        if (chunk.offset != expected) return damaged(name + " names a wrong offset");
        if (expected > bytes.size() || size > bytes.size() - expected)
            return damaged("it ends within chunk " + tagText(chunk.tag) + ", which begins at byte " +
                           std::to_string(chunk.offset));
        chunk.bytes = bytes.subspan(size_t(chunk.offset), size_t(size));
        expected += size;
    }
    const size_t tableEnd = head.offset();
    if (head.u64() != xxhash64(bytes.first(tableEnd)) || head.failed())
        return damaged("its table of chunks does not match its checksum");
    if (expected != bytes.size())
        return damaged("bytes follow its last chunk at " + std::to_string(expected));
    for (uint32_t i = 0; i < count; ++i)
        if (xxhash64(chunks[i].bytes) != checksums[i])
            return damaged("chunk " + tagText(chunks[i].tag) + " at byte " +
                           std::to_string(chunks[i].offset) + " does not match its checksum");
    return chunks;
}

std::vector<uint8_t> deflated(std::span<const uint8_t> bytes) {
    std::vector<uint8_t> packed(ZSTD_compressBound(bytes.size()));
    const auto pack = [&](int level) {
        return ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), level);
    };
    const auto pays = [&](size_t size) {
        return !ZSTD_isError(size) && size < bytes.size() / 8 * 7 && bytes.size() / size < kMaxInflation;
    };
    size_t size = pack(kQuickLevel);
    if (pays(size)) size = pack(bytes.size() <= kStrongUpTo ? kStrongLevel : kFastLevel);
    ByteWriter out;
    if (pays(size)) {
        out.u8(Zstd);
        out.u64(bytes.size());
        out.raw({packed.data(), size});
    } else {
        out.u8(Plain);
        out.raw(bytes);
    }
    return out.take();
}

Result<std::vector<uint8_t>> inflated(std::span<const uint8_t> bytes) {
    ByteReader reader(bytes);
    const uint8_t packing = reader.u8();
    if (reader.failed()) return damaged("is empty");
    if (packing == Plain) {
        const auto rest = reader.raw(reader.left());
        return std::vector<uint8_t>(rest.begin(), rest.end());
    }
    if (packing != Zstd) return damaged("is packed in a way that no version knows");
    const uint64_t size = reader.u64();
    if (reader.failed() || size / kMaxInflation > reader.left())
        return damaged("has a length that cannot be");
    const auto packed = reader.raw(reader.left());
    std::vector<uint8_t> out(static_cast<size_t>(size));
    const size_t got = ZSTD_decompress(out.data(), out.size(), packed.data(), packed.size());
    if (ZSTD_isError(got) || got != size) return damaged("does not unpack to its length");
    return out;
}

}  // namespace tessera
