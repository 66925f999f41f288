// Blurred features: the profile across them, where they fade and where they end, and both renderers.
#include "core/mesh/edge_blur.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>

#include "core/base/parallel.h"
#include "core/export/rasterize.h"
#include "core/mesh/colour_basis.h"
#include "core/mesh/patch_query.h"
#include "tests/support/test_meshes.h"

namespace tessera {
namespace {

using testing::curvedMesh;
using testing::gridMesh;
using testing::randomSpline;

void makeFeature(PatchMesh& mesh, uint32_t a, uint32_t b, float sigma) {
    const EdgeId e = HalfedgeMesh::edge(mesh.connectivity().find(VertexId(a), VertexId(b)));
    EdgeCurve curve = mesh.curve(e);
    curve.feature = true;
    curve.blurSigma = {sigma, sigma};
    mesh.setCurve(e, curve);
}

// Patches with their centre left of x get one colour, the others another.
constexpr std::array<float, 3> kLeft{.1f, .8f, .3f}, kRight{.9f, .2f, .4f};
void paintSides(PatchMesh& mesh, double x) {
    mesh.forEachPatch([&](PatchId p) {
        const double third = 1.0 / 3;
        const bool left = evaluate(toPixels(mesh.controlPoints(p)), {third, third, third}).x < x;
        mesh.setSpline(p, constantSpline(left ? kLeft : kRight));
    });
}

// 40 x 30 px, cut from top to bottom at x = 20 by one feature edge.
PatchMesh cutSquare(float sigma) {
    PatchMesh mesh = gridMesh(40, 30, 2, 1);
    makeFeature(mesh, 1, 4, sigma);
    paintSides(mesh, 20);
    return mesh;
}

// The same with a bent cut and random colours.
PatchMesh bentCut(float sigma) {
    PatchMesh mesh = cutSquare(sigma);
    const HalfedgeId h = mesh.connectivity().find(VertexId(1), VertexId(4));
    mesh.setInnerControlPoints(h, toLattice({25, 9}), toLattice({16, 22}));
    std::mt19937 random(3);
    mesh.forEachPatch([&](PatchId p) {
        const auto interior = certifiedInterior(mesh.controlPoints(p));
        ASSERT_TRUE(interior);
        mesh.setInterior(p, *interior);
        mesh.setSpline(p, randomSpline(3, random));
    });
    return mesh;
}

// 60 x 60 px in 6 x 6 cells; vertex (i, j) is 7 j + i, at (10 i, 10 j) px. The column of edges at x = 30 is a
// feature from the top down to row `last`.
PatchMesh halfCut(float sigma, uint32_t last) {
    PatchMesh mesh = gridMesh(60, 60, 6, 6);
    for (uint32_t j = 0; j < last; ++j) makeFeature(mesh, 7 * j + 3, 7 * j + 10, sigma);
    paintSides(mesh, 30);
    return mesh;
}

Image render(const PatchMesh& mesh, double scale, const RasterizeOptions& options = {}) {
    Result<Image> image = rasterize(mesh, wholePicture(mesh, {scale, scale}), options);
    EXPECT_TRUE(image);
    return image ? std::move(*image) : Image();
}

double largestDifference(const Image& a, const Image& b) {
    double worst = 0;
    for (int c = 0; c < a.channels(); ++c)
        for (size_t i = 0; i < a.plane(c).size(); ++i)
            worst = std::max(worst, std::abs(double(a.plane(c)[i]) - double(b.plane(c)[i])));
    return worst;
}

bool sameBytes(const Image& a, const Image& b) {
    for (int c = 0; c < a.channels(); ++c)
        if (!std::equal(a.plane(c).begin(), a.plane(c).end(), b.plane(c).begin(), b.plane(c).end()))
            return false;
    return true;
}

// What the blur adds at a point, in channel 0.
double blurAt(const PatchMesh& mesh, const EdgeBlur& blur, glm::dvec2 point) {
    const auto hit = PatchQuery(mesh).patchAt(point);
    EXPECT_TRUE(hit);
    double colour[kMaxChannels];
    blurredColour(mesh, blur, hit->patch, hit->at, point, colour);
    return colour[0] - evaluateSpline(mesh.spline(hit->patch), 0, domainPoint(hit->at));
}

TEST(EdgeBlur, ProfileAcrossAStraightCutIsTheShare) {
    constexpr double kSigma = 2.5, kScale = 4;
    const PatchMesh mesh = cutSquare(float(kSigma));
    const Image image = render(mesh, kScale);
    double worst = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            const double offset = (x + .5) / kScale - 20, share = blurShare(std::abs(offset) / kSigma);
            for (int c = 0; c < 3; ++c) {
                const auto [own, other] = offset < 0 ? std::pair(kLeft, kRight) : std::pair(kRight, kLeft);
                const double expected =
                    (1 - share) * double(own[size_t(c)]) + share * double(other[size_t(c)]);
                worst = std::max(worst, std::abs(double(image.at(x, y, c)) - expected));
            }
        }
    EXPECT_LT(worst, 1e-5);
}

TEST(EdgeBlur, SigmaRunsLinearlyAlongTheEdge) {
    PatchMesh mesh = cutSquare(1);
    const HalfedgeId h = mesh.connectivity().find(VertexId(1), VertexId(4));
    EdgeCurve curve = mesh.curve(HalfedgeMesh::edge(h));
    curve.blurSigma =
        h == HalfedgeMesh::halfedge(HalfedgeMesh::edge(h)) ? std::array{1.f, 3.f} : std::array{3.f, 1.f};
    mesh.setCurve(HalfedgeMesh::edge(h), curve);
    const EdgeBlur blur(mesh);
    const double jump = double(kRight[0] - kLeft[0]);
    for (const double y : {3.0, 15.0, 28.0})
        EXPECT_NEAR(blurAt(mesh, blur, {18, y}), jump * blurShare(2 / (1 + 2 * y / 30)), 1e-6) << y;
}

TEST(EdgeBlur, IsContinuousAcrossABentCut) {
    const PatchMesh mesh = bentCut(1.5f);
    const EdgeBlur blur(mesh), hard(mesh, 0);
    const PatchQuery query(mesh);
    const auto curve = toPixels(mesh.controlPoints(mesh.connectivity().find(VertexId(1), VertexId(4))));
    double worst = 0, worstHard = 0;
    for (int i = 1; i < 100; ++i) {
        const glm::dvec2 d = curve.derivative(i / 100.0), normal = glm::normalize(glm::dvec2(-d.y, d.x));
        double colours[2][2][kMaxChannels];
        for (int side = 0; side < 2; ++side) {
            const glm::dvec2 point = curve.at(i / 100.0) + (side ? 1e-4 : -1e-4) * normal;
            const auto hit = query.patchAt(point);
            ASSERT_TRUE(hit);
            blurredColour(mesh, blur, hit->patch, hit->at, point, colours[0][side]);
            blurredColour(mesh, hard, hit->patch, hit->at, point, colours[1][side]);
        }
        for (int c = 0; c < 3; ++c) {
            worst = std::max(worst, std::abs(colours[0][0][c] - colours[0][1][c]));
            worstHard = std::max(worstHard, std::abs(colours[1][0][c] - colours[1][1][c]));
        }
    }
    EXPECT_LT(worst, 1e-3);
    EXPECT_GT(worstHard, .1) << "there is a jump to blur";
}

TEST(EdgeBlur, FootIsTheNearestPointOfABentCut) {
    const PatchMesh mesh = bentCut(2);
    const EdgeBlur blur(mesh);
    const PatchQuery query(mesh);
    const auto curve = toPixels(mesh.controlPoints(mesh.connectivity().find(VertexId(1), VertexId(4))));
    int inside = 0;
    for (double y = .25; y < 30; y += .5)
        for (double x = 12.25; x < 30; x += .5) {
            // From 10000 samples, not by the method under test.
            double distance = 1e9;
            for (int i = 0; i <= 10000; ++i)
                distance = std::min(distance, glm::distance(curve.at(i * 1e-4), {x, y}));
            const auto hit = query.patchAt({x, y});
            ASSERT_TRUE(hit);
            std::array<BlurTerm, kMaxBlurTerms> terms;
            const int count = blur.terms(hit->patch, {x, y}, terms);
            if (distance > 5.9) continue;
            ++inside;
            ASSERT_EQ(count, 1) << x << ' ' << y;
            EXPECT_NEAR(double(terms[0].weight), blurShare(distance / 2), 1e-4);
            // Both parameters are those of one point, at that distance.
            for (const auto& [p, at] :
                 {std::pair(terms[0].own, terms[0].ownAt), std::pair(terms[0].other, terms[0].otherAt)})
                EXPECT_NEAR(
                    glm::distance(evaluate(toPixels(mesh.controlPoints(p)), barycentricOf(at)), {x, y}),
                    distance, 1e-4);
        }
    EXPECT_GT(inside, 1000);
}

TEST(EdgeBlur, FadesBeforeAFreeTip) {
    constexpr double kSigma = 1.5;
    const PatchMesh mesh = halfCut(float(kSigma), 4);
    const EdgeBlur blur(mesh);
    const double jump = double(kRight[0] - kLeft[0]);
    const glm::dvec2 tip(30, 40);
    for (const double arc : {.5, 2.0, 5.0, 7.0, 20.0})
        EXPECT_NEAR(blurAt(mesh, blur, tip + glm::dvec2(-1, -arc)),
                    jump * blurShare(1 / kSigma) * blurFade(arc, kSigma), 1e-5)
            << arc;
    // Around the tip nothing jumps: the blur is near 0 there, and 0 beyond it.
    for (int i = 0; i < 64; ++i) {
        const double angle = 2 * std::numbers::pi * (i + .3) / 64;
        const glm::dvec2 point = tip + .3 * kSigma * glm::dvec2(std::cos(angle), std::sin(angle));
        EXPECT_LE(std::abs(blurAt(mesh, blur, point)), point.y >= 40 ? 1e-9 : .02 * std::abs(jump)) << angle;
    }
    // At the picture's border there is no tip.
    EXPECT_NEAR(blurAt(mesh, blur, {29, .01}), jump * blurShare(1 / kSigma), 1e-6);
}

TEST(EdgeBlur, FadesBeforeAJunctionAndNotBeforeAVertexOfTheChain) {
    PatchMesh mesh = halfCut(1, 6);
    const double jump = double(kRight[0] - kLeft[0]);
    EXPECT_NEAR(blurAt(mesh, EdgeBlur(mesh), {29.5, 30.1}), jump * blurShare(.5), 1e-6);
    makeFeature(mesh, 7 * 3 + 3, 7 * 3 + 4, 1);  // to the right from (30, 30)
    EXPECT_NEAR(blurAt(mesh, EdgeBlur(mesh), {29.5, 30.1}), jump * blurShare(.5) * blurFade(.1, 1), 1e-6);
}

TEST(EdgeBlur, AClosedChainHasNoEnds) {
    PatchMesh mesh = gridMesh(60, 60, 6, 6);
    const uint32_t ring[] = {16, 17, 18, 25, 32, 31, 30, 23};  // around (30, 30), 10 px away
    for (size_t i = 0; i < 8; ++i) makeFeature(mesh, ring[i], ring[(i + 1) % 8], 1);
    mesh.forEachPatch([&](PatchId p) {
        const double third = 1.0 / 3;
        const glm::dvec2 d =
            evaluate(toPixels(mesh.controlPoints(p)), {third, third, third}) - glm::dvec2(30);
        mesh.setSpline(p, constantSpline(std::max(std::abs(d.x), std::abs(d.y)) < 10 ? kLeft : kRight));
    });
    const EdgeBlur blur(mesh);
    const double jump = double(kRight[0] - kLeft[0]);
    for (const glm::dvec2 inside : {glm::dvec2(21, 30), {21, 36}, {39, 25}, {30, 39}, {33, 21}})
        EXPECT_NEAR(blurAt(mesh, blur, inside), jump * blurShare(1), 1e-6);
    // Outside a corner, where the nearest point is the corner itself.
    EXPECT_NEAR(blurAt(mesh, blur, {19.4, 19.2}), -jump * blurShare(1), 1e-6);
    EXPECT_NEAR(blurAt(mesh, blur, {40.6, 40.8}), -jump * blurShare(1), 1e-6);
}

TEST(EdgeBlur, DoesNotReachBeyondAnotherFeature) {
    PatchMesh mesh = gridMesh(60, 30, 20, 1);  // columns of 3 px; vertex (i, j) is 21 j + i
    makeFeature(mesh, 10, 31, 3);              // x = 30, reaches 9 px
    PatchMesh guarded = mesh;
    makeFeature(guarded, 11, 32, 0);  // x = 33, hard
    const auto patchAt = [&](double x) { return PatchQuery(mesh).patchAt({x, 10})->patch; };
    std::array<BlurTerm, kMaxBlurTerms> terms;
    EXPECT_EQ(EdgeBlur(mesh).terms(patchAt(34), {34, 10}, terms), 1);
    EXPECT_EQ(EdgeBlur(guarded).terms(patchAt(34), {34, 10}, terms), 0);
    EXPECT_EQ(EdgeBlur(guarded).terms(patchAt(32), {32, 10}, terms), 1);
    EXPECT_TRUE(EdgeBlur(mesh).inReach(patchAt(38)));
    EXPECT_FALSE(EdgeBlur(mesh).inReach(patchAt(50)));
    EXPECT_FALSE(EdgeBlur(mesh, 0).inReach(patchAt(32)));
    EXPECT_TRUE(EdgeBlur(mesh, 3).inReach(patchAt(50)));
}

// The same elements in memory of their own, with an index of their own.
PatchMesh rebuilt(const PatchMesh& mesh) {
    std::vector<LatticePoint> positions;
    mesh.forEachVertex([&](VertexId v) { positions.push_back(mesh.position(v)); });
    PatchMesh copy(mesh.width(), mesh.height(), mesh.channels(), mesh.connectivity(), positions);
    mesh.forEachEdge([&](EdgeId e) { copy.setCurve(e, mesh.curve(e)); });
    mesh.forEachPatch([&](PatchId p) {
        copy.setInterior(p, mesh.interior(p));
        copy.setSpline(p, mesh.spline(p));
    });
    return copy;
}

TEST(EdgeBlurCache, KeepsTheIndexWhileTheGeometryStays) {
    PatchMesh mesh = bentCut(2);
    const auto first = edgeBlurOf(mesh);
    PatchMesh copy = mesh;
    copy.setSpline(PatchId(0), constantSpline(kLeft));
    copy.setAttributes(PatchId(1), {.hidden = true});
    EXPECT_EQ(edgeBlurOf(copy), first);
    // Moved and put back without being drawn in between: the values count, not what was written.
    const LatticePoint interior = copy.interior(PatchId(0));
    copy.setInterior(PatchId(0), interior + LatticePoint{1, 0});
    copy.setInterior(PatchId(0), interior);
    EXPECT_EQ(edgeBlurOf(copy), first);
    EXPECT_NE(edgeBlurOf(copy, 2), first) << "another sharpen";
    EXPECT_NE(edgeBlurOf(mesh), nullptr);
    EXPECT_TRUE(edgeBlurOf(PatchMesh())->features().empty());
}

// Whatever is edited, the picture is that of a mesh that has never been drawn before.
TEST(EdgeBlurCache, FollowsEveryEditOfTheGeometry) {
    const PatchMesh start = bentCut(2);
    const HalfedgeId cut = start.connectivity().find(VertexId(1), VertexId(4));
    const EdgeId e = HalfedgeMesh::edge(cut);
    const auto withCurve = [&](auto&& change) {
        return [e, change](PatchMesh& mesh) {
            EdgeCurve curve = mesh.curve(e);
            change(curve);
            mesh.setCurve(e, curve);
        };
    };
    const std::function<void(PatchMesh&)> edits[] = {
        [](PatchMesh& mesh) {
            mesh.setPosition(VertexId(1), mesh.position(VertexId(1)) + LatticePoint{700, 0});
        },
        [cut](PatchMesh& mesh) { mesh.setInnerControlPoints(cut, toLattice({22, 8}), toLattice({18, 21})); },
        withCurve([](EdgeCurve& curve) { curve.blurSigma[0] = 1; }),
        withCurve([](EdgeCurve& curve) { curve.blurSigma = {0, 0}; }),
        withCurve([](EdgeCurve& curve) { curve.feature = false; }),
        [](PatchMesh& mesh) {
            HalfedgeMesh c = mesh.connectivity();
            for (const auto& [a, b] : {std::pair(0u, 4u), {3u, 1u}, {1u, 5u}, {4u, 2u}}) {
                const HalfedgeId h = c.find(VertexId(a), VertexId(b));
                if (!h.valid() || !c.canFlip(HalfedgeMesh::edge(h))) continue;
                c.flip(HalfedgeMesh::edge(h));
                mesh.setConnectivity(c);
                const auto inner =
                    straightControlPoints(mesh.position(c.origin(h)), mesh.position(c.target(h)));
                mesh.setInnerControlPoints(h, inner[0], inner[1]);
                return;
            }
            FAIL() << "no diagonal to flip";
        }};
    const Image before = render(start, 3);
    for (size_t i = 0; i < std::size(edits); ++i) {
        PatchMesh mesh = start;
        edits[i](mesh);
        const Image after = render(mesh, 3);
        EXPECT_FALSE(sameBytes(after, before)) << i;
        EXPECT_TRUE(sameBytes(after, render(rebuilt(mesh), 3))) << i;
        EXPECT_TRUE(sameBytes(render(start, 3), before)) << i << ", undone";
    }
}

TEST(EdgeBlur, TwoChainsGiveTwoTerms) {
    PatchMesh mesh = gridMesh(60, 30, 20, 1);
    makeFeature(mesh, 10, 31, 2);
    makeFeature(mesh, 11, 32, 2);
    std::array<BlurTerm, kMaxBlurTerms> terms;
    EXPECT_EQ(EdgeBlur(mesh).terms(PatchQuery(mesh).patchAt({31, 10})->patch, {31, 10}, terms), 2);
    EXPECT_NEAR(terms[0].weight, blurShare(.5), 1e-6);
    EXPECT_NEAR(terms[1].weight, blurShare(1), 1e-6);
}

// Random patches, curves and blurs: every third inner edge is a feature.
PatchMesh blurredMesh(unsigned seed) {
    PatchMesh mesh = curvedMesh(192, 128, 6, 4, seed);
    mesh.forEachEdge([&](EdgeId e) {
        EdgeCurve curve = mesh.curve(e);
        if (curve.feature) curve.blurSigma = {.5f + float(e.index % 4), .5f + float(e.index % 3)};
        mesh.setCurve(e, curve);
    });
    return mesh;
}

// The largest difference of addBlur from blurredColour over a grid of points `step` px apart, and where more
// than the terms that a point can have are near.
double largestErrorOfAddBlur(const PatchMesh& mesh, double step) {
    const EdgeBlur blur(mesh);
    const PatchQuery query(mesh);
    double worst = 0;
    for (double y = .123; y < mesh.height(); y += step)
        for (double x = .077; x < mesh.width(); x += step) {
            const auto hit = query.patchAt({x, y});
            if (!hit) continue;
            double plain[kMaxChannels];
            blurredColour(mesh, blur, hit->patch, hit->at, {x, y}, plain);
            const glm::dvec2 origin =
                evaluate(toPixels(mesh.controlPoints(hit->patch)), Barycentric(1.0 / 3));
            const auto offX = float(x - origin.x), offY = float(y - origin.y);
            float fast[kMaxChannels] = {};
            float* const out[] = {&fast[0], &fast[1], &fast[2], &fast[3]};
            addBlur(mesh, blur, hit->patch, origin, &offX, &offY, 1, out);
            for (int c = 0; c < 3; ++c)
                worst = std::max(worst,
                                 std::abs(plain[c] - double(fast[c]) -
                                          evaluateSpline(mesh.spline(hit->patch), c, domainPoint(hit->at))));
        }
    return worst;
}

TEST(AddBlur, IsBlurredColourInSinglePrecision) {
    EXPECT_LT(largestErrorOfAddBlur(bentCut(2), .5), 1e-4);
    EXPECT_LT(largestErrorOfAddBlur(halfCut(1, 3), .5), 1e-4);
}

TEST(AddBlur, TakesTheHeaviestTermsWhereManyChainsAre) {
    PatchMesh mesh = gridMesh(60, 60, 6, 6);
    for (uint32_t i = 1; i < 6; ++i) makeFeature(mesh, 14 + i, 21 + i, 8);  // chains of one edge, 10 px apart
    std::mt19937 random(8);
    mesh.forEachPatch([&](PatchId p) { mesh.setSpline(p, randomSpline(3, random)); });
    const EdgeBlur blur(mesh);
    const PatchQuery query(mesh);
    size_t full = 0;
    for (double y = 1.3; y < 40; y += .7)
        for (double x = 1.7; x < 40; x += .7) {
            std::array<BlurTerm, kMaxBlurTerms> terms;
            full += blur.terms(query.patchAt({x, y})->patch, {x, y}, terms) == kMaxBlurTerms;
        }
    EXPECT_GT(full, 0u);
    EXPECT_LT(largestErrorOfAddBlur(mesh, .7), 1e-4);
}

TEST(AddBlur, APointDoesNotDependOnItsNeighbours) {
    const PatchMesh mesh = bentCut(2);
    const EdgeBlur blur(mesh);
    const PatchId p = PatchQuery(mesh).patchAt({22, 12})->patch;
    const glm::dvec2 origin(20, 10);
    constexpr size_t kCount = 53;
    std::array<float, kCount> x, y;
    for (size_t i = 0; i < kCount; ++i) {
        x[i] = .21F * float(i % 11);
        y[i] = .37F * float(i % 7);
    }
    std::array<std::array<float, kCount>, 3> together{};
    float* const out[] = {together[0].data(), together[1].data(), together[2].data()};
    addBlur(mesh, blur, p, origin, x.data(), y.data(), kCount, out);
    for (size_t i = 0; i < kCount; ++i) {
        std::array<float, 3> alone{};
        float* const one[] = {&alone[0], &alone[1], &alone[2]};
        addBlur(mesh, blur, p, origin, &x[i], &y[i], 1, one);
        for (size_t c = 0; c < 3; ++c) EXPECT_EQ(alone[c], together[c][i]);
    }
    EXPECT_NE(together[0][0], 0);
}

// The vertex of a bend is the nearest point of a whole wedge, on both edges: the first one's colours are
// taken, also where rounding brings the second one nearer.
TEST(EdgeBlur, BesideABendTheFirstEdgeCounts) {
    PatchMesh mesh = halfCut(2, 3);  // down to (30, 30), then to the right
    makeFeature(mesh, 24, 25, 2);
    const EdgeBlur blur(mesh);
    const PatchQuery query(mesh);
    const PatchId first = mesh.connectivity().face(mesh.connectivity().find(VertexId(24), VertexId(17)));
    const PatchId beyond = mesh.connectivity().face(mesh.connectivity().find(VertexId(17), VertexId(24)));
    int points = 0;
    for (double y = 30.05; y < 34; y += .3)
        for (double x = 26.03; x < 30; x += .3) {
            std::array<BlurTerm, kMaxBlurTerms> terms;
            const PatchId p = query.patchAt({x, y})->patch;
            if (blur.terms(p, {x, y}, terms) != 1) continue;
            ++points;
            EXPECT_EQ(std::minmax(terms[0].own, terms[0].other), std::minmax(first, beyond)) << x << ' ' << y;
        }
    EXPECT_GT(points, 50);
}

TEST(BlurredRendering, FastIsTheReference) {
    for (unsigned seed = 1; seed <= 3; ++seed) {
        const PatchMesh mesh = blurredMesh(seed);
        for (const double sharpen : {1.0, .4, 2.0}) {
            const View view = wholePicture(mesh, {1.5, 1.5});
            const Image fast = render(mesh, 1.5, {.sharpen = sharpen});
            const Image reference = rasterizeReference(mesh, view, sharpen);
            const auto owners = locatePixels(mesh, view), referenceOwners = locatePixelsReference(mesh, view);
            size_t apart = 0;
            for (size_t i = 0; i < owners.size(); ++i) {
                double difference = 0;
                for (int c = 0; c < 3; ++c)
                    difference = std::max(difference,
                                          std::abs(double(fast.plane(c)[i]) - double(reference.plane(c)[i])));
                apart += owners[i].patch == referenceOwners[i].patch && difference > 1.0 / 255;
            }
            EXPECT_LE(apart, owners.size() / 10000) << seed << ' ' << sharpen;
        }
    }
}

TEST(BlurredRendering, SharpenZeroIsHardAndOneIsNot) {
    const PatchMesh mesh = blurredMesh(1);
    PatchMesh hard = mesh;
    mesh.forEachEdge([&](EdgeId e) {
        EdgeCurve curve = mesh.curve(e);
        curve.blurSigma = {};
        hard.setCurve(e, curve);
    });
    EXPECT_TRUE(sameBytes(render(mesh, 1, {.sharpen = 0}), render(hard, 1)));
    EXPECT_GT(largestDifference(render(mesh, 1), render(hard, 1)), .1);
}

TEST(BlurredRendering, DoesNotDependOnThreadsOrTiles) {
    const PatchMesh mesh = blurredMesh(2);
    Image one, other;
    withThreads(1, [&] { one = render(mesh, 2, {.samples = 4}); });
    for (const int threads : {2, 7}) {
        withThreads(threads, [&] { other = render(mesh, 2, {.samples = 4}); });
        EXPECT_TRUE(sameBytes(one, other)) << threads;
    }
    const Image whole = render(mesh, 2);
    View part = wholePicture(mesh, {2, 2});
    part.origin = {20, 15};
    part.width = 150;
    part.height = 100;
    const auto cut = rasterize(mesh, part);
    ASSERT_TRUE(cut);
    for (int y = 0; y < part.height; ++y)
        for (int x = 0; x < part.width; ++x)
            for (int c = 0; c < 3; ++c) ASSERT_EQ(cut->at(x, y, c), whole.at(x + 40, y + 30, c));
}

TEST(BlurredRendering, OpponentColoursLookLikeTheirRgb) {
    const PatchMesh mesh = blurredMesh(3);
    PatchMesh opponent = mesh;
    opponent.setColourBasis(ColourBasis::Opponent);
    mesh.forEachPatch([&](PatchId p) {
        PatchSpline spline = mesh.spline(p);
        float* planes[3];
        for (int c = 0; c < 3; ++c) planes[c] = &spline.coefficients[spline.offset(c)];
        fromWorking(ColourBasis::Opponent, planes, spline.coefficients.size() / 3);
        opponent.setSpline(p, spline);
    });
    EXPECT_LT(largestDifference(render(mesh, 1), render(opponent, 1)), 1e-4);
    const View view = wholePicture(mesh, {1, 1});
    EXPECT_LT(largestDifference(rasterizeReference(mesh, view), rasterizeReference(opponent, view)), 1e-5);
}

}  // namespace
}  // namespace tessera
