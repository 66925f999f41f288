// See range_coder.h.
#include "core/document/range_coder.h"

#include <algorithm>
#include <bit>

#include "core/base/check.h"

namespace tessera {

namespace {

constexpr int kLearnLimit = 60;
constexpr uint32_t kTop = 1u << 24;

// 65536 / (n + 1.5): the mean of what was seen, until the limit makes it a decaying one.
constexpr auto kRates = [] {
    std::array<uint32_t, kLearnLimit + 1> rates{};
    for (size_t n = 0; n < rates.size(); ++n) rates[n] = uint32_t(2 * 65536 / (2 * n + 3));
    return rates;
}();

template <class Coder>
void codeNumber(Coder& coder, IntModel& model, int64_t& value) {
    int length = Coder::kEncodes ? bitLength(value) : 0;
    for (int i = 0; i < IntModel::kMaxBits; ++i) {
        bool more = length > i;
        coder.bit(model.longer[size_t(i)], more);
        if (!more) break;
        if (!Coder::kEncodes) length = i + 1;
    }
    if (length == 0) {
        value = 0;
        return;
    }
    bool negative = value < 0;
    coder.bit(model.negative, negative);
    uint64_t magnitude = Coder::kEncodes ? uint64_t(negative ? -value : value) : uint64_t{1} << (length - 1);
    auto& top = model.top[size_t(length - 1)];
    bool upper = false;
    int below = length - 1;
    for (int i = 0; i < 2 && below > 0; ++i) {
        --below;
        bool bit = (magnitude >> below & 1) != 0;
        coder.bit(top[i == 0 ? 0 : 1 + size_t(upper)], bit);
        upper = bit;
        if (bit) magnitude |= uint64_t{1} << below;
    }
    if (below > 0) {
        uint64_t rest = magnitude & ((uint64_t{1} << below) - 1);
        coder.plainBits(rest, below);
        magnitude |= rest;
    }
    value = negative ? -int64_t(magnitude) : int64_t(magnitude);
}

}  // namespace

int bitLength(int64_t value) {
    return int(std::bit_width(value < 0 ? ~uint64_t(value) + 1 : uint64_t(value)));
}

void BitModel::learn(bool bit) {
    const uint32_t rate = kRates[mCount];
    uint32_t p = mProbability;
    if (bit)
        p -= p * rate >> 16;
    else
        p += (65536 - p) * rate >> 16;
    mProbability = uint16_t(std::clamp<uint32_t>(p, 48, 65536 - 48));
    if (mCount < kLearnLimit) ++mCount;
}

void RangeEncoder::shiftLow() {
    if (uint32_t(mLow) < 0xFF000000u || mLow >> 32 != 0) {
        const auto carry = uint8_t(mLow >> 32);
        uint8_t byte = mCache;
        do {
            mBytes.push_back(uint8_t(byte + carry));
            byte = 0xFF;
        } while (--mPending != 0);
        mCache = uint8_t(mLow >> 24);
    }
    ++mPending;
    mLow = (mLow & 0x00FFFFFF) << 8;
}

void RangeEncoder::normalize() {
    while (mRange < kTop) {
        mRange <<= 8;
        shiftLow();
    }
}

void RangeEncoder::bit(BitModel& model, bool& value) {
    const uint32_t bound = (mRange >> 16) * model.probability();
    if (value) {
        mLow += bound;
        mRange -= bound;
    } else {
        mRange = bound;
    }
    model.learn(value);
    normalize();
}

void RangeEncoder::plainBits(uint64_t& value, int count) {
    for (int i = count; i-- > 0;) {
        mRange >>= 1;
        if (value >> i & 1) mLow += mRange;
        normalize();
    }
}

void RangeEncoder::number(IntModel& model, int64_t& value) {
    TESSERA_CHECK(bitLength(value) <= IntModel::kMaxBits);
    codeNumber(*this, model, value);
}

std::vector<uint8_t> RangeEncoder::finish() {
    for (int i = 0; i < 5; ++i) shiftLow();
    return std::move(mBytes);
}

RangeDecoder::RangeDecoder(std::span<const uint8_t> bytes) : mBytes(bytes) {
    for (int i = 0; i < 5; ++i) mCode = mCode << 8 | nextByte();
}

uint8_t RangeDecoder::nextByte() {
    const size_t at = mAt++;
    return at < mBytes.size() ? mBytes[at] : uint8_t{0};
}

void RangeDecoder::normalize() {
    while (mRange < kTop) {
        mRange <<= 8;
        mCode = mCode << 8 | nextByte();
    }
}

void RangeDecoder::bit(BitModel& model, bool& value) {
    const uint32_t bound = (mRange >> 16) * model.probability();
    value = mCode >= bound;
    if (value) {
        mCode -= bound;
        mRange -= bound;
    } else {
        mRange = bound;
    }
    model.learn(value);
    normalize();
}

void RangeDecoder::plainBits(uint64_t& value, int count) {
    value = 0;
    for (int i = 0; i < count; ++i) {
        mRange >>= 1;
        const bool bit = mCode >= mRange;
        if (bit) mCode -= mRange;
        value = value << 1 | uint64_t(bit);
        normalize();
    }
}

void RangeDecoder::number(IntModel& model, int64_t& value) {
    codeNumber(*this, model, value);
}

}  // namespace tessera
