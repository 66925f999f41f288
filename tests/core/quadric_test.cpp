// Quadric error metrics: distances to planes that can be checked by hand.
#include "core/mesh/quadric.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace tessera {
namespace {

constexpr size_t kCorners[3] = {0, 1, 2};

// A triangle of area 2 over (0, 0), (2, 0), (0, 2) with these heights at its corners, one channel.
QuadricArray oneTriangle(const std::array<float, 3>& z, double scale = 1) {
    QuadricArray quadrics(3, 1);
    const QuadricArray::Point points[3] = {{0, 0, &z[0]}, {2, 0, &z[1]}, {0, 2, &z[2]}};
    quadrics.addTriangle(kCorners, points, scale);
    return quadrics;
}

double errorAt(const QuadricArray& quadrics, size_t i, double x, double y, float z, double scale = 1) {
    return quadrics.error(i, {x, y, &z}, scale);
}

TEST(Quadric, ZeroOnThePlaneAlsoBeyondTheTriangle) {
    const QuadricArray q = oneTriangle({1, 3, 2});  // z = 1 + x + y / 2
    for (size_t corner = 0; corner < 3; ++corner)
        for (const auto& [x, y] : {std::pair{0.0, 0.0}, {1.0, 1.0}, {10.0, -4.0}})
            EXPECT_NEAR(errorAt(q, corner, x, y, float(1 + x + y / 2)), 0, 1e-12);
}

TEST(Quadric, SquaredDistanceTimesArea) {
    EXPECT_DOUBLE_EQ(errorAt(oneTriangle({0, 0, 0}), 0, .5, .5, 3), 2 * 9);
    EXPECT_DOUBLE_EQ(errorAt(oneTriangle({0, 0, 0}), 2, -7, 5, -3), 2 * 9) << "the plane has no end";
    // z = x: area 2 sqrt 2; a point one above it is 1 / sqrt 2 away.
    EXPECT_NEAR(errorAt(oneTriangle({0, 2, 0}), 1, .5, .5, 1.5F), std::sqrt(2), 1e-12);
}

TEST(Quadric, ScaleMultipliesHeights) {
    EXPECT_DOUBLE_EQ(errorAt(oneTriangle({0, 0, 0}, 5), 0, .5, .5, .2F, 5), 2 * std::pow(5 * double(.2F), 2));
    // z = .2 x times 5 is z = x.
    EXPECT_NEAR(errorAt(oneTriangle({0, .4F, 0}, 5), 0, 1, 0, .4F, 5), std::sqrt(2), 1e-6);
}

TEST(Quadric, ChannelsAddUp) {
    QuadricArray q(3, 3);
    const std::array<float, 3> zero{0, 0, 0};
    const QuadricArray::Point points[3] = {{0, 0, zero.data()}, {2, 0, zero.data()}, {0, 2, zero.data()}};
    q.addTriangle(kCorners, points, 1);
    const std::array<float, 3> off{1, 2, 3};
    EXPECT_DOUBLE_EQ(q.error(0, {5, 5, off.data()}, 1), 2 * (1 + 4 + 9));
    const std::array<float, 3> one{0, 2, 0};
    EXPECT_DOUBLE_EQ(q.error(0, {5, 5, one.data()}, 1), 2 * 4);
}

TEST(Quadric, TrianglesAddUpAtACommonCorner) {
    // The ground (area 2) and a wall x = 0 as steep as heights allow are told apart: here z = 0 and z = x.
    QuadricArray q(5, 1);
    const std::array<float, 5> z{0, 0, 0, 2, 0};
    const QuadricArray::Point ground[3] = {{0, 0, &z[0]}, {0, 2, &z[2]}, {-2, 0, &z[1]}};
    const QuadricArray::Point slope[3] = {{0, 0, &z[0]}, {2, 0, &z[3]}, {0, 2, &z[2]}};
    const size_t groundCorners[3] = {0, 2, 1}, slopeCorners[3] = {0, 3, 2};
    q.addTriangle(groundCorners, ground, 1);
    q.addTriangle(slopeCorners, slope, 1);
    EXPECT_NEAR(errorAt(q, 0, 0, 5, 1), 2 * 1 + std::sqrt(2), 1e-12) << "both planes";
    EXPECT_NEAR(errorAt(q, 1, 0, 5, 1), 2, 1e-12) << "the ground alone";
    EXPECT_NEAR(errorAt(q, 3, 0, 5, 1), std::sqrt(2), 1e-12) << "the slope alone";
    EXPECT_NEAR(errorAt(q, 0, 0, 5, 0), 0, 1e-12) << "the line where they meet";
}

TEST(Quadric, AccumulateAddsAndKeepsTheOther) {
    QuadricArray q(3, 1);
    const std::array<float, 3> z{0, 0, 0};
    const QuadricArray::Point points[3] = {{0, 0, &z[0]}, {2, 0, &z[1]}, {0, 2, &z[2]}};
    q.addTriangle(kCorners, points, 1);
    q.accumulate(0, 1);
    q.accumulate(0, 2);
    EXPECT_DOUBLE_EQ(errorAt(q, 0, 1, 1, 1), 6);
    EXPECT_DOUBLE_EQ(errorAt(q, 1, 1, 1, 1), 2);
}

TEST(Quadric, StartsAtZeroAndIgnoresTrianglesWithoutArea) {
    QuadricArray q(3, 1);
    EXPECT_EQ(errorAt(q, 0, 3, 4, 5), 0);
    const float z = 0;
    const QuadricArray::Point points[3] = {{0, 0, &z}, {1, 1, &z}, {2, 2, &z}};
    q.addTriangle(kCorners, points, 1);
    EXPECT_EQ(errorAt(q, 0, 3, 4, 5), 0);
}

}  // namespace
}  // namespace tessera
