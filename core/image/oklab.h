// OKLab and OKLCH (Ottosson 2020): colours by how they look, for distances between them and for changes of
// hue, chroma and lightness.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>

namespace tessera {

// (L, a, b) of a colour in gamma-encoded sRGB and back. Defined for values outside 0..1 too: the curves of
// both spaces go on as odd functions. fromOklab(toOklab(c)) is c within 1e-6.
glm::dvec3 toOklab(glm::dvec3 srgb);
glm::dvec3 fromOklab(glm::dvec3 lab);

// The same of `count` colours in three planes, in place, in single precision: of colours within 0..1 off by
// at most 2e-6, and there and back by 4e-5.
void toOklab(float* const* planes, size_t count);
void fromOklab(float* const* planes, size_t count);

// (L, C, h): lightness, chroma, and hue in degrees, [0, 360); 0 where there is no chroma.
glm::dvec3 toOklch(glm::dvec3 srgb);
glm::dvec3 fromOklch(glm::dvec3 lch);

}  // namespace tessera
