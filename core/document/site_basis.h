// The Newton basis (core/mesh/newton_basis.h) of a patch's sites as the codec needs it: in an order that
// follows from the set of sites alone, known at the points of the sites' lattice, with what rounding a factor
// costs.
//
// What a decoder foresees depends on these numbers, so they must be the same on every machine: they come from
// additions, products, quotients and square roots alone, the logarithm included. The order is the P-greedy
// one of De Marchi, Schaback and Wendland, Near-optimal data-independent point locations, 2005: next comes
// the site of which the others tell least.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/tps.h"

namespace tessera {

// A site's place on the lattice: steps from corner a towards b and towards c.
struct SitePlace {
    int b = 0, c = 0;
};
const std::array<SitePlace, kCentreSites>& sitePlaces();

// The sites around the domain's border, from corner a through b and c; side s has those from s *
// kSiteSubdivisions on.
constexpr int kBorderSites = 3 * kSiteSubdivisions;
const std::array<uint8_t, kBorderSites>& borderSites();

class SiteBasis {
  public:
    // `sites` begin with the corners 0, 1, 2 and are all different. The first counts[c] of them are those of
    // channel c; sites that belong to the same channels may come in any order.
    SiteBasis(std::span<const uint8_t> sites, std::span<const uint8_t> counts);

    int size() const { return int(mSites.size()); }
    std::span<const uint8_t> sites() const { return mSites; }
    // Function k at all of the sites of the lattice.
    std::span<const double> function(int k) const {
        return {mFunctions.data() + size_t(k) * kCentreSites, kCentreSites};
    }
    // How much function k's factor varies where colours vary as the kernel has it; 0 at the corners.
    double spread(int k) const { return mSpreads[size_t(k)]; }

    // For a channel of n factors: row by row the triangle T of T' T = the functions' mean products over the
    // domain, k = n - 1 first. With d the errors of the factors, the mean squared error of the spline is the
    // sum over k of (sum over j <= k of T(k, j) d_j)^2, and T(k, k) is the norm of function k less its best
    // approximation by the ones after it.
    struct Norms {
        int n = 0;
        std::vector<double> triangle;

        double at(int k, int j) const { return triangle[size_t(k) * size_t(n) + size_t(j)]; }
    };
    Norms norms(int n) const;

    // Channel c of a spline over the same sites, in whatever order, at the first `count` sites.
    std::vector<double> values(const PatchSpline& spline, int c, int count) const;
    // The factors of the spline that has `values` at the first sites, in their order.
    std::vector<double> factors(std::span<const double> values) const;
    // The way back, with the channels' `factors`.
    PatchSpline spline(std::span<const std::vector<double>> factors) const;

  private:
    std::vector<uint8_t> mSites;
    std::vector<double> mFunctions;
    std::vector<double> mSpreads;
    std::vector<double> mProducts;  // of functions, size() rows
};

}  // namespace tessera
