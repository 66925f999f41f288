// The deformation from curves to polylines: where it takes points, that it is one-to-one, and that it stays
// local.
#include "core/vectorize/feature_warp.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "tests/support/test_meshes.h"

namespace tessera {
namespace {

using ::testing::IsEmpty;

// The smallest determinant of the warp's derivative over the points of a grid, by central differences.
double smallestDeterminant(const FeatureWarp& warp, double width, double height, double step) {
    constexpr double kDelta = 1e-3;
    double smallest = HUGE_VAL;
    for (double y = step; y < height; y += step)
        for (double x = step; x < width; x += step) {
            const glm::dvec2 dx = warp({x + kDelta, y}) - warp({x - kDelta, y});
            const glm::dvec2 dy = warp({x, y + kDelta}) - warp({x, y - kDelta});
            smallest = std::min(smallest, cross(dx, dy) / (4 * kDelta * kDelta));
        }
    return smallest;
}

// Points along a line 12 px long from (10, 10), each displaced by `offset(t)`, t from 0 to 1.
template <class Offset>
std::vector<PointPair> pairsAlongALine(Offset&& offset) {
    std::vector<PointPair> pairs;
    for (int k = 0; k <= 12; ++k) {
        const glm::dvec2 from(10 + k, 10 + .5 * k);
        pairs.push_back({from, from + offset(k / 12.0)});
    }
    return pairs;
}

TEST(FeatureWarp, IdentityWithoutPairs) {
    const FeatureWarp warp(32, 24, {});
    EXPECT_EQ(warp.residual(), 0);
    for (const glm::dvec2 p : {glm::dvec2(0, 0), {3.25, 7.5}, {32, 24}, {-5, 40}}) EXPECT_EQ(warp(p), p);
}

TEST(FeatureWarp, IdentityForPairsThatAreInPlace) {
    const FeatureWarp warp(32, 24, pairsAlongALine([](double) { return glm::dvec2(0); }));
    EXPECT_EQ(warp.residual(), 0);
    EXPECT_EQ(warp({12, 11}), glm::dvec2(12, 11));
}

// Curves are within a pixel of their polylines.
TEST(FeatureWarp, TakesPairsToTheirTargets) {
    const auto wave = [](double t) { return std::sin(9 * t) * glm::dvec2(-.4, .8); };
    const auto pairs = pairsAlongALine(wave);
    const FeatureWarp warp(40, 30, pairs);
    double worst = 0;
    for (const PointPair& pair : pairs) worst = std::max(worst, glm::distance(warp(pair.from), pair.to));
    EXPECT_NEAR(worst, warp.residual(), 1e-9);
    EXPECT_LT(worst, .15);
    EXPECT_GT(smallestDeterminant(warp, 40, 30, .25), 0);
}

TEST(FeatureWarp, OnePairAlone) {
    const std::vector<PointPair> pairs{{{16, 12}, {16.7, 11.5}}};
    const FeatureWarp warp(32, 24, pairs);
    EXPECT_LT(glm::distance(warp({16, 12}), {16.7, 11.5}), .02);
    EXPECT_GT(smallestDeterminant(warp, 32, 24, .25), 0);
}

TEST(FeatureWarp, FarPointsStay) {
    const FeatureWarp warp(60, 60, pairsAlongALine([](double) { return glm::dvec2(-.6, .8); }));
    // The coarsest lattice has cells of 4 px, and a control reaches two of them.
    for (double y = 0; y <= 60; y += 3)
        for (double x = 0; x <= 60; x += 3) {
            const bool far = x < 0 || x > 36 || y < 0 || y > 30;
            if (far) {
                EXPECT_EQ(warp({x, y}), glm::dvec2(x, y)) << x << ' ' << y;
            }
        }
    EXPECT_NE(warp({16, 13}), glm::dvec2(16, 13));
}

// Neighbours a pixel apart that are pulled across each other cannot be both obeyed; one-to-one comes first.
TEST(FeatureWarp, OneToOneForAdversarialPairs) {
    std::vector<PointPair> crossing, shear;
    for (int k = 0; k < 16; ++k) {
        const double sign = k % 2 ? 1 : -1;
        crossing.push_back({{8.0 + k, 12}, {8.0 + k - sign * 2, 12 + sign}});
        shear.push_back({{8.0 + k, 12.0}, {8.0 + k + 1.5, 12.0}});
        shear.push_back({{8.0 + k, 13.0}, {8.0 + k - 1.5, 13.0}});
    }
    std::vector<PointPair> collapsing;  // everything to one point
    for (int k = -3; k <= 3; ++k)
        for (int l = -3; l <= 3; ++l) collapsing.push_back({{16.0 + k, 12.0 + l}, {16, 12}});
    std::mt19937 random(4);
    std::uniform_real_distribution<double> x(0, 32), y(0, 24), off(-3, 3);
    std::vector<PointPair> noise;
    for (int k = 0; k < 300; ++k) {
        const glm::dvec2 from(x(random), y(random));
        noise.push_back({from, from + glm::dvec2(off(random), off(random))});
    }
    for (const auto* pairs : {&crossing, &shear, &collapsing, &noise})
        EXPECT_GT(smallestDeterminant(FeatureWarp(32, 24, *pairs), 32, 24, .1), 0);
}

TEST(FeaturePairs, OnFeaturesAlone) {
    PatchMesh mesh = testing::gridMesh(24, 24, 2, 2);
    std::vector<std::vector<glm::dvec2>> paths(mesh.connectivity().edgeCapacity());
    EXPECT_THAT(featurePairs(mesh, paths), IsEmpty());

    // The edge from (12, 12) to (24, 12) as a feature, bent by a pixel; its polyline is straight.
    const HalfedgeId h = mesh.connectivity().find(VertexId(4), VertexId(5));
    const EdgeId e = HalfedgeMesh::edge(h);
    EdgeCurve curve = mesh.curve(e);
    curve.feature = true;
    mesh.setCurve(e, curve);
    mesh.setInnerControlPoints(h, toLattice({16, 13}), toLattice({20, 13}));
    const bool forward = HalfedgeMesh::halfedge(e) == h;
    for (int k = 0; k <= 8; ++k) paths[e.index].emplace_back(forward ? 12 + 1.5 * k : 24 - 1.5 * k, 12);
    const auto pairs = featurePairs(mesh, paths);
    ASSERT_EQ(pairs.size(), 13U) << "about a pixel apart, ends included";
    const BezierCurve along = toPixels(mesh.controlPoints(HalfedgeMesh::halfedge(e)));
    for (size_t k = 0; k < pairs.size(); ++k) {
        EXPECT_LT(nearestOnCurve(along, pairs[k].from).distance, 1e-3);
        EXPECT_NEAR(pairs[k].to.y, 12, 1e-12);
        EXPECT_NEAR(pairs[k].to.x, forward ? 12.0 + double(k) : 24.0 - double(k), 1e-9);
        EXPECT_LT(glm::distance(pairs[k].from, pairs[k].to), 1);
    }
    EXPECT_EQ(pairs.front().from, along.p[0]);
    EXPECT_EQ(pairs.back().from, along.p[3]);
}

}  // namespace
}  // namespace tessera
