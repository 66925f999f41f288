// See oklab.h.
#include "core/image/oklab.h"

#include <array>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include "core/base/vector_math.h"
#include "core/image/color_management.h"

namespace tessera {

namespace {

// Rows as published; glm's matrices are filled column by column.
const glm::dmat3 kToCones = glm::transpose(glm::dmat3(0.4122214708, 0.5363325363, 0.0514459929,  //
                                                      0.2119034982, 0.6806995451, 0.1073969566,  //
                                                      0.0883024619, 0.2817188376, 0.6299787005));
const glm::dmat3 kToLab = glm::transpose(glm::dmat3(0.2104542553, 0.7936177850, -0.0040720468,  //
                                                    1.9779984951, -2.4285922050, 0.4505937099,  //
                                                    0.0259040371, 0.7827717662, -0.8086757660));
const glm::dmat3 kFromCones = glm::inverse(kToCones);
const glm::dmat3 kFromLab = glm::inverse(kToLab);

// Rows of a matrix in single precision.
struct Rows {
    explicit Rows(const glm::dmat3& m) {
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 3; ++column)
                at[size_t(row)][size_t(column)] = float(m[column][row]);
    }

    TESSERA_INLINE float times(size_t row, float x, float y, float z) const {
        return at[row][0] * x + at[row][1] * y + at[row][2] * z;
    }

    std::array<std::array<float, 3>, 3> at;
};
const Rows kToConesRows(kToCones), kToLabRows(kToLab), kFromConesRows(kFromCones), kFromLabRows(kFromLab);

// |x|^exponent with the sign of x.
TESSERA_INLINE float oddPower(float x, float exponent) {
    constexpr float kLeast = 1e-30F;
    return std::copysign(fastExp2(exponent * fastLog2(std::abs(x) + kLeast)), x);
}

// The curves of decodeSrgb and encodeSrgb; a factor chooses their part, since a branch makes no vectors.
TESSERA_INLINE float fastDecode(float encoded) {
    const float x = std::abs(encoded);
    const float low = x * (1 / 12.92F), high = oddPower((x + .055F) * (1 / 1.055F), 2.4F);
    const float bent = x > .04045F ? 1.F : 0.F;
    return std::copysign(low + bent * (high - low), encoded);
}

TESSERA_INLINE float fastEncode(float linear) {
    const float x = std::abs(linear);
    const float low = 12.92F * x, high = 1.055F * oddPower(x, 1 / 2.4F) - .055F;
    const float bent = x > .0031308F ? 1.F : 0.F;
    return std::copysign(low + bent * (high - low), linear);
}

}  // namespace

glm::dvec3 toOklab(glm::dvec3 srgb) {
    glm::dvec3 linear;
    for (int c = 0; c < 3; ++c) linear[c] = double(decodeSrgb(float(srgb[c])));
    glm::dvec3 cones = kToCones * linear;
    for (int c = 0; c < 3; ++c) cones[c] = std::cbrt(cones[c]);
    return kToLab * cones;
}

glm::dvec3 fromOklab(glm::dvec3 lab) {
    const glm::dvec3 roots = kFromLab * lab;
    const glm::dvec3 linear = kFromCones * (roots * roots * roots);
    glm::dvec3 srgb;
    for (int c = 0; c < 3; ++c) srgb[c] = double(encodeSrgb(float(linear[c])));
    return srgb;
}

TESSERA_VECTOR_CLONES
void toOklab(float* const* planes, size_t count) {
    float *const p0 = planes[0], *const p1 = planes[1], *const p2 = planes[2];
    const Rows cones = kToConesRows, lab = kToLabRows;
    for (size_t i = 0; i < count; ++i) {
        const float r = fastDecode(p0[i]), g = fastDecode(p1[i]), b = fastDecode(p2[i]);
        const float l = oddPower(cones.times(0, r, g, b), 1.F / 3);
        const float m = oddPower(cones.times(1, r, g, b), 1.F / 3);
        const float s = oddPower(cones.times(2, r, g, b), 1.F / 3);
        p0[i] = lab.times(0, l, m, s);
        p1[i] = lab.times(1, l, m, s);
        p2[i] = lab.times(2, l, m, s);
    }
}

TESSERA_VECTOR_CLONES
void fromOklab(float* const* planes, size_t count) {
    float *const p0 = planes[0], *const p1 = planes[1], *const p2 = planes[2];
    const Rows cones = kFromConesRows, lab = kFromLabRows;
    for (size_t i = 0; i < count; ++i) {
        const float l = lab.times(0, p0[i], p1[i], p2[i]);
        const float m = lab.times(1, p0[i], p1[i], p2[i]);
        const float s = lab.times(2, p0[i], p1[i], p2[i]);
        const float lll = l * l * l, mmm = m * m * m, sss = s * s * s;
        p0[i] = fastEncode(cones.times(0, lll, mmm, sss));
        p1[i] = fastEncode(cones.times(1, lll, mmm, sss));
        p2[i] = fastEncode(cones.times(2, lll, mmm, sss));
    }
}

glm::dvec3 toOklch(glm::dvec3 srgb) {
    const glm::dvec3 lab = toOklab(srgb);
    const double chroma = std::hypot(lab.y, lab.z);
    constexpr double kGrey = 1e-6;
    if (chroma < kGrey) return {lab.x, 0, 0};
    const double hue = glm::degrees(std::atan2(lab.z, lab.y));
    return {lab.x, chroma, hue < 0 ? hue + 360 : hue};
}

glm::dvec3 fromOklch(glm::dvec3 lch) {
    const double hue = glm::radians(lch.z);
    return fromOklab({lch.x, lch.y * std::cos(hue), lch.y * std::sin(hue)});
}

}  // namespace tessera
