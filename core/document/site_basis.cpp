// See site_basis.h.
#include "core/document/site_basis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "core/base/check.h"
#include "core/base/row_products.h"
#include "core/base/vector_clones.h"

namespace tessera {

namespace {

constexpr int kCorners = 3;
// The natural logarithm of m >= 1: m = 2^e f with f in [1, 2), log f by the series of atanh.
double portableLog(int m) {
    constexpr double kLog2 = 0.693147180559945309417232;
    double f = m;
    int e = 0;
    for (; f >= 2; f /= 2) ++e;
    const double z = (f - 1) / (f + 1), zz = z * z;
    double sum = 0;
    for (int i = 41; i > 0; i -= 2) sum = sum * zz + 1.0 / i;
    return e * kLog2 + 2 * z * sum;
}

int squaredDistance(SitePlace p, SitePlace q) {
    const int b = p.b - q.b, c = p.c - q.c;
    return b * b + b * c + c * c;
}

// phi of the distance between two places.
double latticeKernel(SitePlace p, SitePlace q, int subdivisions) {
    const int squared = squaredDistance(p, q), unit = subdivisions * subdivisions;
    if (squared == 0) return 0;
    return double(squared) / unit * (portableLog(squared) - portableLog(unit)) / 2;
}

// Divides what is a function's multiple by `left`, and takes what it leaves of the kernel's diagonal.
TESSERA_VECTOR_CLONES
void finishFunction(double* __restrict row, size_t count, double left, double* __restrict power) {
    for (size_t i = 0; i < count; ++i) {
        const double function = row[i] / left;
        power[i] -= function * row[i];
        row[i] = function;
    }
}

}  // namespace

const SiteLattice& SiteLattice::current() {
    static const SiteLattice kLattice(kSiteSubdivisions);
    return kLattice;
}

const SiteLattice& SiteLattice::ofVersion(uint32_t version) {
    static const SiteLattice kFirst(10);
    return version < 3 ? kFirst : current();
}

SiteLattice::SiteLattice(int subdivisions) : mSubdivisions(subdivisions) {
    const int n = subdivisions;
    TESSERA_CHECK(n >= 1 && n <= kSiteSubdivisions);
    mPlaces = {{0, 0}, {n, 0}, {0, n}};
    for (int c = 0; c <= n; ++c)
        for (int b = 0; b + c <= n; ++b)
            if (b < n && c < n && b + c > 0) mPlaces.push_back({b, c});
    mBorder.resize(size_t(3 * n));
    for (size_t s = 0; s < size(); ++s) {
        const SitePlace p = mPlaces[s];
        if (p.c == 0 && p.b < n)
            mBorder[size_t(p.b)] = uint8_t(s);
        else if (p.b + p.c == n && p.c < n)
            mBorder[size_t(n + p.c)] = uint8_t(s);
        else if (p.b == 0)
            mBorder[size_t(3 * n - p.c)] = uint8_t(s);
        const int sides = (p.b == 0) + (p.c == 0) + (p.b + p.c == n);
        mParts.push_back(sides == 0 ? 6 : sides == 1 ? 3 : 1);
        mWeight.push_back((sides == 0 ? 1 : sides == 1 ? .5 : 1.0 / 6) * 2 / (n * n));
    }
    fillKernels();
}

void SiteLattice::fillKernels() {
    const auto phiOf = [&](size_t i, size_t j) {
        return latticeKernel(mPlaces[i], mPlaces[j], mSubdivisions);
    };
    for (size_t i = 0; i < size(); ++i) {
        for (size_t j = 0; j < size(); ++j) {
            double sum = phiOf(i, j);
            for (int q = 0; q < kCorners; ++q) {
                sum -= share(i, q) * phiOf(size_t(q), j);
                sum -= share(j, q) * phiOf(i, size_t(q));
                for (int r = 0; r < kCorners; ++r)
                    sum += share(i, q) * share(j, r) * phiOf(size_t(q), size_t(r));
            }
            mSquaredDistances.push_back(squaredDistance(mPlaces[i], mPlaces[j]));
            mPhi.push_back(phiOf(i, j));
            mKernel.push_back(i < kCorners || j < kCorners ? 0 : sum);
        }
        for (const uint8_t place : mBorder)
            mBorderFunctions.push_back(i < kCorners ? share(place, int(i)) : kernel(i)[place]);
        for (size_t q = 0; q < kCorners; ++q) {
            double sum = phiOf(q, i);
            for (int r = 0; r < kCorners; ++r) sum -= share(i, r) * phiOf(q, size_t(r));
            mCornerKernel.push_back(sum);
        }
    }
}

double SiteLattice::share(size_t site, int corner) const {
    const SitePlace p = mPlaces[site];
    const int steps = corner == 0 ? mSubdivisions - p.b - p.c : corner == 1 ? p.b : p.c;
    return double(steps) / mSubdivisions;
}

int SiteLattice::ring(size_t site) const {
    const SitePlace p = mPlaces[site];
    return std::min({p.b, p.c, mSubdivisions - p.b - p.c});
}

glm::dvec2 SiteLattice::point(size_t site) const {
    return domainPoint({share(site, 0), share(site, 1), share(site, 2)});
}

std::string SiteLattice::adopt(PatchSpline& spline) const {
    if (mSubdivisions == kSiteSubdivisions) return {};
    for (const uint8_t site : spline.sites) {
        if (site >= size()) return "has a list of sites that cannot be";
        spline.centres.push_back(glm::vec2(point(site)));
    }
    spline.sites = {};
    return {};
}

SiteBasis::SiteBasis(const SiteLattice& lattice, std::span<const uint8_t> sites,
                     std::span<const uint8_t> counts)
    : mLattice(&lattice),
      mSites(sites.begin(), sites.end()),
      mAtSites(sites.size() * (sites.size() - 1) / 2),
      mPowers(sites.size()) {
    const size_t n = mSites.size();
    TESSERA_CHECK(n >= kCorners && mSites[0] == 0 && mSites[1] == 1 && mSites[2] == 2);
    std::array<bool, kCentreSites + 1> ends{};  // of groups
    for (const uint8_t count : counts) ends[count] = true;
    ends[n] = true;
    chooseOrder(ends);
}

void SiteBasis::chooseOrder(std::span<const bool> ends) {
    const SiteLattice& lattice = *mLattice;
    const size_t n = mSites.size();
    // Row k has function k at the sites that come later, as they lie in mSites; power is what the functions
    // so far leave of the kernel's diagonal there.
    const auto rows = std::make_unique_for_overwrite<double[]>(n * n);
    std::vector<double> power(n), known(n);
    for (size_t i = 0; i < n; ++i) {
        for (size_t k = 0; k < kCorners; ++k) rows[k * n + i] = lattice.share(mSites[i], int(k));
        power[i] = lattice.kernel(mSites[i])[mSites[i]];
    }
    size_t end = kCorners;  // of the group
    for (size_t k = kCorners; k < n; ++k) {
        if (k == end) {
            do ++end;
            while (!ends[end]);
        }
        size_t best = k;
        for (size_t i = k + 1; i < end; ++i)
            if (power[i] > power[best] || (power[i] == power[best] && mSites[i] < mSites[best])) best = i;
        const double left = power[best];
        TESSERA_CHECK(left > 0);  // the sites differ
        // The site here goes to where the chosen one was.
        double* atSite = &mAtSites[k * (k - 1) / 2];
        for (size_t j = 0; j < k; ++j) {
            atSite[j] = std::exchange(rows[j * n + best], rows[j * n + k]);
            known[j] = -(atSite[j] * mPowers[j]);
        }
        std::swap(mSites[k], mSites[best]);
        power[best] = power[k];
        mPowers[k] = left;

        const auto kernel = lattice.kernel(mSites[k]);
        const size_t next = k + 1;
        double* row = &rows[k * n];
        for (size_t i = next; i < n; ++i) row[i] = kernel[mSites[i]];
        addRows({&known[kCorners], k - kCorners}, &rows[kCorners * n + next], n, {row + next, n - next});
        finishFunction(row + next, n - next, left, power.data() + next);
    }
}

std::vector<double> SiteBasis::functionsAt(std::span<const uint8_t> places, size_t count) const {
    const size_t length = places.size();
    std::vector<double> functions(count * length), known(count);
    for (size_t k = 0; k < count; ++k) {
        double* row = &functions[k * length];
        if (k < kCorners) {
            for (size_t i = 0; i < length; ++i) row[i] = mLattice->share(places[i], int(k));
            continue;
        }
        const auto kernel = mLattice->kernel(mSites[k]);
        for (size_t i = 0; i < length; ++i) row[i] = kernel[places[i]];
        for (size_t j = kCorners; j < k; ++j) known[j] = -(before(k)[j] * mPowers[j]);
        addRows({&known[kCorners], k - kCorners}, &functions[kCorners * length], length, {row, length});
        for (size_t i = 0; i < length; ++i) row[i] /= mPowers[k];
    }
    return functions;
}

std::vector<double> SiteBasis::values(const PatchSpline& spline, int c, int count) const {
    const float* k = &spline.coefficients[spline.offset(c)];
    std::vector<double> values;
    for (int i = 0; i < count; ++i) {
        const size_t site = mSites[size_t(i)];
        const glm::dvec2 at = mLattice->point(site);
        double sum = double(k[0]) + double(k[1]) * at.x + double(k[2]) * at.y;
        for (size_t j = 0; j < spline.terms[size_t(c)]; ++j)
            sum += double(k[3 + j]) * mLattice->phi(spline.sites[j], site);
        values.push_back(sum);
    }
    return values;
}

std::vector<double> SiteBasis::factors(std::span<const double> values) const {
    std::vector<double> factors(values.begin(), values.end());
    for (size_t i = 1; i < factors.size(); ++i)
        for (size_t k = 0; k < i; ++k) factors[i] -= factors[k] * before(i)[k];
    return factors;
}

std::vector<double> SiteBasis::kernelFactors(std::span<const double> factors) const {
    std::vector<double> all(factors.begin(), factors.end());
    // Function k times its power is the kernel about its site and a sum of the functions before it.
    for (size_t k = kCorners; k < all.size(); ++k) all[k] /= mPowers[k];
    for (size_t k = all.size(); k-- > kCorners;) {
        const double less = -all[k];
        addRows({&less, 1}, before(k).data() + kCorners, 0, {&all[kCorners], k - kCorners});
    }
    return all;
}

PatchSpline SiteBasis::spline(std::span<const std::vector<double>> kernelFactors) const {
    PatchSpline spline;
    size_t most = 0;
    for (size_t c = 0; c < kernelFactors.size(); ++c)
        spline.terms[c] = uint8_t(kernelFactors[c].size() > kCorners ? kernelFactors[c].size() : 0);
    spline.coefficients.reserve(spline.offset(int(kernelFactors.size())));
    for (size_t c = 0; c < kernelFactors.size(); ++c) {
        const std::vector<double>& alphas = kernelFactors[c];
        std::array<double, kCorners> plane{alphas[0], alphas[1], alphas[2]}, atCorners{};
        // The kernel is phi less what makes it 0 at the corners.
        for (size_t k = alphas.size(); k-- > kCorners;)
            for (size_t q = 0; q < kCorners; ++q) {
                atCorners[q] -= alphas[k] * mLattice->share(mSites[k], int(q));
                plane[q] -= alphas[k] * mLattice->cornerKernel(mSites[k], q);
            }
        for (const double b :
             {plane[0], plane[1] - plane[0], (plane[2] - .5 * (plane[0] + plane[1])) / kDomainHeight})
            spline.coefficients.push_back(float(b));
        const size_t terms = spline.terms[c];
        for (size_t k = 0; k < terms; ++k)
            spline.coefficients.push_back(float(k < kCorners ? atCorners[k] : alphas[k]));
        most = std::max(most, terms);
    }
    spline.sites = std::span(mSites).first(std::max<size_t>(most, kCorners));
    return spline;
}

}  // namespace tessera
