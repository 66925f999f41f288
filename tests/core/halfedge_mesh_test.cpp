// Half-edge connectivity on meshes of a few triangles: building, collapsing, flipping, compacting, and
// whether connectivityViolations() finds what is broken.
#include "core/mesh/halfedge_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "core/mesh/mesh_validate.h"

namespace tessera {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Triangles = std::vector<std::array<uint32_t, 3>>;

HalfedgeMesh make(size_t vertices, const Triangles& triangles) {
    return HalfedgeMesh::fromTriangles(vertices, triangles);
}

HalfedgeMesh square() {
    return make(4, {{0, 1, 2}, {0, 2, 3}});
}

// Vertex 0 inside a ring of the vertices 1 .. n.
HalfedgeMesh fan(uint32_t n) {
    Triangles triangles;
    for (uint32_t k = 0; k < n; ++k) triangles.push_back({0, 1 + k, 1 + (k + 1) % n});
    return make(n + 1, triangles);
}

// columns x rows cells of two triangles; vertex (i, j) is j (columns + 1) + i.
HalfedgeMesh grid(uint32_t columns, uint32_t rows) {
    Triangles triangles;
    for (uint32_t j = 0; j < rows; ++j)
        for (uint32_t i = 0; i < columns; ++i) {
            const uint32_t a = j * (columns + 1) + i, c = a + columns + 1;
            triangles.push_back({a, a + 1, c + 1});
            triangles.push_back({a, c + 1, c});
        }
    return make((columns + 1) * (rows + 1), triangles);
}

HalfedgeId between(const HalfedgeMesh& mesh, uint32_t a, uint32_t b) {
    return mesh.find(VertexId(a), VertexId(b));
}

// The faces' corners, each from its smallest, sorted: what a mesh is but for its ids.
Triangles facesOf(const HalfedgeMesh& mesh) {
    Triangles faces;
    for (uint32_t f = 0; f < mesh.faceCapacity(); ++f) {
        if (!mesh.alive(FaceId(f))) continue;
        const auto corners = mesh.corners(FaceId(f));
        std::array<uint32_t, 3> t{corners[0].index, corners[1].index, corners[2].index};
        std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
        faces.push_back(t);
    }
    std::sort(faces.begin(), faces.end());
    return faces;
}

int valence(const HalfedgeMesh& mesh, uint32_t v) {
    int count = 0;
    mesh.forEachOutgoing(VertexId(v), [&](HalfedgeId) { ++count; });
    return count;
}

TEST(HalfedgeMesh, SingleTriangle) {
    const HalfedgeMesh mesh = make(3, {{0, 1, 2}});
    EXPECT_THAT(connectivityViolations(mesh), IsEmpty());
    EXPECT_EQ(mesh.vertexCount(), 3U);
    EXPECT_EQ(mesh.edgeCount(), 3U);
    EXPECT_EQ(mesh.faceCount(), 1U);
    for (uint32_t v = 0; v < 3; ++v) EXPECT_TRUE(mesh.onBorder(VertexId(v)));
    for (uint32_t e = 0; e < 3; ++e) EXPECT_TRUE(mesh.onBorder(EdgeId(e)));
    const HalfedgeId h = between(mesh, 0, 1);
    ASSERT_TRUE(h.valid());
    EXPECT_EQ(mesh.target(mesh.next(h)), VertexId(2));
    EXPECT_EQ(mesh.origin(mesh.prev(h)), VertexId(2));
    EXPECT_EQ(mesh.face(h), FaceId(0));
    const HalfedgeId outside = HalfedgeMesh::twin(h);
    EXPECT_FALSE(mesh.face(outside).valid());
    EXPECT_EQ(mesh.target(mesh.next(outside)), VertexId(2)) << "the border runs against the face";
    EXPECT_EQ(mesh.next(mesh.prev(outside)), outside);
}

TEST(HalfedgeMesh, Square) {
    const HalfedgeMesh mesh = square();
    EXPECT_THAT(connectivityViolations(mesh), IsEmpty());
    EXPECT_EQ(mesh.edgeCount(), 5U);
    const EdgeId diagonal = HalfedgeMesh::edge(between(mesh, 0, 2));
    EXPECT_FALSE(mesh.onBorder(diagonal));
    EXPECT_EQ(mesh.face(between(mesh, 0, 2)), FaceId(1));
    EXPECT_EQ(mesh.face(between(mesh, 2, 0)), FaceId(0));
    EXPECT_FALSE(between(mesh, 1, 3).valid());
    EXPECT_EQ(mesh.corners(FaceId(1)), (std::array{VertexId(0), VertexId(2), VertexId(3)}));
}

TEST(HalfedgeMesh, Fan) {
    const HalfedgeMesh mesh = fan(5);
    EXPECT_THAT(connectivityViolations(mesh), IsEmpty());
    EXPECT_EQ(mesh.edgeCount(), 10U);
    EXPECT_FALSE(mesh.onBorder(VertexId(0)));
    EXPECT_EQ(valence(mesh, 0), 5);
    EXPECT_EQ(valence(mesh, 1), 3);
    // rotate() comes around the centre against the order of the faces.
    const HalfedgeId h = between(mesh, 0, 2);
    EXPECT_EQ(mesh.target(mesh.rotate(h)), VertexId(1));
}

TEST(HalfedgeMesh, VerticesWithoutFacesAreNotAlive) {
    const HalfedgeMesh mesh = make(5, {{0, 1, 2}});
    EXPECT_EQ(mesh.vertexCapacity(), 5U);
    EXPECT_EQ(mesh.vertexCount(), 3U);
    EXPECT_FALSE(mesh.alive(VertexId(4)));
    EXPECT_THAT(connectivityViolations(mesh), IsEmpty());
}

TEST(HalfedgeMeshDeathTest, RefusesWhatIsNoManifold) {
    EXPECT_DEATH(make(4, {{0, 1, 2}, {0, 1, 3}}), "check failed") << "one direction twice";
    EXPECT_DEATH(make(5, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}), "check failed") << "three faces at an edge";
    EXPECT_DEATH(make(5, {{0, 1, 2}, {0, 3, 4}}), "check failed") << "two faces that meet in a vertex alone";
    EXPECT_DEATH(make(3, {{0, 1, 1}}), "check failed");
    EXPECT_DEATH(make(3, {{0, 1, 3}}), "check failed");
}

TEST(Collapse, InteriorOntoRing) {
    HalfedgeMesh mesh = fan(6);
    ASSERT_TRUE(mesh.canCollapse(between(mesh, 0, 1)));
    const auto done = mesh.collapse(between(mesh, 0, 1));
    EXPECT_THAT(connectivityViolations(mesh), IsEmpty());
    EXPECT_EQ(facesOf(mesh), (Triangles{{1, 2, 3}, {1, 3, 4}, {1, 4, 5}, {1, 5, 6}}));
    EXPECT_FALSE(mesh.alive(VertexId(0)));
    EXPECT_EQ(mesh.vertexCount(), 6U);
    EXPECT_EQ(mesh.edgeCount(), 9U);
    // The edges 1-2 and 1-6 survive in place of 0-2 and 0-6.
    EXPECT_EQ(HalfedgeMesh::edge(done.merges[0].kept), HalfedgeMesh::edge(between(mesh, 1, 2)));
    EXPECT_EQ(HalfedgeMesh::edge(done.merges[1].kept), HalfedgeMesh::edge(between(mesh, 1, 6)));
    for (const auto& merge : done.merges) EXPECT_FALSE(mesh.alive(HalfedgeMesh::edge(merge.replaced)));
}

TEST(Collapse, RingOntoCentre) {
    HalfedgeMesh mesh = fan(5);
    ASSERT_TRUE(mesh.canCollapse(between(mesh, 1, 0)));
    mesh.collapse(between(mesh, 1, 0));
    EXPECT_THAT(connectivityViolations(mesh), IsEmpty());
    EXPECT_EQ(facesOf(mesh), (Triangles{{0, 2, 3}, {0, 3, 4}, {0, 4, 5}}));
    EXPECT_TRUE(mesh.onBorder(VertexId(0)));
}

TEST(Collapse, AlongTheBorder) {
    HalfedgeMesh mesh = fan(5);
    const HalfedgeId inner = between(mesh, 1, 2), outer = between(mesh, 2, 1);
    ASSERT_TRUE(mesh.face(inner).valid());
    ASSERT_FALSE(mesh.face(outer).valid());
    EXPECT_TRUE(mesh.canCollapse(outer));
    ASSERT_TRUE(mesh.canCollapse(inner));
    const auto done = mesh.collapse(inner);
    EXPECT_THAT(connectivityViolations(mesh), IsEmpty());
    EXPECT_EQ(facesOf(mesh), (Triangles{{0, 2, 3}, {0, 3, 4}, {0, 4, 5}, {0, 5, 2}}));
    EXPECT_TRUE(done.merges[0].kept.valid());
    EXPECT_FALSE(done.merges[1].kept.valid()) << "no face on that side";
    EXPECT_FALSE(done.merges[1].replaced.valid());
}

TEST(Collapse, AlongTheBorderFromOutside) {
    HalfedgeMesh mesh = fan(5);
    const auto done = mesh.collapse(between(mesh, 2, 1));
    EXPECT_THAT(connectivityViolations(mesh), IsEmpty());
    EXPECT_EQ(facesOf(mesh), (Triangles{{0, 1, 3}, {0, 3, 4}, {0, 4, 5}, {0, 5, 1}}));
    EXPECT_FALSE(done.merges[0].kept.valid());
    EXPECT_TRUE(done.merges[1].kept.valid());
}

TEST(Collapse, RefusesToPinchTheRegion) {
    const HalfedgeMesh mesh = square();
    EXPECT_FALSE(mesh.canCollapse(between(mesh, 0, 2)));
    EXPECT_FALSE(mesh.canCollapse(between(mesh, 2, 0)));
    // A strip of two squares: its middle edge joins border to border, too.
    const HalfedgeMesh strip = grid(2, 1);
    EXPECT_FALSE(strip.canCollapse(between(strip, 1, 4)));
}

TEST(Collapse, KeepsTwoFacesAtLeast) {
    const HalfedgeMesh triangle = make(3, {{0, 1, 2}}), two = square();
    EXPECT_FALSE(triangle.canCollapse(between(triangle, 0, 1)));
    for (const auto& [a, b] : {std::pair{0U, 1U}, {1U, 2U}, {2U, 3U}, {3U, 0U}}) {
        EXPECT_FALSE(two.canCollapse(between(two, a, b)));
        EXPECT_FALSE(two.canCollapse(between(two, b, a)));
    }
}

// Vertices 1 and 2 of the fan of three have the common neighbour 3 beyond the edge's own face.
TEST(Collapse, LinkConditionAtValenceThree) {
    HalfedgeMesh mesh = fan(3);
    EXPECT_FALSE(mesh.canCollapse(between(mesh, 1, 2)));
    EXPECT_FALSE(mesh.canCollapse(between(mesh, 2, 1)));
    ASSERT_TRUE(mesh.canCollapse(between(mesh, 0, 1)));
    mesh.collapse(between(mesh, 0, 1));
    EXPECT_THAT(connectivityViolations(mesh), IsEmpty());
    EXPECT_EQ(facesOf(mesh), (Triangles{{1, 2, 3}}));
}

TEST(Collapse, LinkConditionInside) {
    // A triangle (0, 1, 2) with vertex 3 inside it, in a ring: 0-1 has the opposite corners 3 and, outside,
    // 4; vertex 2 is a further common neighbour.
    HalfedgeMesh mesh = make(
        7,
        {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {1, 0, 4}, {2, 1, 5}, {0, 2, 6}, {0, 6, 4}, {1, 4, 5}, {2, 5, 6}});
    ASSERT_THAT(connectivityViolations(mesh), IsEmpty());
    EXPECT_FALSE(mesh.canCollapse(between(mesh, 0, 1)));
    EXPECT_TRUE(mesh.canCollapse(between(mesh, 3, 1)));
    mesh.collapse(between(mesh, 3, 1));
    EXPECT_THAT(connectivityViolations(mesh), IsEmpty());
    EXPECT_TRUE(mesh.canCollapse(between(mesh, 0, 1))) << "nothing stands in the way now";
    mesh.collapse(between(mesh, 0, 1));
    EXPECT_THAT(connectivityViolations(mesh), IsEmpty());
}

// The corner of a strip: its face's other two edges are both on the border, and would become an edge without
// a face.
TEST(Collapse, RefusesEdgesBesideAnEar) {
    const HalfedgeMesh mesh = make(5, {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}});
    EXPECT_FALSE(mesh.canCollapse(between(mesh, 0, 2)));
    EXPECT_TRUE(mesh.canCollapse(between(mesh, 2, 3)));
}

// The tip of the ear moves onto either of its neighbours, from inside or outside, whichever edge survives.
TEST(Collapse, TakesAnEarAway) {
    for (const auto& [from, to] : {std::pair{1U, 0U}, {1U, 2U}, {0U, 1U}})
        for (const bool first : {false, true})
            for (const bool second : {false, true}) {
                HalfedgeMesh mesh = make(5, {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}});
                ASSERT_TRUE(mesh.canCollapse(between(mesh, from, to)));
                mesh.collapse(between(mesh, from, to), {first, second});
                EXPECT_THAT(connectivityViolations(mesh), IsEmpty());
                const uint32_t left = from == 0 ? 1 : 0;
                const Triangles expected =
                    left == 0 ? Triangles{{0, 2, 3}, {0, 3, 4}} : Triangles{{1, 2, 3}, {1, 3, 4}};
                EXPECT_EQ(facesOf(mesh), expected);
            }
}

// Vertex 1 of the fan lies on the border, and so do its edges 1-2 and 1-5 that give way to those of the
// centre.
TEST(Collapse, KeepOriginWhereTheLostEdgesLieOnTheBorder) {
    for (const bool first : {false, true})
        for (const bool second : {false, true}) {
            HalfedgeMesh mesh = fan(5);
            mesh.collapse(between(mesh, 0, 1), {first, second});
            EXPECT_THAT(connectivityViolations(mesh), IsEmpty());
            EXPECT_EQ(facesOf(mesh), (Triangles{{1, 2, 3}, {1, 3, 4}, {1, 4, 5}}));
        }
}

TEST(Collapse, KeepOriginKeepsTheEdgesOfTheVertexThatGoes) {
    for (const bool first : {false, true})
        for (const bool second : {false, true}) {
            HalfedgeMesh mesh = grid(3, 3);
            const uint32_t u = 5, v = 10;  // both inside; the diagonal of a cell
            const HalfedgeId h = between(mesh, u, v);
            const uint32_t left = mesh.target(mesh.next(h)).index,
                           right = mesh.target(mesh.next(HalfedgeMesh::twin(h))).index;
            const EdgeId leftKept = HalfedgeMesh::edge(between(mesh, first ? u : v, left));
            const EdgeId leftLost = HalfedgeMesh::edge(between(mesh, first ? v : u, left));
            const EdgeId rightKept = HalfedgeMesh::edge(between(mesh, second ? u : v, right));
            const EdgeId rightLost = HalfedgeMesh::edge(between(mesh, second ? v : u, right));
            const auto faceBeyond = [&](EdgeId e, FaceId not1, FaceId not2) {
                const HalfedgeId a = HalfedgeMesh::halfedge(e);
                const FaceId f = mesh.face(a);
                return f != not1 && f != not2 ? f : mesh.face(HalfedgeMesh::twin(a));
            };
            const FaceId gone1 = mesh.face(h), gone2 = mesh.face(HalfedgeMesh::twin(h));
            const FaceId beyondKept = faceBeyond(leftKept, gone1, gone2),
                         beyondLost = faceBeyond(leftLost, gone1, gone2);

            ASSERT_TRUE(mesh.canCollapse(h));
            const auto done = mesh.collapse(h, {first, second});
            EXPECT_THAT(connectivityViolations(mesh), IsEmpty());
            EXPECT_TRUE(mesh.alive(leftKept));
            EXPECT_FALSE(mesh.alive(leftLost));
            EXPECT_TRUE(mesh.alive(rightKept));
            EXPECT_FALSE(mesh.alive(rightLost));
            EXPECT_EQ(HalfedgeMesh::edge(between(mesh, v, left)), leftKept);
            EXPECT_EQ(HalfedgeMesh::edge(between(mesh, v, right)), rightKept);
            // `kept` lies in the face where `replaced` lay, and its twin where it was.
            EXPECT_EQ(HalfedgeMesh::edge(done.merges[0].kept), leftKept);
            EXPECT_EQ(HalfedgeMesh::edge(done.merges[0].replaced), leftLost);
            EXPECT_EQ(mesh.face(done.merges[0].kept), beyondLost);
            EXPECT_EQ(mesh.face(HalfedgeMesh::twin(done.merges[0].kept)), beyondKept);
            EXPECT_EQ(HalfedgeMesh::edge(done.merges[1].kept), rightKept);
            EXPECT_EQ(HalfedgeMesh::edge(done.merges[1].replaced), rightLost);
        }
}

TEST(Collapse, OfAVertexOfHighValence) {
    HalfedgeMesh mesh = fan(60);  // more than collapse() keeps without allocating
    ASSERT_TRUE(mesh.canCollapse(between(mesh, 0, 30)));
    mesh.collapse(between(mesh, 0, 30));
    EXPECT_THAT(connectivityViolations(mesh), IsEmpty());
    EXPECT_EQ(mesh.faceCount(), 58U);
    EXPECT_EQ(valence(mesh, 30), 59);
}

TEST(Collapse, LeavesSnapshotsAlone) {
    HalfedgeMesh mesh = fan(6);
    const HalfedgeMesh snapshot = mesh;
    mesh.collapse(between(mesh, 0, 1));
    EXPECT_THAT(connectivityViolations(snapshot), IsEmpty());
    EXPECT_EQ(facesOf(snapshot), facesOf(fan(6)));
}

TEST(Flip, TurnsAnEdgeAndComesBack) {
    HalfedgeMesh mesh = square();
    const HalfedgeId h = between(mesh, 0, 2);
    const EdgeId e = HalfedgeMesh::edge(h);
    const VertexId opposite = mesh.target(mesh.next(HalfedgeMesh::halfedge(e)));
    ASSERT_TRUE(mesh.canFlip(e));
    mesh.flip(e);
    EXPECT_THAT(connectivityViolations(mesh), IsEmpty());
    EXPECT_EQ(facesOf(mesh), (Triangles{{0, 1, 3}, {1, 2, 3}}));
    EXPECT_EQ(mesh.origin(HalfedgeMesh::halfedge(e)), opposite);
    EXPECT_EQ(HalfedgeMesh::edge(between(mesh, 1, 3)), e);
    // Two flips reverse the edge's direction, four restore it.
    mesh.flip(e);
    EXPECT_EQ(facesOf(mesh), facesOf(square()));
    EXPECT_EQ(between(mesh, 2, 0), h);
    mesh.flip(e);
    mesh.flip(e);
    EXPECT_THAT(connectivityViolations(mesh), IsEmpty());
    EXPECT_EQ(between(mesh, 0, 2), h);
}

TEST(Flip, RefusesBordersAndDoubledEdges) {
    const HalfedgeMesh mesh = square();
    EXPECT_FALSE(mesh.canFlip(HalfedgeMesh::edge(between(mesh, 0, 1))));
    const HalfedgeMesh three = fan(3);
    EXPECT_FALSE(three.canFlip(HalfedgeMesh::edge(between(three, 0, 1)))) << "2 and 3 are joined already";
    const HalfedgeMesh four = fan(4);
    EXPECT_TRUE(four.canFlip(HalfedgeMesh::edge(between(four, 0, 1))));
}

TEST(Compacted, DropsDeletedElementsAndTellsTheOldIds) {
    HalfedgeMesh mesh = grid(3, 2);
    mesh.collapse(between(mesh, 5, 6));
    mesh.collapse(between(mesh, 1, 0));
    const auto compact = mesh.compacted();
    EXPECT_THAT(connectivityViolations(compact.mesh), IsEmpty());
    EXPECT_EQ(compact.mesh.vertexCapacity(), mesh.vertexCount());
    EXPECT_EQ(compact.mesh.edgeCapacity(), mesh.edgeCount());
    EXPECT_EQ(compact.mesh.faceCapacity(), mesh.faceCount());
    ASSERT_EQ(compact.oldFace.size(), mesh.faceCount());
    for (uint32_t f = 0; f < compact.oldFace.size(); ++f) {
        const auto now = compact.mesh.corners(FaceId(f)), before = mesh.corners(compact.oldFace[f]);
        for (size_t k = 0; k < 3; ++k) EXPECT_EQ(compact.oldVertex[now[k].index], before[k]);
    }
    for (uint32_t e = 0; e < compact.oldEdge.size(); ++e) {
        const HalfedgeId now = HalfedgeMesh::halfedge(EdgeId(e)),
                         old = HalfedgeMesh::halfedge(compact.oldEdge[e]);
        EXPECT_EQ(compact.oldVertex[compact.mesh.origin(now).index], mesh.origin(old));
        EXPECT_EQ(compact.oldVertex[compact.mesh.target(now).index], mesh.target(old));
    }
}

TEST(Split, OfAnEdgeBetweenTwoFaces) {
    HalfedgeMesh mesh = square();
    const HalfedgeMesh before = mesh;
    const EdgeId e = HalfedgeMesh::edge(between(mesh, 0, 2));
    const VertexId start = mesh.origin(HalfedgeMesh::halfedge(e)),
                   end = mesh.target(HalfedgeMesh::halfedge(e));
    const VertexId v = mesh.split(e);
    EXPECT_THAT(connectivityViolations(mesh), IsEmpty());
    EXPECT_EQ(v, VertexId(4));
    EXPECT_EQ(facesOf(mesh), (Triangles{{0, 1, 4}, {0, 4, 3}, {1, 2, 4}, {2, 3, 4}}));
    EXPECT_FALSE(mesh.onBorder(v));
    // The edge keeps its start; the first new one runs on to its old end.
    EXPECT_EQ(mesh.origin(HalfedgeMesh::halfedge(e)), start);
    EXPECT_EQ(mesh.target(HalfedgeMesh::halfedge(e)), v);
    const HalfedgeId onward = HalfedgeMesh::halfedge(EdgeId(uint32_t(before.edgeCapacity())));
    EXPECT_EQ(mesh.origin(onward), v);
    EXPECT_EQ(mesh.target(onward), end);
    EXPECT_EQ(facesOf(before).size(), 2U);  // snapshots stay
}

TEST(Split, OfAnEdgeOnTheBorder) {
    for (const bool turned : {false, true}) {
        HalfedgeMesh mesh = turned ? make(3, {{1, 2, 0}}) : make(3, {{0, 1, 2}});
        const VertexId v = mesh.split(HalfedgeMesh::edge(between(mesh, 0, 1)));
        EXPECT_THAT(connectivityViolations(mesh), IsEmpty());
        EXPECT_TRUE(mesh.onBorder(v));
        EXPECT_EQ(facesOf(mesh), (Triangles{{0, 3, 2}, {1, 2, 3}}));
        EXPECT_EQ(mesh.edgeCount(), 5U);
    }
}

TEST(Split, OfAFace) {
    HalfedgeMesh mesh = square();
    const FaceId f = mesh.face(between(mesh, 0, 1));
    const HalfedgeId first = mesh.halfedge(f);
    const VertexId v = mesh.split(f);
    EXPECT_THAT(connectivityViolations(mesh), IsEmpty());
    EXPECT_EQ(facesOf(mesh), (Triangles{{0, 1, 4}, {0, 2, 3}, {0, 4, 2}, {1, 2, 4}}));
    EXPECT_EQ(valence(mesh, v.index), 3);
    EXPECT_EQ(mesh.face(first), f);
}

// The vertex of a split can go again.
TEST(Split, IsUndoneByACollapse) {
    HalfedgeMesh mesh = grid(3, 2);
    const Triangles before = facesOf(mesh);
    for (uint32_t e = 0; e < 20; ++e) {
        const VertexId end = mesh.target(HalfedgeMesh::halfedge(EdgeId(e)));
        const VertexId v = mesh.split(EdgeId(e));
        ASSERT_NE(facesOf(mesh), before);
        const HalfedgeId back = mesh.find(v, end);
        ASSERT_TRUE(mesh.canCollapse(back));
        mesh.collapse(back);
        EXPECT_EQ(facesOf(mesh), before) << e;
        EXPECT_THAT(connectivityViolations(mesh), IsEmpty());
    }
}

// Any sequence of operations that are allowed keeps the invariants, and the region a disc (Euler).
TEST(HalfedgeMesh, RandomLegalOperationsKeepTheInvariants) {
    for (unsigned seed = 1; seed <= 20; ++seed) {
        std::mt19937 random(seed);
        HalfedgeMesh mesh = grid(6, 5);
        int done = 0;
        for (int step = 0; step < 600 && mesh.faceCount() > 2; ++step) {
            const HalfedgeId h(uint32_t(random() % (2 * mesh.edgeCapacity())));
            if (!mesh.alive(HalfedgeMesh::edge(h))) continue;
            const auto kind = random() % 8;
            if (kind == 0) {
                const VertexId v = mesh.split(HalfedgeMesh::edge(h));
                EXPECT_EQ(mesh.target(HalfedgeMesh::halfedge(HalfedgeMesh::edge(h))), v);
            } else if (kind == 1) {
                const FaceId f(uint32_t(random() % mesh.faceCapacity()));
                if (!mesh.alive(f)) continue;
                EXPECT_EQ(valence(mesh, mesh.split(f).index), 3);
            } else if (kind < 4) {
                if (!mesh.canFlip(HalfedgeMesh::edge(h))) continue;
                mesh.flip(HalfedgeMesh::edge(h));
            } else {
                if (!mesh.canCollapse(h)) continue;
                const VertexId kept = mesh.target(h), gone = mesh.origin(h);
                mesh.collapse(h, {random() % 2 == 0, random() % 2 == 0});
                EXPECT_TRUE(mesh.alive(kept));
                EXPECT_FALSE(mesh.alive(gone));
            }
            ++done;
            ASSERT_THAT(connectivityViolations(mesh), IsEmpty()) << "seed " << seed << ", step " << step;
            ASSERT_EQ(mesh.vertexCount() + mesh.faceCount(), mesh.edgeCount() + 1);
        }
        EXPECT_GT(done, 20);
        EXPECT_THAT(connectivityViolations(mesh.compacted().mesh), IsEmpty());
    }
}

// collapse() relies on canCollapse(); what it makes of a collapse that is not allowed is what the comparer
// must find.
TEST(ConnectivityViolations, FindsTwoEdgesBetweenTwoVertices) {
    HalfedgeMesh mesh = make(
        7,
        {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {1, 0, 4}, {2, 1, 5}, {0, 2, 6}, {0, 6, 4}, {1, 4, 5}, {2, 5, 6}});
    ASSERT_FALSE(mesh.canCollapse(between(mesh, 0, 1)));
    mesh.collapse(between(mesh, 0, 1));
    EXPECT_THAT(connectivityViolations(mesh), ::testing::Contains(HasSubstr("two edges to one neighbour")));
}

TEST(ConnectivityViolations, FindsAPinch) {
    HalfedgeMesh mesh = grid(4, 1);
    const HalfedgeId middle = between(mesh, 2, 7);
    ASSERT_FALSE(mesh.canCollapse(middle));
    mesh.collapse(middle);
    EXPECT_FALSE(connectivityViolations(mesh).empty());
}

TEST(ConnectivityViolations, FindsAnEdgeWithoutFaces) {
    HalfedgeMesh mesh = make(5, {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}});
    ASSERT_FALSE(mesh.canCollapse(between(mesh, 0, 2)));
    mesh.collapse(between(mesh, 0, 2));
    EXPECT_FALSE(connectivityViolations(mesh).empty());
}

}  // namespace
}  // namespace tessera
