// XXH64 (Collet, xxHash specification 0.1.1): the checksum of a document's chunks. Detects damage, not
// forgery.
#pragma once

#include <cstdint>
#include <span>

namespace tessera {

// XXH64 of `bytes` with seed 0, the same on every machine.
uint64_t xxhash64(std::span<const uint8_t> bytes);

}  // namespace tessera
