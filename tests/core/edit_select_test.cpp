// Sets of patches, the wand, floods, growing, outlines, palettes.
#include "core/edit/select.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include <numeric>
#include <set>

#include "core/edit/enclosed_region.h"
#include "core/edit/palette.h"
#include "core/image/oklab.h"
#include "tests/support/edit_meshes.h"
#include "tests/support/test_meshes.h"

namespace tessera {
namespace {

using ::testing::ElementsAre;
using testing::gridMesh;
using ::testing::IsEmpty;

PatchSet ids(std::initializer_list<uint32_t> indices) {
    PatchSet set;
    for (const uint32_t i : indices) set.push_back(PatchId(i));
    return set;
}

void paintPatch(PatchMesh& mesh, uint32_t p, std::array<float, 3> colour) {
    mesh.setSpline(PatchId(p), constantSpline(colour));
}

EdgeId edgeBetween(const PatchMesh& mesh, uint32_t a, uint32_t b) {
    for (const HalfedgeId side : mesh.connectivity().sides(PatchId(a)))
        if (mesh.connectivity().face(HalfedgeMesh::twin(side)) == PatchId(b)) return HalfedgeMesh::edge(side);
    return {};
}

void makeFeature(PatchMesh& mesh, EdgeId e) {
    EdgeCurve curve = mesh.curve(e);
    curve.feature = true;
    mesh.setCurve(e, curve);
}

// Cells of two patches: cell i has patches 2 i and 2 i + 1. The left 3 columns are red, the others nearly so.
PatchMesh twoReds() {
    PatchMesh mesh = gridMesh(60, 40, 6, 4);
    for (uint32_t p = 0; p < 48; ++p)
        paintPatch(mesh, p, (p / 2) % 6 < 3 ? std::array{.8F, .1F, .1F} : std::array{.1F, .3F, .8F});
    return mesh;
}

TEST(PatchSet, HasTheAlgebraOfSets) {
    const PatchSet a = ids({1, 3, 5}), b = ids({3, 4, 5, 9});
    EXPECT_EQ(united(a, b), ids({1, 3, 4, 5, 9}));
    EXPECT_EQ(subtracted(a, b), ids({1}));
    EXPECT_EQ(intersected(a, b), ids({3, 5}));
    EXPECT_EQ(patchSet({PatchId(4), PatchId(1), PatchId(4)}), ids({1, 4}));
    EXPECT_TRUE(contains(a, PatchId(3)));
    EXPECT_FALSE(contains(a, PatchId(4)));
    PatchMesh mesh = gridMesh(20, 20, 2, 1);
    mesh.setAttributes(PatchId(2), {true, false, false});
    mesh.setAttributes(PatchId(3), {false, true, false});
    EXPECT_EQ(inverted(mesh, ids({0})), ids({1}));
    EXPECT_EQ(editable(mesh, ids({0, 1, 2, 3})), ids({0, 1, 2}));
}

TEST(Wand, TakesWhatIsLikeTheSeed) {
    PatchMesh mesh = twoReds();
    const PatchSet left = wand(mesh, PatchId(0), {});
    EXPECT_EQ(left.size(), 24U);
    for (const PatchId p : left) EXPECT_LT((p.index / 2) % 6, 3U);
    // A red island on the other side is found only where the whole picture is searched.
    paintPatch(mesh, 23, {.81F, .1F, .1F});
    EXPECT_EQ(wand(mesh, PatchId(0), {}).size(), 24U);
    EXPECT_EQ(wand(mesh, PatchId(0), {.06, false, false}).size(), 25U);
    EXPECT_EQ(wand(mesh, PatchId(0), {2, true, false}).size(), 48U);
    mesh.setAttributes(PatchId(2), {false, true, false});
    EXPECT_FALSE(contains(wand(mesh, PatchId(0), {}), PatchId(2)));
}

TEST(Wand, StopsAtFeaturesWhereItShould) {
    PatchMesh mesh = twoReds();
    // A line of features below the first row of cells, 6 edges: patch 2 i + 1 of it against 2 (i + 6).
    for (uint32_t i = 0; i < 6; ++i) makeFeature(mesh, edgeBetween(mesh, 2 * i + 1, 2 * (i + 6)));
    EXPECT_EQ(wand(mesh, PatchId(0), {.06, true, true}).size(), 6U);
    EXPECT_EQ(wand(mesh, PatchId(0), {.06, true, false}).size(), 24U);
    EXPECT_EQ(enclosedByFeatures(mesh, PatchId(0), 0).size(), 12U);
    EXPECT_EQ(enclosedByFeatures(mesh, PatchId(47), 0).size(), 36U);
}

TEST(PatchColours, FollowWhatChanges) {
    PatchMesh mesh = twoReds();
    PatchColours colours(mesh);
    EXPECT_NEAR(colours[PatchId(0)].srgb.x, .8, 1e-6);
    EXPECT_NEAR(colours[PatchId(0)].area, 50, 1e-9);
    paintPatch(mesh, 0, {0, 1, 0});
    colours.update(mesh, ids({0}));
    EXPECT_NEAR(colours[PatchId(0)].srgb.y, 1, 1e-6);
    EXPECT_GT(colourDistance(colours[PatchId(0)], colours[PatchId(1)]), .3);
}

TEST(Grow, GoesOverEdgesAndBack) {
    const PatchMesh mesh = gridMesh(50, 50, 5, 5);
    // The middle cell: patches 24 (right, above) and 25 (left, below).
    const PatchSet middle = ids({24, 25});
    const PatchSet more = grown(mesh, middle);
    EXPECT_EQ(more.size(), 6U);
    EXPECT_EQ(shrunk(mesh, more), middle);
    // The picture's border takes nothing away.
    EXPECT_EQ(shrunk(mesh, allSelectable(mesh)).size(), 50U);
    EXPECT_THAT(shrunk(mesh, middle), IsEmpty());
}

TEST(Outline, RunsOnceAroundEachPartAndEachHole) {
    const PatchMesh mesh = gridMesh(50, 50, 5, 5);
    PatchSet ring = allSelectable(mesh);
    ring = subtracted(ring, ids({24, 25}));
    const auto loops = outline(mesh, ring);
    ASSERT_EQ(loops.size(), 2U);
    const HalfedgeMesh& c = mesh.connectivity();
    std::set<size_t> lengths;
    for (const auto& loop : loops) {
        lengths.insert(loop.size());
        for (size_t i = 0; i < loop.size(); ++i) {
            EXPECT_EQ(c.target(loop[i]), c.origin(loop[(i + 1) % loop.size()]));
            EXPECT_TRUE(contains(ring, c.face(loop[i])));
        }
    }
    EXPECT_EQ(lengths, (std::set<size_t>{4, 20}));
    EXPECT_THAT(outline(mesh, {}), IsEmpty());
    // Two patches that touch in a vertex alone have a loop each.
    EXPECT_EQ(outline(mesh, ids({0, 12})).size(), 2U);
}

TEST(Palette, FindsTheColoursThatThereAre) {
    PatchMesh mesh = gridMesh(100, 100, 10, 10);
    const std::array<std::array<float, 3>, 6> colours{{{.9F, .1F, .1F},
                                                       {.1F, .8F, .1F},
                                                       {.1F, .1F, .9F},
                                                       {.9F, .9F, .1F},
                                                       {.05F, .05F, .05F},
                                                       {.9F, .9F, .9F}}};
    for (uint32_t p = 0; p < 200; ++p) paintPatch(mesh, p, colours[p % 20 < 10 ? 0 : 1 + p % 5]);
    const PatchColours means(mesh);
    const Palette found = palette(mesh, means, 8);
    ASSERT_EQ(found.entries.size(), 6U);
    EXPECT_NEAR(found.entries[0].weight, .5, 1e-6);
    EXPECT_NEAR(found.entries[0].colour.x, .9, 1e-3);
    EXPECT_EQ(found.entries[0].patches, 100U);
    double weight = 0;
    for (const PaletteEntry& e : found.entries) weight += e.weight;
    EXPECT_NEAR(weight, 1, 1e-9);
    EXPECT_EQ(patchesOf(found, 0).size(), 100U);
    EXPECT_EQ(found.nearest, palette(mesh, means, 8).nearest);
}

// A colour that a person has made is no more one of the dominant ones, and stays an entry all the same.
TEST(Palette, EntriesStayThroughAnEdit) {
    PatchMesh mesh = gridMesh(100, 100, 10, 10);
    const std::array own{.5F, .35F, .55F};
    for (uint32_t p = 0; p < 200; ++p)
        paintPatch(mesh, p, p < 190 ? std::array{float(p) / 190, .2F, 1 - float(p) / 190} : own);
    const PatchColours means(mesh);
    const glm::dvec3 wanted(own[0], own[1], own[2]);
    const auto nearestTo = [&](const Palette& found) {
        double nearest = 1;
        for (const PaletteEntry& e : found.entries)
            nearest = std::min(nearest, glm::distance(toOklab(e.colour), toOklab(wanted)));
        return nearest;
    };
    const Palette fresh = palette(mesh, means, 5);
    ASSERT_GT(nearestTo(fresh), .03);
    std::vector<glm::dvec3> like{wanted, {-1, 5, 9}};  // the second is none of the picture's
    for (const PaletteEntry& e : fresh.entries) like.push_back(e.colour);
    const Palette found = palette(mesh, means, 6, like);
    EXPECT_LT(nearestTo(found), .02);
    EXPECT_EQ(found.entries.size(), 6U);
}

// Shares of the entries in colours near to and far from all of them.
TEST(Palette, SharesAreOneInSum) {
    const std::vector<glm::dvec3> entries{{.2, 0, 0}, {.5, .1, .1}, {.9, -.1, 0}};
    constexpr size_t kCount = 45;
    std::array<std::array<float, kCount>, 3> planes{};
    for (size_t i = 0; i < kCount; ++i) planes[0][i] = 4 * float(i) / kCount - 1;
    for (int c = 0; c < 3; ++c) planes[size_t(c)][7] = float(entries[1][c]);
    const float* const lab[] = {planes[0].data(), planes[1].data(), planes[2].data()};
    std::array<float, kCount> sum{}, shares;
    for (size_t entry = 0; entry < entries.size(); ++entry) {
        paletteShares(entries, .1, entry, lab, kCount, shares.data());
        for (size_t i = 0; i < kCount; ++i) {
            EXPECT_GE(shares[i], 0);
            sum[i] += shares[i];
        }
        const glm::dvec3 off = entries[entry] - entries[1];
        double all = 0;
        for (const glm::dvec3& e : entries) all += std::exp(-glm::dot(e - entries[1], e - entries[1]) / .02);
        EXPECT_NEAR(shares[7], std::exp(-glm::dot(off, off) / .02) / all, 1e-5);
    }
    for (const float s : sum) EXPECT_NEAR(s, 1, 1e-5);
}

TEST(Palette, AnEntryTakesItsPatchesAlong) {
    PatchMesh mesh = twoReds();
    const PatchMesh before = mesh;
    const Palette found = palette(mesh, PatchColours(mesh), 5);
    ASSERT_EQ(found.entries.size(), 2U);
    const int blue = found.entries[0].colour.z > .5 ? 0 : 1;
    const Touched touched = recolourPalette(mesh, found, blue, {.1, .7, .2});
    const PatchColours after(mesh);
    EXPECT_NEAR(after[PatchId(6)].srgb.y, .7, .03);
    EXPECT_NEAR(after[PatchId(6)].srgb.z, .2, .05);
    EXPECT_NEAR(after[PatchId(0)].srgb.x, .8, .03);
    EXPECT_EQ(intersected(touched.patches, patchesOf(found, blue)), patchesOf(found, blue));
    EXPECT_THAT(testing::changedPatches(before, mesh), ::testing::ElementsAreArray(touched.patches));
}

}  // namespace
}  // namespace tessera
