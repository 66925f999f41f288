// The container of a document: a head with a table of checked chunks. It knows nothing of what is in them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace tessera {

using ChunkTag = std::array<char, 4>;

struct Chunk {
    ChunkTag tag{};
    bool safeToCopy = false;  // by programs that do not know it, after they have changed the mesh
    std::span<const uint8_t> bytes;
    uint64_t offset = 0;  // in the file
};

constexpr size_t kChunkEntrySize = 32;

// A tag as text; bytes that are not printable as '?'.
std::string tagText(const ChunkTag& tag);

// The chunks' bytes must outlive the call only; their offsets are set here.
std::vector<uint8_t> packChunks(uint32_t version, std::span<const Chunk> chunks);

// The chunks, whose bytes point into `bytes`. Checks the head, that the chunks fill the file without a gap,
// and every checksum; refuses versions above `newestVersion`.
Result<std::vector<Chunk>> unpackChunks(std::span<const uint8_t> bytes, uint32_t newestVersion);

// The version of a file that unpackChunks takes.
uint32_t chunkFileVersion(std::span<const uint8_t> bytes);

bool startsLikeChunkFile(std::span<const uint8_t> bytes);

// Bytes as zstd where that is less than 7/8 of them, else as they are; a leading byte says which. No more
// than kMaxInflation times smaller, so that a reader can bound what it takes.
std::vector<uint8_t> deflated(std::span<const uint8_t> bytes);
constexpr uint64_t kMaxInflation = 64;
// What deflated() had, or what is wrong.
Result<std::vector<uint8_t>> inflated(std::span<const uint8_t> bytes);

}  // namespace tessera
