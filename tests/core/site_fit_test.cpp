// Fits of splines at the sites: as near as their terms allow, and further terms where that is not near.
#include "core/edit/site_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "core/mesh/newton_basis.h"

namespace tessera {
namespace {

constexpr int kChannels = 3;

template <class Value>
SitePlanes valuesOf(Value&& value) {
    SitePlanes planes{};
    for (size_t c = 0; c < kChannels; ++c)
        for (size_t i = 0; i < size_t(kCentreSites); ++i)
            planes[c][i] = float(value(centreSites()[i], int(c)));
    return planes;
}

double gentle(glm::dvec2 p, int c) {
    return .3 + .1 * c + .02 * std::sin(2 * p.x + c) * std::cos(2 * p.y);
}

double wild(glm::dvec2 p, int c) {
    return .5 + .4 * std::sin(14 * p.x + 11 * p.y + c);
}

PatchSpline zeroWith(std::vector<uint8_t> sites) {
    PatchSpline spline;
    spline.terms = {uint8_t(sites.size()), 3, 3, 0};
    spline.sites = std::move(sites);
    spline.coefficients.assign(spline.offset(kChannels), 0.F);
    return spline;
}

// A spline of the space that sites span, with random alphas.
PatchSpline randomWith(const std::vector<uint8_t>& sites, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(-.2, .2);
    std::array<std::vector<double>, kChannels> factors;
    for (size_t c = 0; c < kChannels; ++c) {
        factors[c].resize(c == 0 ? sites.size() : std::max<size_t>(3, sites.size() / 2));
        for (double& f : factors[c]) f = unit(random);
    }
    const std::array<std::span<const double>, kChannels> spans{factors[0], factors[1], factors[2]};
    return NewtonBasis(sites).spline(spans);
}

std::vector<uint8_t> manySites(size_t count, unsigned seed) {
    std::vector<uint8_t> sites;
    for (int s = 0; s < kCentreSites; ++s) sites.push_back(uint8_t(s));
    std::mt19937 random(seed);
    std::shuffle(sites.begin() + 3, sites.end(), random);
    sites.resize(count);
    return sites;
}

// The weighted mean of what a spline is off, at the sites.
template <class Value>
double deviation(const PatchSpline& spline, Value&& value) {
    double sum = 0;
    for (int c = 0; c < kChannels; ++c)
        for (size_t i = 0; i < size_t(kCentreSites); ++i)
            sum += double(sitePoints().weights[i]) *
                   std::abs(evaluateSpline(spline, c, centreSites()[i]) - value(centreSites()[i], c));
    return sum / (kChannels * sitePoints().weight);
}

// The alphas of a spline leave nothing that is constant or linear.
void expectSideConditions(const PatchSpline& spline) {
    for (int c = 0; c < kChannels; ++c) {
        glm::dvec3 sum(0);
        double size = 1e-3;
        for (int i = 0; i < spline.terms[size_t(c)]; ++i) {
            const auto alpha = double(spline.coefficients[spline.offset(c) + 3 + size_t(i)]);
            sum += alpha * glm::dvec3(1, spline.centre(i));
            size += std::abs(alpha);
        }
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(sum[k], 0, 1e-5 * size);
    }
}

TEST(SitePoints, AreTheSitesWithTheCornersFirst) {
    const SitePoints& points = sitePoints();
    ASSERT_EQ(points.domain.size(), size_t(kCentreSites));
    int onSides = 0;
    for (size_t i = 0; i < points.domain.size(); ++i) {
        const glm::dvec2 site = centreSites()[i];
        EXPECT_NEAR(site.x, double(points.domain.x[i]), 1e-6);
        EXPECT_NEAR(site.y, double(points.domain.y[i]), 1e-6);
        onSides += points.weights[i] > 1;
    }
    EXPECT_EQ(onSides, 3 * kSiteSubdivisions);
    EXPECT_EQ(points.weights[kSitePlane - 1], 0);
    for (int corner = 0; corner < 3; ++corner) EXPECT_EQ(points.barycentrics[size_t(corner)][corner], 1);
}

// A spline of the same sites is found again, whether they are few, many or all.
TEST(SiteFit, FindsASplineOfTheSameSites) {
    for (const size_t count : {3U, 4U, 8U, 11U, 40U, 97U, 153U}) {
        const auto sites = manySites(count, unsigned(count));
        const PatchSpline wanted = randomWith(sites, 1);
        const auto value = [&](glm::dvec2 p, int c) { return evaluateSpline(wanted, c, p); };
        const PatchSpline found = fittedLike(wanted, kChannels, valuesOf(value));
        EXPECT_LT(deviation(found, value), .03 / 255) << count;
        EXPECT_LE(found.sites.size(), count);
        expectSideConditions(found);
    }
}

TEST(SiteFit, FewerSitesAreFartherOff) {
    const auto sites = manySites(40, 5);
    const PatchSpline wanted = randomWith(sites, 1);
    const auto value = [&](glm::dvec2 p, int c) { return evaluateSpline(wanted, c, p); };
    const PatchSpline found = fittedLike(zeroWith({0, 1, 2, sites[3], sites[4]}), kChannels, valuesOf(value));
    EXPECT_GT(deviation(found, value), .03 / 255);
    EXPECT_LE(deviation(found, value), kFitTolerance * 1.01);
}

TEST(SiteFit, WhatIsGentleNeedsNoFurtherSites) {
    const PatchSpline like = zeroWith({0, 1, 2, 30, 77, 101, 140, 20});
    const PatchSpline spline = fittedLike(like, kChannels, valuesOf(gentle));
    EXPECT_LE(deviation(spline, gentle), kFitTolerance * 1.01);
    EXPECT_EQ(spline.sites, like.sites);
}

TEST(SiteFit, TakesFurtherSitesWhereItsOwnDoNotDo) {
    const PatchSpline like = zeroWith({0, 1, 2, 30});
    const PatchSpline spline = fittedLike(like, kChannels, valuesOf(wild));
    EXPECT_LE(deviation(spline, wild), kFitTolerance * 1.01);
    EXPECT_GT(spline.sites.size(), like.sites.size());
    EXPECT_EQ(std::set(spline.sites.begin(), spline.sites.end()).size(), spline.sites.size());
    for (size_t i = 0; i < like.sites.size(); ++i) EXPECT_EQ(spline.sites[i], like.sites[i]);
    expectSideConditions(spline);
}

TEST(SiteFit, AddsToWhatIsThere) {
    const auto sites = manySites(30, 7);
    const PatchSpline start = randomWith(sites, 2);
    const std::array colour{.1F, .2F, .3F};
    for (const PatchSpline& spline : {start, constantSpline(colour)}) {
        for (const auto& value : {gentle, wild}) {
            const PatchSpline sum = withAdded(spline, kChannels, valuesOf(value));
            const auto both = [&](glm::dvec2 p, int c) { return evaluateSpline(spline, c, p) + value(p, c); };
            EXPECT_LE(deviation(sum, both), kFitTolerance * 1.01);
            expectSideConditions(sum);
        }
    }
    // What nothing is added to stays.
    const PatchSpline same = withAdded(start, kChannels, {});
    EXPECT_EQ(same, start);
}

// Splines on other centres get sites.
TEST(SiteFit, SplinesWithoutSitesGetThem) {
    PatchSpline spline;
    spline.terms = {kDefaultCentreCount, kDefaultCentreCount, kDefaultCentreCount, 0};
    const NodalBasis& basis = defaultNodalBasis();
    for (int c = 0; c < kChannels; ++c)
        for (size_t row = 0; row < size_t(basis.n) + 3; ++row) {
            double sum = 0;
            for (size_t k = 0; k < size_t(basis.n); ++k)
                sum += basis.toCoefficients[row * size_t(basis.n) + k] * gentle(defaultCentres()[k], c);
            spline.coefficients.push_back(float(sum));
        }
    const PatchSpline sum = withAdded(spline, kChannels, valuesOf(gentle));
    EXPECT_FALSE(sum.sites.empty());
    EXPECT_LE(
        deviation(sum, [&](glm::dvec2 p, int c) { return evaluateSpline(spline, c, p) + gentle(p, c); }),
        kFitTolerance * 1.01);
}

}  // namespace
}  // namespace tessera
