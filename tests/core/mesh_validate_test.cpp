// The validator on sound meshes and on meshes broken in one known way each, and the measure of seams.
#include "core/mesh/mesh_validate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/test_meshes.h"

namespace tessera {
namespace {

using ::testing::Contains;
using testing::curvedMesh;
using testing::gridMesh;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr int kPx = kLatticePerPixel;

HalfedgeId between(const PatchMesh& mesh, uint32_t a, uint32_t b) {
    return mesh.connectivity().find(VertexId(a), VertexId(b));
}

// A mesh over 9 x 9 px of 3 x 3 cells; vertex (i, j) is 4 j + i, at (3 i, 3 j) px.
PatchMesh nineCells() {
    return gridMesh(9, 9, 3, 3);
}

// A mesh of the given triangles, for pictures that gridMesh cannot cover wrongly.
PatchMesh handMade(int width, int height, const std::vector<LatticePoint>& positions,
                   const std::vector<std::array<uint32_t, 3>>& triangles) {
    return PatchMesh(width, height, 3, HalfedgeMesh::fromTriangles(positions.size(), triangles), positions);
}

TEST(Validate, StraightGrid) {
    const MeshValidation v = validate(nineCells());
    EXPECT_THAT(v.violations, IsEmpty());
    EXPECT_TRUE(v.valid());
    EXPECT_DOUBLE_EQ(v.minBernstein, 1);
    EXPECT_EQ(v.subdividedPatches, 0U);
    EXPECT_EQ(v.areaError, 0);
    EXPECT_EQ(v.uncoveredPixels, 0U);
    EXPECT_EQ(v.doublePixels, 0U);
}

TEST(Validate, CurvedMeshes) {
    for (unsigned seed = 1; seed <= 5; ++seed) {
        const MeshValidation v = validate(curvedMesh(64, 48, 5, 4, seed, seed % 2 ? 3 : 4));
        EXPECT_THAT(v.violations, IsEmpty()) << "seed " << seed;
        EXPECT_LT(v.minBernstein, 1);
        EXPECT_LT(v.areaError, 1e-12);
    }
}

TEST(Validate, CountsPatchesCertifiedBySubdivision) {
    // One side of a large patch bent until the coefficients are mixed but det J is not (see jacobian_test).
    std::mt19937 random(1);
    std::uniform_int_distribution<int> off(-12 * kPx, 12 * kPx);
    for (int round = 0; round < 20000; ++round) {
        PatchMesh mesh = gridMesh(40, 40, 1, 1);
        const HalfedgeId h = between(mesh, 0, 3);
        const auto straight = mesh.controlPoints(h);
        mesh.setInnerControlPoints(h, straight[1] + LatticePoint{off(random), off(random)},
                                   straight[2] + LatticePoint{off(random), off(random)});
        bool sound = true, mixed = false;
        mesh.forEachPatch([&](PatchId p) {
            sound = sound && certified(mesh.controlPoints(p));
            mixed = mixed || minBernstein(mesh.controlPoints(p)) <= 0;
        });
        if (!sound || !mixed) continue;
        const MeshValidation v = validate(mesh);
        EXPECT_THAT(v.violations, IsEmpty());
        EXPECT_GE(v.subdividedPatches, 1U);
        EXPECT_LE(v.minBernstein, 0);
        return;
    }
    FAIL() << "no such patch among the random ones";
}

TEST(Validate, FindsAVertexThatFoldsItsPatches) {
    PatchMesh mesh = nineCells();
    mesh.setPosition(VertexId(5), {7 * kPx, 7 * kPx});  // past its neighbours
    const MeshValidation v = validate(mesh);
    EXPECT_FALSE(v.valid());
    EXPECT_THAT(v.violations, Contains(HasSubstr("is not certified free of folds")));
    EXPECT_LT(v.minBernstein, 0);
    EXPECT_GT(v.doublePixels, 0U);
}

TEST(Validate, FindsABentSideThatCrossesAnother) {
    PatchMesh mesh = nineCells();
    mesh.setInnerControlPoints(between(mesh, 5, 6), {4 * kPx, 12 * kPx}, {5 * kPx, 12 * kPx});
    const MeshValidation v = validate(mesh);
    EXPECT_THAT(v.violations, Contains(HasSubstr("is not certified free of folds")));
    EXPECT_LT(v.areaError, 1e-12) << "what one patch gains the other loses";
}

TEST(Validate, FindsAFoldByAnInteriorPointAlone) {
    PatchMesh mesh = nineCells();
    mesh.setInterior(PatchId(4), {0, 0});
    const MeshValidation v = validate(mesh);
    EXPECT_EQ(v.violationCount, 1U);
    EXPECT_THAT(v.violations, Contains(HasSubstr("patch 4 is not certified")));
}

TEST(Validate, FindsABentBorderEdge) {
    PatchMesh mesh = nineCells();
    const HalfedgeId h = between(mesh, 1, 2);
    const auto p = mesh.controlPoints(h);
    mesh.setInnerControlPoints(h, p[1] + LatticePoint{0, 1}, p[2]);
    EXPECT_THAT(validate(mesh).violations, Contains(HasSubstr("leaves the picture's side")));
}

TEST(Validate, AllowsBorderVerticesToSlide) {
    PatchMesh mesh = nineCells();
    mesh.setPosition(VertexId(1), {2 * kPx, 0});
    mesh.forEachEdge([&](EdgeId e) {
        const HalfedgeId h = HalfedgeMesh::halfedge(e);
        const auto inner = straightControlPoints(mesh.position(mesh.connectivity().origin(h)),
                                                 mesh.position(mesh.connectivity().target(h)));
        mesh.setInnerControlPoints(h, inner[0], inner[1]);
    });
    EXPECT_THAT(validate(mesh).violations, IsEmpty());
}

TEST(Validate, FindsAMissingCorner) {
    const PatchMesh mesh = handMade(6, 6, {{0, 0}, {6 * kPx, 0}, {0, 6 * kPx}}, {{0, 1, 2}});
    const MeshValidation v = validate(mesh);
    EXPECT_THAT(v.violations, Contains("3 vertices at the picture's corners in place of 4"));
    EXPECT_THAT(v.violations, Contains(HasSubstr("leaves the picture's side")));
    EXPECT_THAT(v.violations, Contains(HasSubstr("areas do not add up")));
    EXPECT_DOUBLE_EQ(v.areaError, .5);
    EXPECT_GT(v.uncoveredPixels, 10U);
}

TEST(Validate, FindsAHole) {
    std::vector<LatticePoint> positions;
    std::vector<std::array<uint32_t, 3>> triangles;
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) positions.push_back({3 * kPx * i, 3 * kPx * j});
    for (uint32_t cell = 0; cell < 9; ++cell) {
        const uint32_t a = cell / 3 * 4 + cell % 3;
        if (cell == 4) continue;  // the middle
        triangles.push_back({a, a + 1, a + 5});
        triangles.push_back({a, a + 5, a + 4});
    }
    const MeshValidation v = validate(handMade(9, 9, positions, triangles));
    EXPECT_THAT(v.violations, Contains("the border is not one loop"));
    EXPECT_THAT(v.violations, Contains("9 pixel centres are in no patch"));
    EXPECT_EQ(v.uncoveredPixels, 9U);
    EXPECT_DOUBLE_EQ(v.areaError, 1.0 / 9);
}

TEST(Validate, FindsAVertexOutsideThePicture) {
    PatchMesh mesh = nineCells();
    mesh.setPosition(VertexId(1), {3 * kPx, -1});
    EXPECT_THAT(validate(mesh).violations, Contains("vertex 1 lies outside the picture"));
}

TEST(Validate, FindsAPictureOfAnotherSize) {
    const PatchMesh nine = nineCells();
    std::vector<LatticePoint> positions;
    nine.forEachVertex([&](VertexId v) { positions.push_back(nine.position(v)); });
    const MeshValidation v = validate(PatchMesh(9, 10, 3, nine.connectivity(), positions));
    EXPECT_THAT(v.violations, Contains(HasSubstr("areas do not add up")));
    EXPECT_THAT(v.violations, Contains("9 pixel centres are in no patch"));
    EXPECT_NEAR(v.areaError, .1, 1e-12);
}

TEST(Validate, FindsAFeatureOnTheBorder) {
    PatchMesh mesh = nineCells();
    const EdgeId e = HalfedgeMesh::edge(between(mesh, 0, 1));
    EdgeCurve curve = mesh.curve(e);
    curve.feature = true;
    mesh.setCurve(e, curve);
    EXPECT_THAT(validate(mesh).violations, Contains(HasSubstr("is marked as a feature")));
}

TEST(Validate, FindsSplinesOfTheWrongSize) {
    PatchMesh mesh = nineCells();
    PatchSpline spline = mesh.spline(PatchId(2));
    spline.coefficients.push_back(0);
    mesh.setSpline(PatchId(2), spline);
    EXPECT_THAT(validate(mesh).violations,
                Contains(HasSubstr("patch 2 has a colour spline of the wrong size")));

    // Terms without centres: 17 where there are 16 by default, and 2, which no side conditions allow.
    for (const int terms : {17, 2}) {
        spline = mesh.spline(PatchId(0));
        spline.terms[0] = uint8_t(terms);
        spline.coefficients.resize(spline.offset(3), 0);
        mesh.setSpline(PatchId(2), spline);
        EXPECT_THAT(validate(mesh).violations, Contains(HasSubstr("wrong size"))) << terms;
    }
}

TEST(Validate, FindsSplinesThatAreNotFinite) {
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        PatchMesh mesh = curvedMesh(32, 32, 2, 2, 1);
        PatchSpline spline = mesh.spline(PatchId(3));
        spline.coefficients[5] = bad;
        mesh.setSpline(PatchId(3), spline);
        EXPECT_THAT(validate(mesh).violations, Contains(HasSubstr("patch 3 has a colour spline")));
    }
}

TEST(Validate, FindsSplinesWithoutSideConditions) {
    for (const int alpha : {0, 7}) {
        PatchMesh mesh = curvedMesh(32, 32, 2, 2, 1);
        PatchSpline spline = mesh.spline(PatchId(1));
        spline.coefficients[spline.offset(2) + 3 + size_t(alpha)] += .01F;
        mesh.setSpline(PatchId(1), spline);
        const MeshValidation v = validate(mesh);
        EXPECT_EQ(v.violationCount, 1U);
        EXPECT_THAT(v.violations, Contains("patch 1 has a colour spline without its side conditions"));
    }
}

TEST(Validate, ChecksSmoothJoins) {
    // Edges 4-5 and 5-6 lie on one line; 5-6 and 5-9 make a right angle.
    PatchMesh mesh = nineCells();
    const EdgeId left = HalfedgeMesh::edge(between(mesh, 4, 5)),
                 right = HalfedgeMesh::edge(between(mesh, 5, 6)),
                 down = HalfedgeMesh::edge(between(mesh, 5, 9));
    mesh.setSmoothJoins({{VertexId(5), left, right}});
    EXPECT_THAT(validate(mesh).violations, IsEmpty());
    mesh.setSmoothJoins({{VertexId(5), right, down}});
    EXPECT_THAT(validate(mesh).violations, Contains("smooth join at vertex 5 is not smooth"));
    mesh.setSmoothJoins({{VertexId(5), right, right}});
    EXPECT_FALSE(validate(mesh).valid()) << "a curve that turns back is not smooth";
    mesh.setSmoothJoins({{VertexId(6), left, right}});
    EXPECT_FALSE(validate(mesh).valid()) << "the first curve does not end there";
}

TEST(Validate, NoticesAJoinThatTurnsByOneDegree) {
    PatchMesh mesh = gridMesh(90, 90, 3, 3);
    const HalfedgeId right = between(mesh, 5, 6);
    mesh.setSmoothJoins({{VertexId(5), HalfedgeMesh::edge(between(mesh, 4, 5)), HalfedgeMesh::edge(right)}});
    const auto p = mesh.controlPoints(right);
    mesh.setInnerControlPoints(right, p[1] + LatticePoint{0, 1}, p[2]);
    EXPECT_TRUE(validate(mesh).valid()) << "one lattice unit is rounding";
    mesh.setInnerControlPoints(right, p[1] + LatticePoint{0, 45}, p[2]);  // of 2560: one degree
    EXPECT_THAT(validate(mesh).violations, Contains(HasSubstr("is not smooth")));
}

TEST(Validate, KeepsAtMostAHundredSentencesButCountsAll) {
    PatchMesh mesh = gridMesh(20, 20, 10, 10);
    mesh.forEachPatch([&](PatchId p) { mesh.setInterior(p, {-100 * kPx, 0}); });
    const MeshValidation v = validate(mesh);
    EXPECT_EQ(v.violationCount, 200U);
    EXPECT_EQ(v.violations.size(), kMaxViolations);
}

TEST(Validate, StopsAtBrokenConnectivity) {
    // A pinch: both ends on the border.
    HalfedgeMesh strip = gridMesh(4, 1, 4, 1).connectivity();
    strip.collapse(strip.find(VertexId(2), VertexId(7)));
    PatchMesh pinched = gridMesh(4, 1, 4, 1);
    pinched.setConnectivity(strip);
    EXPECT_FALSE(validate(pinched).valid());
}

// A column of edges from the top of the picture down to y = 40, blurred, between random colours.
PatchMesh blurredCut() {
    PatchMesh mesh = gridMesh(60, 60, 6, 6);  // vertex (i, j) is 7 j + i, at (10 i, 10 j) px
    std::mt19937 random(9);
    mesh.forEachPatch([&](PatchId p) { mesh.setSpline(p, testing::randomSpline(3, random)); });
    for (uint32_t j = 0; j < 4; ++j) {
        const EdgeId e = HalfedgeMesh::edge(between(mesh, 7 * j + 3, 7 * j + 10));
        EdgeCurve curve = mesh.curve(e);
        curve.feature = true;
        curve.blurSigma = {2, 2};
        mesh.setCurve(e, curve);
    }
    return mesh;
}

TEST(Validate, ColourBreaksAreNoFeatures) {
    PatchMesh mesh = testing::gridMesh(40, 40, 2, 2);
    EdgeId inner, border;
    mesh.forEachEdge([&](EdgeId e) { (mesh.connectivity().onBorder(e) ? border : inner) = e; });
    EdgeCurve curve = mesh.curve(inner);
    curve.colourBreak = true;
    mesh.setCurve(inner, curve);
    EXPECT_TRUE(validate(mesh).valid());
    curve.feature = true;
    mesh.setCurve(inner, curve);
    EXPECT_THAT(validate(mesh).violations, Contains(HasSubstr("is a colour break on a feature")));
    mesh = testing::gridMesh(40, 40, 2, 2);
    curve = mesh.curve(border);
    curve.colourBreak = true;
    mesh.setCurve(border, curve);
    EXPECT_THAT(validate(mesh).violations, Contains(HasSubstr("is a colour break")));
}

TEST(Validate, BlurOnFeaturesAlone) {
    const PatchMesh sound = blurredCut();
    EXPECT_THAT(validate(sound).violations, IsEmpty());
    const EdgeId feature = HalfedgeMesh::edge(between(sound, 3, 10)),
                 other = HalfedgeMesh::edge(between(sound, 8, 9));
    const auto violations = [&](EdgeId e, float sigma) {
        PatchMesh mesh = sound;
        EdgeCurve curve = mesh.curve(e);
        curve.blurSigma[1] = sigma;
        mesh.setCurve(e, curve);
        return validate(mesh).violations;
    };
    EXPECT_THAT(violations(feature, -1), Contains(HasSubstr("negative or not finite")));
    EXPECT_THAT(violations(feature, std::numeric_limits<float>::infinity()),
                Contains(HasSubstr("negative or not finite")));
    EXPECT_THAT(violations(feature, std::numeric_limits<float>::quiet_NaN()),
                Contains(HasSubstr("negative or not finite")));
    EXPECT_THAT(violations(other, .5F), Contains(HasSubstr("is no feature")));
}

TEST(Validate, BlurThatLeavesAJumpIsTold) {
    const PatchMesh mesh = blurredCut();
    const EdgeBlur blur(mesh), hard(mesh, 0);
    const auto violations = [&](const ColourOf& colour) { return blurViolations(mesh, blur, colour).size(); };
    const auto right = [&](PatchId p, const Barycentric& at, glm::dvec2 point, double* out) {
        blurredColour(mesh, blur, p, at, point, out);
    };
    EXPECT_EQ(violations(right), 0U);
    const auto none = [&](PatchId p, const Barycentric& at, glm::dvec2 point, double* out) {
        blurredColour(mesh, hard, p, at, point, out);
    };
    EXPECT_EQ(violations(none), 4U);
    const auto exchanged = [&](PatchId p, const Barycentric& at, glm::dvec2 point, double* out) {
        double plain[kMaxChannels];
        none(p, at, point, plain);
        right(p, at, point, out);
        for (int c = 0; c < 3; ++c) out[c] = 2 * plain[c] - out[c];
    };
    EXPECT_EQ(violations(exchanged), 4U) << "own and other colour exchanged";
    const auto shifted = [&](PatchId p, const Barycentric& at, glm::dvec2 point, double* out) {
        right(p, at, point + glm::dvec2(0, .5), out);
    };
    EXPECT_EQ(violations(shifted), 4U) << "feet half a pixel off along the curve";
}

// The linear colour field 0.1 c + 0.01 x + 0.02 y on straight patches.
PatchMesh linearColours() {
    PatchMesh mesh = nineCells();
    const auto field = [](LatticePoint p, int c) {
        return .1 * c + .01 * toPixels(p).x + .02 * toPixels(p).y;
    };
    mesh.forEachPatch([&](PatchId p) {
        const LatticeTriangle t = mesh.controlPoints(p);
        PatchSpline spline;
        for (int c = 0; c < 3; ++c) {
            const double a = field(t.corner(0), c), b = field(t.corner(1), c), top = field(t.corner(2), c);
            spline.coefficients.insert(spline.coefficients.end(),
                                       {float(a), float(b - a), float((top - .5 * (a + b)) / kDomainHeight)});
        }
        mesh.setSpline(p, spline);
    });
    return mesh;
}

TEST(MeasureSeams, ZeroForOneLinearColour) {
    const SeamStatistics seams = measureSeams(linearColours());
    EXPECT_LT(seams.mean, 1e-4);  // coefficients are floats
    EXPECT_LT(seams.p95, 1e-4);
}

TEST(MeasureSeams, AKnownStep) {
    PatchMesh mesh = gridMesh(8, 8, 1, 1);
    const std::array<float, 3> colour{.1F, .2F, .3F};
    mesh.setSpline(PatchId(1), constantSpline(colour));
    // The mean of the channels: .2, in levels.
    EXPECT_NEAR(measureSeams(mesh).mean, .2 * 255, 1e-4);
    EXPECT_NEAR(measureSeams(mesh).p95, .2 * 255, 1e-4);

    const EdgeId e = HalfedgeMesh::edge(between(mesh, 0, 3));
    EdgeCurve curve = mesh.curve(e);
    curve.feature = true;
    mesh.setCurve(e, curve);
    EXPECT_EQ(measureSeams(mesh).mean, 0) << "features are no seams";
    EXPECT_EQ(measureSeams(mesh).p95, 0);
}

TEST(MeasureSeams, IsInTheWorkingSpace) {
    PatchMesh mesh = gridMesh(8, 8, 1, 1);
    mesh.setColourBasis(ColourBasis::Opponent);
    const std::array<float, 3> grey{float(.5 * std::sqrt(3)), 0, 0};
    mesh.setSpline(PatchId(1), constantSpline(grey));
    EXPECT_NEAR(measureSeams(mesh).mean, .5 * 255, 1e-4);
}

TEST(MeasureSeams, BlurMakesNone) {
    const PatchMesh mesh = blurredCut();
    PatchMesh hard = mesh;
    mesh.forEachEdge([&](EdgeId e) {
        EdgeCurve curve = mesh.curve(e);
        curve.blurSigma = {};
        hard.setCurve(e, curve);
    });
    EXPECT_GT(measureSeams(hard).mean, 1);
    EXPECT_NEAR(measureSeams(mesh).mean, measureSeams(hard).mean, .01);
}

TEST(MeasureSeams, WeightsByLength) {
    // Two cells of 3 px: the diagonals are sqrt 2 times as long as the side between the cells.
    PatchMesh mesh = gridMesh(6, 3, 2, 1);
    const std::array<float, 3> grey{.5F, .5F, .5F};
    // Patch 0 is upper right, patch 1 lower left of the left cell; the side between the cells has patches 0
    // and 3.
    mesh.setSpline(PatchId(1), constantSpline(grey));
    const double diagonal = std::sqrt(2);
    EXPECT_NEAR(measureSeams(mesh).mean, .5 * 255 * diagonal / (2 * diagonal + 1), 1e-4);
    EXPECT_NEAR(measureSeams(mesh).p95, .5 * 255, 1e-4);
}

TEST(MeasureSeams, ADifferenceThatGrowsAlongTheSeam) {
    PatchMesh mesh = gridMesh(8, 8, 1, 1);
    // Grey rises from 0 at one end of the diagonal to 1 at the other, in one patch alone.
    const HalfedgeId h = between(mesh, 0, 3);
    const PatchId p = mesh.connectivity().face(h);
    const auto corners = mesh.connectivity().corners(p);
    std::array<double, 3> at{};
    for (size_t k = 0; k < 3; ++k) at[k] = corners[k] == VertexId(3) ? 1 : 0;
    PatchSpline spline;
    for (int c = 0; c < 3; ++c)
        spline.coefficients.insert(
            spline.coefficients.end(),
            {float(at[0]), float(at[1] - at[0]), float((at[2] - .5 * (at[0] + at[1])) / kDomainHeight)});
    mesh.setSpline(p, spline);
    EXPECT_NEAR(measureSeams(mesh).mean, .5 * 255, 1e-3);
    EXPECT_NEAR(measureSeams(mesh).p95, 15.0 / 16 * 255, 1e-3)
        << "of 17 samples the last but one: the last counts half";
}

}  // namespace
}  // namespace tessera
