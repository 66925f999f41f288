// Little-endian numbers and strings in a row of bytes: what a document is made of outside its mesh.
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tessera {

class ByteWriter {
  public:
    void u8(uint8_t value) { word(value, 1); }
    void u32(uint32_t value) { word(value, 4); }
    void u64(uint64_t value) { word(value, 8); }
    void f64(double value) { u64(std::bit_cast<uint64_t>(value)); }
    void raw(std::span<const uint8_t> bytes);
    // Its length as u32, then its bytes.
    void string(std::string_view text);

    size_t size() const { return mBytes.size(); }
    std::vector<uint8_t> take() { return std::move(mBytes); }
    const std::vector<uint8_t>& bytes() const { return mBytes; }

  private:
    void word(uint64_t value, int count);

    std::vector<uint8_t> mBytes;
};

// Reads what ByteWriter wrote. Past the end every read gives 0 or nothing and failed() stays true; nothing is
// ever read outside the bytes, and no length is believed beyond what is left of them.
class ByteReader {
  public:
    explicit ByteReader(std::span<const uint8_t> bytes) : mBytes(bytes) {}

    uint8_t u8() { return uint8_t(word(1)); }
    uint32_t u32() { return uint32_t(word(4)); }
    uint64_t u64() { return word(8); }
    double f64() { return std::bit_cast<double>(u64()); }
    std::span<const uint8_t> raw(uint64_t count);
    std::string string();

    size_t offset() const { return mAt; }
    size_t left() const { return mBytes.size() - mAt; }
    bool failed() const { return mFailed; }

  private:
    uint64_t word(int count);

    std::span<const uint8_t> mBytes;
    size_t mAt = 0;
    bool mFailed = false;
};

}  // namespace tessera
