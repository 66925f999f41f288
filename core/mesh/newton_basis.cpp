// See newton_basis.h.
#include "core/mesh/newton_basis.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/check.h"
#include "core/base/row_products.h"

namespace tessera {

namespace {

constexpr int kPolynomials = 3;
constexpr int kCorners = 3;

// Coefficients (b0, b1, b2) of the barycentric coordinates u, v, w.
constexpr double kHalfOverHeight = .5 / kDomainHeight;
constexpr std::array<std::array<double, kPolynomials>, kCorners> kBarycentric{
    {{1, -1, -kHalfOverHeight}, {0, 1, -kHalfOverHeight}, {0, 0, 1 / kDomainHeight}}};

double kernel(glm::dvec2 a, glm::dvec2 b) {
    const glm::dvec2 d = a - b;
    return tpsKernel(d.x * d.x + d.y * d.y);
}

}  // namespace

NewtonBasis::NewtonBasis(std::span<const uint8_t> sites)
    : mSites(sites.begin(), sites.end()),
      mStride((sites.size() + 3) / 4 * 4),
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
    const int m = n - kCorners;
    const auto at = [](int i, int j) { return size_t(i) * (size_t(i) + 1) / 2 + size_t(j); };
    std::vector<double> g(at(m, 0)), inverse(g.size());
    std::vector<glm::dvec3> shares(static_cast<size_t>(m)), cornerValues(static_cast<size_t>(m));
    for (int i = 0; i < m; ++i) {
        const glm::dvec2 c = places[mSites[size_t(i + kCorners)]];
        const Barycentric l = barycentricOf(c);
        shares[size_t(i)] = l;
        for (int j = 0; j < kCorners; ++j) {
            double value = kernel(c, places[size_t(j)]);
            for (int q = 0; q < kCorners; ++q) value -= l[q] * kernel(places[size_t(q)], places[size_t(j)]);
            cornerValues[size_t(i)][j] = value;
        }
    }
    for (int i = 0; i < m; ++i) {
        const glm::dvec2 ci = places[mSites[size_t(i + kCorners)]];
        for (int j = 0; j <= i; ++j) {
            const glm::dvec2 cj = places[mSites[size_t(j + kCorners)]];
            double sum = kernel(ci, cj);
            for (int q = 0; q < kCorners; ++q) {
                sum -= shares[size_t(i)][q] * kernel(places[size_t(q)], cj);
                sum -= shares[size_t(j)][q] * cornerValues[size_t(i)][q];
            }
            for (int k = 0; k < j; ++k) sum -= g[at(i, k)] * g[at(j, k)];
            if (i == j) {
                TESSERA_CHECK(sum > 0);  // the sites differ
                g[at(i, i)] = std::sqrt(sum);
            } else {
                g[at(i, j)] = sum / g[at(j, j)];
            }
        }
    }
    for (int k = 0; k < m; ++k)
        for (int i = 0; i <= k; ++i) {
            double sum = i == k ? 1 : 0;
            for (int j = i; j < k; ++j) sum -= g[at(k, j)] * inverse[at(j, i)];
            inverse[at(k, i)] = sum / g[at(k, k)];
        }
    for (int k = 0; k < m; ++k) mEnergies[size_t(k + kCorners)] = 1 / (g[at(k, k)] * g[at(k, k)]);
    for (int k = 0; k < m; ++k)
        for (int i = 0; i <= k; ++i) {
            const double factor = inverse[at(k, i)] / g[at(k, k)];
            const int column = k + kCorners;
            coefficient(kPolynomials + kCorners + i, column) += factor;
            for (int j = 0; j < kCorners; ++j) {
                coefficient(kPolynomials + j, column) -= factor * shares[size_t(i)][j];
                for (int row = 0; row < kPolynomials; ++row)
                    coefficient(row, column) -=
                        factor * cornerValues[size_t(i)][j] * kBarycentric[size_t(j)][size_t(row)];
            }
        }
}

void NewtonBasis::evaluate(const float* x, const float* y, size_t count, float* out, size_t stride) const {
    TESSERA_CHECK(count <= stride);
    constexpr size_t kBlock = 64, kTile = 8;  // points whose kernels the nearest cache holds; at once
    constexpr size_t kFunctions = 4;          // at once
    const size_t n = mSites.size();
    // What the coefficients are of: 1, x, y, and the kernels about the centres.
    std::vector<double> terms((kPolynomials + n) * kBlock, 0);
    std::array<double, kFunctions * kBlock> values{};
    for (size_t first = 0; first < count; first += kBlock) {
        const size_t points = std::min(kBlock, count - first);
        for (size_t i = 0; i < points; ++i) {
            terms[i] = 1;
            terms[kBlock + i] = double(x[first + i]);
            terms[2 * kBlock + i] = double(y[first + i]);
        }
        evaluateKernels(mCentres, x + first, y + first, points, &terms[kPolynomials * kBlock], kBlock);
        // A function has no coefficients at later centres, the first ones none but the polynomial's.
        for (size_t k = 0; k < n; k += kFunctions) {
            multiplyFour({&mCoefficients[k], mStride, 1}, terms.data(), kBlock,
                         kPolynomials + std::min(k + kFunctions, n), values.data(), kBlock,
                         (points + kTile - 1) / kTile * kTile);
            for (size_t f = k; f < std::min(k + kFunctions, n); ++f)
                for (size_t i = 0; i < points; ++i)
                    out[f * stride + first + i] = float(values[(f - k) * kBlock + i]);
        }
    }
}

void NewtonBasis::evaluateWithDerivatives(glm::dvec2 at, double* values, double* alongX,
                                          double* alongY) const {
    const size_t n = mSites.size();
    constexpr size_t kMost = kCentreSites + kPolynomials;
    std::array<double, kMost> f{1, at.x, at.y}, fx{0, 1, 0}, fy{0, 0, 1};
    for (size_t i = 0; i < n; ++i) {
        const glm::dvec2 d = at - mCentres[i];
        const double q = d.x * d.x + d.y * d.y;
        // phi = q log(q) / 2, so grad phi = (log q + 1) d; 0 at the centre.
        const double slope = q > 0 ? std::log(q) + 1 : 0;
        f[kPolynomials + i] = tpsKernel(q);
        fx[kPolynomials + i] = slope * d.x;
        fy[kPolynomials + i] = slope * d.y;
    }
    const auto combine = [&](const std::array<double, kMost>& terms, double* sums) {
        std::fill_n(sums, n, 0);
        addRows({terms.data(), kPolynomials + kCorners}, mCoefficients.data(), mStride, {sums, n});
        // From here on a row has coefficients of its own function and the later ones alone.
        constexpr size_t kRows = 4;
        for (size_t i = kCorners; i < n; i += kRows)
            addRows({&terms[kPolynomials + i], std::min(kRows, n - i)},
                    &mCoefficients[(kPolynomials + i) * mStride + i], mStride, {sums + i, n - i});
    };
    combine(f, values);
    combine(fx, alongX);
    combine(fy, alongY);
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
