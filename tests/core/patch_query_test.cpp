// Queries against exhaustive search.
#include "core/mesh/patch_query.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "tests/support/test_meshes.h"

namespace tessera {
namespace {

struct PatchQueryTest : ::testing::Test {
    PatchMesh mesh = testing::curvedMesh(120, 80, 7, 5, 11);
    PatchQuery query{mesh};
    std::mt19937 random{1};

    glm::dvec2 randomPoint(double margin = 0) {
        std::uniform_real_distribution<double> x(-margin, 120 + margin), y(-margin, 80 + margin);
        return {x(random), y(random)};
    }
};

TEST_F(PatchQueryTest, InvertFindsTheParametersOfEveryPoint) {
    mesh.forEachPatch([&](PatchId p) {
        const BezierTriangle t = toPixels(mesh.controlPoints(p));
        for (int j = 0; j <= 8; ++j)
            for (int k = 0; j + k <= 8; ++k) {
                const Barycentric b(1 - (j + k) / 8.0, j / 8.0, k / 8.0);
                const auto found = invert(t, evaluate(t, b));
                ASSERT_TRUE(found);
                EXPECT_LT(glm::distance(*found, b), 1e-6);
            }
    });
}

TEST_F(PatchQueryTest, InvertOutsideIsARootOrNothing) {
    const BezierTriangle t = toPixels(mesh.controlPoints(PatchId(20)));
    for (int i = 0; i < 500; ++i) {
        const glm::dvec2 point = randomPoint(20);
        if (const auto b = invert(t, point)) {
            EXPECT_LT(glm::distance(evaluate(t, *b), point), 1e-6);
            EXPECT_NEAR(b->x + b->y + b->z, 1, 1e-9);
        }
    }
    EXPECT_FALSE(invert(BezierTriangle{}, {1, 1}));
}

TEST_F(PatchQueryTest, NearestParametersAreInTheDomainAndNear) {
    for (int i = 0; i < 300; ++i) {
        const PatchId p(uint32_t(i) % uint32_t(mesh.patchCount()));
        const BezierTriangle t = toPixels(mesh.controlPoints(p));
        const glm::dvec2 point = randomPoint(5);
        const Barycentric b = nearestParameters(t, point, .01);
        EXPECT_GE(std::min({b.x, b.y, b.z}), 0);
        double nearest = 1e9;
        for (int s = 0; s < 3; ++s)
            nearest = std::min(nearest, nearestOnCurve(BezierCurve{t.side(s)}, point).distance);
        EXPECT_LE(glm::distance(evaluate(t, b), point), nearest + .01);
    }
}

TEST_F(PatchQueryTest, PatchAtHoldsThePoint) {
    for (int i = 0; i < 2000; ++i) {
        const glm::dvec2 point = randomPoint();
        const auto hit = query.patchAt(point);
        ASSERT_TRUE(hit);
        EXPECT_LT(glm::distance(evaluate(toPixels(mesh.controlPoints(hit->patch)), hit->at), point), 1e-6);
        EXPECT_GE(std::min({hit->at.x, hit->at.y, hit->at.z}), -1e-6);
    }
    EXPECT_FALSE(query.patchAt({-.001, 10}));
    EXPECT_FALSE(query.patchAt({10, 80.001}));
    EXPECT_FALSE(query.patchAt({NAN, 1}));
    for (const glm::dvec2 corner : {glm::dvec2(0, 0), {120, 0}, {120, 80}, {0, 80}})
        EXPECT_TRUE(query.patchAt(corner));
}

TEST_F(PatchQueryTest, OnASharedEdgeTheSmallerIdWins) {
    const HalfedgeMesh& c = mesh.connectivity();
    mesh.forEachEdge([&](EdgeId e) {
        if (c.onBorder(e)) return;
        const HalfedgeId h = HalfedgeMesh::halfedge(e);
        for (const double t : {.25, .5, .75}) {
            const auto hit = query.patchAt(toPixels(mesh.controlPoints(h)).at(t));
            ASSERT_TRUE(hit);
            EXPECT_EQ(hit->patch, std::min(c.face(h), c.face(HalfedgeMesh::twin(h))));
        }
    });
}

TEST_F(PatchQueryTest, PatchesInARectangle) {
    for (int i = 0; i < 200; ++i) {
        const glm::dvec2 a = randomPoint(30), b = randomPoint(30);
        const Rect rect{glm::min(a, b), glm::max(a, b)};
        std::vector<PatchId> expected;
        mesh.forEachPatch([&](PatchId p) {
            const Rect box = controlBounds(mesh, p);
            if (box.min.x <= rect.max.x && rect.min.x <= box.max.x && box.min.y <= rect.max.y &&
                rect.min.y <= box.max.y)
                expected.push_back(p);
        });
        EXPECT_EQ(query.patchesIn(rect), expected);
    }
}

TEST_F(PatchQueryTest, PatchesInAPolygon) {
    const std::vector<glm::dvec2> all{{-1, -1}, {121, -1}, {121, 81}, {-1, 81}};
    EXPECT_EQ(query.patchesInPolygon(all).size(), mesh.patchCount());
    EXPECT_TRUE(query.patchesInPolygon(std::vector<glm::dvec2>{{0, 0}, {9, 9}}).empty());
    // A ring of even-odd winding: the patches of the hole are not in it.
    std::vector<glm::dvec2> ring = all;
    ring.push_back(all[0]);
    const std::vector<glm::dvec2> hole{{30, 20}, {90, 20}, {90, 60}, {30, 60}, {30, 20}};
    ring.insert(ring.end(), hole.begin(), hole.end());
    const size_t inHole = query.patchesInPolygon(hole).size();
    EXPECT_GT(inHole, 0u);
    EXPECT_EQ(query.patchesInPolygon(ring).size(), mesh.patchCount() - inHole);
}

TEST_F(PatchQueryTest, NearestControlPoint) {
    using Kind = ControlPointHit::Kind;
    const HalfedgeMesh& c = mesh.connectivity();
    mesh.forEachVertex([&](VertexId v) {
        const auto hit = query.nearestControlPoint(toPixels(mesh.position(v)) + glm::dvec2(.01, 0), 1);
        ASSERT_TRUE(hit);
        EXPECT_EQ(hit->kind, Kind::Vertex);
        EXPECT_EQ(hit->vertex, v);
    });
    mesh.forEachEdge([&](EdgeId e) {
        for (const HalfedgeId h :
             {HalfedgeMesh::halfedge(e), HalfedgeMesh::twin(HalfedgeMesh::halfedge(e))}) {
            const auto hit = query.nearestControlPoint(toPixels(mesh.controlPoints(h)[1]), .5);
            ASSERT_TRUE(hit);
            EXPECT_EQ(hit->distance, 0);
            if (hit->kind == Kind::CurveInner) {
                EXPECT_EQ(hit->halfedge, h);
            }
        }
    });
    const auto interior = query.nearestControlPoint(toPixels(mesh.interior(PatchId(9))), .5);
    ASSERT_TRUE(interior);
    EXPECT_EQ(interior->patch, PatchId(9));
    EXPECT_FALSE(query.nearestControlPoint({-50, -50}, 10));
    // Border points reach past the picture too.
    EXPECT_TRUE(query.nearestControlPoint({-3, -3}, 5));
    EXPECT_EQ(c.origin(c.halfedge(VertexId(0))), VertexId(0));
}

TEST_F(PatchQueryTest, NearestCurve) {
    for (int i = 0; i < 300; ++i) {
        const glm::dvec2 point = randomPoint(3);
        std::optional<CurveHit> expected;
        mesh.forEachEdge([&](EdgeId e) {
            const CurveFoot foot =
                nearestOnCurve(toPixels(mesh.controlPoints(HalfedgeMesh::halfedge(e))), point);
            if (foot.distance <= 4 && (!expected || foot.distance < expected->distance))
                expected = CurveHit{e, foot.t, foot.distance};
        });
        const auto hit = query.nearestCurve(point, 4);
        ASSERT_EQ(hit.has_value(), expected.has_value());
        if (!hit) continue;
        EXPECT_EQ(hit->edge, expected->edge);
        EXPECT_EQ(hit->distance, expected->distance);
    }
}

}  // namespace
}  // namespace tessera
