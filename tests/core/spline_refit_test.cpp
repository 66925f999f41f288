// Refits of splines: where they look, and when few points do.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/edit/spline_edit.h"

namespace tessera {
namespace {

// Smooth values at some points, three channels.
template <class Value>
std::vector<double> valuesAt(const RefitPoints& at, Value&& value) {
    std::vector<double> values;
    for (int c = 0; c < 3; ++c)
        for (const Barycentric& b : at.barycentrics) values.push_back(value(domainPoint(b), c));
    return values;
}

double gentle(glm::dvec2 p, int c) {
    return .3 + .1 * c + .02 * std::sin(2 * p.x + c) * std::cos(2 * p.y);
}

PatchSpline withSites(std::vector<uint8_t> sites) {
    PatchSpline spline;
    spline.terms = {uint8_t(sites.size()), 3, 3, 0};
    spline.sites = std::move(sites);
    spline.coefficients.assign(spline.offset(3), 0.F);
    return spline;
}

TEST(RefitPoints, AreSitesWithTheCornersFirst) {
    EXPECT_EQ(RefitPoints::all().size(), size_t(kCentreSites));
    const PatchSpline few = withSites({0, 1, 2, 30, 31, 77});
    const RefitPoints enough = RefitPoints::enoughFor(few);
    EXPECT_LT(enough.size(), 52U);
    EXPECT_GE(enough.size(), 45U);
    for (const uint8_t site : few.sites)
        EXPECT_NE(std::find(enough.sites.begin(), enough.sites.end(), site), enough.sites.end());
    for (const RefitPoints& points : {RefitPoints::all(), enough}) {
        EXPECT_EQ(std::set(points.sites.begin(), points.sites.end()).size(), points.size());
        for (size_t i = 0; i < points.size(); ++i) {
            const glm::dvec2 site = centreSites()[points.sites[i]];
            EXPECT_NEAR(site.x, double(points.domain.x[i]), 1e-6);
            EXPECT_NEAR(site.y, double(points.domain.y[i]), 1e-6);
            EXPECT_GT(points.weights[i], 0);
        }
        for (uint8_t corner = 0; corner < 3; ++corner) EXPECT_EQ(points.sites[corner], corner);
    }
    std::vector<uint8_t> many;
    for (uint8_t s = 0; s < 60; ++s) many.push_back(s);
    EXPECT_EQ(RefitPoints::enoughFor(withSites(many)).size(), size_t(kCentreSites));
}

// What few points give is as near between them as what all points give.
TEST(SplineRefit, FewPointsDoForFewTerms) {
    const PatchSpline like = withSites({0, 1, 2, 30, 77, 101, 140, 20});
    for (const RefitPoints& at : {RefitPoints::all(), RefitPoints::enoughFor(like)}) {
        const auto spline = SplineRefit(like, at).fit(valuesAt(at, gentle), 3);
        ASSERT_TRUE(spline);
        double sum = 0;
        for (const Barycentric& b : RefitPoints::all().barycentrics)
            for (int c = 0; c < 3; ++c)
                sum += std::abs(evaluateSpline(*spline, c, domainPoint(b)) - gentle(domainPoint(b), c));
        EXPECT_LT(sum / (3 * kCentreSites), kRefitTolerance);
    }
}

TEST(SplineRefit, AsksForAllPointsWhereFewTermsDoNotDo) {
    const PatchSpline like = withSites({0, 1, 2, 30});
    const auto wild = [](glm::dvec2 p, int c) { return .5 + .4 * std::sin(14 * p.x + 11 * p.y + c); };
    const RefitPoints few = RefitPoints::enoughFor(like), &all = RefitPoints::all();
    EXPECT_FALSE(SplineRefit(like, few).fit(valuesAt(few, wild), 3));
    const auto spline = SplineRefit(like, all).fit(valuesAt(all, wild), 3);
    ASSERT_TRUE(spline);
    EXPECT_GT(spline->sites.size(), like.sites.size());
}

}  // namespace
}  // namespace tessera
