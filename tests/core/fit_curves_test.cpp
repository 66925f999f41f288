// Patch boundaries: Eq. (1) and its gradient, the sets that are optimized together, and certified results.
#include "core/vectorize/fit_curves.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>
#include <set>

#include "core/mesh/mesh_validate.h"
#include "tests/support/test_meshes.h"

namespace tessera {
namespace {

using testing::gridMesh;
using ::testing::IsEmpty;

constexpr BoundaryObjective::Weights kWeights{.2, 1, 5};

// A base domain of straight edges whose paths are as `path` says, from end to end.
template <class MakePath>
BaseDomain baseOf(PatchMesh mesh, MakePath&& path) {
    BaseDomain base{std::move(mesh), {}};
    base.paths.resize(base.mesh.connectivity().edgeCapacity());
    base.mesh.forEachEdge([&](EdgeId e) {
        const BezierCurve line = toPixels(base.mesh.controlPoints(HalfedgeMesh::halfedge(e)));
        base.paths[e.index] = path(e, line.p[0], line.p[3]);
    });
    return base;
}

std::vector<glm::dvec2> straightPath(EdgeId, glm::dvec2 a, glm::dvec2 b) {
    return {a, b};
}

// A zigzag of 8 steps along an S that swings `swing` px to either side, every other one mirrored.
auto zigzag(double swing) {
    return [swing](EdgeId e, glm::dvec2 a, glm::dvec2 b) {
        const glm::dvec2 d = b - a, normal = glm::dvec2(-d.y, d.x) / std::hypot(d.x, d.y);
        std::vector<glm::dvec2> path{a};
        for (int k = 1; k < 8; ++k)
            path.push_back(
                a + d * (k / 8.0) +
                normal * swing *
                    ((e.index % 2 ? 1 : -1) * std::sin(k * std::numbers::pi / 4) + (k % 2 ? .2 : -.2)));
        path.push_back(b);
        return path;
    };
}

struct Outcome {
    PatchMesh mesh;
    StageReport report;

    double figure(const std::string& name) const {
        for (const auto& [key, value] : report.figures)
            if (key == name) return value;
        ADD_FAILURE() << "no figure " << name;
        return 0;
    }
};

Outcome fit(const BaseDomain& base, const std::string& variant = "traced",
            const std::function<void(const PatchMesh&)>& observe = {}) {
    Outcome outcome{{}, {"curves", variant, 0, {}}};
    Progress progress;
    auto mesh = fitCurves(base, {}, outcome.report, progress, observe);
    EXPECT_TRUE(mesh.has_value());
    if (mesh) outcome.mesh = std::move(*mesh);
    return outcome;
}

// Eq. (1) of the curve of h in a mesh, C0 given along h.
BoundaryObjective objectiveOf(const PatchMesh& mesh, HalfedgeId h, const BezierCurve& initial) {
    const HalfedgeMesh& c = mesh.connectivity();
    const HalfedgeId t = HalfedgeMesh::twin(h);
    const auto sideOf = [&](HalfedgeId side) {
        const auto sides = c.sides(c.face(side));
        return int(std::find(sides.begin(), sides.end(), side) - sides.begin());
    };
    return BoundaryObjective(toPixels(mesh.controlPoints(c.face(h))), sideOf(h),
                             toPixels(mesh.controlPoints(c.face(t))), sideOf(t), initial, kWeights);
}

// Each of the nine pairs of sides, so that each orientation of the curve in its patches is covered.
TEST(BoundaryObjective, GradientEqualsFiniteDifferences) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> off(-1.2, 1.2);
    const BezierTriangle straight = toPixels(gridMesh(12, 12, 1, 1).controlPoints(PatchId(0)));
    for (int firstSide = 0; firstSide < 3; ++firstSide)
        for (int secondSide = 0; secondSide < 3; ++secondSide) {
            BezierTriangle first = straight, second = straight;
            for (glm::dvec2& p : first.p) p += glm::dvec2(off(random), off(random));
            for (glm::dvec2& p : second.p) p += glm::dvec2(off(random), off(random));
            // C runs against the second patch's side.
            const auto side = first.side(firstSide);
            for (int i = 0; i < 4; ++i) second.p[size_t((3 * secondSide + i) % 9)] = side[size_t(3 - i)];
            BezierCurve initial{side};
            initial.p[1] += glm::dvec2(.7, -.3);
            initial.p[2] += glm::dvec2(-.2, .9);
            const BoundaryObjective objective(first, firstSide, second, secondSide, initial, kWeights);
            const auto x = objective.start();
            EXPECT_EQ(x[0], side[1].x);
            EXPECT_EQ(x[3], side[2].y);
            EXPECT_EQ(x[4], first.p[kInterior].x);
            EXPECT_EQ(x[7], second.p[kInterior].y);

            std::array<double, BoundaryObjective::kUnknowns> gradient{};
            const double value = objective.evaluate(x.data(), gradient.data());
            EXPECT_EQ(value, objective.evaluate(x.data(), nullptr));
            for (size_t k = 0; k < gradient.size(); ++k) {
                constexpr double kStep = 1e-5;
                auto more = x, less = x;
                more[k] += kStep;
                less[k] -= kStep;
                const double difference =
                    (objective.evaluate(more.data(), nullptr) - objective.evaluate(less.data(), nullptr)) /
                    (2 * kStep);
                EXPECT_NEAR(gradient[k], difference, 1e-5 * std::max(1.0, value)) << k;
            }
        }
}

TEST(BoundaryObjective, NothingToGainFromStraightPatches) {
    const PatchMesh mesh = gridMesh(12, 12, 1, 1);
    const HalfedgeId h = mesh.connectivity().find(VertexId(0), VertexId(3));
    const BoundaryObjective objective = objectiveOf(mesh, h, toPixels(mesh.controlPoints(h)));
    std::array<double, BoundaryObjective::kUnknowns> gradient{};
    EXPECT_NEAR(objective.evaluate(objective.start().data(), gradient.data()), 0, 1e-18);
    for (const double g : gradient) EXPECT_NEAR(g, 0, 1e-9);
}

// Affine patches have no Jacobian term: what is left is w_d times the squared distances of 7 samples from C0.
TEST(BoundaryObjective, DistanceTermByHand) {
    const PatchMesh mesh = gridMesh(12, 12, 1, 1);
    const HalfedgeId h = mesh.connectivity().find(VertexId(0), VertexId(3));
    BezierCurve initial = toPixels(mesh.controlPoints(h));
    initial.p[1] += glm::dvec2(2, 0);
    double expected = 0;
    for (int i = 1; i < 8; ++i) {
        const double t = i / 8.0;
        expected += 5 * std::pow(2 * 3 * t * (1 - t) * (1 - t), 2);
    }
    const BoundaryObjective objective = objectiveOf(mesh, h, initial);
    EXPECT_NEAR(objective.evaluate(objective.start().data(), nullptr), expected, 1e-9);
}

// Negative determinants weigh w_n, positive ones w_p.
TEST(BoundaryObjective, WeightsBySign) {
    PatchMesh mesh = gridMesh(12, 12, 1, 1);
    const HalfedgeId h = mesh.connectivity().find(VertexId(0), VertexId(3));
    const PatchId first = mesh.connectivity().face(h);
    mesh.setInterior(first, {-40 * kLatticePerPixel, 50 * kLatticePerPixel});
    const BezierTriangle t = toPixels(mesh.controlPoints(first));
    double expected = 0;
    int negative = 0;
    for (int i = 0; i <= 8; ++i)
        for (int j = 0; i + j <= 8; ++j) {
            const PatchPoint p = evaluateWithDerivatives(t, {i / 8.0, j / 8.0, (8 - i - j) / 8.0});
            const double jacobian = cross(p.dv, p.dw);
            negative += jacobian <= 0;
            expected += (jacobian > 0 ? .2 : 1) * std::pow(jacobian - 144, 2);
        }
    ASSERT_GT(negative, 3);
    const BoundaryObjective objective = objectiveOf(mesh, h, toPixels(mesh.controlPoints(h)));
    EXPECT_NEAR(objective.evaluate(objective.start().data(), nullptr), expected, 1e-9 * expected);
}

TEST(ColourEdges, NoTwoOfASetShareAPatch) {
    const PatchMesh mesh = gridMesh(12, 12, 6, 5);
    const HalfedgeMesh& c = mesh.connectivity();
    std::vector<EdgeId> edges;
    mesh.forEachEdge([&](EdgeId e) {
        if (!c.onBorder(e) && e.index % 7 != 3) edges.push_back(e);
    });
    const auto sets = colourEdges(c, edges);
    std::multiset<EdgeId> seen;
    for (const auto& set : sets) {
        EXPECT_FALSE(set.empty());
        std::set<FaceId> patches;
        for (const EdgeId e : set) {
            seen.insert(e);
            for (const HalfedgeId h :
                 {HalfedgeMesh::halfedge(e), HalfedgeMesh::twin(HalfedgeMesh::halfedge(e))})
                EXPECT_TRUE(patches.insert(c.face(h)).second) << "edge " << e.index;
        }
    }
    EXPECT_EQ(seen, std::multiset<EdgeId>(edges.begin(), edges.end()));
    EXPECT_LE(sets.size(), 5U) << "an edge has four neighbours at most";
    EXPECT_THAT(colourEdges(c, {}), IsEmpty());
}

TEST(FitCurves, StraightPathsStayStraight) {
    const BaseDomain base = baseOf(gridMesh(24, 24, 2, 2), straightPath);
    const Outcome o = fit(base);
    EXPECT_THAT(validate(o.mesh).violations, IsEmpty());
    EXPECT_EQ(o.figure("curves pulled"), 0);
    EXPECT_EQ(o.figure("curves"), 8);
    base.mesh.forEachEdge([&](EdgeId e) {
        const auto now = toPixels(o.mesh.controlPoints(HalfedgeMesh::halfedge(e)));
        const auto before = toPixels(base.mesh.controlPoints(HalfedgeMesh::halfedge(e)));
        for (size_t i = 0; i < 4; ++i)
            EXPECT_NEAR(glm::distance(now.p[i], before.p[i]), 0, 1.5 / kLatticePerPixel);
    });
}

// Two patches and one free curve, so that Eq. (1) is the whole of what is minimized.
TEST(FitCurves, OptimizingReducesEquation1) {
    const auto bulge = [](EdgeId, glm::dvec2 a, glm::dvec2 b) {
        const glm::dvec2 d = b - a, normal(-d.y, d.x);
        std::vector<glm::dvec2> path;
        for (int k = 0; k <= 10; ++k)
            path.push_back(a + d * (k / 10.0) + normal * (.03 * k * (10 - k) / 10.0));
        return path;
    };
    const BaseDomain base = baseOf(gridMesh(24, 24, 1, 1), bulge);
    PatchMesh initial;
    const Outcome o = fit(base, "traced", [&](const PatchMesh& mesh) { initial = mesh; });
    const HalfedgeId h = base.mesh.connectivity().find(VertexId(0), VertexId(3));
    const BezierCurve traced = fitCurve(base.paths[HalfedgeMesh::edge(h).index]);
    const BezierCurve along = HalfedgeMesh::halfedge(HalfedgeMesh::edge(h)) == h ? traced : traced.reversed();
    const auto value = [&](const PatchMesh& mesh) {
        const BoundaryObjective objective = objectiveOf(mesh, h, along);
        return objective.evaluate(objective.start().data(), nullptr);
    };
    ASSERT_GT(value(initial), 100);
    EXPECT_EQ(o.figure("curves pulled"), 0);
    EXPECT_LT(value(o.mesh), .9 * value(initial));
    EXPECT_THAT(validate(o.mesh).violations, IsEmpty());
    // At a minimum, but for rounding to the lattice and the solver's tolerance.
    const BoundaryObjective end = objectiveOf(o.mesh, h, along);
    for (size_t k = 0; k < BoundaryObjective::kUnknowns; ++k)
        for (const double step : {-.25, .25}) {
            auto x = end.start();
            x[k] += step;
            EXPECT_GT(end.evaluate(x.data(), nullptr), value(o.mesh));
        }
}

// Swings far larger than the patches: the fitted curves fold them, the result does not.
TEST(FitCurves, ZigzagPathsEndCertified) {
    for (const double swing : {1.0, 4.0, 12.0}) {
        const BaseDomain base = baseOf(gridMesh(40, 30, 4, 3), zigzag(swing));
        bool folded = false;
        const Outcome o = fit(base, "traced", [&](const PatchMesh& mesh) {
            mesh.forEachPatch([&](PatchId p) { folded = folded || !certified(mesh.controlPoints(p)); });
        });
        EXPECT_THAT(validate(o.mesh).violations, IsEmpty());
        EXPECT_TRUE(folded || swing < 12) << "what the observer of the initial curves sees";
        if (swing >= 12) {
            EXPECT_GT(o.figure("curves pulled"), 0);
        }
    }
}

TEST(FitCurves, FeaturesAndBordersAreNotMoved) {
    PatchMesh mesh = gridMesh(40, 30, 4, 3);
    std::vector<EdgeId> kept;
    mesh.forEachEdge([&](EdgeId e) {
        EdgeCurve curve = mesh.curve(e);
        curve.feature = !mesh.connectivity().onBorder(e) && e.index % 3 == 0;
        mesh.setCurve(e, curve);
        if (curve.feature || mesh.connectivity().onBorder(e)) kept.push_back(e);
    });
    const BaseDomain base = baseOf(mesh, zigzag(3));
    const Outcome o = fit(base);
    EXPECT_THAT(validate(o.mesh).violations, IsEmpty());
    for (const EdgeId e : kept) EXPECT_EQ(o.mesh.curve(e), base.mesh.curve(e));
    size_t moved = 0;
    mesh.forEachEdge([&](EdgeId e) { moved += !(o.mesh.curve(e) == base.mesh.curve(e)); });
    EXPECT_GT(moved, 5U);
}

TEST(FitCurves, VariantStraightLeavesTheBaseDomain) {
    const BaseDomain base = baseOf(gridMesh(40, 30, 4, 3), zigzag(4));
    const Outcome o = fit(base, "straight");
    base.mesh.forEachPatch(
        [&](PatchId p) { EXPECT_EQ(o.mesh.controlPoints(p).p, base.mesh.controlPoints(p).p); });
}

TEST(FitCurves, StopsOnRequest) {
    std::stop_source stop;
    stop.request_stop();
    Progress progress(stop.get_token());
    StageReport report{"curves", "traced", 0, {}};
    const auto mesh = fitCurves(baseOf(gridMesh(40, 30, 4, 3), zigzag(4)), {}, report, progress);
    ASSERT_FALSE(mesh.has_value());
    EXPECT_EQ(mesh.error().code, ErrorCode::Stopped);
}

}  // namespace
}  // namespace tessera
