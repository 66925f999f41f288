// Splines changed as functions: channels mixed exactly.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "core/mesh/colour_basis.h"
#include "core/mesh/tps.h"

namespace tessera {

// colour -> matrix * colour + offset, in gamma-encoded sRGB.
struct AffineColour {
    glm::dmat3 matrix{1};
    glm::dvec3 offset{0};

    glm::dvec3 operator()(glm::dvec3 colour) const { return matrix * colour + offset; }
};

// Goes `strength` of the way to the hue and saturation of a colour; luma stays.
AffineColour tinted(glm::dvec3 colour, double strength);

// The spline with its colours changed, whatever its alpha: exact but for the rounding of coefficients. A
// channel gets as many terms as the longest of those that it is mixed of: channels use prefixes of one list
// of centres.
PatchSpline mixed(const PatchSpline& spline, int channels, ColourBasis basis, const AffineColour& change);

}  // namespace tessera
