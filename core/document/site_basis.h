// The Newton basis (core/mesh/newton_basis.h) of a patch's sites as the codec needs it: in an order that
// follows from the set of sites alone, and known at the points of the sites' lattice.
//
// What a decoder foresees depends on these numbers, so they must be the same on every machine: they come from
// additions, products, quotients and square roots alone, the logarithm included. The order is the P-greedy
// one of De Marchi, Schaback and Wendland, Near-optimal data-independent point locations, 2005: next comes
// the site of which the others tell least.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/mesh/tps.h"

namespace tessera {

// A site's place on a lattice: steps from corner a towards b and towards c.
struct SitePlace {
    int b = 0, c = 0;
};

// The places that a file's sites are numbered by, in the order of centreSites(): the corners first, then row
// by row.
class SiteLattice {
  public:
    // Of files of this version: centreSites() from version 3 on, before it had 10 steps a side.
    static const SiteLattice& ofVersion(uint32_t version);
    static const SiteLattice& current();

    explicit SiteLattice(int subdivisions);

    int subdivisions() const { return mSubdivisions; }
    size_t size() const { return mPlaces.size(); }  // at most kCentreSites
    SitePlace place(size_t site) const { return mPlaces[site]; }
    glm::dvec2 point(size_t site) const;
    // The sites around the domain's border, from corner a through b and c; side s has those from s *
    // subdivisions() on.
    std::span<const uint8_t> border() const { return mBorder; }
    // Steps to the nearest side.
    int ring(size_t site) const;
    // Of a site from all of them, in units of a step.
    std::span<const int> squaredDistances(size_t site) const {
        return {mSquaredDistances.data() + site * size(), size()};
    }

    // Gives a spline whose sites are of this lattice what it is in a mesh: where the lattice is an old one,
    // centres of its own. Returns what is wrong with its sites, or empty.
    std::string adopt(PatchSpline& spline) const;

    double share(size_t site, int corner) const;  // barycentric coordinate
    double phi(size_t i, size_t j) const { return mPhi[i * size() + j]; }
    // Phi less what planes and the corners tell: positive semidefinite. A row has size() numbers.
    std::span<const double> kernel(size_t i) const { return {mKernel.data() + i * size(), size()}; }
    // What SiteBasis::kernelFactors() are of, at the places of border(): a corner's share, or a site's
    // kernel.
    std::span<const double> borderFunction(size_t i) const {
        return {mBorderFunctions.data() + i * mBorder.size(), mBorder.size()};
    }
    // Phi about a corner less its part at the corners.
    double cornerKernel(size_t site, size_t corner) const { return mCornerKernel[3 * site + corner]; }
    // Of a site in means over the domain: the trapezoidal rule.
    double weight(size_t site) const { return mWeight[site]; }
    // The same in whole numbers: how many of the six triangles that may meet in a place the domain has.
    int parts(size_t site) const { return mParts[site]; }

  private:
    void fillKernels();

    int mSubdivisions;
    std::vector<SitePlace> mPlaces;
    std::vector<uint8_t> mBorder;
    std::vector<int> mParts, mSquaredDistances;
    std::vector<double> mPhi, mKernel, mBorderFunctions, mCornerKernel, mWeight;
};

class SiteBasis {
  public:
    // `sites` of the lattice, which must outlive this, begin with the corners 0, 1, 2 and are all different.
    // The first counts[c] of them are those of channel c; sites that belong to the same channels may come in
    // any order.
    SiteBasis(const SiteLattice& lattice, std::span<const uint8_t> sites, std::span<const uint8_t> counts);

    int size() const { return int(mSites.size()); }
    const SiteLattice& lattice() const { return *mLattice; }
    std::span<const uint8_t> sites() const { return mSites; }
    // The functions before k at site k; function k is 1 there.
    std::span<const double> before(size_t k) const { return {mAtSites.data() + k * (k - 1) / 2, k}; }
    // How much function k's factor varies where colours vary as the kernel has it; 0 at the corners.
    double spread(size_t k) const { return std::sqrt(mPowers[k]); }

    // The first `count` functions, row by row, at some places of the lattice.
    std::vector<double> functionsAt(std::span<const uint8_t> places, size_t count) const;

    // Channel c of a spline over the same sites, in whatever order, at the first `count` sites.
    std::vector<double> values(const PatchSpline& spline, int c, int count) const;
    // The factors of the spline that has `values` at the first sites, in their order.
    std::vector<double> factors(std::span<const double> values) const;
    // Of the spline with these `factors`: what the corners' barycentric coordinates are multiplied by, which
    // are its values there, then what the kernels about the other sites are.
    std::vector<double> kernelFactors(std::span<const double> factors) const;
    // The way back, with the channels' kernel factors.
    PatchSpline spline(std::span<const std::vector<double>> kernelFactors) const;

  private:
    // ends[i]: a group ends before the i-th site.
    void chooseOrder(std::span<const bool> ends);

    const SiteLattice* mLattice;
    std::vector<uint8_t> mSites;
    std::vector<double> mAtSites;  // before(k), one after another
    // What the functions before k leave of the kernel at site k; 0 at the corners.
    std::vector<double> mPowers;
};

}  // namespace tessera
