// Certificates that a cubic patch does not fold: the determinant of its Jacobian is a polynomial of degree 4,
// and it is positive everywhere if its 15 Bernstein coefficients are. On the lattice these are integers, so
// the answer is exact. (Coefficients of products: Farin, Curves and Surfaces for CAGD; the use as a
// certificate: Johnen, Remacle, Geuzaine 2013.)
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/mesh/bezier.h"

namespace tessera {

// Index of the coefficient with exponents (i, j, k), i + j + k = 4.
constexpr int quarticIndex(int i, int j) {
    return (4 - i) * (5 - i) / 2 + (4 - i - j);
}

// det J of the patch in the parameters (v, w), relative to the triangle of its corners: coefficient / (twice
// the area of the base triangle). 1 everywhere where the patch is affine. The base triangle must have
// positive area.
std::array<double, 15> jacobianBernstein(const LatticeTriangle& t);

// Whether det J is positive on the whole closed patch, decided exactly: by the signs of the coefficients,
// subdividing where they are mixed. False also where it is zero somewhere, or where `kMaxCertificateDepth`
// subdivisions leave it open.
constexpr int kMaxCertificateDepth = 4;
bool certified(const LatticeTriangle& t);

// The smallest of the 15 coefficients of jacobianBernstein; -1 where the base triangle is not positive.
double minBernstein(const LatticeTriangle& t);

// An interior control point for the given sides with which the patch is certified: the present one, the
// default one, or else the one that makes the smallest of the 15 coefficients largest (det J is affine in any
// single control point, so that is a small linear program). None where no interior point passes certified().
std::optional<LatticePoint> certifiedInterior(const LatticeTriangle& t);

// The same from the default point on, whatever t's own: it depends on the nine points of the sides alone, not
// on which corner comes first.
std::optional<LatticePoint> certifiedDefaultInterior(const LatticeTriangle& t);

// Whether the triangle of these corners is so high over its longest side that a patch with straight sides,
// whose control points are thirds rounded to the lattice, is certified. No such patch needs a test then.
bool certifiedIfStraight(LatticePoint a, LatticePoint b, LatticePoint c);

}  // namespace tessera
