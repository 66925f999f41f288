// Adaptive binary range coder (the carry-less-output scheme of Pavlov's LZMA) with models for bits and for
// integers of any size. Residuals of a mesh are many small numbers whose spread changes from place to place:
// a model that learns as it goes spends about a tenth less on them than zstd on byte planes, and, as the
// coder is ours, the same document gives the same bytes for ever.
//
// Encoder and decoder have the same members, so that one template describes a stream for both directions:
// `bit` and `number` write their argument in the one and set it in the other.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tessera {

// The probability of a 0, learnt: fast at first, then over the last few dozen bits.
class BitModel {
  public:
    uint32_t probability() const { return mProbability; }  // of 0, in 1/65536; never 0 or 1
    void learn(bool bit);

  private:
    uint16_t mProbability = 1 << 15;
    uint8_t mCount = 0;
};

// A signed integer with |value| < 2^kMaxBits: its bit length in unary, its sign, the two bits below the
// highest one, each with models of their own; the bits below as they are.
struct IntModel {
    static constexpr int kMaxBits = 48;

    std::array<BitModel, kMaxBits> longer;
    BitModel negative;
    std::array<std::array<BitModel, 3>, kMaxBits> top;
};

class RangeEncoder {
  public:
    static constexpr bool kEncodes = true;

    void bit(BitModel& model, bool& value);
    void plainBits(uint64_t& value, int count);
    void number(IntModel& model, int64_t& value);

    // Ends the stream: its bytes.
    std::vector<uint8_t> finish();

  private:
    void shiftLow();
    void normalize();

    uint64_t mLow = 0;
    uint32_t mRange = 0xFFFFFFFF;
    uint8_t mCache = 0;
    uint64_t mPending = 1;
    std::vector<uint8_t> mBytes;
};

// Any bytes decode to something; past the end zeros are read and overrun() tells.
class RangeDecoder {
  public:
    static constexpr bool kEncodes = false;

    explicit RangeDecoder(std::span<const uint8_t> bytes);

    void bit(BitModel& model, bool& value);
    void plainBits(uint64_t& value, int count);
    void number(IntModel& model, int64_t& value);

    bool overrun() const { return mAt > mBytes.size(); }
    // Bytes read so far.
    size_t offset() const { return mAt; }

  private:
    void normalize();
    uint8_t nextByte();

    std::span<const uint8_t> mBytes;
    size_t mAt = 0;
    uint32_t mRange = 0xFFFFFFFF;
    uint32_t mCode = 0;
};

// Number of bits of |value|'s binary representation; 0 for 0.
int bitLength(int64_t value);

}  // namespace tessera
