// Dragging of points and curves: certified at every moment, as far as it goes, and smooth joins stay smooth.
#include "core/edit/reshape.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "core/edit/blur_room.h"
#include "core/edit/edge_edits.h"
#include "core/edit/split_merge.h"
#include "core/mesh/jacobian.h"
#include "tests/support/edit_meshes.h"
#include "tests/support/test_meshes.h"

namespace tessera {
namespace {

using testing::changedPatches;
using ::testing::ElementsAreArray;
using testing::expectValid;
using testing::gridMesh;
using ::testing::IsSupersetOf;
using testing::sameMesh;
using testing::sceneMesh;

const PatchMesh& scene() {
    static const PatchMesh mesh = sceneMesh();
    return mesh;
}

VertexId vertexAt(const PatchMesh& mesh, double x, double y) {
    VertexId found;
    mesh.forEachVertex([&](VertexId v) {
        if (mesh.position(v) == toLattice({x, y})) found = v;
    });
    return found;
}

glm::dvec2 at(const PatchMesh& mesh, VertexId v) {
    return toPixels(mesh.position(v));
}

TEST(ShapeDrag, GoesAllTheWayWhereNothingFolds) {
    const PatchMesh start = gridMesh(80, 80, 4, 4);
    PatchMesh mesh = start;
    const VertexId v = vertexAt(mesh, 40, 40);
    const ShapeDrag drag(start, {ControlPointRef::of(v)});
    const DragResult result = drag.drag(mesh, {6.5, -3.25});
    EXPECT_EQ(result.fraction, 1);
    EXPECT_FALSE(result.blocking);
    EXPECT_EQ(at(mesh, v), glm::dvec2(46.5, 36.75));
    EXPECT_EQ(drag.patches().size(), 6U);
    EXPECT_THAT(changedPatches(start, mesh), ElementsAreArray(drag.patches()));
    EXPECT_EQ(result.touched.patches, drag.patches());
    // Straight edges stay straight, and the interior points are the usual ones.
    mesh.connectivity().forEachOutgoing(v, [&](HalfedgeId h) {
        const auto p = mesh.controlPoints(h);
        EXPECT_EQ(straightControlPoints(p[0], p[3]), (std::array{p[1], p[2]}));
    });
    for (const PatchId p : drag.patches()) {
        const glm::dvec2 usual = defaultInterior(toPixels(mesh.controlPoints(p)));
        EXPECT_LT(glm::distance(usual, toPixels(mesh.interior(p))), .01);
    }
    expectValid(mesh);
    drag.drag(mesh, {0, 0});
    EXPECT_TRUE(sameMesh(mesh, start));
}

TEST(ShapeDrag, StopsBeforeAFoldAndSaysWhichPatch) {
    const PatchMesh start = gridMesh(80, 80, 4, 4);
    PatchMesh mesh = start;
    const VertexId v = vertexAt(mesh, 40, 40);
    const ShapeDrag drag(start, {ControlPointRef::of(v)});
    // Straight on to the neighbour (60, 40): the patches fold as it gets there.
    const DragResult result = drag.drag(mesh, {35, 0});
    EXPECT_LT(result.fraction, 20.0 / 35);
    EXPECT_GT(result.fraction, 19.5 / 35);
    ASSERT_TRUE(result.blocking);
    EXPECT_TRUE(contains(drag.patches(), *result.blocking));
    expectValid(mesh);
    // A little farther the blocking patch is not certified.
    PatchMesh beyond = start;
    for (const PatchId p : drag.patches()) EXPECT_TRUE(certified(mesh.controlPoints(p)));
    beyond.setPosition(v, toLattice({60.1, 40}));
    EXPECT_FALSE(certified(beyond.controlPoints(*result.blocking)));
}

TEST(ShapeDrag, SlidesAlongTheLimit) {
    const PatchMesh start = gridMesh(80, 80, 4, 4);
    PatchMesh mesh = start;
    const VertexId v = vertexAt(mesh, 40, 40);
    const ShapeDrag drag(start, {ControlPointRef::of(v)});
    const glm::dvec2 goal(30, 14);
    const DragResult result = drag.drag(mesh, goal);
    ASSERT_LT(result.fraction, 1);
    const double stopped = glm::distance(result.fraction * goal, goal),
                 slid = glm::distance(at(mesh, v) - glm::dvec2(40), goal);
    EXPECT_LT(slid, stopped - .5);
    expectValid(mesh);
    PatchMesh again = start;
    drag.drag(again, {1, 2});
    drag.drag(again, goal);
    EXPECT_TRUE(sameMesh(mesh, again));
}

TEST(ShapeDrag, TheBorderSlidesAndCornersStay) {
    const PatchMesh start = gridMesh(80, 80, 4, 4);
    PatchMesh mesh = start;
    const VertexId side = vertexAt(mesh, 40, 0), corner = vertexAt(mesh, 0, 0);
    ShapeDrag(start, {ControlPointRef::of(side)}).drag(mesh, {5, 7});
    EXPECT_EQ(at(mesh, side), glm::dvec2(45, 0));
    expectValid(mesh);
    mesh = start;
    ShapeDrag(start, {ControlPointRef::of(corner)}).drag(mesh, {5, 7});
    EXPECT_TRUE(sameMesh(mesh, start));
}

// The scene with its features cut in two, which makes joins.
PatchMesh joinedScene() {
    PatchMesh mesh = scene();
    for (uint32_t e = 0; e < scene().connectivity().edgeCapacity(); ++e)
        if (mesh.curve(EdgeId(e)).feature) splitEdge(mesh, EdgeId(e), .5);
    return mesh;
}

TEST(ShapeDrag, JoinsStaySmoothUnlessBroken) {
    const PatchMesh start = joinedScene();
    ASSERT_FALSE(start.smoothJoins().empty());
    int turned = 0;
    for (const SmoothJoin& join : start.smoothJoins()) {
        HalfedgeId h = HalfedgeMesh::halfedge(join.first);
        if (start.connectivity().origin(h) != join.vertex) h = HalfedgeMesh::twin(h);
        PatchMesh mesh = start;
        const ShapeDrag drag(start, {ControlPointRef::of(h)});
        const DragResult result = drag.drag(mesh, {1.5, 1});
        EXPECT_TRUE(isSmooth(mesh, join));
        EXPECT_EQ(mesh.smoothJoins(), start.smoothJoins());
        turned += result.fraction == 1;
        for (const PatchId p : drag.patches()) EXPECT_TRUE(certified(mesh.controlPoints(p)));
        mesh = start;
        if (drag.drag(mesh, {1.5, 1}, true).fraction == 1) {
            EXPECT_EQ(mesh.smoothJoins().size() + 1, start.smoothJoins().size());
            const HalfedgeId other = HalfedgeMesh::halfedge(join.second);
            EXPECT_EQ(mesh.controlPoints(other), start.controlPoints(other));
        }
    }
    EXPECT_GT(turned, 3);
}

// Features of the default method are smooth without being known as joins.
TEST(ShapeDrag, NearlyStraightFeaturesTurnTogether) {
    PatchMesh start = joinedScene();
    const std::vector<SmoothJoin> joins = start.smoothJoins();
    start.setSmoothJoins({});
    int turned = 0;
    for (const SmoothJoin& join : joins) {
        HalfedgeId h = HalfedgeMesh::halfedge(join.first);
        if (start.connectivity().origin(h) != join.vertex) h = HalfedgeMesh::twin(h);
        PatchMesh mesh = start;
        if (ShapeDrag(start, {ControlPointRef::of(h)}).drag(mesh, {1, .7}).fraction < 1) continue;
        EXPECT_TRUE(isSmooth(mesh, join));
        ++turned;
    }
    EXPECT_GT(turned, 3);
}

TEST(ShapeDrag, BendingMovesTheCurvesPoint) {
    const PatchMesh start = gridMesh(80, 80, 4, 4);
    const VertexId a = vertexAt(start, 20, 40), b = vertexAt(start, 40, 40);
    const EdgeId e = HalfedgeMesh::edge(start.connectivity().find(a, b));
    for (const double t : {.3, .5, .8}) {
        PatchMesh mesh = start;
        EXPECT_EQ(ShapeDrag::bend(start, e, t).drag(mesh, {.5, 2}).fraction, 1);
        const BezierCurve before = toPixels(start.controlPoints(HalfedgeMesh::halfedge(e))),
                          after = toPixels(mesh.controlPoints(HalfedgeMesh::halfedge(e)));
        EXPECT_LT(glm::distance(after.at(t), before.at(t) + glm::dvec2(.5, 2)), .01);
        EXPECT_EQ(after.p[0], before.p[0]);
        expectValid(mesh);
    }
}

TEST(ShapeDrag, AWholeRegionMovesAsOne) {
    const PatchMesh start = gridMesh(160, 160, 8, 8);
    std::vector<ControlPointRef> points;
    start.forEachVertex([&](VertexId v) {
        const glm::dvec2 p = at(start, v);
        if (glm::distance(p, {80, 80}) < 45) points.push_back(ControlPointRef::of(v));
    });
    PatchMesh mesh = start;
    const ShapeDrag drag(start, points);
    EXPECT_EQ(drag.drag(mesh, {5, 4}).fraction, 1);
    EXPECT_EQ(at(mesh, points[3].vertex), at(start, points[3].vertex) + glm::dvec2(5, 4));
    expectValid(mesh);
    EXPECT_LT(drag.drag(mesh, {60, 0}).fraction, .5);
    expectValid(mesh);
}

TEST(ShapeDrag, LockedPatchesBlock) {
    PatchMesh start = gridMesh(80, 80, 4, 4);
    const VertexId v = vertexAt(start, 40, 40);
    const PatchId locked = start.connectivity().face(start.connectivity().halfedge(v));
    start.setAttributes(locked, {false, true, false});
    PatchMesh mesh = start;
    const DragResult result = ShapeDrag(start, {ControlPointRef::of(v)}).drag(mesh, {3, 3});
    EXPECT_EQ(result.fraction, 0);
    EXPECT_EQ(result.blocking, locked);
    EXPECT_TRUE(sameMesh(mesh, start));
}

TEST(ShapeDrag, RandomDragsOnAVectorizedPictureStayValid) {
    const unsigned seed = 71;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> way(-25, 25);
    PatchMesh mesh = scene();
    const HalfedgeMesh& c = mesh.connectivity();
    int full = 0, blocked = 0;
    for (int i = 0; i < 300; ++i) {
        const PatchMesh start = mesh;
        const auto pick = [&](size_t count) { return uint32_t(random() % count); };
        const glm::dvec2 offset(way(random), way(random));
        const int kind = int(random() % 4);
        const EdgeId e(pick(c.edgeCapacity()));
        const DragResult result =
            kind == 0 ? ShapeDrag(start, {ControlPointRef::of(VertexId(pick(c.vertexCapacity())))})
                            .drag(mesh, offset)
            : kind == 1 ? ShapeDrag(start, {ControlPointRef::of(HalfedgeId(pick(2 * c.edgeCapacity())))})
                              .drag(mesh, .3 * offset, random() % 4 == 0)
            : kind == 2 ? ShapeDrag::bend(start, e, .4).drag(mesh, .3 * offset)
                        : ShapeDrag(start, controlPointsOf(start, e)).drag(mesh, .5 * offset);
        (result.fraction == 1 ? full : blocked)++;
        EXPECT_THAT(result.touched.patches, IsSupersetOf(changedPatches(start, mesh)));
        if (i % 50 == 49) expectValid(mesh);
    }
    EXPECT_GT(full, 30);
    EXPECT_GT(blocked, 30);
    expectValid(mesh);
}

TEST(MovePoints, GoesACommonShareOfAllWays) {
    const PatchMesh start = gridMesh(80, 80, 4, 4);
    PatchMesh mesh = start;
    const VertexId a = vertexAt(mesh, 20, 20), b = vertexAt(mesh, 60, 60);
    const std::array moves{PointMove{ControlPointRef::of(a), {24, 22}},
                           PointMove{ControlPointRef::of(b), {55, 60}}};
    EXPECT_EQ(movePoints(mesh, moves).fraction, 1);
    EXPECT_EQ(at(mesh, a), glm::dvec2(24, 22));
    EXPECT_EQ(at(mesh, b), glm::dvec2(55, 60));
    const std::array far{PointMove{ControlPointRef::of(a), {64, 22}},
                         PointMove{ControlPointRef::of(b), {55, 62}}};
    const DragResult result = movePoints(mesh, far);
    EXPECT_LT(result.fraction, .6);
    EXPECT_NEAR(at(mesh, b).y, 60 + 2 * result.fraction, .01);
    expectValid(mesh);
}

TEST(ResetShape, BringsBackTheFittedShape) {
    PatchMesh mesh = scene();
    std::vector<VertexId> inner;
    mesh.forEachVertex([&](VertexId v) {
        if (!mesh.connectivity().onBorder(v)) inner.push_back(v);
    });
    for (size_t i = 0; i < inner.size(); i += 5) {
        const PatchMesh start = mesh;
        ShapeDrag(start, {ControlPointRef::of(inner[i])}).drag(mesh, {3, -2}, i % 2 == 0);
    }
    EXPECT_FALSE(sameMesh(mesh, scene()));
    PatchMesh part = mesh;
    const Touched touched = resetShape(part, scene(), {PatchId(20), PatchId(21), PatchId(22)});
    EXPECT_THAT(touched.patches, ElementsAreArray(changedPatches(mesh, part)));
    expectValid(part);
    resetShape(mesh, scene(), allSelectable(mesh));
    EXPECT_EQ(changedPatches(mesh, scene()).size(), 0U);
    EXPECT_EQ(mesh.smoothJoins().size(), scene().smoothJoins().size());
    expectValid(mesh);
}

TEST(SetBlur, RunsAlongAPath) {
    PatchMesh mesh = gridMesh(80, 80, 4, 4);
    const HalfedgeMesh& c = mesh.connectivity();
    std::vector<EdgeId> path;
    for (int i = 0; i < 3; ++i)
        path.push_back(HalfedgeMesh::edge(
            c.find(vertexAt(mesh, 10 + 20 * i + 10, 40), vertexAt(mesh, 10 + 20 * i + 30, 40))));
    const EdgeId last = HalfedgeMesh::edge(c.find(vertexAt(mesh, 0, 40), vertexAt(mesh, 20, 40)));
    path.insert(path.begin(), last);
    EXPECT_FALSE(setBlur(mesh, path, 0, 4));
    ASSERT_TRUE(setFeature(mesh, path, true));
    ASSERT_TRUE(setBlur(mesh, path, 0, 4));
    for (size_t i = 0; i < path.size(); ++i) {
        const HalfedgeId h = HalfedgeMesh::halfedge(path[i]);
        const auto& sigma = mesh.curve(path[i]).blurSigma;
        EXPECT_NEAR(double(sigma[0]), at(mesh, c.origin(h)).x / 20, 1e-6);
        EXPECT_NEAR(double(sigma[1]), at(mesh, c.target(h)).x / 20, 1e-6);
    }
    std::swap(path[0], path[2]);
    EXPECT_FALSE(setBlur(mesh, path, 0, 4));
    EXPECT_TRUE(setBlur(mesh, path, 2, 2));
    EXPECT_FALSE(setBlur(mesh, path, -1, -1));
    EXPECT_FALSE(setBlur(mesh, path, 65, 65));
    expectValid(mesh);
}

// Marks a part of the grid's column at x as a feature.
std::vector<EdgeId> column(PatchMesh& mesh, double x, double from, double to) {
    std::vector<EdgeId> edges;
    for (double y = from; y < to; y += 20)
        edges.push_back(
            HalfedgeMesh::edge(mesh.connectivity().find(vertexAt(mesh, x, y), vertexAt(mesh, x, y + 20))));
    EXPECT_TRUE(setFeature(mesh, edges, true));
    return edges;
}

TEST(BlurRoom, IsAThirdOfTheDistanceToTheNextFeature) {
    PatchMesh mesh = gridMesh(400, 200, 20, 10);
    const std::vector<EdgeId> feature = column(mesh, 100, 0, 200);
    for (const auto& ends : blurRoom(PatchQuery(mesh), feature))
        EXPECT_THAT(ends, ::testing::Each(kWidestBlurPx)) << "nothing else is there";
    column(mesh, 160, 0, 100);
    const auto room = blurRoom(PatchQuery(mesh), feature);
    for (size_t i = 0; i < feature.size(); ++i) {
        const HalfedgeId h = HalfedgeMesh::halfedge(feature[i]);
        for (const size_t end : {size_t(0), size_t(1)}) {
            const double y =
                at(mesh, end == 0 ? mesh.connectivity().origin(h) : mesh.connectivity().target(h)).y;
            // What is nearest of the half is its end beyond that, 10 px nearer from the middle of a curve.
            const double beyond = std::max(0., y - 10 - 100);
            EXPECT_NEAR(room[i][end], std::hypot(60, beyond) / 3, 1e-6) << "at " << y;
        }
    }
    ASSERT_TRUE(setBlur(mesh, feature, 50, 50, room));
    EXPECT_NEAR(double(mesh.curve(feature[0]).blurSigma[0]), 20, 1e-6);
    ASSERT_TRUE(setBlur(mesh, feature, 50, 50));
    ASSERT_TRUE(setBlur(mesh, feature, 40, 40, room)) << "what is softer already may be made sharper";
    EXPECT_EQ(mesh.curve(feature[0]).blurSigma[0], 40);
}

TEST(BlurRoom, GrowsWithTheWayToAJunctionOrATip) {
    PatchMesh mesh = gridMesh(400, 200, 20, 10);
    const std::vector<EdgeId> down = column(mesh, 100, 0, 200);
    std::vector<EdgeId> across;
    for (double x = 100; x < 300; x += 20)
        across.push_back(HalfedgeMesh::edge(
            mesh.connectivity().find(vertexAt(mesh, x, 100), vertexAt(mesh, x + 20, 100))));
    ASSERT_TRUE(setFeature(mesh, across, true));
    const auto beside = [](double y) { return std::max(std::abs(y - 100) - 10, 10.) / kBlurFade; };
    const auto room = blurRoom(PatchQuery(mesh), down);
    for (size_t i = 0; i < down.size(); ++i) {
        const HalfedgeId h = HalfedgeMesh::halfedge(down[i]);
        EXPECT_NEAR(room[i][0], beside(at(mesh, mesh.connectivity().origin(h)).y), 1e-6);
        EXPECT_NEAR(room[i][1], beside(at(mesh, mesh.connectivity().target(h)).y), 1e-6);
    }
    // From the junction to a tip: wide in the middle.
    const auto toTip = blurRoom(PatchQuery(mesh), across);
    for (size_t i = 0; i < across.size(); ++i) {
        const double fromMiddle = std::abs(double(i) + .5 - 5) - .5;  // curves
        EXPECT_NEAR(std::max(toTip[i][0], toTip[i][1]), (90 - 20 * fromMiddle) / kBlurFade, 1e-6) << i;
    }
}

TEST(SetFeature, AnUnmarkedOneWithAJumpIsAColourBreak) {
    PatchMesh mesh = scene();
    std::vector<EdgeId> features;
    EdgeId border;
    mesh.forEachEdge([&](EdgeId e) {
        if (mesh.curve(e).feature) features.push_back(e);
        if (mesh.connectivity().onBorder(e)) border = e;
    });
    const Result<Touched> touched = setFeature(mesh, features, false);
    ASSERT_TRUE(touched);
    EXPECT_EQ(touched->edges, features);
    size_t breaks = 0;
    mesh.forEachEdge([&](EdgeId e) {
        EXPECT_FALSE(mesh.curve(e).feature);
        breaks += mesh.curve(e).colourBreak;
    });
    EXPECT_GT(breaks, features.size() / 2);
    EXPECT_TRUE(mesh.smoothJoins().empty());
    expectValid(mesh);
    ASSERT_TRUE(setFeature(mesh, features, true));
    mesh.forEachEdge([&](EdgeId e) { EXPECT_FALSE(mesh.curve(e).colourBreak); });
    EXPECT_FALSE(setFeature(mesh, std::array{border}, true));
    expectValid(mesh);
}

}  // namespace
}  // namespace tessera
