// See site_basis.h.
#include "core/document/site_basis.h"

#include <algorithm>
#include <array>
#include <cmath>

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

// phi of the distance between two places.
double latticeKernel(SitePlace p, SitePlace q, int subdivisions) {
    const int b = p.b - q.b, c = p.c - q.c, squared = b * b + b * c + c * c;
    const int unit = subdivisions * subdivisions;
    if (squared == 0) return 0;
    return double(squared) / unit * (portableLog(squared) - portableLog(unit)) / 2;
}

// The function whose multiple by `left` is `row`, and what it leaves of the kernel's diagonal.
TESSERA_VECTOR_CLONES
void finishFunction(const double* row, size_t count, double left, double* __restrict function,
                    double* __restrict power) {
    for (size_t s = 0; s < count; ++s) {
        function[s] = row[s] / left;
        power[s] -= function[s] * row[s];
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
            mPhi.push_back(phiOf(i, j));
            mKernel.push_back(i < kCorners || j < kCorners ? 0 : sum);
        }
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
      mFunctions(sites.size() * lattice.size(), 0),
      mAtSites(sites.size() * sites.size(), 0),
      mSpreads(sites.size()) {
    const size_t places = lattice.size();
    TESSERA_CHECK(size() >= kCorners && mSites[0] == 0 && mSites[1] == 1 && mSites[2] == 2);
    for (size_t k = 0; k < kCorners; ++k)
        for (size_t s = 0; s < places; ++s) mFunctions[k * places + s] = lattice.share(s, int(k));
    std::array<bool, kCentreSites + 1> ends{};
    for (const uint8_t count : counts) ends[count] = true;
    ends[mSites.size()] = true;

    // What the functions so far leave of the kernel's diagonal.
    std::vector<double> power(places, 0), row(places), known(mSites.size());
    for (size_t s = kCorners; s < places; ++s) power[s] = lattice.kernel(s)[s];
    size_t end = kCorners;
    for (size_t k = kCorners; k < mSites.size(); ++k) {
        if (k == end) {
            do ++end;
            while (!ends[end]);
            std::sort(mSites.begin() + ptrdiff_t(k), mSites.begin() + ptrdiff_t(end));
        }
        size_t best = k;
        for (size_t i = k + 1; i < end; ++i)
            if (power[mSites[i]] > power[mSites[best]]) best = i;
        std::rotate(mSites.begin() + ptrdiff_t(k), mSites.begin() + ptrdiff_t(best),
                    mSites.begin() + ptrdiff_t(best) + 1);
        const size_t site = mSites[k];
        const double left = power[site];
        TESSERA_CHECK(left > 0);  // the sites differ
        std::ranges::copy(lattice.kernel(site), row.begin());
        double* atSite = &mAtSites[k * mSites.size()];
        for (size_t j = 0; j < k; ++j) {
            atSite[j] = mFunctions[j * places + site];
            known[j] = -(atSite[j] * mSpreads[j]);
        }
        addRows({&known[kCorners], k - kCorners}, &mFunctions[kCorners * places], places, row);
        finishFunction(row.data(), places, left, &mFunctions[k * places], power.data());
        mSpreads[k] = left;
    }
    for (double& s : mSpreads) s = std::sqrt(s);

    const size_t n = mSites.size();
    std::vector<double> weighted(mFunctions.size());
    for (size_t k = 0; k < n; ++k)
        for (size_t s = 0; s < places; ++s)
            weighted[k * places + s] = lattice.weight(s) * mFunctions[k * places + s];
    mProducts = lowerProducts(weighted, mFunctions, n, places);
}

SiteBasis::Norms SiteBasis::norms(int n) const {
    const auto count = size_t(n);
    Norms norms{n, std::vector<double>(count * count, 0)};
    std::vector<double> known(count + 1);
    double* t = norms.triangle.data();
    // Cholesky from the last function back; row k is orthogonal to the functions after k.
    for (size_t k = count; k-- > 0;) {
        double* row = t + k * count;
        std::copy_n(&mProducts[k * mSites.size()], k + 1, row);
        for (size_t later = k + 1; later < count; ++later) known[later] = -t[later * count + k];
        addRows({&known[k + 1], count - k - 1}, row + count, count, {row, k + 1});
        const double root = std::sqrt(row[k]);
        for (size_t j = 0; j <= k; ++j) row[j] /= root;
    }
    return norms;
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
        for (size_t k = 0; k < i; ++k) factors[i] -= factors[k] * mAtSites[i * mSites.size() + k];
    return factors;
}

PatchSpline SiteBasis::spline(std::span<const std::vector<double>> factors) const {
    PatchSpline spline;
    size_t most = 0;
    for (size_t c = 0; c < factors.size(); ++c)
        spline.terms[c] = uint8_t(factors[c].size() > kCorners ? factors[c].size() : 0);
    spline.coefficients.reserve(spline.offset(int(factors.size())));
    for (size_t c = 0; c < factors.size(); ++c) {
        std::vector<double> left = factors[c];
        const size_t n = left.size(), terms = spline.terms[c];
        std::vector<double> alphas(terms, 0);
        // Function k is 1 / spread^2 times the kernel about its site and a sum of the functions before it.
        for (size_t k = n; k-- > kCorners;) {
            const size_t site = mSites[k];
            const double alpha = left[k] / (mSpreads[k] * mSpreads[k]);
            const double* atSite = &mAtSites[k * mSites.size()];
            for (size_t j = kCorners; j < k; ++j) left[j] -= alpha * mSpreads[j] * mSpreads[j] * atSite[j];
            // The kernel is phi less what makes it 0 at the corners.
            alphas[k] = alpha;
            for (size_t q = 0; q < kCorners; ++q) {
                alphas[q] -= alpha * mLattice->share(site, int(q));
                left[q] -= alpha * mLattice->cornerKernel(site, q);
            }
        }
        for (const double b :
             {left[0], left[1] - left[0], (left[2] - .5 * (left[0] + left[1])) / kDomainHeight})
            spline.coefficients.push_back(float(b));
        for (const double alpha : alphas) spline.coefficients.push_back(float(alpha));
        most = std::max(most, terms);
    }
    spline.sites = std::span(mSites).first(std::max<size_t>(most, kCorners));
    return spline;
}

}  // namespace tessera
