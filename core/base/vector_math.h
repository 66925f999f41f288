// Logarithms and powers in single precision, without branches or calls, for loops that are to become vector
// instructions (vector_clones.h).
#pragma once

#include <bit>
#include <cstdint>

#include "core/base/vector_clones.h"

namespace tessera {

// log2 x for normal x > 0, off by at most 3e-7 or that share of it. With x = 2^e f, f from sqrt(1/2) to
// sqrt(2), log f = 2 atanh(z), z = (f - 1) / (f + 1), by its series.
TESSERA_INLINE float fastLog2(float x) {
    constexpr uint32_t kOne = 0x3f800000, kMantissa = 0x7fffff;
    constexpr float kRoot = 1.41421356F, kPerLog = 2.88539008F;  // sqrt 2, 2 / log 2
    const auto bits = std::bit_cast<uint32_t>(x);
    const float mantissa = std::bit_cast<float>((bits & kMantissa) | kOne);
    const float high = mantissa > kRoot ? 1.F : 0.F;
    const float f = mantissa - .5F * high * mantissa;
    const float e = float(int32_t(bits >> 23) - 127) + high;
    const float z = (f - 1) / (f + 1), zz = z * z;
    float sum = 1.F / 9;
    sum = sum * zz + 1.F / 7;
    sum = sum * zz + 1.F / 5;
    sum = sum * zz + 1.F / 3;
    sum = sum * zz + 1;
    return e + kPerLog * z * sum;
}

// 2^x for -126 <= x < 127, off by at most 3e-7 of it.
TESSERA_INLINE float fastExp2(float x) {
    constexpr float kRounder = 12582912.F;  // 1.5 * 2^23: adding it leaves no bits for fractions
    constexpr float kLog2 = .693147181F;
    const float whole = (x + kRounder) - kRounder;
    const float t = kLog2 * (x - whole);
    float sum = 1.F / 720;
    sum = sum * t + 1.F / 120;
    sum = sum * t + 1.F / 24;
    sum = sum * t + 1.F / 6;
    sum = sum * t + .5F;
    sum = sum * t + 1;
    sum = sum * t + 1;
    return sum * std::bit_cast<float>(uint32_t(int32_t(whole) + 127) << 23);
}

}  // namespace tessera
