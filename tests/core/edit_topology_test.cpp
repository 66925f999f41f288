// Splitting and merging: the picture stays, and so does every invariant.
#include "core/edit/split_merge.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "core/edit/drag_colour.h"
#include "core/export/rasterize.h"
#include "tests/support/colour_change.h"
#include "tests/support/edit_meshes.h"
#include "tests/support/test_meshes.h"

namespace tessera {
namespace {

using testing::curvedMesh;
using testing::expectValid;
using testing::gridMesh;
using ::testing::HasSubstr;
using testing::meanColourChange;
using testing::sameMesh;
using testing::sceneMesh;

const PatchMesh& scene() {
    static const PatchMesh mesh = sceneMesh();
    return mesh;
}

struct Difference {
    double mean = 0;
    size_t beyond = 0;  // pixels off by more than 8 levels
};

// In levels, at twice the size.
Difference difference(const PatchMesh& a, const PatchMesh& b) {
    const View view = wholePicture(a, {2, 2});
    const auto one = rasterize(a, view), other = rasterize(b, view);
    Difference result;
    if (!one || !other) return {HUGE_VAL, 0};
    for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x) {
            double worst = 0;
            for (int c = 0; c < a.channels(); ++c) {
                const double off = 255 * std::abs(double(one->at(x, y, c)) - double(other->at(x, y, c)));
                result.mean += off;
                worst = std::max(worst, off);
            }
            result.beyond += worst > 8;
        }
    result.mean /= double(view.width) * view.height * a.channels();
    return result;
}

TEST(SplitEdge, KeepsThePicture) {
    PatchMesh mesh = scene();
    const size_t patches = mesh.patchCount();
    size_t splits = 0;
    for (uint32_t e = 0; e < scene().connectivity().edgeCapacity(); e += 7) {
        const auto touched = splitEdge(mesh, EdgeId(e), .35);
        if (!touched) continue;
        EXPECT_TRUE(touched->topology);
        ++splits;
    }
    EXPECT_GT(splits, 25U);
    EXPECT_GT(mesh.patchCount(), patches + splits);
    expectValid(mesh);
    const Difference off = difference(mesh, scene());
    EXPECT_LT(off.mean, .5);
    EXPECT_LT(off.beyond, size_t(.004 * 400 * 300));
}

TEST(SplitEdge, WorksWithDefaultCentresAndOnTheBorder) {
    const PatchMesh start = curvedMesh(120, 90, 6, 5, 3);
    PatchMesh mesh = start;
    EdgeId border;
    mesh.forEachEdge([&](EdgeId e) {
        if (mesh.connectivity().onBorder(e)) border = e;
    });
    ASSERT_TRUE(splitEdge(mesh, border, .5));
    for (uint32_t e = 0; e < 40; e += 3) splitEdge(mesh, EdgeId(e), .6);
    expectValid(mesh);
    EXPECT_LT(difference(mesh, start).mean, .5);
}

TEST(SplitEdge, HalvesOfAFeatureAreSmoothAndInheritItsBlur) {
    PatchMesh mesh = scene();
    std::vector<EdgeId> features;
    mesh.forEachEdge([&](EdgeId e) {
        EdgeCurve curve = mesh.curve(e);
        if (!curve.feature) return;
        features.push_back(e);
        curve.blurSigma = {1, 3};
        mesh.setCurve(e, curve);
    });
    Result<Touched> touched = failure(ErrorCode::Usage, "there are no features");
    EdgeId feature;
    const size_t joins = mesh.smoothJoins().size();
    for (size_t i = 0; i < features.size() && !touched; ++i)
        touched = splitEdge(mesh, feature = features[i], .5);
    ASSERT_TRUE(touched) << touched.error().message;
    ASSERT_EQ(touched->vertices.size(), 1U);
    EXPECT_EQ(mesh.smoothJoins().size(), joins + 1);
    int halves = 0;
    for (const EdgeId e : touched->edges) {
        if (!mesh.curve(e).feature) continue;
        ++halves;
        EXPECT_NEAR(mesh.curve(e).blurSigma[0] + mesh.curve(e).blurSigma[1], e == feature ? 3 : 5, 1e-6);
    }
    EXPECT_EQ(halves, 2);
    expectValid(mesh);
}

TEST(SplitPatch, KeepsThePicture) {
    PatchMesh mesh = scene();
    size_t splits = 0;
    for (uint32_t p = 0; p < 200; p += 9) splits += splitPatch(mesh, PatchId(p), {.3, .45, .25}).has_value();
    EXPECT_GT(splits, 15U);
    EXPECT_EQ(mesh.patchCount(), scene().patchCount() + 2 * splits);
    expectValid(mesh);
    const Difference off = difference(mesh, scene());
    EXPECT_LT(off.mean, .5);
    EXPECT_LT(off.beyond, size_t(.004 * 400 * 300));
    EXPECT_FALSE(hasFitted(mesh, scene(), PatchId(0)));
    EXPECT_TRUE(hasFitted(mesh, scene(), PatchId(100)));
}

TEST(Split, RefusesWhatCannotBe) {
    PatchMesh mesh = gridMesh(40, 40, 2, 2);
    const PatchMesh before = mesh;
    EXPECT_FALSE(splitEdge(mesh, EdgeId(3), 0));
    EXPECT_FALSE(splitEdge(mesh, EdgeId(3), 1));
    EXPECT_FALSE(splitEdge(mesh, EdgeId(999), .5));
    EXPECT_FALSE(splitPatch(mesh, PatchId(0), {1, 0, 0}));
    mesh.setAttributes(PatchId(0), {false, true, false});
    const auto locked = splitPatch(mesh, PatchId(0), Barycentric(1.0 / 3));
    ASSERT_FALSE(locked);
    EXPECT_THAT(locked.error().message, HasSubstr("locked"));
    mesh.setAttributes(PatchId(0), {});
    EXPECT_TRUE(sameMesh(mesh, before));
    // Down to the lattice: at some point there is no room.
    bool refused = false;
    for (int i = 0; i < 30 && !refused; ++i) refused = !splitPatch(mesh, PatchId(0), Barycentric(1.0 / 3));
    EXPECT_TRUE(refused);
    expectValid(mesh);
}

TEST(MergeEdge, TakesAVertexAway) {
    PatchMesh mesh = gridMesh(80, 80, 4, 4);
    const size_t patches = mesh.patchCount(), vertices = mesh.connectivity().vertexCount();
    size_t merged = 0;
    EdgeId inner;
    mesh.forEachEdge([&](EdgeId e) {
        const HalfedgeId h = HalfedgeMesh::halfedge(e);
        if (!mesh.connectivity().onBorder(mesh.connectivity().origin(h)) &&
            !mesh.connectivity().onBorder(mesh.connectivity().target(h)))
            inner = e;
    });
    const auto touched = mergeEdge(mesh, inner);
    ASSERT_TRUE(touched) << touched.error().message;
    ++merged;
    EXPECT_EQ(mesh.patchCount(), patches - 2);
    EXPECT_EQ(mesh.connectivity().vertexCount(), vertices - merged);
    EXPECT_FALSE(mesh.connectivity().alive(inner));
    expectValid(mesh);
    EXPECT_FALSE(mergeEdge(mesh, inner));
}

TEST(MergeEdge, KeepsTheOutlineAndRefusesFolds) {
    PatchMesh mesh = gridMesh(40, 40, 1, 1);
    mesh.forEachEdge([&](EdgeId e) { EXPECT_FALSE(mergeEdge(mesh, e)) << e.index; });
    mesh = scene();
    std::mt19937 random(5);
    size_t merged = 0, refused = 0;
    for (int i = 0; i < 150; ++i) {
        const EdgeId e(uint32_t(random() % mesh.connectivity().edgeCapacity()));
        if (!mesh.connectivity().alive(e)) continue;
        const PatchMesh before = mesh;
        if (mergeEdge(mesh, e)) {
            ++merged;
        } else {
            ++refused;
            EXPECT_TRUE(sameMesh(mesh, before));
        }
    }
    EXPECT_GT(merged, 20U);
    EXPECT_GT(refused, 5U);
    expectValid(mesh);
}

// The median over many merges: what was there is seen on the new patches.
TEST(MergeEdge, IsHardlySeen) {
    std::vector<double> changes;
    for (uint32_t e = 0; e < scene().connectivity().edgeCapacity(); e += 3) {
        PatchMesh mesh = scene();
        const auto touched = mergeEdge(mesh, EdgeId(e));
        if (touched) changes.push_back(meanColourChange(scene(), mesh, touched->patches));
    }
    ASSERT_GT(changes.size(), 30U);
    std::sort(changes.begin(), changes.end());
    const double median = changes[changes.size() / 2], high = changes[changes.size() * 9 / 10];
    std::printf("change by a merge in levels: median %.3f, nine in ten below %.3f\n", median, high);
    EXPECT_LT(median, 1);
    EXPECT_LT(high, 4);
}

TEST(MergeEdge, DoesNotBringColoursAcrossAFeature) {
    // Two colours with a feature between them in the middle of a grid: a merge on one side stays on it.
    PatchMesh mesh = gridMesh(60, 60, 6, 6);
    const HalfedgeMesh& c = mesh.connectivity();
    for (uint32_t j = 0; j < 6; ++j) {
        const EdgeId e = HalfedgeMesh::edge(c.find(VertexId(7 * j + 3), VertexId(7 * j + 10)));
        EdgeCurve curve = mesh.curve(e);
        curve.feature = true;
        mesh.setCurve(e, curve);
    }
    mesh.forEachPatch([&](PatchId p) {
        const float value = controlBounds(mesh, p).max.x <= 30 ? .2F : .8F;
        mesh.setSpline(p, constantSpline(std::array{value, value, value}));
    });
    // From beside the feature onto it.
    const EdgeId e = HalfedgeMesh::edge(c.find(VertexId(7 * 3 + 2), VertexId(7 * 3 + 3)));
    const PatchMesh before = mesh;
    const auto touched = mergeEdge(mesh, e);
    ASSERT_TRUE(touched) << touched.error().message;
    EXPECT_LT(meanColourChange(before, mesh, touched->patches), .01);
}

TEST(MeanColourChange, SeesAPaintedPatch) {
    PatchMesh mesh = scene();
    EXPECT_EQ(meanColourChange(scene(), mesh, {PatchId(5)}), 0);
    mesh.setSpline(PatchId(5), constantSpline(std::array{1.F, 0.F, 0.F}));
    EXPECT_GT(meanColourChange(scene(), mesh, {PatchId(5)}), 20);
}

TEST(MergeEdge, UndoesASplit) {
    PatchMesh mesh = scene();
    const auto split = splitPatch(mesh, PatchId(50), Barycentric(1.0 / 3));
    ASSERT_TRUE(split);
    const auto merged = mergeEdge(mesh, split->edges[0]);
    ASSERT_TRUE(merged) << merged.error().message;
    EXPECT_EQ(mesh.patchCount(), scene().patchCount());
    expectValid(mesh);
    EXPECT_LT(meanColourChange(scene(), mesh, merged->patches), 1);
}

TEST(CarriedOver, FollowsSplitsAndMerges) {
    PatchMesh mesh = scene();
    const PatchSet set{PatchId(40), PatchId(41), PatchId(50)};
    PatchMesh before = mesh;
    ASSERT_TRUE(splitPatch(mesh, PatchId(50), Barycentric(1.0 / 3)));
    const PatchSet split = carriedOver(before, mesh, set);
    const auto capacity = uint32_t(before.connectivity().faceCapacity());
    EXPECT_EQ(split,
              (PatchSet{PatchId(40), PatchId(41), PatchId(50), PatchId(capacity), PatchId(capacity + 1)}));
    before = mesh;
    ASSERT_TRUE(splitPatch(mesh, PatchId(60), Barycentric(1.0 / 3)));
    EXPECT_EQ(carriedOver(before, mesh, split), split);
    before = mesh;
    EdgeId inside;
    for (const HalfedgeId side : mesh.connectivity().sides(PatchId(capacity)))
        if (contains(split, mesh.connectivity().face(HalfedgeMesh::twin(side))))
            inside = HalfedgeMesh::edge(side);
    ASSERT_TRUE(mergeEdge(mesh, inside));
    EXPECT_EQ(carriedOver(before, mesh, split).size(), split.size() - 2);
}

TEST(CarriedOver, TheWaysThereAndBackAreTheSame) {
    PatchMesh mesh = scene();
    const PatchMesh before = mesh;
    PatchSet all, even, parts;
    before.forEachPatch([&](PatchId p) { all.push_back(p); });
    for (const PatchId p : all)
        if (p.index % 2 == 0) even.push_back(p);
    const PatchQuery query(before);
    size_t splits = 0;
    for (const PatchId p : all) splits += splitPatch(mesh, p, Barycentric(1. / 3)).has_value() ? 1 : 0;
    ASSERT_GT(splits, all.size() / 2);
    mesh.forEachPatch([&](PatchId p) {
        const auto whole = query.patchAt(evaluate(toPixels(mesh.controlPoints(p)), Barycentric(1. / 3)));
        if (whole.value().patch.index % 2 == 0) parts.push_back(p);
    });
    EXPECT_EQ(carriedOver(before, mesh, even), parts);
    EXPECT_EQ(carriedOver(mesh, before, parts), even);
    EXPECT_EQ(carriedOver(before, mesh, all).size(), mesh.patchCount());
    EXPECT_TRUE(carriedOver(before, mesh, {}).empty());
}

}  // namespace
}  // namespace tessera
