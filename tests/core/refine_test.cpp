#include "core/vectorize/refine.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <thread>

#include "core/base/parallel.h"
#include "tests/support/blurred_shapes.h"
#include "tests/support/cut_meshes.h"
#include "tests/support/stop_latency.h"

namespace tessera {
namespace {

using testing::cutMeshViolations;
using testing::detectedNetwork;
using ::testing::IsEmpty;
using testing::smallestAngle;

// A picture with its features cut out, and a mesh to begin with.
struct Start {
    Image sharp;
    VectorizeSettings settings;
    CutMesh cut;
};

Start startOf(const Image& image, int patches, double surplus = 3) {
    Start start;
    start.settings.patches = patches;
    const FeatureNetwork network = detectedNetwork(image, start.settings);
    start.sharp = virtualSharp(image, network);
    StageReport report;
    Progress progress;
    start.cut =
        buildCutMesh(start.sharp, network, size_t(surplus * patches), start.settings, report, progress)
            .value();
    return start;
}

Image painted(int width, int height, const std::function<double(double, double)>& colour) {
    Image image(width, height, 3);
    for (int c = 0; c < 3; ++c)
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                image.at(x, y, c) = float(colour(x + .5, y + .5)) * (c == 1 ? .8f : 1.f);
    return image;
}

Image waves(int width, int height) {
    return painted(width, height, [](double x, double y) {
        return .5 + .2 * std::sin(x / 5 + 2 * std::sin(y / 11)) + .2 * std::sin(x * y / 300);
    });
}

// A disc with a feature around it over waves that give all the rest something to do.
Image wavyDisc() {
    Image image = blurredDisc(100, {52.3, 47.8}, 27, .7);
    const Image texture = waves(100, 100);
    for (int c = 0; c < 3; ++c)
        for (size_t i = 0; i < image.planeSize(); ++i) image.plane(c)[i] += .15f * texture.plane(c)[i];
    return image;
}

// What the lattice and the test's own measure add; curves that were straightened to begin with may stay so.
double tolerancePx(const Start& start) {
    return std::max(start.settings.featureTolerancePx + .1, testing::furthestOffChain(start.cut) + 1e-9);
}

Result<CutMesh> refined(const Start& start, Progress& progress, std::string* shortfall = nullptr) {
    StageReport report;
    std::string unused;
    const PolynomialFit fit(start.sharp);
    return refine(start.cut, fit, start.settings, report, shortfall ? *shortfall : unused, progress);
}

CutMesh refined(const Start& start, std::string* shortfall = nullptr) {
    Progress progress;
    return refined(start, progress, shortfall).value();
}

bool same(const CutMesh& a, const CutMesh& b) {
    if (a.positions != b.positions || a.mesh.faceCapacity() != b.mesh.faceCapacity() ||
        a.mesh.faceCount() != b.mesh.faceCount())
        return false;
    for (uint32_t f = 0; f < a.mesh.faceCapacity(); ++f) {
        if (a.mesh.alive(FaceId(f)) != b.mesh.alive(FaceId(f))) return false;
        if (a.mesh.alive(FaceId(f)) && a.mesh.corners(FaceId(f)) != b.mesh.corners(FaceId(f))) return false;
    }
    return true;
}

TEST(Refine, ReachesThePatchesThatAreWanted) {
    const std::vector<std::pair<Image, const char*>> pictures{
        {Image(60, 50, 3, .4f), "flat"},
        {painted(60, 50, [](double x, double y) { return .2 + x / 200 + y / 150; }), "gradient"},
        {wavyDisc(), "disc"},
        {waves(90, 40), "waves"}};
    for (const auto& [image, name] : pictures)
        for (const int patches : {60, 150}) {
            const Start start = startOf(image, patches);
            std::string shortfall;
            const CutMesh cut = refined(start, &shortfall);
            EXPECT_LE(cut.mesh.faceCount(), size_t(patches)) << name;
            EXPECT_GE(cut.mesh.faceCount() + 3, size_t(patches)) << name;
            EXPECT_EQ(shortfall, "") << name;
            EXPECT_THAT(cutMeshViolations(cut, tolerancePx(start)), IsEmpty()) << name;
        }
}

TEST(Refine, TellsWhereFeaturesPinTheMesh) {
    Start start = startOf(wavyDisc(), 150);
    start.settings.patches = 2;
    std::string shortfall;
    const CutMesh cut = refined(start, &shortfall);
    EXPECT_GT(cut.mesh.faceCount(), 2U);
    EXPECT_NE(shortfall, "");
    EXPECT_THAT(cutMeshViolations(cut, tolerancePx(start)), IsEmpty());
}

// Flat pictures lose all but what the shapes of faces need.
TEST(Refine, AFlatPictureNeedsFewFaces) {
    const CutMesh cut = refined(startOf(Image(64, 64, 3, .4f), 4, 40));
    EXPECT_LE(cut.mesh.faceCount(), 12U);
}

TEST(Refiner, EachOperationKeepsTheInvariants) {
    Start start = startOf(wavyDisc(), 150);
    const PolynomialFit fit(start.sharp);
    CutMesh cut = start.cut;
    Refiner refiner(cut, fit, start.settings);
    // Faces that were worse to begin with may stay so.
    const double least = std::min(Refiner::kMinAngleDegrees, smallestAngle(cut)) - 1e-6;
    const auto check = [&](const char* what, double allowedDegrees) {
        EXPECT_THAT(cutMeshViolations(cut, tolerancePx(start)), IsEmpty()) << what;
        EXPECT_GE(smallestAngle(cut), allowedDegrees) << what;
        // What it has kept up is what it would find anew.
        const Refiner anew(cut, fit, start.settings);
        EXPECT_NEAR(refiner.totalError(), anew.totalError(), 1e-9 * anew.totalError()) << what;
        EXPECT_EQ(refiner.faceCount(), cut.mesh.faceCount());
    };
    Progress progress;
    for (const double step : {.3, .15, .1}) {
        double before = refiner.totalError();
        size_t faces = refiner.faceCount();
        const size_t flipped = refiner.flip();
        check("flip", least);
        EXPECT_LE(refiner.totalError(), before);
        EXPECT_EQ(refiner.faceCount(), faces);
        if (step == .3) {
            EXPECT_GT(flipped, 0U);
            EXPECT_LT(refiner.totalError(), before);
        }

        before = refiner.totalError();
        EXPECT_GT(refiner.move(step), 0U);
        check("move", least);
        EXPECT_LT(refiner.totalError(), before);

        ASSERT_TRUE(refiner.collapseTo(150, progress));
        check("collapse", least);
        EXPECT_LE(refiner.faceCount(), 150U);
        EXPECT_GE(refiner.faceCount(), 149U);

        before = refiner.totalError();
        faces = refiner.faceCount();
        refiner.splitTo(200);
        check("split", least);
        EXPECT_LT(refiner.totalError(), before);
        EXPECT_GT(refiner.faceCount(), faces);
        EXPECT_LE(refiner.faceCount(), 201U);
    }
    EXPECT_FALSE(cut.curves.empty());
}

TEST(Refiner, MeasuresWhatThePolynomialsLeave) {
    const Start quintic = startOf(painted(60, 50, [](double x, double y) { return .2 + x * y / 6000; }), 40);
    CutMesh cut = quintic.cut;
    EXPECT_NEAR(Refiner(cut, PolynomialFit(quintic.sharp), quintic.settings).totalError(), 0, 1e-4);
    const Start wavy = startOf(waves(60, 50), 40);
    cut = wavy.cut;
    EXPECT_GT(Refiner(cut, PolynomialFit(wavy.sharp), wavy.settings).totalError(), .01);
}

TEST(Refiner, FeaturesStayWhereTheyAre) {
    const Start start = startOf(blurredDisc(100, {52.3, 47.8}, 27, .7), 100);
    ASSERT_GT(start.cut.curves.size(), 4U);
    const CutMesh cut = refined(start);
    double length = 0;
    for (uint32_t e = 0; e < cut.mesh.edgeCapacity(); ++e) {
        const CutCurve* c = cut.mesh.alive(EdgeId(e)) ? cut.curve(EdgeId(e)) : nullptr;
        if (!c) continue;
        const BezierCurve curve = toPixels(c->controlPoints(c->from, cut.positions));
        length += curve.length();
        for (int k = 0; k <= 10; ++k) {
            const glm::dvec2 p = curve.at(k / 10.0);
            EXPECT_NEAR(std::hypot(p.x - 52.3, p.y - 47.8), 27, .6);
        }
    }
    EXPECT_NEAR(length, 2 * 3.14159265 * 27, 3);
}

// Refining is worth it: at the same number of faces less is left than a mesh of that size has to begin with.
TEST(Refine, LeavesLessThanItBeganWith) {
    const Start few = startOf(wavyDisc(), 150, 1.2), many = startOf(wavyDisc(), 150);
    CutMesh before = few.cut, after = refined(many);
    const PolynomialFit fit(many.sharp);
    EXPECT_GE(before.mesh.faceCount() + 20, after.mesh.faceCount());
    EXPECT_LT(Refiner(after, fit, many.settings).totalError(),
              .6 * Refiner(before, fit, many.settings).totalError());
}

TEST(Refine, DoesNotDependOnThreads) {
    const Start start = startOf(wavyDisc(), 200);
    CutMesh one;
    withThreads(1, [&] { one = refined(start); });
    for (const int threads : {2, 7}) {
        CutMesh many;
        withThreads(threads, [&] { many = refined(start); });
        EXPECT_TRUE(same(one, many)) << threads;
    }
    EXPECT_FALSE(same(one, start.cut));
}

TEST(Refine, StopsWithin50Ms) {
    const Start start = startOf(waves(700, 500), 3000);
    for (const int delayMs : {0, 5, 60, 300}) {
        const double latency = leastOfTries(50, [&] {
            const PolynomialFit fit(start.sharp);
            CutMesh cut = start.cut;
            return stopLatencyMs(delayMs, [&](Progress& progress) {
                StageReport report;
                std::string shortfall;
                return refine(std::move(cut), fit, start.settings, report, shortfall, progress);
            });
        });
        EXPECT_LT(latency, 50) << delayMs;
    }
}

}  // namespace
}  // namespace tessera
