// SHA-256 (FIPS 180-4), to recognize a source picture again.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

namespace tessera {

// The digest of `bytes`, most significant byte first.
std::array<uint8_t, 32> sha256(std::span<const uint8_t> bytes);

// The digest as 64 lower-case hex digits.
std::string sha256Hex(std::span<const uint8_t> bytes);

}  // namespace tessera
