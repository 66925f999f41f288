// The Newton basis of the splines over a list of sites: the spaces of the first 3, 4, 5, ... centres lie in
// each other, and function k belongs to the space of the first k + 1 centres, is 1 at centre k and 0 at the
// centres before it. So a spline of fewer terms is a prefix of its factors, and each factor is what the
// spline differs by, at one centre, from the one before. (Mueller and Schaback, A Newton basis for kernel
// spaces, 2009.)
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "core/mesh/tps.h"

namespace tessera {

class NewtonBasis {
  public:
    // `sites` begin with the corners 0, 1, 2 and are all different. The first three functions are the
    // barycentric coordinates.
    explicit NewtonBasis(std::span<const uint8_t> sites);

    int size() const { return int(mSites.size()); }

    // The thin-plate energy of function k, up to a constant: the alphas' quadratic form in phi. The functions
    // are orthogonal in it, so that a spline's is the sum of energy(k) times its factors squared.
    double energy(int k) const { return mEnergies[size_t(k)]; }

    // The functions at `count` points of the domain, rounded: out[k * stride + i] is function k at point i.
    void evaluate(const float* x, const float* y, size_t count, float* out, size_t stride) const;
    // Their sums over groups of points, none of them empty, group g from firstPoint[g] to firstPoint[g + 1]:
    // out[k * stride + g], of one group fewer than there are numbers.
    void evaluateSums(const float* x, const float* y, std::span<const uint32_t> firstPoint, float* out,
                      size_t stride) const;
    // The functions and their derivatives along the domain's axes, likewise, unrounded; `stride` is a
    // multiple of 8.
    void evaluateWithDerivatives(const float* x, const float* y, size_t count, double* values, double* alongX,
                                 double* alongY, size_t stride) const;

    // The spline with these factors, for each channel of its first functions (at least 3).
    PatchSpline spline(std::span<const std::span<const double>> factors) const;

  private:
    // Coefficient `row` of function k: b0, b1, b2, then the alphas.
    double& coefficient(int row, int k) { return mCoefficients[size_t(row) * mStride + size_t(k)]; }
    double coefficient(int row, int k) const { return mCoefficients[size_t(row) * mStride + size_t(k)]; }

    // Functions from `terms`, which are what the coefficients are of, at some points: row by row, `stride`
    // numbers apart, `points` a multiple of 8. Calls take(k, row) with each function's values.
    template <class Take>
    void combine(const double* terms, size_t stride, size_t points, Take&& take) const;

    std::vector<uint8_t> mSites;
    std::vector<glm::dvec2> mCentres;
    size_t mStride;                     // numbers a row, a multiple of four
    std::vector<double> mCoefficients;  // row by row
    std::vector<double> mEnergies;
};

// What a spline may be made of: the barycentric coordinates, and for each further site the spline with alpha
// 1 there and the alphas at the corners that the side conditions ask for. Values at `count` points:
// out[k * stride + i] for sites[k]; the first three sites are the corners.
void evaluateSiteFunctions(std::span<const uint8_t> sites, const float* x, const float* y, size_t count,
                           double* out, size_t stride);

}  // namespace tessera
