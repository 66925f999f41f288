// See colour_basis.h.
#include "core/mesh/colour_basis.h"

namespace tessera {

namespace {

constexpr float kThird = .57735026918962576451f;  // 1 / sqrt 3
constexpr float kHalf = .70710678118654752440f;   // 1 / sqrt 2
constexpr float kSixth = .40824829046386301637f;  // 1 / sqrt 6

}  // namespace

void toWorking(ColourBasis basis, float* const* planes, size_t count) {
    if (basis == ColourBasis::Rgb) return;
    float* const p0 = planes[0];
    float* const p1 = planes[1];
    float* const p2 = planes[2];
    for (size_t i = 0; i < count; ++i) {
        const float sum = kThird * p0[i], redBlue = kHalf * p1[i], green = kSixth * p2[i];
        p0[i] = sum + redBlue + green;
        p1[i] = sum - 2 * green;
        p2[i] = sum - redBlue + green;
    }
}

void fromWorking(ColourBasis basis, float* const* planes, size_t count) {
    if (basis == ColourBasis::Rgb) return;
    float* const p0 = planes[0];
    float* const p1 = planes[1];
    float* const p2 = planes[2];
    for (size_t i = 0; i < count; ++i) {
        const float r = p0[i], g = p1[i], b = p2[i];
        p0[i] = kThird * (r + g + b);
        p1[i] = kHalf * (r - b);
        p2[i] = kSixth * (r - 2 * g + b);
    }
}

}  // namespace tessera
