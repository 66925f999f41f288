// Delaunay against its definition, by brute force over all vertices and edges.
#include "core/mesh/delaunay.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <set>

#include "core/mesh/mesh_validate.h"

namespace tessera {
namespace {

using ::testing::IsEmpty;

__extension__ typedef __int128 Wide;

int signOf(Wide v) {
    return v > 0 ? 1 : v < 0 ? -1 : 0;
}

int turn(LatticePoint a, LatticePoint b, LatticePoint c) {
    return signOf(cross(b - a, c - a));
}

// By the determinant of the lifted points, from b's side.
bool inCircle(LatticePoint a, LatticePoint b, LatticePoint c, LatticePoint d) {
    const auto row = [&](LatticePoint p) {
        const LatticePoint q = p - d;
        return std::array<Wide, 3>{q.x, q.y, Wide(q.x) * q.x + Wide(q.y) * q.y};
    };
    const auto p = row(b), q = row(c), r = row(a);
    const Wide det = p[0] * (q[1] * r[2] - q[2] * r[1]) - p[1] * (q[0] * r[2] - q[2] * r[0]) +
                     p[2] * (q[0] * r[1] - q[1] * r[0]);
    return det > 0;
}

bool properlyCross(LatticePoint a, LatticePoint b, LatticePoint c, LatticePoint d) {
    return turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0;
}

using Walls = std::vector<std::array<LatticePoint, 2>>;

// Faces of no area, and pairs of face and vertex where the vertex lies inside the face's circle although no
// constrained edge hides it from there.
int violations(const HalfedgeMesh& mesh, const std::vector<LatticePoint>& positions, const Walls& walls) {
    const auto at = [&](VertexId v) { return positions[v.index]; };
    int found = 0;
    for (uint32_t f = 0; f < mesh.faceCapacity(); ++f) {
        const auto corners = mesh.corners(FaceId(f));
        const std::array<LatticePoint, 3> p{at(corners[0]), at(corners[1]), at(corners[2])};
        if (turn(p[0], p[1], p[2]) <= 0) ++found;
        for (const LatticePoint q : positions) {
            if (!inCircle(p[0], p[1], p[2], q)) continue;
            // Seen from a corner of the face, or else hidden.
            bool seen = true;
            for (const LatticePoint corner : p)
                for (const auto& wall : walls) seen = seen && !properlyCross(corner, q, wall[0], wall[1]);
            for (size_t k = 0; k < 3; ++k)
                for (const auto& wall : walls)
                    if ((wall[0] == p[k] && wall[1] == p[(k + 1) % 3]) ||
                        (wall[1] == p[k] && wall[0] == p[(k + 1) % 3]))
                        seen = seen && turn(p[k], p[(k + 1) % 3], q) >= 0;
            found += seen;
        }
    }
    return found;
}

int violations(const Delaunay& d) {
    Walls walls;
    for (uint32_t e = 0; e < d.mesh().edgeCapacity(); ++e) {
        const HalfedgeId h = HalfedgeMesh::halfedge(EdgeId(e));
        if (d.constrained(EdgeId(e)))
            walls.push_back(
                {d.positions()[d.mesh().origin(h).index], d.positions()[d.mesh().target(h).index]});
    }
    return violations(d.mesh(), d.positions(), walls);
}

int64_t twiceArea(const Delaunay& d) {
    int64_t sum = 0;
    for (uint32_t f = 0; f < d.mesh().faceCapacity(); ++f) {
        const auto c = d.mesh().corners(FaceId(f));
        const auto at = [&](size_t k) { return d.positions()[c[k].index]; };
        sum += cross(at(1) - at(0), at(2) - at(0));
    }
    return sum;
}

void expectSound(const Delaunay& d, LatticePoint extent) {
    EXPECT_THAT(connectivityViolations(d.mesh()), IsEmpty());
    EXPECT_EQ(d.mesh().vertexCount(), d.positions().size());
    EXPECT_EQ(twiceArea(d), 2 * int64_t(extent.x) * extent.y);
    EXPECT_EQ(violations(d), 0);
}

TEST(Delaunay, BeginsAsARectangleInTwo) {
    const Delaunay d({3, 5});
    EXPECT_EQ(d.mesh().faceCount(), 2U);
    expectSound(d, {3, 5});
}

TEST(Delaunay, OfRandomPoints) {
    for (unsigned seed = 1; seed <= 12; ++seed) {
        // Coarse lattices have points that repeat, lie on edges and on common circles.
        const int size = seed % 3 == 0 ? 8 : seed % 3 == 1 ? 60 : 2000000;
        const LatticePoint extent{size, size / 2 + 1};
        std::mt19937 random(seed);
        Delaunay d(extent);
        std::set<std::pair<int, int>> distinct{{0, 0}, {extent.x, 0}, {0, extent.y}, {extent.x, extent.y}};
        for (int i = 0; i < 100; ++i) {
            const LatticePoint p{int(random() % unsigned(extent.x + 1)),
                                 int(random() % unsigned(extent.y + 1))};
            distinct.insert({p.x, p.y});
            const VertexId v = d.insert(p);
            ASSERT_TRUE(v.valid());
            EXPECT_EQ(d.positions()[v.index], p);
        }
        EXPECT_EQ(d.positions().size(), distinct.size());
        expectSound(d, extent);
    }
}

TEST(Delaunay, PointsAlongTheBorder) {
    const LatticePoint extent{64, 48};
    Delaunay d(extent);
    for (const int k : {1, 5, 3, 2, 4, 7, 6}) {
        for (const LatticePoint p : {LatticePoint{8 * k, 0}, {8 * k, 48}, {0, 6 * k}, {64, 6 * k}})
            d.insert(p);
        expectSound(d, extent);
    }
    EXPECT_EQ(d.positions().size(), 4U + 28U);
}

TEST(Delaunay, ADuplicateIsTheVertexThatIsThere) {
    Delaunay d({100, 100});
    const VertexId v = d.insert({40, 30});
    d.insert({41, 30});
    EXPECT_EQ(d.insert({40, 30}), v);
    EXPECT_EQ(d.insert({100, 0}), VertexId(1));
    EXPECT_EQ(d.positions().size(), 6U);
}

TEST(Delaunay, ConstraintsThatCrossManyEdges) {
    for (unsigned seed = 1; seed <= 10; ++seed) {
        const LatticePoint extent{4000, 3000};
        std::mt19937 random(seed);
        Delaunay d(extent);
        for (int i = 0; i < 120; ++i) d.insert({int(random() % 4001), int(random() % 3001)});
        const VertexId a = d.insert({11, 1503}), b = d.insert({3989, 1501});
        ASSERT_FALSE(d.mesh().find(a, b).valid());
        const EdgeId e = d.constrain(a, b);
        ASSERT_TRUE(e.valid());
        EXPECT_EQ(HalfedgeMesh::edge(d.mesh().find(a, b)), e);
        EXPECT_TRUE(d.constrained(e));
        EXPECT_EQ(d.constrain(b, a), e);
        expectSound(d, extent);
        // What comes later leaves it alone.
        for (int i = 0; i < 60; ++i) d.insert({int(random() % 4001), 1480 + int(random() % 40)});
        EXPECT_EQ(HalfedgeMesh::edge(d.mesh().find(a, b)), e);
        expectSound(d, extent);
    }
}

TEST(Delaunay, RefusedConstraintsChangeNothing) {
    const LatticePoint extent{100, 100};
    Delaunay d(extent);
    const VertexId west = d.insert({10, 50}), east = d.insert({90, 50});
    const VertexId north = d.insert({50, 10}), south = d.insert({50, 90});
    ASSERT_TRUE(d.constrain(west, east).valid());
    const auto facesBefore = [&] {
        std::vector<std::array<VertexId, 3>> faces;
        for (uint32_t f = 0; f < d.mesh().faceCapacity(); ++f) faces.push_back(d.mesh().corners(FaceId(f)));
        return faces;
    };
    const auto before = facesBefore();
    EXPECT_FALSE(d.constrain(north, south).valid());  // crosses a constraint
    EXPECT_EQ(facesBefore(), before);
    EXPECT_FALSE(d.insert({50, 50}).valid());  // lies inside one
    EXPECT_EQ(facesBefore(), before);
    expectSound(d, extent);

    const VertexId middle = d.insert({50, 30});
    ASSERT_TRUE(middle.valid());
    EXPECT_FALSE(d.constrain(north, d.insert({50, 45})).valid());  // a vertex between
    expectSound(d, extent);
}

TEST(Delaunay, OfAnEdgeThatIsThere) {
    Delaunay d({10, 10});
    const EdgeId e = d.constrain(VertexId(0), VertexId(2));
    EXPECT_TRUE(e.valid());
    EXPECT_TRUE(d.constrained(e));
    EXPECT_FALSE(d.constrain(VertexId(1), VertexId(3)).valid());
}

TEST(Delaunay, TheCheckFindsTheWrongDiagonal) {
    constexpr std::array<std::array<uint32_t, 3>, 2> kLong{{{0, 1, 2}, {0, 2, 3}}},
        kShort{{{1, 2, 3}, {3, 0, 1}}};
    const std::vector<LatticePoint> kite{{0, 0}, {10, -3}, {20, 0}, {10, 3}};
    EXPECT_GT(violations(HalfedgeMesh::fromTriangles(4, kLong), kite, {}), 0);
    EXPECT_EQ(violations(HalfedgeMesh::fromTriangles(4, kLong), kite, {{{kite[2], kite[0]}}}), 0);
    EXPECT_EQ(violations(HalfedgeMesh::fromTriangles(4, kShort), kite, {}), 0);
    const std::vector<LatticePoint> flat{{0, 0}, {10, 0}, {20, 0}, {10, 3}};
    EXPECT_GT(violations(HalfedgeMesh::fromTriangles(4, kLong), flat, {}), 0);
}

}  // namespace
}  // namespace tessera
