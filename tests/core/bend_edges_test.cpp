#include "core/vectorize/bend_edges.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <thread>

#include "core/base/parallel.h"
#include "core/mesh/jacobian.h"
#include "core/mesh/mesh_validate.h"
#include "core/vectorize/parameter_fit.h"
#include "tests/support/stop_latency.h"
#include "tests/support/test_meshes.h"

namespace tessera {
namespace {

using testing::gridMesh;

Image painted(int width, int height, const std::function<double(double x, double y)>& colour) {
    Image image(width, height, 3);
    for (int c = 0; c < 3; ++c)
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) image.at(x, y, c) = float(colour(x + .5, y + .5));
    return image;
}

// Dark inside a circle through two corners of the square, bright outside, with a soft edge.
constexpr int kSize = 48;
constexpr glm::dvec2 kCentre(-20, kSize + 20);
double arcRadius() {
    return glm::distance(kCentre, glm::dvec2(0, 0));
}
Image arcPicture() {
    return painted(kSize, kSize, [](double x, double y) {
        return .5 + .4 * std::tanh((glm::distance(kCentre, glm::dvec2(x, y)) - arcRadius()) / 1.5);
    });
}

// Waves of all directions, so that edges everywhere want to bend.
Image wavyPicture(int width, int height) {
    return painted(width, height, [](double x, double y) {
        return .5 + .25 * std::tanh(3 * std::sin(x / 9 + 2 * std::sin(y / 11))) + .2 * std::sin(x * y / 300);
    });
}

PatchMesh bent(PatchMesh mesh, const Image& picture, StageReport* report = nullptr) {
    StageReport unused;
    Progress progress;
    auto result = bendEdges(std::move(mesh), picture, report ? *report : unused, progress);
    EXPECT_TRUE(result.has_value());
    return *result;
}

double figure(const StageReport& report, const std::string& name) {
    for (const auto& [key, value] : report.figures)
        if (key == name) return value;
    ADD_FAILURE() << name;
    return 0;
}

EdgeId innerEdge(const PatchMesh& mesh) {
    EdgeId found;
    mesh.forEachEdge([&](EdgeId e) {
        if (!mesh.connectivity().onBorder(e)) found = e;
    });
    return found;
}

bool sameGeometry(const PatchMesh& a, const PatchMesh& b) {
    bool same = a.patchCount() == b.patchCount();
    a.forEachEdge([&](EdgeId e) { same = same && a.curve(e) == b.curve(e); });
    a.forEachPatch([&](PatchId p) { same = same && a.interior(p) == b.interior(p); });
    return same;
}

TEST(ParameterFit, NoErrorForAPolynomialButForAStep) {
    const auto quadratic = [](double x, double y) { return .2 + .01 * x + .0002 * x * y - .0001 * y * y; };
    const ParameterFit smooth(painted(64, 64, quadratic));
    LatticeTriangle t = gridMesh(64, 64, 2, 2).controlPoints(PatchId(0));
    EXPECT_LT(smooth.error(t), 1e-4);
    // A step of height h along a line that no polynomial follows leaves a part of h^2 times the area.
    const ParameterFit step(painted(64, 64, [](double x, double y) { return x + 3 * y > 40 ? .8 : .2; }));
    EXPECT_GT(step.error(t), 1);
    EXPECT_LT(step.error(t), 3 * .09 * 600);
}

TEST(ParameterFit, AnUnevenJacobianCosts) {
    const auto power = [](double u, int n) { return std::pow((u - 16) / 16, n); };
    const ParameterFit quintic(
        painted(64, 64, [&](double x, double y) { return .5 + .2 * power(x, 5) - .2 * power(y, 4); }));
    const ParameterFit plane(painted(64, 64, [](double x, double y) { return .1 + .006 * (x + y); }));
    LatticeTriangle t = gridMesh(64, 64, 2, 2).controlPoints(PatchId(0));
    const double even = quintic.error(t);
    // The same region in other parameters: control points of a straight side slide along it.
    t.p[1].x -= 8 * kLatticePerPixel;
    t.p[2].x -= 8 * kLatticePerPixel;
    ASSERT_TRUE(certified(t));
    EXPECT_GT(quintic.error(t), 10 * even);
    EXPECT_LT(plane.error(t), 1e-4);  // a cubic in any cubic's parameters
}

TEST(BendEdges, FollowsAnArc) {
    const Image picture = arcPicture();
    const PatchMesh straight = gridMesh(kSize, kSize, 1, 1);
    StageReport report;
    const PatchMesh mesh = bent(straight, picture, &report);
    EXPECT_TRUE(validate(mesh).valid());
    EXPECT_LT(figure(report, "error after"), .3 * figure(report, "error before"));
    EXPECT_EQ(figure(report, "curved edges"), 1);
    const auto farthest = [](const PatchMesh& m) {
        const BezierCurve curve = toPixels(m.controlPoints(HalfedgeMesh::halfedge(innerEdge(m))));
        double most = 0;
        for (double t = 0; t <= 1; t += .05)
            most = std::max(most, std::abs(glm::distance(curve.at(t), kCentre) - arcRadius()));
        return most;
    };
    EXPECT_GT(farthest(straight), 4);
    EXPECT_LT(farthest(mesh), 2);
}

TEST(BendEdges, LeavesWhatGainsNothing) {
    const Image flat = painted(60, 40, [](double, double) { return .4; });
    const PatchMesh straight = gridMesh(60, 40, 3, 2);
    EXPECT_TRUE(sameGeometry(bent(straight, flat), straight));
    const Image ramp = painted(60, 40, [](double x, double y) { return .1 + .008 * x + .004 * y; });
    EXPECT_TRUE(sameGeometry(bent(straight, ramp), straight));
    EXPECT_FALSE(sameGeometry(bent(straight, wavyPicture(60, 40)), straight));
}

TEST(BendEdges, LeavesFeaturesAndTheBorder) {
    PatchMesh straight = gridMesh(120, 90, 6, 5);
    straight.forEachEdge([&](EdgeId e) {
        EdgeCurve curve = straight.curve(e);
        curve.feature = !straight.connectivity().onBorder(e) && e.index % 3 == 0;
        straight.setCurve(e, curve);
    });
    StageReport report;
    const PatchMesh mesh = bent(straight, wavyPicture(120, 90), &report);
    size_t free = 0;
    mesh.forEachEdge([&](EdgeId e) {
        if (mesh.connectivity().onBorder(e) || mesh.curve(e).feature)
            EXPECT_EQ(mesh.curve(e), straight.curve(e));
        else
            ++free;
    });
    EXPECT_EQ(figure(report, "edges"), double(free));
    EXPECT_GT(figure(report, "curved edges"), .3 * double(free));
}

TEST(BendEdges, StaysCertifiedWhereTheWantedBendFolds) {
    // Thin patches beside strong waves: without the test for evenness, many of them fold.
    for (const auto& [columns, rows] : {std::pair{4, 20}, {20, 4}, {10, 10}}) {
        const PatchMesh mesh = bent(gridMesh(200, 200, columns, rows), wavyPicture(200, 200));
        const MeshValidation validation = validate(mesh);
        EXPECT_TRUE(validation.valid()) << validation.violations.front();
        EXPECT_GT(validation.minBernstein, 0);
        EXPECT_EQ(validation.subdividedPatches, 0);
    }
}

TEST(BendEdges, DoesNotDependOnThreads) {
    const Image picture = wavyPicture(160, 120);
    const PatchMesh straight = gridMesh(160, 120, 12, 9);
    PatchMesh one;
    withThreads(1, [&] { one = bent(straight, picture); });
    for (const int threads : {2, 7}) {
        PatchMesh many;
        withThreads(threads, [&] { many = bent(straight, picture); });
        EXPECT_TRUE(sameGeometry(one, many)) << threads;
    }
    EXPECT_FALSE(sameGeometry(one, straight));
}

TEST(BendEdges, StopsWithin50Ms) {
    const Image picture = wavyPicture(1200, 900);
    const PatchMesh straight = gridMesh(1200, 900, 80, 60);
    for (const int delayMs : {0, 5, 60, 300}) {
        const double latency = leastOfTries(50, [&] {
            return stopLatencyMs(delayMs, [&](Progress& progress) {
                StageReport report;
                return bendEdges(straight, picture, report, progress);
            });
        });
        EXPECT_LT(latency, 50) << delayMs;
    }
}

}  // namespace
}  // namespace tessera
