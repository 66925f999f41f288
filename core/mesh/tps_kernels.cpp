// phi at many points in double, for fits: their systems are ill-conditioned where centres lie close. In loops
// that a compiler turns into vector instructions, without fused operations, so that results are the same with
// and without them.
#include <bit>
#include <numbers>

#include "core/base/vector_clones.h"
#include "core/mesh/tps.h"

namespace tessera {

namespace {

// q log(q) / 2. With q = 2^e f, f from sqrt(1/2) to sqrt(2), log f = 2 atanh(z), z = (f - 1) / (f + 1), by
// its series. At q = 0 the exponent is -1023 and the product the wanted 0, without a branch.
inline double kernelOf(double q) {
    constexpr uint64_t kMantissa = (uint64_t{1} << 52) - 1, kOne = uint64_t{1023} << 52;
    constexpr uint64_t kTwo52Bits = uint64_t{1075} << 52;
    constexpr double kTwo52 = 4503599627370496.0;
    const auto bits = std::bit_cast<uint64_t>(q);
    // An integer below 2^52 in the mantissa of 2^52 is a sum; vectors of 64-bit integers have no conversion.
    const double exponent = std::bit_cast<double>((bits >> 52) | kTwo52Bits) - (kTwo52 + 1023);
    const double mantissa = std::bit_cast<double>((bits & kMantissa) | kOne);
    const double high = mantissa > std::numbers::sqrt2 ? 1 : 0;
    const double f = mantissa - .5 * high * mantissa, e = exponent + high;
    const double z = (f - 1) / (f + 1), zz = z * z;
    double sum = 1.0 / 15;
    sum = sum * zz + 1.0 / 13;
    sum = sum * zz + 1.0 / 11;
    sum = sum * zz + 1.0 / 9;
    sum = sum * zz + 1.0 / 7;
    sum = sum * zz + 1.0 / 5;
    sum = sum * zz + 1.0 / 3;
    sum = sum * zz + 1;
    return q * (e * (.5 * std::numbers::ln2) + z * sum);
}

}  // namespace

TESSERA_VECTOR_CLONES
void evaluateKernels(std::span<const glm::dvec2> centres, const float* x, const float* y, size_t count,
                     double* out, size_t stride) {
    for (const glm::dvec2 c : centres) {
        for (size_t k = 0; k < count; ++k) {
            const double dx = double(x[k]) - c.x, dy = double(y[k]) - c.y;
            out[k] = kernelOf(dx * dx + dy * dy);
        }
        out += stride;
    }
}

}  // namespace tessera
