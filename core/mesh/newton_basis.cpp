// See newton_basis.h.
#include "core/mesh/newton_basis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/base/check.h"
#include "core/base/round_up.h"
#include "core/base/row_products.h"

namespace tessera {

namespace {

constexpr int kPolynomials = 3;
constexpr int kCorners = 3;

// Coefficients (b0, b1, b2) of the barycentric coordinates u, v, w.
constexpr double kHalfOverHeight = .5 / kDomainHeight;
constexpr std::array<std::array<double, kPolynomials>, kCorners> kBarycentric{
    {{1, -1, -kHalfOverHeight}, {0, 1, -kHalfOverHeight}, {0, 0, 1 / kDomainHeight}}};

// Of products: points whose terms the nearest cache holds, and a tile.
constexpr size_t kBlock = 64, kPointsAtOnce = 8, kFunctionsAtOnce = 4;

// phi of the distance between two sites.
double siteKernel(uint8_t a, uint8_t b) {
    static const std::vector<double> kKernels = [] {
        std::vector<double> all;
        for (const glm::dvec2 p : centreSites())
            for (const glm::dvec2 q : centreSites()) {
                const glm::dvec2 d = p - q;
                all.push_back(tpsKernel(d.x * d.x + d.y * d.y));
            }
        return all;
    }();
    return kKernels[size_t(a) * kCentreSites + b];
}

}  // namespace

NewtonBasis::NewtonBasis(std::span<const uint8_t> sites)
    : mSites(sites.begin(), sites.end()),
      mStride(roundUp(sites.size(), kFunctionsAtOnce)),
      mCoefficients((sites.size() + kPolynomials) * mStride, 0),
      mEnergies(sites.size(), 0) {
    const int n = size();
    TESSERA_CHECK(n >= kCorners && mSites[0] == 0 && mSites[1] == 1 && mSites[2] == 2);
    const auto& places = centreSites();
    for (const uint8_t s : mSites) mCentres.push_back(places[s]);
    for (int k = 0; k < kCorners; ++k)
        for (int row = 0; row < kPolynomials; ++row)
            coefficient(row, k) = kBarycentric[size_t(k)][size_t(row)];

    // Function i >= 3 before orthogonalization: alpha 1 at centre i, -L_j(c_i) at corner j (L the barycentric
    // coordinates), less its interpolant at the corners. Its values at the centres are a positive definite
    // matrix K = G G^T, and the Newton functions are the rows of G^-1, scaled.
    const size_t m = size_t(n) - kCorners;
    std::vector<glm::dvec3> shares(m), cornerValues(m);
    for (size_t i = 0; i < m; ++i) {
        const uint8_t site = mSites[i + kCorners];
        const Barycentric l = barycentricOf(places[site]);
        shares[i] = l;
        for (uint8_t j = 0; j < kCorners; ++j) {
            double value = siteKernel(site, j);
            for (uint8_t q = 0; q < kCorners; ++q) value -= l[q] * siteKernel(q, j);
            cornerValues[i][j] = value;
        }
    }
    std::vector<double> columns(m * m, 0), inverse(m * m, 0), diagonal(m), row(m), known(m);  // columns of G
    for (size_t i = 0; i < m; ++i) {
        const uint8_t site = mSites[i + kCorners];
        for (size_t j = 0; j <= i; ++j) {
            const uint8_t other = mSites[j + kCorners];
            double sum = siteKernel(site, other);
            for (uint8_t q = 0; q < kCorners; ++q) {
                sum -= shares[i][q] * siteKernel(q, other);
                sum -= shares[j][q] * cornerValues[i][q];
            }
            row[j] = sum;
        }
        for (size_t k = 0; k < i; ++k) {
            double* column = &columns[k * m];
            column[i] = row[k] / diagonal[k];
            for (size_t j = k + 1; j <= i; ++j) row[j] -= column[i] * column[j];
            known[k] = -column[i];
        }
        TESSERA_CHECK(row[i] > 0);  // the sites differ
        diagonal[i] = std::sqrt(row[i]);
        double* inverted = &inverse[i * m];
        inverted[i] = 1;
        addRows({known.data(), i}, inverse.data(), m, {inverted, i});
        for (size_t j = 0; j <= i; ++j) inverted[j] /= diagonal[i];
    }
    for (size_t k = 0; k < m; ++k) {
        mEnergies[k + kCorners] = 1 / (diagonal[k] * diagonal[k]);
        const int column = int(k) + kCorners;
        for (size_t i = 0; i <= k; ++i) {
            const double factor = inverse[k * m + i] / diagonal[k];
            coefficient(kPolynomials + kCorners + int(i), column) += factor;
            for (int j = 0; j < kCorners; ++j) {
                coefficient(kPolynomials + j, column) -= factor * shares[i][j];
                for (int r = 0; r < kPolynomials; ++r)
                    coefficient(r, column) -=
                        factor * cornerValues[i][j] * kBarycentric[size_t(j)][size_t(r)];
            }
        }
    }
}

template <class Take>
void NewtonBasis::combine(const double* terms, size_t stride, size_t points, Take&& take) const {
    const size_t n = mSites.size();
    std::array<double, kFunctionsAtOnce * kBlock> values{};
    for (size_t k = 0; k < n; k += kFunctionsAtOnce) {
        const size_t end = std::min(k + kFunctionsAtOnce, n);
        // A function has no coefficients at later centres.
        multiplyFour({&mCoefficients[k], mStride, 1}, terms, stride, kPolynomials + end, values.data(),
                     kBlock, points);
        for (size_t f = k; f < end; ++f) take(f, &values[(f - k) * kBlock]);
    }
}

void NewtonBasis::evaluate(const float* x, const float* y, size_t count, float* out, size_t stride) const {
    std::vector<uint32_t> each(count + 1);
    std::iota(each.begin(), each.end(), 0U);
    evaluateSums(x, y, each, out, stride);
}

void NewtonBasis::evaluateSums(const float* x, const float* y, std::span<const uint32_t> firstPoint,
                               float* out, size_t stride) const {
    const size_t groups = firstPoint.size() - 1;
    TESSERA_CHECK(groups <= stride);
    // What the coefficients are of, 1, x, y and the kernels about the centres, summed before they are
    // combined: that is most of the work.
    std::vector<double> terms((kPolynomials + mSites.size()) * kBlock, 0), kernels;
    for (size_t first = 0; first < groups; first += kBlock) {
        const std::span<const uint32_t> starts =
            firstPoint.subspan(first, std::min(kBlock, groups - first) + 1);
        const size_t begin = starts.front(), points = starts.back() - begin;
        for (size_t g = 0; g + 1 < starts.size(); ++g) {
            terms[g] = double(starts[g + 1] - starts[g]);
            terms[kBlock + g] = std::accumulate(x + starts[g], x + starts[g + 1], 0.0);
            terms[2 * kBlock + g] = std::accumulate(y + starts[g], y + starts[g + 1], 0.0);
        }
        double* sums = &terms[kPolynomials * kBlock];
        if (points + 1 == starts.size()) {  // one each
            evaluateKernels(mCentres, x + begin, y + begin, points, sums, kBlock);
        } else {
            kernels.resize(mSites.size() * points);
            evaluateKernels(mCentres, x + begin, y + begin, points, kernels.data(), points);
            for (size_t j = 0; j < mSites.size(); ++j)
                for (size_t g = 0; g + 1 < starts.size(); ++g) {
                    const double* kernel = &kernels[j * points];
                    sums[j * kBlock + g] =
                        std::accumulate(kernel + (starts[g] - begin), kernel + (starts[g + 1] - begin), 0.0);
                }
        }
        combine(terms.data(), kBlock, roundUp(starts.size() - 1, kPointsAtOnce),
                [&](size_t k, const double* values) {
                    for (size_t g = 0; g + 1 < starts.size(); ++g)
                        out[k * stride + first + g] = float(values[g]);
                });
    }
}

void NewtonBasis::evaluateWithDerivatives(const float* x, const float* y, size_t count, double* values,
                                          double* alongX, double* alongY, size_t stride) const {
    TESSERA_CHECK(count <= stride && stride % kPointsAtOnce == 0);
    const size_t n = mSites.size();
    std::vector<double> f((kPolynomials + n) * stride, 0), fx(f), fy(f);
    for (size_t i = 0; i < count; ++i) {
        f[i] = fx[stride + i] = fy[2 * stride + i] = 1;
        f[stride + i] = double(x[i]);
        f[2 * stride + i] = double(y[i]);
    }
    evaluateKernels(mCentres, x, y, count, &f[kPolynomials * stride], stride);
    for (size_t j = 0; j < n; ++j) {
        const size_t row = (kPolynomials + j) * stride;
        for (size_t i = 0; i < count; ++i) {
            const double dx = double(x[i]) - mCentres[j].x, dy = double(y[i]) - mCentres[j].y;
            const double q = dx * dx + dy * dy;
            // phi = q log(q) / 2, so grad phi = (log q + 1) d; 0 at the centre.
            const double slope = q > 0 ? 2 * f[row + i] / q + 1 : 0;
            fx[row + i] = slope * dx;
            fy[row + i] = slope * dy;
        }
    }
    for (const auto& [terms, out] : {std::pair(&f, values), std::pair(&fx, alongX), std::pair(&fy, alongY)})
        for (size_t first = 0; first < count; first += kBlock) {
            const size_t points = std::min(kBlock, count - first);
            combine(terms->data() + first, stride, roundUp(points, kPointsAtOnce),
                    [&, out = out](size_t k, const double* from) {
                        std::copy_n(from, points, out + k * stride + first);
                    });
        }
}

PatchSpline NewtonBasis::spline(std::span<const std::span<const double>> factors) const {
    PatchSpline result;
    result.sites = mSites;
    for (size_t c = 0; c < factors.size(); ++c) {
        const int n = int(factors[c].size());
        TESSERA_CHECK(n >= kCorners && n <= size());
        const int terms = n > kCorners ? n : 0;
        result.terms[c] = uint8_t(terms);
        for (int row = 0; row < kPolynomials + terms; ++row) {
            double sum = 0;
            for (int k = 0; k < n; ++k) sum += coefficient(row, k) * factors[c][size_t(k)];
            result.coefficients.push_back(float(sum));
        }
    }
    return result;
}

void evaluateSiteFunctions(std::span<const uint8_t> sites, const float* x, const float* y, size_t count,
                           double* out, size_t stride) {
    TESSERA_CHECK(count <= stride && sites.size() >= kCorners);
    std::vector<glm::dvec2> places;
    for (const uint8_t s : sites) places.push_back(centreSites()[s]);
    evaluateKernels(places, x, y, count, out, stride);
    const double *a = out, *b = out + stride, *c = out + 2 * stride;
    for (size_t k = kCorners; k < sites.size(); ++k) {
        double* to = out + k * stride;
        const Barycentric l = barycentricOf(places[k]);
        for (size_t i = 0; i < count; ++i) to[i] -= l.x * a[i] + l.y * b[i] + l.z * c[i];
    }
    for (size_t j = 0; j < kCorners; ++j) {
        const auto [b0, b1, b2] = kBarycentric[j];
        double* to = out + j * stride;
        for (size_t i = 0; i < count; ++i) to[i] = b0 + b1 * double(x[i]) + b2 * double(y[i]);
    }
}

}  // namespace tessera
