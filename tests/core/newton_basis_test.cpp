// The Newton basis over sites: values at centres, prefixes, energies, derivatives, splines of factors.
#include "core/mesh/newton_basis.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

namespace tessera {
namespace {

const std::vector<uint8_t> kSites{0, 1, 2, 37, 5, 60, 18, 44, 9, 31};

std::vector<float> valuesAt(const NewtonBasis& basis, glm::dvec2 at) {
    const auto x = float(at.x), y = float(at.y);
    std::vector<float> values(size_t(basis.size()));
    basis.evaluate(&x, &y, 1, values.data(), 1);
    return values;
}

TEST(NewtonBasis, IsOneAtItsCentreAndNothingAtThoseBefore) {
    const NewtonBasis basis(kSites);
    for (size_t k = 0; k < kSites.size(); ++k) {
        const auto values = valuesAt(basis, centreSites()[kSites[k]]);
        EXPECT_NEAR(values[k], 1, 1e-4);
        for (size_t j = k + 1; j < kSites.size(); ++j) EXPECT_NEAR(values[j], 0, 1e-4) << j << " at " << k;
    }
}

TEST(NewtonBasis, APrefixOfTheSitesHasThePrefixOfTheFunctions) {
    const NewtonBasis all(kSites), some(std::span<const uint8_t>(kSites).first(6));
    const auto a = valuesAt(all, {.31, .27}), b = valuesAt(some, {.31, .27});
    ASSERT_EQ(b.size(), 6U);
    for (size_t k = 0; k < 6; ++k) EXPECT_FLOAT_EQ(a[k], b[k]);
}

TEST(NewtonBasis, SumsOverGroupsAreThoseOfTheValues) {
    const NewtonBasis basis(kSites);
    // More groups than are made at once, of 1 to 6 points.
    std::mt19937 random(11);
    std::uniform_real_distribution<float> uniform(.1F, .8F);
    std::vector<float> x, y;
    std::vector<uint32_t> firstPoint{0};
    for (size_t g = 0; g < 150; ++g) {
        for (size_t i = 0; i <= random() % 6; ++i) {
            x.push_back(uniform(random));
            y.push_back(uniform(random));
        }
        firstPoint.push_back(uint32_t(x.size()));
    }
    const size_t points = x.size(), stride = 160;
    std::vector<float> values(kSites.size() * points), sums(kSites.size() * stride);
    basis.evaluate(x.data(), y.data(), points, values.data(), points);
    basis.evaluateSums(x.data(), y.data(), firstPoint, sums.data(), stride);
    for (size_t k = 0; k < kSites.size(); ++k)
        for (size_t g = 0; g + 1 < firstPoint.size(); ++g) {
            const float* row = &values[k * points];
            const double wanted = std::accumulate(row + firstPoint[g], row + firstPoint[g + 1], 0.0);
            EXPECT_NEAR(sums[k * stride + g], wanted, 1e-5) << k << " " << g;
        }
}

TEST(NewtonBasis, DerivativesAreThoseOfTheValues) {
    const NewtonBasis basis(kSites);
    const size_t n = kSites.size();
    const glm::dvec2 at(.42, .33);
    constexpr float kStep = 1e-3F;
    constexpr size_t kPoints = 5, kStride = 8;  // the point, and a step on all four sides
    const std::array<float, kPoints> x{.42F, .42F - kStep, .42F + kStep, .42F, .42F},
        y{.33F, .33F, .33F, .33F - kStep, .33F + kStep};
    std::vector<double> value(n * kStride), dx(value), dy(value);
    basis.evaluateWithDerivatives(x.data(), y.data(), kPoints, value.data(), dx.data(), dy.data(), kStride);
    const auto single = valuesAt(basis, at);
    for (size_t k = 0; k < n; ++k) {
        const double* values = &value[k * kStride];
        const double slopeX = (values[2] - values[1]) / double(x[2] - x[1]);
        const double slopeY = (values[4] - values[3]) / double(y[4] - y[3]);
        EXPECT_NEAR(slopeX, dx[k * kStride], 1e-3 * (1 + std::abs(slopeX)));
        EXPECT_NEAR(slopeY, dy[k * kStride], 1e-3 * (1 + std::abs(slopeY)));
        EXPECT_NEAR(single[k], values[0], 1e-4);
    }
}

TEST(NewtonBasis, ASplineOfFactorsIsTheirSum) {
    const NewtonBasis basis(kSites);
    const std::vector<double> luma{.2, .5, .9, .1, -.2, .05, .3, 0, -.1, .07}, chroma{.1, .2, .3};
    const std::array<std::span<const double>, 3> factors{luma, chroma, chroma};
    const PatchSpline spline = basis.spline(factors);
    EXPECT_EQ(spline.terms, (std::array<uint8_t, kMaxChannels>{10, 0, 0, 0}));
    EXPECT_EQ(spline.sites, kSites);
    for (const glm::dvec2 at : {glm::dvec2(.5, .2), glm::dvec2(.1, .05), glm::dvec2(.55, .6)}) {
        const auto values = valuesAt(basis, at);
        double sum = 0;
        for (size_t k = 0; k < luma.size(); ++k) sum += luma[k] * double(values[k]);
        EXPECT_NEAR(evaluateSpline(spline, 0, at), sum, 2e-4);
        EXPECT_NEAR(evaluateSpline(spline, 1, at),
                    .1 * double(values[0]) + .2 * double(values[1]) + .3 * double(values[2]), 1e-5);
    }
}

// The energy of a spline is the quadratic form of its alphas in phi; planes have none.
TEST(NewtonBasis, EnergiesAddUp) {
    const NewtonBasis basis(kSites);
    std::vector<double> factors{.2, .5, .9, .1, -.2, .05, .3, .15, -.1, .07};
    const std::array<std::span<const double>, 1> channel{factors};
    const PatchSpline spline = basis.spline(channel);
    double direct = 0, sum = 0;
    for (int i = 0; i < spline.terms[0]; ++i)
        for (int j = 0; j < spline.terms[0]; ++j) {
            const glm::dvec2 d = spline.centre(i) - spline.centre(j);
            direct += double(spline.coefficients[size_t(3 + i)]) *
                      double(spline.coefficients[size_t(3 + j)]) * tpsKernel(d.x * d.x + d.y * d.y);
        }
    for (size_t k = 0; k < factors.size(); ++k) sum += basis.energy(int(k)) * factors[k] * factors[k];
    EXPECT_EQ(basis.energy(1), 0);
    EXPECT_NEAR(direct, sum, 1e-3 * sum);
}

TEST(NewtonBasisDeathTest, RefusesSitesTwice) {
    const std::vector<uint8_t> twice{0, 1, 2, 20, 20};
    EXPECT_DEATH(NewtonBasis basis{std::span<const uint8_t>(twice)}, "");
}

TEST(SiteFunctions, SpanTheNewtonFunctions) {
    // Function 3 of the basis is a multiple of the site's function less a plane: compare second differences.
    const NewtonBasis basis(kSites);
    const std::array<float, 3> x{.3F, .4F, .5F}, y{.2F, .25F, .3F};
    std::vector<double> sites(kCentreSites * 3);
    std::vector<float> newton(kSites.size() * 3);
    std::vector<uint8_t> all(kCentreSites);
    std::iota(all.begin(), all.end(), uint8_t{0});
    evaluateSiteFunctions(all, x.data(), y.data(), 3, sites.data(), 3);
    basis.evaluate(x.data(), y.data(), 3, newton.data(), 3);
    const auto bend = [](const auto* v) { return double(v[0]) - 2 * double(v[1]) + double(v[2]); };
    const double factor = bend(newton.data() + 9) / bend(sites.data() + 3 * size_t(kSites[3]));
    EXPECT_NEAR(factor, basis.energy(3), 1e-2 * factor);
    for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(sites[i] + sites[3 + i] + sites[6 + i], 1, 1e-6);
}

TEST(Kernels, AreThoseOfTheSplines) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(0, 1);
    std::vector<float> x{0, 1, .5F}, y{0, 0, float(kDomainHeight)};
    while (x.size() < 300) {
        x.push_back(unit(random));
        y.push_back(unit(random));
    }
    std::vector<double> phi(size_t(kCentreSites) * x.size());
    evaluateKernels(centreSites(), x.data(), y.data(), x.size(), phi.data(), x.size());
    for (size_t s = 0; s < size_t(kCentreSites); ++s)
        for (size_t i = 0; i < x.size(); ++i) {
            const glm::dvec2 d = glm::dvec2(double(x[i]), double(y[i])) - centreSites()[s];
            EXPECT_NEAR(phi[s * x.size() + i], tpsKernel(d.x * d.x + d.y * d.y), 1e-13);
        }
}

}  // namespace
}  // namespace tessera
