// See oklab.h.
#include "core/image/oklab.h"

#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

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
