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
constexpr double kAtCorner = .54, kOnBorder = .77, kInside = .91;

std::vector<uint8_t> allPlaces(const SiteLattice& lattice) {
    std::vector<uint8_t> places(lattice.size());
    std::iota(places.begin(), places.end(), uint8_t{0});
    return places;
}

using Places = std::array<int, kCentreSites>;

TESSERA_VECTOR_CLONES
void takeNearer(const int* distances, size_t count, int* __restrict nearest) {
    for (size_t s = 0; s < count; ++s) nearest[s] = std::min(nearest[s], distances[s]);
}

TESSERA_VECTOR_CLONES
void countEqual(const int* distances, const int* nearest, size_t count, int* __restrict equals) {
    for (size_t s = 0; s < count; ++s) equals[s] += distances[s] == nearest[s] ? 1 : 0;
}

TESSERA_VECTOR_CLONES
int sumWhereEqual(const int* distances, const int* nearest, const int* shares, size_t count) {
    int sum = 0;
    for (size_t s = 0; s < count; ++s) sum += distances[s] == nearest[s] ? shares[s] : 0;
    return sum;
}

// The share of the domain that is nearest to each of the sites. Those that are equally near to a place share
// it, in whole parts so that the order of sums does not matter.
std::vector<double> cells(const SiteLattice& lattice, std::span<const uint8_t> sites) {
    constexpr int kFine = 60;
    const size_t places = lattice.size();
    Places nearest, owners{}, shares;
    nearest.fill(std::numeric_limits<int>::max());
    for (const uint8_t site : sites)
        takeNearer(lattice.squaredDistances(site).data(), places, nearest.data());
    for (const uint8_t site : sites)
        countEqual(lattice.squaredDistances(site).data(), nearest.data(), places, owners.data());
    int whole = 0;
    for (size_t s = 0; s < places; ++s) {
        shares[s] = kFine * lattice.parts(s) / owners[s];
        whole += kFine * lattice.parts(s);
    }
    std::vector<double> areas;
    areas.reserve(sites.size());
    for (const uint8_t site : sites)
        areas.push_back(double(sumWhereEqual(lattice.squaredDistances(site).data(), nearest.data(),
                                             shares.data(), places)) /
                        whole);
    return areas;
}

}  // namespace

std::vector<double> SiteNorms::diagonal() const {
    std::vector<double> all;
    for (size_t k = 0; k < n; ++k) all.push_back(at(k, k));
    return all;
}

SiteProducts::SiteProducts(const SiteBasis& basis, size_t count) : mSize(count) {
    const SiteLattice& lattice = basis.lattice();
    const std::vector<double> functions = basis.functionsAt(allPlaces(lattice), count);
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
