// Regions that features enclose, with gaps in them.
#include "core/edit/enclosed_region.h"

#include <gtest/gtest.h>

#include <array>
#include <glm/geometric.hpp>
#include <random>

#include "core/edit/distance_grid.h"
#include "tests/support/test_meshes.h"

namespace tessera {
namespace {

using testing::gridMesh;

constexpr int kCell = 10;
constexpr int kColumns = 24, kRows = 16;

PatchMesh ground() {
    return gridMesh(kColumns * kCell, kRows * kCell, kColumns, kRows);
}

// Cell (column, row) has patches 2 i (right, above) and 2 i + 1 (left, below).
PatchId patchIn(int column, int row) {
    return PatchId(uint32_t(2 * (row * kColumns + column)));
}

// Features along the lines of the grid from one crossing to another.
void wall(PatchMesh& mesh, glm::ivec2 from, glm::ivec2 to) {
    const glm::ivec2 step = glm::sign(to - from);
    const auto vertex = [](glm::ivec2 at) { return VertexId(uint32_t(at.y * (kColumns + 1) + at.x)); };
    for (glm::ivec2 at = from; at != to; at += step) {
        const EdgeId e = HalfedgeMesh::edge(mesh.connectivity().find(vertex(at), vertex(at + step)));
        EdgeCurve curve = mesh.curve(e);
        curve.feature = true;
        mesh.setCurve(e, curve);
    }
}

// The patches of the cells in [from, to).
PatchSet cells(glm::ivec2 from, glm::ivec2 to) {
    std::vector<PatchId> found;
    for (int row = from.y; row < to.y; ++row)
        for (int column = from.x; column < to.x; ++column)
            for (const uint32_t half : {0U, 1U}) found.emplace_back(patchIn(column, row).index + half);
    return patchSet(std::move(found));
}

TEST(EnclosedRegion, DoesNotLeaveThroughNarrowGaps) {
    PatchMesh mesh = ground();
    // Two rooms; the wall between them has a gap two cells wide.
    wall(mesh, {12, 0}, {12, 7});
    wall(mesh, {12, 9}, {12, kRows});
    const PatchSet left = cells({0, 0}, {12, kRows}), right = cells({12, 0}, {kColumns, kRows});
    for (const glm::ivec2 seed : {glm::ivec2(0, 0), glm::ivec2(3, 7), glm::ivec2(11, 15)})
        EXPECT_EQ(enclosedByFeatures(mesh, patchIn(seed.x, seed.y), 24), left) << seed.x << ' ' << seed.y;
    EXPECT_EQ(enclosedByFeatures(mesh, patchIn(20, 4), 24), right);
    // The gap is wider than what is asked for.
    for (const double gap : {0., 12., 16.})
        EXPECT_EQ(enclosedByFeatures(mesh, patchIn(0, 0), gap).size(), mesh.patchCount()) << gap;
}

TEST(EnclosedRegion, ClosesGapsAtThePicturesBorder) {
    PatchMesh mesh = ground();
    wall(mesh, {12, 0}, {12, kRows - 1});
    // What is in the gap itself may be of either side.
    const PatchSet gap = cells({11, kRows - 1}, {13, kRows});
    EXPECT_EQ(subtracted(enclosedByFeatures(mesh, patchIn(2, 2), 16), gap),
              subtracted(cells({0, 0}, {12, kRows}), gap));
    EXPECT_EQ(enclosedByFeatures(mesh, patchIn(2, 2), 0).size(), mesh.patchCount());
}

TEST(EnclosedRegion, MeetsAnotherInTheMiddleOfAPassage) {
    PatchMesh mesh = ground();
    // Two rooms and a corridor, one cell wide, from column 10 to column 14.
    for (const int x : {10, 14}) {
        wall(mesh, {x, 0}, {x, 7});
        wall(mesh, {x, 8}, {x, kRows});
    }
    wall(mesh, {10, 7}, {14, 7});
    wall(mesh, {10, 8}, {14, 8});
    const PatchSet left = enclosedByFeatures(mesh, patchIn(2, 2), 24);
    const PatchSet right = enclosedByFeatures(mesh, patchIn(20, 2), 24);
    EXPECT_TRUE(intersected(left, right).empty());
    EXPECT_EQ(subtracted(cells({0, 0}, {10, kRows}), left), PatchSet());
    EXPECT_EQ(subtracted(cells({14, 0}, {kColumns, kRows}), right), PatchSet());
    EXPECT_EQ(subtracted(united(left, right), cells({10, 7}, {14, 8})),
              united(cells({0, 0}, {10, kRows}), cells({14, 0}, {kColumns, kRows})));
}

TEST(EnclosedRegion, KeepsNarrowRegionsAndNecksWhole) {
    PatchMesh mesh = ground();
    // A slat one cell wide, all of it narrower than the gaps that are closed.
    wall(mesh, {4, 3}, {20, 3});
    wall(mesh, {4, 4}, {20, 4});
    wall(mesh, {4, 3}, {4, 4});
    wall(mesh, {20, 3}, {20, 4});
    EXPECT_EQ(enclosedByFeatures(mesh, patchIn(9, 3), 60), cells({4, 3}, {20, 4}));
    // A bottle: its neck is two cells wide and more than half as wide as its body.
    wall(mesh, {4, 8}, {7, 8});
    wall(mesh, {4, 11}, {7, 11});
    wall(mesh, {4, 8}, {4, 11});
    wall(mesh, {7, 8}, {7, 9});
    wall(mesh, {7, 9}, {16, 9});
    wall(mesh, {7, 11}, {16, 11});
    wall(mesh, {16, 9}, {16, 11});
    EXPECT_EQ(enclosedByFeatures(mesh, patchIn(5, 9), 60),
              united(cells({4, 8}, {7, 11}), cells({7, 9}, {16, 11})));
}

TEST(EnclosedRegion, LeavesOutWhatCannotBeSelectedAndPassesIt) {
    PatchMesh mesh = ground();
    wall(mesh, {12, 0}, {12, kRows});
    for (const PatchId p : cells({5, 0}, {6, kRows})) mesh.setAttributes(p, {false, true, false});
    EXPECT_EQ(enclosedByFeatures(mesh, patchIn(0, 0), 16),
              subtracted(cells({0, 0}, {12, kRows}), cells({5, 0}, {6, kRows})));
}

void paintPatch(PatchMesh& mesh, uint32_t p, std::array<float, 3> colour) {
    mesh.setSpline(PatchId(p), constantSpline(colour));
}

// One colour for a set of patches.
void paint(PatchMesh& mesh, const PatchSet& patches, std::array<float, 3> srgb) {
    for (const PatchId p : patches) paintPatch(mesh, p.index, srgb);
}

TEST(EnclosedRegion, ClosesWideGapsWhereColoursChange) {
    PatchMesh mesh = ground();
    const PatchSet everything = cells({0, 0}, {kColumns, kRows}), thing = cells({8, 4}, {16, 12});
    paint(mesh, everything, {.7F, .7F, .6F});
    paint(mesh, thing, {.1F, .5F, .5F});
    // A frame with one side missing: 80 px wide.
    wall(mesh, {8, 4}, {16, 4});
    wall(mesh, {8, 4}, {8, 12});
    wall(mesh, {16, 4}, {16, 12});
    EXPECT_EQ(enclosedByFeatures(mesh, patchIn(9, 5), 24), thing);
    EXPECT_EQ(enclosedByFeatures(mesh, patchIn(14, 11), 24), thing);
    // Features alone count.
    EXPECT_EQ(enclosedByFeatures(mesh, patchIn(9, 5), 0), everything);
}

TEST(EnclosedRegion, KeepsWhatFeaturesEncloseWhateverTheColours) {
    PatchMesh mesh = ground();
    const PatchSet thing = cells({8, 4}, {16, 12});
    paint(mesh, cells({0, 0}, {kColumns, kRows}), {.7F, .7F, .6F});
    paint(mesh, cells({8, 4}, {12, 12}), {.1F, .5F, .5F});
    paint(mesh, cells({12, 4}, {16, 12}), {.8F, .1F, .1F});
    wall(mesh, {8, 4}, {16, 4});
    wall(mesh, {8, 12}, {16, 12});
    wall(mesh, {8, 4}, {8, 12});
    wall(mesh, {16, 4}, {16, 12});
    EXPECT_EQ(enclosedByFeatures(mesh, patchIn(9, 5), 24), thing);
    EXPECT_EQ(enclosedByFeatures(mesh, patchIn(14, 11), 24), thing);
}

// Though the colours beyond are a stronger outline.
TEST(EnclosedRegion, DoesNotGrowBeyondClosedGaps) {
    PatchMesh mesh = ground();
    paint(mesh, cells({0, 0}, {kColumns, kRows}), {.7F, .7F, .6F});
    paint(mesh, cells({3, 0}, {21, kRows}), {.1F, .5F, .5F});
    for (const int y : {5, 11}) {
        wall(mesh, {9, y}, {11, y});
        wall(mesh, {13, y}, {15, y});
    }
    for (const int x : {9, 15}) {
        wall(mesh, {x, 5}, {x, 7});
        wall(mesh, {x, 9}, {x, 11});
    }
    const PatchSet found = enclosedByFeatures(mesh, patchIn(11, 7), 24);
    EXPECT_TRUE(subtracted(cells({10, 6}, {14, 10}), found).empty());
    EXPECT_TRUE(subtracted(found, cells({8, 4}, {16, 12})).empty());
}

TEST(EnclosedRegion, IsEverythingWhereNothingHolds) {
    PatchMesh mesh = ground();
    const PatchSet everything = cells({0, 0}, {kColumns, kRows});
    EXPECT_EQ(enclosedByFeatures(mesh, patchIn(9, 5), 24), everything);
    // Nearly flat, in two halves.
    paint(mesh, everything, {.5F, .5F, .5F});
    paint(mesh, cells({12, 0}, {kColumns, kRows}), {.51F, .5F, .5F});
    EXPECT_EQ(enclosedByFeatures(mesh, patchIn(9, 5), 24), everything);
}

TEST(DistanceGrid, IsTheDistanceToTheNearestSegment) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-40, 90), step(-9, 9);
    std::vector<LineSegment> segments{{{0, 0}, {80, 55}}, {{-30, 20}, {-30, 20}}, {{10, -20}, {10, 70}}};
    for (int i = 0; i < 200; ++i) {
        const glm::dvec2 from(place(random), place(random));
        segments.emplace_back(from, from + glm::dvec2(step(random), step(random)));
    }
    for (const double reach : {.5, 4., 30., 300.}) {
        const DistanceGrid grid(segments, reach);
        for (int i = 0; i < 2000; ++i) {
            const glm::dvec2 point(1.4 * place(random), 1.4 * place(random));
            double nearest = reach;
            for (const auto& [a, b] : segments) {
                const glm::dvec2 along = b - a;
                const double squared = glm::dot(along, along);
                const double t = squared > 0 ? glm::clamp(glm::dot(point - a, along) / squared, 0., 1.) : 0;
                nearest = std::min(nearest, glm::distance(a + t * along, point));
            }
            ASSERT_NEAR(grid.distance(point), nearest, 1e-9) << reach << ' ' << point.x << ' ' << point.y;
        }
    }
}

}  // namespace
}  // namespace tessera
