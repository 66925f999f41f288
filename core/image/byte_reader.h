// Integers at offsets of a byte array, for headers that may lie about their sizes.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace tessera {

// What lies beyond the end reads as 0, so that a caller need not check each field.
class ByteReader {
  public:
    explicit ByteReader(std::span<const uint8_t> bytes, bool bigEndian = false)
        : mBytes(bytes), mBigEndian(bigEndian) {}

    uint32_t u8(uint64_t at) const { return at < mBytes.size() ? mBytes[at] : 0; }
    uint32_t u16(uint64_t at) const {
        return mBigEndian ? u8(at) << 8 | u8(at + 1) : u8(at + 1) << 8 | u8(at);
    }
    uint32_t u32(uint64_t at) const {
        return mBigEndian ? u16(at) << 16 | u16(at + 2) : u16(at + 2) << 16 | u16(at);
    }

    // Whether exactly `text` lies at offset `at`.
    bool has(uint64_t at, std::string_view text) const {
        if (at > mBytes.size() || mBytes.size() - at < text.size()) return false;
        for (size_t i = 0; i < text.size(); ++i)
            if (mBytes[at + i] != uint8_t(text[i])) return false;
        return true;
    }

  private:
    std::span<const uint8_t> mBytes;
    bool mBigEndian;
};

}  // namespace tessera
