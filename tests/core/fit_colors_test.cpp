// Colours of patches by Eq. (5): where the constraints lie, what is reproduced, and what joins over seams.
#include "core/vectorize/fit_colors.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/mesh/mesh_validate.h"
#include "tests/support/painted_image.h"
#include "tests/support/test_meshes.h"

namespace tessera {
namespace {

using testing::curvedMesh;
using testing::gridMesh;
using ::testing::IsEmpty;
using testing::paint;

using Paths = std::vector<std::vector<glm::dvec2>>;

PatchMesh fit(const PatchMesh& mesh, const Image& image, const Paths& paths = {},
              const std::string& variant = "sampled") {
    StageReport report{"colours", variant, 0, {}};
    Progress progress;
    const Paths none(mesh.connectivity().edgeCapacity());
    auto result = fitColors(mesh, paths.empty() ? none : paths, image, {}, report, progress);
    EXPECT_TRUE(result.has_value());
    return result ? *result : PatchMesh{};
}

// The largest error of the mesh's colours against a function of image points, over a patch's domain.
template <class Value>
double largestError(const PatchMesh& mesh, PatchId p, Value&& value) {
    const BezierTriangle t = toPixels(mesh.controlPoints(p));
    double worst = 0;
    for (int i = 0; i <= 12; ++i)
        for (int j = 0; i + j <= 12; ++j) {
            const Barycentric b(i / 12.0, j / 12.0, (12 - i - j) / 12.0);
            const glm::dvec2 at = evaluate(t, b);
            for (int c = 0; c < mesh.channels(); ++c)
                worst = std::max(worst, std::abs(evaluateSpline(mesh.spline(p), c, domainPoint(b)) -
                                                 value(at.x, at.y, c)));
        }
    return worst;
}

void markFeature(PatchMesh& mesh, uint32_t a, uint32_t b) {
    const EdgeId e = HalfedgeMesh::edge(mesh.connectivity().find(VertexId(a), VertexId(b)));
    EdgeCurve curve = mesh.curve(e);
    curve.feature = true;
    mesh.setCurve(e, curve);
}

TEST(ConstraintPoints, CountsOfThePapersN) {
    EXPECT_EQ(constraintPoints(10, 0).size(), 66U + 100U);
    for (const unsigned side : {1U, 2U, 4U}) EXPECT_EQ(constraintPoints(10, side).size(), 166U + 18U);
    EXPECT_EQ(constraintPoints(10, 7).size(), 166U + 54U);
    EXPECT_EQ(constraintPoints(1, 7).size(), 3U + 1U) << "no corners within the sides";
}

TEST(ConstraintPoints, CornersAndMiddlesLieInTheDomain) {
    std::vector<Barycentric> points = constraintPoints(10, 0);
    int onCorners = 0, onSides = 0;
    for (const Barycentric& b : points) {
        EXPECT_NEAR(b.x + b.y + b.z, 1, 1e-15);
        EXPECT_GE(std::min({b.x, b.y, b.z}), -1e-15);
        onCorners += std::max({b.x, b.y, b.z}) > 1 - 1e-12;
        onSides += std::min({b.x, b.y, b.z}) < 1e-12;
    }
    EXPECT_EQ(onCorners, 3);
    EXPECT_EQ(onSides, 30);
    for (size_t i = 0; i < points.size(); ++i)
        for (size_t j = i + 1; j < points.size(); ++j)
            EXPECT_GT(glm::distance(domainPoint(points[i]), domainPoint(points[j])), .05);
}

// Fig. 10(a): one point of a pair inside, one outside, on the normal through the side's own constraint.
TEST(ConstraintPoints, PairsLieOnBothSidesAlongTheNormal) {
    for (int s = 0; s < 3; ++s) {
        const auto points = constraintPoints(10, 1U << s);
        Barycentric from(0), to(0);
        from[s] = to[(s + 1) % 3] = 1;
        for (int k = 1; k < 10; ++k) {
            const glm::dvec2 foot = domainPoint(from + (to - from) * (k / 10.0));
            const Barycentric first = points[166 + size_t(2 * (k - 1))],
                              second = points[166 + size_t(2 * k - 1)];
            EXPECT_NEAR(first[(s + 2) % 3], kPairOffset / 10, 1e-15) << "inside";
            EXPECT_NEAR(second[(s + 2) % 3], -kPairOffset / 10, 1e-15) << "outside";
            const glm::dvec2 along = domainPoint(to) - domainPoint(from);
            for (const Barycentric& b : {first, second}) {
                EXPECT_NEAR(glm::dot(domainPoint(b) - foot, along), 0, 1e-15);
                EXPECT_NEAR(glm::length(domainPoint(b) - foot), kDomainHeight * kPairOffset / 10, 1e-15);
            }
        }
    }
}

TEST(FitColors, AConstantIsExact) {
    for (const int channels : {3, 4}) {
        const auto constant = [](double, double, int c) { return .2 + .15 * c; };
        const PatchMesh mesh = fit(curvedMesh(40, 32, 3, 3, 5, channels), paint(40, 32, channels, constant),
                                   {}, "sampled-nowarp");
        EXPECT_THAT(validate(mesh).violations, IsEmpty());
        // Coefficients are floats, of which 19 add up.
        mesh.forEachPatch([&](PatchId p) { EXPECT_LT(largestError(mesh, p, constant), 1e-5); });
    }
}

// In a straight patch a linear field is linear over the domain. Within half a pixel of the picture's sides
// bilinear interpolation has no further pixels to go on, so the patches that touch them are left out.
TEST(FitColors, ALinearFieldIsExactInStraightPatches) {
    const auto linear = [](double x, double y, int c) { return .1 + .01 * x - .004 * y + .1 * c; };
    const PatchMesh mesh = fit(gridMesh(60, 48, 5, 4), paint(60, 48, 3, linear));
    int checked = 0;
    mesh.forEachPatch([&](PatchId p) {
        for (const VertexId v : mesh.connectivity().corners(p))
            if (mesh.connectivity().onBorder(v)) return;
        ++checked;
        EXPECT_LT(largestError(mesh, p, linear), 1e-5);
    });
    EXPECT_EQ(checked, 12);
}

TEST(FitColors, SplinesHaveSixteenTermsAndTheirSideConditions) {
    const auto busy = [](double x, double y, int c) { return std::fmod(.37 * x + .21 * y * (c + 1), 1.0); };
    const PatchMesh mesh = fit(gridMesh(40, 32, 3, 3), paint(40, 32, 3, busy));
    EXPECT_THAT(validate(mesh).violations, IsEmpty()) << "of which the side conditions are a part";
    mesh.forEachPatch([&](PatchId p) {
        EXPECT_EQ(mesh.spline(p).terms, (std::array<uint8_t, 4>{16, 16, 16, 0}));
        EXPECT_EQ(mesh.spline(p).coefficients.size(), 57U);
    });
}

TEST(FitColors, SmoothFieldsJoinOverSeams) {
    const auto smooth = [](double x, double y, int c) {
        return .5 + .3 * std::sin(.09 * x + c) * std::cos(.07 * y);
    };
    PatchMesh mesh = curvedMesh(64, 48, 4, 3, 8);
    mesh.forEachEdge([&](EdgeId e) {
        EdgeCurve curve = mesh.curve(e);
        curve.feature = false;
        mesh.setCurve(e, curve);
    });
    const PatchMesh fitted = fit(mesh, paint(64, 48, 3, smooth));
    const SeamStatistics seams = measureSeams(fitted);
    EXPECT_LT(seams.mean, 1) << "levels of 255";
    EXPECT_LT(seams.p95, 2);
    EXPECT_GT(measureSeams(mesh).mean, 20) << "random colours before";
}

// Changes the picture beyond the reach of the left patches' own samples, but within that of a pair's outer
// points. On a feature there is none, so that the other side's colours do not come in.
TEST(FitColors, FeaturesHaveNoPairs) {
    const auto field = [](double x, double y, int) { return .3 + .005 * x + .002 * y; };
    const Image plain = paint(80, 60, 3, field);
    const Image other =
        paint(80, 60, 3, [&](double x, double y, int c) { return x > 41 ? .9 : field(x, y, c); });
    // Two columns of cells, one row; the seam is at x = 40, and pairs reach to 41.7.
    for (const bool feature : {false, true}) {
        PatchMesh mesh = gridMesh(80, 60, 2, 1);
        const HalfedgeId seam = mesh.connectivity().find(VertexId(1), VertexId(4));
        const EdgeId e = HalfedgeMesh::edge(seam);
        Paths paths(mesh.connectivity().edgeCapacity());
        const BezierCurve line = toPixels(mesh.controlPoints(HalfedgeMesh::halfedge(e)));
        paths[e.index] = {line.p[0], line.p[3]};
        if (feature) markFeature(mesh, 1, 4);
        HalfedgeId onLeft = seam;
        const auto leftmost = [&](HalfedgeId h) {
            return mesh.position(mesh.connectivity().target(mesh.connectivity().next(h))).x;
        };
        if (leftmost(onLeft) != 0) onLeft = HalfedgeMesh::twin(onLeft);
        const PatchId left = mesh.connectivity().face(onLeft);
        const PatchMesh a = fit(mesh, plain, paths), b = fit(mesh, other, paths);
        EXPECT_EQ(a.spline(left) == b.spline(left), feature);
    }
}

// Fig. 11: the polyline is two pixels away from its curve; sampled along the curve, colours of the other side
// come in.
TEST(FitColors, TheWarpKeepsToTheRightSide) {
    const double bend = 2;
    PatchMesh mesh = gridMesh(80, 60, 2, 1);
    const HalfedgeId seam = mesh.connectivity().find(VertexId(1), VertexId(4));
    const EdgeId e = HalfedgeMesh::edge(seam);
    markFeature(mesh, 1, 4);
    // The discontinuity is at 40 + bend sin, the curve is straight.
    Paths paths(mesh.connectivity().edgeCapacity());
    const BezierCurve line = toPixels(mesh.controlPoints(HalfedgeMesh::halfedge(e)));
    const auto edgeAt = [&](double y) { return 40 + bend * std::sin(y / 60 * 3.14159265358979); };
    for (int k = 0; k <= 60; ++k) {
        const double y = line.p[0].y + (line.p[3].y - line.p[0].y) * k / 60;
        paths[e.index].emplace_back(k == 0 || k == 60 ? 40 : edgeAt(y), y);
    }
    const Image image = paint(80, 60, 3, [&](double x, double y, int) { return x < edgeAt(y) ? .2 : .8; });
    // The mean error near the seam, where each patch has the one colour of its side.
    const auto errorOf = [&](const std::string& variant) {
        const PatchMesh fitted = fit(mesh, image, paths, variant);
        const HalfedgeMesh& c = fitted.connectivity();
        double sum = 0;
        for (const HalfedgeId side : {seam, HalfedgeMesh::twin(seam)}) {
            const PatchId p = c.face(side);
            const auto sides = c.sides(p);
            const auto s = int(std::find(sides.begin(), sides.end(), side) - sides.begin());
            const bool left = fitted.position(c.target(c.next(side))).x == 0;
            for (int k = 1; k < 20; ++k) {
                Barycentric b;
                b[s] = .95 * (1 - k / 20.0);
                b[(s + 1) % 3] = .95 * k / 20.0;
                b[(s + 2) % 3] = .05;
                sum += std::abs(evaluateSpline(fitted.spline(p), 0, domainPoint(b)) - (left ? .2 : .8));
            }
        }
        return sum / 38;
    };
    EXPECT_LT(errorOf("sampled"), .7 * errorOf("sampled-nowarp")) << errorOf("sampled-nowarp");
}

TEST(FitColors, StopsOnRequest) {
    std::stop_source stop;
    stop.request_stop();
    Progress progress(stop.get_token());
    StageReport report{"colours", "sampled", 0, {}};
    const PatchMesh mesh = gridMesh(40, 32, 3, 3);
    const Paths paths(mesh.connectivity().edgeCapacity());
    const auto result = fitColors(mesh, paths, Image(40, 32, 3, .5F), {}, report, progress);
    ASSERT_FALSE(result.has_value());
    EXPECT_EQ(result.error().code, ErrorCode::Stopped);
}

}  // namespace
}  // namespace tessera
