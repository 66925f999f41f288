// What the rounding of factors costs (core/document/site_basis.h), and what a reader takes it to be.
#pragma once

#include <cstddef>
#include <vector>

#include "core/document/site_basis.h"

namespace tessera {

// For a channel of n factors: row by row the triangle T of T' T = the functions' mean products over the
// domain, k = n - 1 first. With d the errors of the factors, the mean squared error of the spline is the sum
// over k of (sum over j <= k of T(k, j) d_j)^2, and T(k, k) is the norm of function k less its best
// approximation by the ones after it.
struct SiteNorms {
    size_t n = 0;
    std::vector<double> triangle;

    double at(size_t k, size_t j) const { return triangle[k * n + j]; }
    std::vector<double> diagonal() const;
};

// The mean products of the first `count` functions, by the trapezoidal rule on the lattice: what norms come
// from.
class SiteProducts {
  public:
    SiteProducts(const SiteBasis& basis, size_t count);
    SiteNorms norms(size_t n) const;  // of the first n <= count functions

  private:
    size_t mSize;
    std::vector<double> mProducts;  // row by row
};

// What T(k, k) is about, from where the first n sites lie alone.
std::vector<double> foretoldNorms(const SiteBasis& basis, size_t n);

}  // namespace tessera
