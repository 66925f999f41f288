// See site_basis.h.
#include "core/document/site_basis.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"

namespace tessera {

namespace {

constexpr int kCorners = 3;
using Row = std::array<double, kCentreSites>;

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
double latticeKernel(SitePlace p, SitePlace q) {
    const int b = p.b - q.b, c = p.c - q.c, squared = b * b + b * c + c * c;
    constexpr int kUnit = kSiteSubdivisions * kSiteSubdivisions;
    if (squared == 0) return 0;
    return double(squared) / kUnit * (portableLog(squared) - portableLog(kUnit)) / 2;
}

double share(size_t site, int corner) {
    const SitePlace p = sitePlaces()[site];
    const int steps = corner == 0 ? kSiteSubdivisions - p.b - p.c : corner == 1 ? p.b : p.c;
    return double(steps) / kSiteSubdivisions;
}

struct Tables {
    std::array<Row, kCentreSites> phi{};
    std::array<Row, kCentreSites>
        kernel{};  // phi less what planes and the corners tell: positive semidefinite
    std::array<std::array<double, kCorners>, kCentreSites> cornerKernel{};  // phi less its part at corners
    Row weight{};  // of a site in means over the domain: the trapezoidal rule
};

const Tables& tables() {
    static const Tables kTables = [] {
        Tables t;
        const auto& places = sitePlaces();
        for (size_t i = 0; i < kCentreSites; ++i) {
            for (size_t j = 0; j < kCentreSites; ++j) {
                double sum = latticeKernel(places[i], places[j]);
                for (int q = 0; q < kCorners; ++q) {
                    sum -= share(i, q) * latticeKernel(places[size_t(q)], places[j]);
                    sum -= share(j, q) * latticeKernel(places[i], places[size_t(q)]);
                    for (int r = 0; r < kCorners; ++r)
                        sum +=
                            share(i, q) * share(j, r) * latticeKernel(places[size_t(q)], places[size_t(r)]);
                }
                t.phi[i][j] = latticeKernel(places[i], places[j]);
                t.kernel[i][j] = i < kCorners || j < kCorners ? 0 : sum;
            }
            for (size_t q = 0; q < kCorners; ++q) {
                t.cornerKernel[i][q] = latticeKernel(places[q], places[i]);
                for (int r = 0; r < kCorners; ++r)
                    t.cornerKernel[i][q] -= share(i, r) * latticeKernel(places[q], places[size_t(r)]);
            }
            const SitePlace p = places[i];
            const int sides = (p.b == 0) + (p.c == 0) + (p.b + p.c == kSiteSubdivisions);
            t.weight[i] = (sides == 0   ? 1
                           : sides == 1 ? .5
                                        : 1.0 / 6) *
                          2 / (kSiteSubdivisions * kSiteSubdivisions);
        }
        return t;
    }();
    return kTables;
}

}  // namespace

const std::array<SitePlace, kCentreSites>& sitePlaces() {
    static const auto kPlaces = [] {
        std::array<SitePlace, kCentreSites> places;
        for (size_t s = 0; s < kCentreSites; ++s) {
            const Barycentric b = barycentricOf(centreSites()[s]);
            places[s] = {int(std::lround(b.y * kSiteSubdivisions)),
                         int(std::lround(b.z * kSiteSubdivisions))};
        }
        return places;
    }();
    return kPlaces;
}

const std::array<uint8_t, kBorderSites>& borderSites() {
    static const auto kSites = [] {
        std::array<uint8_t, kBorderSites> sites{};
        for (size_t s = 0; s < kCentreSites; ++s) {
            const SitePlace p = sitePlaces()[s];
            constexpr int n = kSiteSubdivisions;
            if (p.c == 0 && p.b < n)
                sites[size_t(p.b)] = uint8_t(s);
            else if (p.b + p.c == n && p.c < n)
                sites[size_t(n + p.c)] = uint8_t(s);
            else if (p.b == 0)
                sites[size_t(3 * n - p.c)] = uint8_t(s);
        }
        return sites;
    }();
    return kSites;
}

SiteBasis::SiteBasis(std::span<const uint8_t> sites, std::span<const uint8_t> counts)
    : mSites(sites.begin(), sites.end()), mFunctions(sites.size() * kCentreSites, 0), mSpreads(sites.size()) {
    TESSERA_CHECK(size() >= kCorners && mSites[0] == 0 && mSites[1] == 1 && mSites[2] == 2);
    for (size_t k = 0; k < kCorners; ++k)
        for (size_t s = 0; s < kCentreSites; ++s) mFunctions[k * kCentreSites + s] = share(s, int(k));
    std::array<bool, kCentreSites + 1> ends{};
    for (const uint8_t count : counts) ends[count] = true;
    ends[mSites.size()] = true;

    Row power{};  // what the functions so far leave of the kernel's diagonal
    for (size_t s = kCorners; s < kCentreSites; ++s) power[s] = tables().kernel[s][s];
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
        Row row = tables().kernel[site];
        for (size_t j = kCorners; j < k; ++j) {
            const double* f = &mFunctions[j * kCentreSites];
            const double factor = f[site] * mSpreads[j];
            for (size_t s = 0; s < kCentreSites; ++s) row[s] -= factor * f[s];
        }
        double* out = &mFunctions[k * kCentreSites];
        for (size_t s = 0; s < kCentreSites; ++s) {
            out[s] = row[s] / left;
            power[s] -= out[s] * row[s];
        }
        mSpreads[k] = left;
    }
    for (double& s : mSpreads) s = std::sqrt(s);

    // Site by site, so that the inner loop is over independent sums.
    const size_t n = mSites.size();
    mProducts.resize(n * n);
    std::vector<double> atSite(n);
    for (size_t s = 0; s < kCentreSites; ++s) {
        for (size_t k = 0; k < n; ++k) atSite[k] = mFunctions[k * kCentreSites + s];
        for (size_t i = 0; i < n; ++i) {
            const double weighted = tables().weight[s] * atSite[i];
            double* row = &mProducts[i * n];
            for (size_t j = 0; j <= i; ++j) row[j] += weighted * atSite[j];
        }
    }
}

SiteBasis::Norms SiteBasis::norms(int n) const {
    const auto count = size_t(n);
    Norms norms{n, std::vector<double>(count * count, 0)};
    double* t = norms.triangle.data();
    // Cholesky from the last function back; row k is orthogonal to the functions after k.
    for (size_t k = count; k-- > 0;) {
        double* row = t + k * count;
        for (size_t j = 0; j <= k; ++j) row[j] = mProducts[k * mSites.size() + j];
        for (size_t later = k + 1; later < count; ++later) {
            const double* above = t + later * count;
            const double factor = above[k];
            for (size_t j = 0; j <= k; ++j) row[j] -= factor * above[j];
        }
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
        const glm::dvec2 at = centreSites()[site];
        double sum = double(k[0]) + double(k[1]) * at.x + double(k[2]) * at.y;
        for (size_t j = 0; j < spline.terms[size_t(c)]; ++j)
            sum += double(k[3 + j]) * tables().phi[spline.sites[j]][site];
        values.push_back(sum);
    }
    return values;
}

std::vector<double> SiteBasis::factors(std::span<const double> values) const {
    std::vector<double> factors(values.begin(), values.end());
    for (size_t k = 0; k < factors.size(); ++k)
        for (size_t i = k + 1; i < factors.size(); ++i)
            factors[i] -= factors[k] * mFunctions[k * kCentreSites + mSites[i]];
    return factors;
}

PatchSpline SiteBasis::spline(std::span<const std::vector<double>> factors) const {
    PatchSpline spline;
    size_t most = 0;
    for (size_t c = 0; c < factors.size(); ++c) {
        std::vector<double> left = factors[c];
        const size_t n = left.size(), terms = n > kCorners ? n : 0;
        std::vector<double> alphas(terms, 0);
        // Function k is 1 / spread^2 times the kernel about its site and a sum of the functions before it.
        for (size_t k = n; k-- > kCorners;) {
            const size_t site = mSites[k];
            const double alpha = left[k] / (mSpreads[k] * mSpreads[k]);
            for (size_t j = kCorners; j < k; ++j)
                left[j] -= alpha * mSpreads[j] * mSpreads[j] * mFunctions[j * kCentreSites + site];
            // The kernel is phi less what makes it 0 at the corners.
            alphas[k] = alpha;
            for (size_t q = 0; q < kCorners; ++q) {
                alphas[q] -= alpha * share(site, int(q));
                left[q] -= alpha * tables().cornerKernel[site][q];
            }
        }
        for (const double b :
             {left[0], left[1] - left[0], (left[2] - .5 * (left[0] + left[1])) / kDomainHeight})
            spline.coefficients.push_back(float(b));
        for (const double alpha : alphas) spline.coefficients.push_back(float(alpha));
        spline.terms[c] = uint8_t(terms);
        most = std::max(most, terms);
    }
    spline.sites.assign(mSites.begin(), mSites.begin() + ptrdiff_t(std::max<size_t>(most, kCorners)));
    return spline;
}

}  // namespace tessera
