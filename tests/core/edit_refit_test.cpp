// Colours fitted anew to the photo, and curves snapped to its edges.
#include "core/edit/refit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "core/edit/drag_colour.h"
#include "core/edit/edge_edits.h"
#include "core/edit/recolour.h"
#include "core/edit/reshape.h"
#include "core/edit/snap.h"
#include "core/export/rasterize.h"
#include "tests/support/edit_meshes.h"
#include "tests/support/painted_image.h"
#include "tests/support/test_meshes.h"

namespace tessera {
namespace {

using testing::changedPatches;
using testing::curvedMesh;
using testing::editScene;
using ::testing::ElementsAreArray;
using testing::expectValid;
using testing::gridMesh;
using testing::paint;
using testing::sceneMesh;

const PatchMesh& scene() {
    static const PatchMesh mesh = sceneMesh();
    return mesh;
}

const Image& photo() {
    static const Image image = editScene(200, 150);
    return image;
}

// Root mean square difference from the photo over the pixels of some patches, in levels.
double errorOver(const PatchMesh& mesh, const Image& image, const PatchSet& set) {
    const View view = wholePicture(mesh, {1, 1});
    const auto picture = rasterize(mesh, view, {4, 1});
    const auto owners = locatePixels(mesh, view);
    double sum = 0;
    size_t count = 0;
    for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x) {
            if (!contains(set, owners[size_t(y) * size_t(view.width) + size_t(x)].patch)) continue;
            for (int c = 0; c < mesh.channels(); ++c) {
                const double off = 255 * double(picture->at(x, y, c) - image.at(x, y, c));
                sum += off * off;
                ++count;
            }
        }
    return std::sqrt(sum / double(std::max<size_t>(1, count)));
}

TEST(RefitColours, MendsWhatAReshapeLeaves) {
    const PatchMesh start = scene();
    const glm::dvec2 offset{5, 3};
    // A vertex off features whose drag is seen.
    VertexId v;
    start.forEachVertex([&](VertexId candidate) {
        bool free = !v.valid() && !start.connectivity().onBorder(candidate);
        start.connectivity().forEachOutgoing(
            candidate, [&](HalfedgeId h) { free = free && !start.curve(HalfedgeMesh::edge(h)).feature; });
        if (!free) return;
        PatchMesh moved = start;
        const ShapeDrag drag(start, {ControlPointRef::of(candidate)});
        drag.drag(moved, offset);
        if (errorOver(moved, photo(), drag.patches()) > 3 * errorOver(start, photo(), drag.patches()))
            v = candidate;
    });
    ASSERT_TRUE(v.valid());
    PatchMesh mesh = start;
    const ShapeDrag drag(start, {ControlPointRef::of(v)});
    drag.drag(mesh, offset);
    const PatchMesh dragged = mesh;
    const double before = errorOver(mesh, photo(), drag.patches());
    const SeamStatistics seams = measureSeams(scene());
    const Touched touched = refitColours(mesh, photo(), drag.patches());
    EXPECT_THAT(touched.patches, ElementsAreArray(changedPatches(dragged, mesh)));
    EXPECT_LT(touched.patches.size(), 30U);
    EXPECT_GE(touched.patches.size(), drag.patches().size());
    const double after = errorOver(mesh, photo(), drag.patches());
    EXPECT_LT(after, .7 * before);
    EXPECT_LT(after, 1.6 * errorOver(scene(), photo(), drag.patches()) + .5);
    EXPECT_LE(measureSeams(mesh).mean, seams.mean + .2);
    EXPECT_LE(measureSeams(mesh).p95, seams.p95 + 1);
    expectValid(mesh);
}

// What has not been touched is a fixed point, nearly: the whole picture was solved by the same equations.
TEST(RefitColours, ChangesLittleWhereNothingWasWrong) {
    PatchMesh mesh = scene();
    const PatchSet set{PatchId(30), PatchId(31), PatchId(77)};
    refitColours(mesh, photo(), set);
    EXPECT_LE(errorOver(mesh, photo(), set), errorOver(scene(), photo(), set) * 1.25 + .3);
    expectValid(mesh);
}

TEST(RefitColours, LeavesLockedPatchesAndTakesOtherCentres) {
    PatchMesh mesh = curvedMesh(200, 150, 6, 5, 3);
    mesh.setAttributes(PatchId(12), {false, true, false});
    const PatchMesh before = mesh;
    const PatchSet set{PatchId(10), PatchId(11), PatchId(12), PatchId(13)};
    const Touched touched = refitColours(mesh, photo(), set);
    EXPECT_FALSE(contains(touched.patches, PatchId(12)));
    EXPECT_EQ(mesh.spline(PatchId(12)), before.spline(PatchId(12)));
    EXPECT_LT(errorOver(mesh, photo(), {PatchId(11)}), .5 * errorOver(before, photo(), {PatchId(11)}));
    expectValid(mesh);
}

TEST(RefitColours, StoppedAnywhereTheMeshIsAsItWas) {
    PatchSet all;
    scene().forEachPatch([&](PatchId p) { all.push_back(p); });
    for (const double share : {0., .05, .3, .6, .9}) {
        PatchMesh mesh = scene();
        std::stop_source stop;
        Progress progress(stop.get_token(), [&](std::string_view, double fraction, double) {
            if (fraction >= share) stop.request_stop();
        });
        if (share == 0) stop.request_stop();
        progress.beginStage("", 1);
        const auto touched = refitColours(mesh, photo(), all, ProgressPart(progress));
        ASSERT_FALSE(touched.has_value()) << share;
        EXPECT_EQ(touched.error().code, ErrorCode::Stopped);
        EXPECT_THAT(changedPatches(scene(), mesh), ::testing::IsEmpty()) << share;
    }
}

// A step along a circle, and a mesh whose line of features runs a few px beside it.
TEST(Snap, MovesCurvesOntoTheEdge) {
    const int size = 96;
    const Image step = paint(size, size, 3, [](double x, double y, int c) {
        const double edge = 52 + 4 * std::sin(.07 * y);
        const double share = .5 * (1 + std::erf((x - edge) / 1.4));
        return (c == 0 ? .2 : .6) * (1 - share) + (c == 0 ? .9 : .1) * share;
    });
    PatchMesh mesh = gridMesh(size, size, 4, 4);
    std::vector<EdgeId> line;
    mesh.forEachEdge([&](EdgeId e) {
        const auto p = toPixels(mesh.controlPoints(HalfedgeMesh::halfedge(e)));
        if (p.p[0].x == 48 && p.p[3].x == 48) line.push_back(e);
    });
    ASSERT_EQ(line.size(), 4U);
    ASSERT_TRUE(setFeature(mesh, line, true));
    const auto offEdge = [&] {
        double worst = 0;
        for (const EdgeId e : line) {
            const BezierCurve curve = toPixels(mesh.controlPoints(HalfedgeMesh::halfedge(e)));
            for (double t = .05; t < 1; t += .1) {
                const glm::dvec2 p = curve.at(t);
                worst = std::max(worst, std::abs(p.x - 52 - 4 * std::sin(.07 * p.y)));
            }
        }
        return worst;
    };
    EXPECT_GT(offEdge(), 4);
    const auto touched = snapToFeature(mesh, step, line);
    ASSERT_TRUE(touched) << touched.error().message;
    EXPECT_LT(offEdge(), .35);
    EXPECT_FALSE(touched->patches.empty());
    expectValid(mesh);
}

TEST(Snap, SaysWhereThereIsNoEdge) {
    const Image flat(96, 96, 3, .5F);
    PatchMesh mesh = gridMesh(96, 96, 4, 4);
    const auto touched = snapToFeature(mesh, flat, std::array{EdgeId(20)});
    ASSERT_FALSE(touched);
    EXPECT_EQ(touched.error().code, ErrorCode::Usage);
}

}  // namespace
}  // namespace tessera
