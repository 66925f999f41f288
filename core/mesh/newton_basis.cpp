// See newton_basis.h.
#include "core/mesh/newton_basis.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/check.h"
#include "core/base/vector_clones.h"

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

// Where functions are asked for, and where their values go.
struct PointBlock {
    const float *x, *y;
    size_t count;
    float* out;
    size_t stride;
};

// The Newton functions from the kernels, kernels[j * kernelStride + i]: their coefficients are a triangle.
TESSERA_VECTOR_CLONES
void combine(const double* coefficients, size_t functions, const double* kernels, size_t kernelStride,
             PointBlock to) {
    std::vector<double> sum(to.count);
    for (size_t k = 0; k < functions; ++k) {
        const double *b0 = coefficients + k, *b1 = b0 + functions, *b2 = b1 + functions;
        for (size_t i = 0; i < to.count; ++i) sum[i] = *b0 + *b1 * double(to.x[i]) + *b2 * double(to.y[i]);
        for (size_t j = 0; k >= kCorners && j <= k; ++j) {
            const double alpha = coefficients[(kPolynomials + j) * functions + k];
            const double* from = kernels + j * kernelStride;
            for (size_t i = 0; i < to.count; ++i) sum[i] += alpha * from[i];
        }
        for (size_t i = 0; i < to.count; ++i) to.out[k * to.stride + i] = float(sum[i]);
    }
}

}  // namespace

NewtonBasis::NewtonBasis(std::span<const uint8_t> sites)
    : mSites(sites.begin(), sites.end()),
      mCoefficients((sites.size() + kPolynomials) * sites.size(), 0),
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
    constexpr size_t kBlock = 64;  // points whose kernels the nearest cache holds
    std::vector<double> kernels(mCentres.size() * kBlock);
    for (size_t first = 0; first < count; first += kBlock) {
        const size_t points = std::min(kBlock, count - first);
        evaluateKernels(mCentres, x + first, y + first, points, kernels.data(), kBlock);
        combine(mCoefficients.data(), mSites.size(), kernels.data(), kBlock,
                {x + first, y + first, points, out + first, stride});
    }
}

void NewtonBasis::evaluateWithDerivatives(glm::dvec2 at, double* values, double* alongX,
                                          double* alongY) const {
    const int n = size();
    constexpr size_t kMost = kCentreSites + kPolynomials;
    std::array<double, kMost> f{1, at.x, at.y}, fx{0, 1, 0}, fy{0, 0, 1};
    for (int i = 0; i < n; ++i) {
        const glm::dvec2 d = at - centreSites()[mSites[size_t(i)]];
        const double q = d.x * d.x + d.y * d.y;
        // phi = q log(q) / 2, so grad phi = (log q + 1) d; 0 at the centre.
        const double slope = q > 0 ? std::log(q) + 1 : 0;
        f[size_t(kPolynomials + i)] = tpsKernel(q);
        fx[size_t(kPolynomials + i)] = slope * d.x;
        fy[size_t(kPolynomials + i)] = slope * d.y;
    }
    for (int k = 0; k < n; ++k) {
        values[k] = alongX[k] = alongY[k] = 0;
        const int rows = k < kCorners ? kPolynomials : kPolynomials + k + 1;
        for (int row = 0; row < rows; ++row) {
            const double c = coefficient(row, k);
            values[k] += c * f[size_t(row)];
            alongX[k] += c * fx[size_t(row)];
            alongY[k] += c * fy[size_t(row)];
        }
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
