// The codec's basis of a patch's sites against the one that the fit uses, and against sums over the domain.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "core/document/site_basis.h"
#include "core/document/site_norms.h"
#include "core/mesh/newton_basis.h"

namespace tessera {
namespace {

std::vector<uint8_t> randomSites(size_t count, std::mt19937& random) {
    std::vector<uint8_t> sites(kCentreSites);
    std::iota(sites.begin(), sites.end(), uint8_t{0});
    std::shuffle(sites.begin() + 3, sites.end(), random);
    sites.resize(count);
    return sites;
}

const SiteLattice& kLattice = SiteLattice::current();

std::vector<uint8_t> allPlaces() {
    std::vector<uint8_t> places(kLattice.size());
    std::iota(places.begin(), places.end(), uint8_t{0});
    return places;
}

TEST(SiteLattice, IsThatOfTheCentreSites) {
    ASSERT_EQ(kLattice.size(), size_t(kCentreSites));
    for (size_t s = 0; s < kLattice.size(); ++s) {
        const glm::dvec2 d = kLattice.point(s) - centreSites()[s];
        EXPECT_LT(std::abs(d.x) + std::abs(d.y), 1e-12);
    }
    EXPECT_EQ(&SiteLattice::ofVersion(3), &kLattice);
}

TEST(SiteLattice, HadTenStepsASideBeforeVersion3) {
    const SiteLattice& old = SiteLattice::ofVersion(2);
    EXPECT_EQ(old.subdivisions(), 10);
    EXPECT_EQ(old.size(), 66u);
    PatchSpline spline;
    spline.sites = {0, 1, 2, 3, 12};
    ASSERT_EQ(old.adopt(spline), "");
    EXPECT_TRUE(spline.sites.empty());
    EXPECT_EQ(spline.centres[3], glm::vec2(domainPoint({.9, .1, 0})));
    EXPECT_EQ(spline.centres[4], glm::vec2(domainPoint({.9, 0, .1})));
    PatchSpline beyond;
    beyond.sites = {0, 1, 2, 66};
    EXPECT_NE(old.adopt(beyond), "");
    EXPECT_EQ(kLattice.adopt(beyond), "");
    EXPECT_EQ(beyond.sites.size(), 4u);
}

TEST(SiteLattice, HasABorderThatRunsOnceAroundTheDomain) {
    for (const uint32_t version : {2u, 3u}) {
        const SiteLattice& lattice = SiteLattice::ofVersion(version);
        const auto border = lattice.border();
        ASSERT_EQ(border.size(), size_t(3 * lattice.subdivisions()));
        for (size_t i = 0; i < border.size(); ++i) {
            const SitePlace p = lattice.place(border[i]), q = lattice.place(border[(i + 1) % border.size()]);
            const int side = int(i) / lattice.subdivisions();
            EXPECT_EQ(q.b - p.b, side == 0 ? 1 : side == 1 ? -1 : 0) << i;
            EXPECT_EQ(q.c - p.c, side == 0 ? 0 : side == 1 ? 1 : -1) << i;
        }
        EXPECT_EQ(border[0], 0);
    }
}

TEST(SiteBasis, IsTheNewtonBasisOfItsOrder) {
    std::mt19937 random(1);
    std::vector<float> x, y;
    for (const glm::dvec2 p : centreSites()) {
        x.push_back(float(p.x));
        y.push_back(float(p.y));
    }
    for (const size_t count : {3u, 4u, 12u, 30u, 66u, unsigned(kCentreSites)}) {
        const SiteBasis basis(kLattice, randomSites(count, random), {});
        const NewtonBasis newton(basis.sites());
        const std::vector<double> functions = basis.functionsAt(allPlaces(), count);
        constexpr size_t kStride = 160;
        std::vector<double> values(count * kStride), dx(values), dy(values);
        newton.evaluateWithDerivatives(x.data(), y.data(), kCentreSites, values.data(), dx.data(), dy.data(),
                                       kStride);
        for (size_t k = 0; k < count; ++k)
            for (size_t s = 0; s < kCentreSites; ++s) {
                const size_t i = k * kStride + s;
                const double rounding = 1e-7 * (std::abs(dx[i]) + std::abs(dy[i]));  // of the points
                EXPECT_NEAR(functions[k * kCentreSites + s], values[i], 1e-9 + rounding);
            }
        for (size_t k = 0; k < count; ++k)
            for (size_t j = 0; j < k; ++j)
                EXPECT_EQ(basis.before(k)[j], functions[j * kCentreSites + basis.sites()[k]]);
    }
}

TEST(SiteBasis, DoesNotDependOnTheOrderWithinAGroup) {
    std::mt19937 random(2);
    auto sites = randomSites(25, random);
    const std::vector<uint8_t> counts{25, 9, 3};
    const SiteBasis basis(kLattice, sites, counts);
    const auto sorted = [](std::span<const uint8_t> part) {
        std::vector<uint8_t> all(part.begin(), part.end());
        std::sort(all.begin(), all.end());
        return all;
    };
    EXPECT_EQ(sorted(basis.sites().first(9)), sorted(std::span(sites).first(9)));
    for (int i = 0; i < 20; ++i) {
        std::shuffle(sites.begin() + 3, sites.begin() + 9, random);
        std::shuffle(sites.begin() + 9, sites.end(), random);
        EXPECT_TRUE(std::ranges::equal(SiteBasis(kLattice, sites, counts).sites(), basis.sites()));
    }
    std::swap(sites[5], sites[15]);
    EXPECT_FALSE(std::ranges::equal(SiteBasis(kLattice, sites, counts).sites(), basis.sites()));
}

TEST(SiteBasis, FactorsAndSplinesAreEachOthersInverse) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (const size_t count : {3u, 5u, 20u, 66u}) {
        const SiteBasis basis(kLattice, randomSites(count, random), {});
        std::vector<double> values;
        for (size_t i = 0; i < count; ++i) values.push_back(unit(random));
        const auto factors = basis.factors(values);
        const std::array kernelFactors{basis.kernelFactors(factors)};
        const PatchSpline spline = basis.spline(kernelFactors);
        const auto back = basis.values(spline, 0, int(count));
        for (size_t i = 0; i < count; ++i) {
            EXPECT_NEAR(back[i], values[i], 1e-4);
            EXPECT_NEAR(evaluateSpline(spline, 0, centreSites()[basis.sites()[i]]), values[i], 1e-4);
        }
        const std::span<const double> span(factors);
        const PatchSpline newton = NewtonBasis(basis.sites()).spline({&span, 1});
        EXPECT_NEAR(evaluateSpline(spline, 0, {.4, .3}), evaluateSpline(newton, 0, {.4, .3}), 1e-4);
    }
}

TEST(SiteBasis, KernelFactorsMakeTheSplineAroundTheBorder) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(-1, 1);
    const SiteBasis basis(kLattice, randomSites(40, random), {});
    std::vector<double> factors(40);
    for (double& f : factors) f = unit(random);
    const std::vector<double> kernelFactors = basis.kernelFactors(factors);
    const auto border = kLattice.border();
    const std::vector<double> functions = basis.functionsAt(border, 40);
    for (size_t i = 0; i < border.size(); ++i) {
        double direct = 0, byKernels = 0;
        for (size_t k = 0; k < 40; ++k) {
            direct += factors[k] * functions[k * border.size() + i];
            byKernels += kernelFactors[k] * kLattice.borderFunction(basis.sites()[k])[i];
        }
        EXPECT_NEAR(byKernels, direct, 1e-9);
    }
}

TEST(SiteNorms, GiveTheMeanSquareOfASpline) {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> unit(-1, 1);
    const SiteBasis basis(kLattice, randomSites(18, random), {});
    const SiteProducts products(basis, 18);
    for (const size_t n : {3u, 7u, 18u}) {
        std::vector<double> errors(n);
        for (double& e : errors) e = unit(random);
        const SiteNorms norms = products.norms(n);
        double foretold = 0;
        for (size_t k = 0; k < n; ++k) {
            double sum = 0;
            for (size_t j = 0; j <= k; ++j) sum += norms.at(k, j) * errors[j];
            foretold += sum * sum;
        }
        const PatchSpline spline = basis.spline(std::array{basis.kernelFactors(errors)});
        double measured = 0, count = 0;
        constexpr int kGrid = 150;
        for (int i = 0; i < kGrid; ++i)
            for (int j = 0; i + j < kGrid; ++j) {
                const double v = (i + 1.0 / 3) / kGrid, w = (j + 1.0 / 3) / kGrid;
                const double value = evaluateSpline(spline, 0, domainPoint({1 - v - w, v, w}));
                measured += value * value;
                ++count;
            }
        EXPECT_NEAR(foretold / (measured / count), 1, .1) << n;
    }
}

TEST(SiteNorms, AreAboutWhatTheCellsForetell) {
    std::mt19937 random(6);
    for (const size_t n : {25u, 40u, 60u, 120u}) {
        double mean = 0, square = 0;
        for (int i = 0; i < 20; ++i) {
            const SiteBasis basis(kLattice, randomSites(n, random), {});
            const std::vector<double> norms = SiteProducts(basis, n).norms(n).diagonal();
            const std::vector<double> foretold = foretoldNorms(basis, n);
            for (size_t k = 0; k < n; ++k) {
                const double off = std::log(foretold[k] / norms[k]);
                mean += off / double(20 * n);
                square += off * off / double(20 * n);
            }
        }
        EXPECT_NEAR(mean, 0, .15) << n;
        EXPECT_LT(square - mean * mean, .15 * .15) << n;
    }
}

}  // namespace
}  // namespace tessera
