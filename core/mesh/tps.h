// Thin-plate splines over a patch's parametric domain (paper section 4.4, Eqs. 2 to 5). The colour function
// of a patch is specified in COLOUR.md beside this file.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "core/base/shared_list.h"
#include "core/mesh/bezier.h"

namespace tessera {

constexpr int kMaxChannels = 4;

// The parametric domain is the equilateral triangle of side 1, for every patch: corner a at (0, 0), b at (1,
// 0), c at (1/2, sqrt(3)/2). (The paper takes the base triangle itself; with a fixed domain, moving a vertex
// leaves the spline as it is, and the system of Eq. 5 is the same for all patches.)
constexpr double kDomainHeight = 0.86602540378443864676;
inline glm::dvec2 domainPoint(const Barycentric& b) {
    return {b.y + .5 * b.z, kDomainHeight * b.z};
}
inline Barycentric barycentricOf(glm::dvec2 d) {
    const double w = d.y / kDomainHeight, v = d.x - .5 * w;
    return {1 - v - w, v, w};
}

// phi(s) = s^2 log s (Eq. 3), taken at the squared distance; 0 at 0.
double tpsKernel(double squaredDistance);

// The 16 centres of the paper's fit: the 10 corners of the domain cut into 3^2 triangles and the middles of
// the 6 of those that stand upright: 9 on the boundary, 7 inside. In this order: corners a, b, c; two on each
// of ab, bc, ca; the centroid; the six middles.
constexpr int kDefaultCentreCount = 16;
const std::array<glm::dvec2, kDefaultCentreCount>& defaultCentres();

// The places that a spline can choose its centres from: the points of the domain's lattice of
// kSiteSubdivisions steps a side; the corners a, b, c first, then row by row from side ab.
constexpr int kSiteSubdivisions = 16;
constexpr int kCentreSites = (kSiteSubdivisions + 1) * (kSiteSubdivisions + 2) / 2;
const std::array<glm::dvec2, kCentreSites>& centreSites();

// Colour of one patch: for each channel f(x) = b0 + b1 x.x + b2 x.y + sum over i of alpha_i phi(|x -
// centre_i|), x in the parametric domain, values in the mesh's ColourBasis. Channels share one list of
// centres; a channel with n terms uses its first n. The alphas fulfil sum alpha = 0 and sum alpha centre = 0.
struct PatchSpline {
    std::array<uint8_t, kMaxChannels> terms{};  // alphas per channel: 0, or 3 and more
    // The centres: places among centreSites(), all different; or, where there are none, points of the
    // spline's own; or, where there are none of those either, the default ones. Recolouring keeps them, so
    // that all states of a patch share one list.
    SharedList<uint8_t> sites;
    std::vector<glm::vec2> centres;
    // Channel after channel: b0, b1, b2, alpha_0 .. alpha_(n-1).
    std::vector<float> coefficients;

    bool operator==(const PatchSpline&) const = default;

    // Where channel c's coefficients begin.
    size_t offset(int c) const;
    glm::dvec2 centre(int i) const;
    size_t centreCount() const;
    int maxTerms(int channels) const;
};

// A spline of constant colour, for `colour.size()` channels, with no alphas.
PatchSpline constantSpline(std::span<const float> colour);

// Channel c at a point of the parametric domain, in double: the readable twin of evaluateSplines.
double evaluateSpline(const PatchSpline& spline, int c, glm::dvec2 at);

// Its derivatives along the domain's axes; at a centre those of the other terms.
glm::dvec2 splineGradient(const PatchSpline& spline, int c, glm::dvec2 at);

// All channels at `count` points of the domain: out[c][i]. Uses the widest vector instructions that the
// machine has; phi is accurate to 1e-6 on the domain. Thread-safe. (tps_simd.cpp)
void evaluateSplines(const PatchSpline& spline, int channels, const float* x, const float* y, size_t count,
                     float* const* out);

// The instructions that there is code for; Baseline are those that every machine has. Avx2 and Avx512 give
// the same bits.
enum class SplineInstructions : uint8_t { Baseline, Avx2, Avx512 };
const char* nameOf(SplineInstructions instructions);
// Those that this machine has, the widest last.
const std::vector<SplineInstructions>& splineInstructions();
// evaluateSplines with one of them.
void evaluateSplinesWith(SplineInstructions instructions, const PatchSpline& spline, int channels,
                         const float* x, const float* y, size_t count, float* const* out);

// phi of the distances from `count` points of the domain to each of `centres`: out[i * stride + k] for centre
// i and point k. Within 1e-13, and the same on every machine.
void evaluateKernels(std::span<const glm::dvec2> centres, const float* x, const float* y, size_t count,
                     double* out, size_t stride);

// Between a spline's n alphas with three polynomial terms and its values at its n >= 3 centres: the n + 3
// coefficients (b0, b1, b2, alphas, as in PatchSpline) are `toCoefficients` (row-major, n + 3 rows of n)
// times the values. The side conditions hold by construction. Fails a check where the centres lie on one line
// or two coincide.
struct NodalBasis {
    int n = 0;
    std::vector<double> toCoefficients;
};
NodalBasis nodalBasis(std::span<const glm::dvec2> centres);
// nodalBasis of the default centres, computed once.
const NodalBasis& defaultNodalBasis();

}  // namespace tessera
