// See site_norms.h.
#include "core/document/site_norms.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/base/row_products.h"
#include "core/base/vector_clones.h"

namespace tessera {

namespace {

constexpr size_t kCorners = 3;
// Of norms to what cells foretell: at the corners, at other sites of the border, and inside. Measured over
// the patches of photographs.
constexpr double kAtCorner = .53, kOnBorder = .79, kInside = .95;

std::vector<uint8_t> allPlaces(const SiteLattice& lattice) {
    std::vector<uint8_t> places(lattice.size());
    std::iota(places.begin(), places.end(), uint8_t{0});
    return places;
}

// Which of the sites is nearest to each place, the first among equals: in the low byte of what is the least
// so far.
TESSERA_VECTOR_CLONES
void takeNearer(const int* squaredDistances, int k, int* __restrict nearest, size_t count) {
    for (size_t s = 0; s < count; ++s) nearest[s] = std::min(nearest[s], squaredDistances[s] * 256 + k);
}

// The share of the domain that is nearest to each of the sites.
std::vector<double> cells(const SiteLattice& lattice, std::span<const uint8_t> sites) {
    std::array<int, kCentreSites> nearest;
    nearest.fill(std::numeric_limits<int>::max());
    for (size_t k = 0; k < sites.size(); ++k)
        takeNearer(lattice.squaredDistances(sites[k]).data(), int(k), nearest.data(), lattice.size());
    std::vector<double> areas(sites.size(), 0);
    for (size_t s = 0; s < lattice.size(); ++s) areas[size_t(nearest[s] & 255)] += lattice.weight(s);
    return areas;
}

}  // namespace

std::vector<double> SiteNorms::diagonal() const {
    std::vector<double> all;
    for (size_t k = 0; k < n; ++k) all.push_back(at(k, k));
    return all;
}

SiteProducts::SiteProducts(const SiteBasis& basis) : mSize(size_t(basis.size())) {
    const SiteLattice& lattice = basis.lattice();
    const std::vector<double> functions = basis.functionsAt(allPlaces(lattice));
    std::vector<double> weighted(functions);
    for (size_t i = 0; i < weighted.size(); ++i) weighted[i] *= lattice.weight(i % lattice.size());
    mProducts = lowerProducts(weighted, functions, mSize, lattice.size());
}

SiteNorms SiteProducts::norms(size_t n) const {
    SiteNorms norms{n, std::vector<double>(n * n, 0)};
    std::vector<double> known(n + 1);
    double* t = norms.triangle.data();
    // Cholesky from the last function back; row k is orthogonal to the functions after k.
    for (size_t k = n; k-- > 0;) {
        double* row = t + k * n;
        std::copy_n(&mProducts[k * mSize], k + 1, row);
        for (size_t later = k + 1; later < n; ++later) known[later] = -t[later * n + k];
        addRows({&known[k + 1], n - k - 1}, row + n, n, {row, k + 1});
        const double root = std::sqrt(row[k]);
        for (size_t j = 0; j <= k; ++j) row[j] /= root;
    }
    return norms;
}

std::vector<double> foretoldNorms(const SiteBasis& basis, size_t n) {
    const SiteLattice& lattice = basis.lattice();
    const auto sites = basis.sites().first(n);
    std::vector<double> norms = cells(lattice, sites);
    for (size_t k = 0; k < n; ++k) {
        const double share = k < kCorners ? kAtCorner : lattice.ring(sites[k]) == 0 ? kOnBorder : kInside;
        // Functions take in what is around their cells too, so that norms are nearer to each other than
        // the cells' are: the mean of a cell and the mean cell.
        norms[k] = share * std::sqrt(std::sqrt(norms[k] / double(n)));
    }
    return norms;
}

}  // namespace tessera
