#include "core/vectorize/cut_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tests/support/blurred_shapes.h"
#include "tests/support/cut_meshes.h"

namespace tessera {
namespace {

using testing::cutMeshViolations;
using testing::detectedNetwork;
using ::testing::IsEmpty;

constexpr double kTolerancePx = .6;  // of features, and the lattice's rounding

CutMesh build(const Image& sharp, const FeatureNetwork& network, size_t faces,
              StageReport* report = nullptr) {
    StageReport unused;
    Progress progress;
    return buildCutMesh(sharp, network, faces, {}, report ? *report : unused, progress).value();
}

FeatureNetwork noFeatures(const Image& image) {
    FeatureNetwork network;
    network.width = image.width();
    network.height = image.height();
    return network;
}

Image disc() {
    return blurredDisc(80, {41.3, 38.7}, 24, .7);
}

CutMesh ofDisc(size_t faces = 400) {
    const Image image = disc();
    const FeatureNetwork network = detectedNetwork(image, {});
    return build(virtualSharp(image, network), network, faces);
}

TEST(CutMesh, OfFlatPicturesIsEven) {
    for (const auto& [width, height] : {std::pair{60, 40}, {7, 90}, {1, 1}, {2, 1}}) {
        const Image image(width, height, 3, .4f);
        const CutMesh cut = build(image, noFeatures(image), 200);
        EXPECT_THAT(cutMeshViolations(cut, kTolerancePx), IsEmpty()) << width << "x" << height;
        EXPECT_TRUE(cut.curves.empty());
        if (width < 60) continue;
        EXPECT_NEAR(double(cut.mesh.faceCount()), 200, 60);
        // As many vertices in the left half as in the right one, about.
        int left = 0, right = 0;
        for (const LatticePoint p : cut.positions) ++(p.x < 30 * kLatticePerPixel ? left : right);
        EXPECT_NEAR(left, right, 10);
    }
}

TEST(CutMesh, HasAboutTheFacesThatAreWanted) {
    for (const auto& [width, height] : {std::pair{600, 400}, {90, 700}}) {
        const Image image(width, height, 3, .4f);
        for (const size_t faces : {20, 60, 300, 5000})
            EXPECT_NEAR(double(build(image, noFeatures(image), faces).mesh.faceCount()) / double(faces), 1,
                        .2)
                << width << "x" << height << ' ' << faces;
    }
}

// A feature from (x, 0) straight down.
FeatureNetwork oneFeature(int width, int height, LatticePoint top) {
    FeatureNetwork network{width, height, {}, {}, {}};
    FeatureChain chain;
    constexpr int kSteps = 12;
    for (int i = 0; i <= kSteps; ++i) {
        FeaturePoint point;
        point.position = toPixels(top) + glm::dvec2(0, i);
        chain.points.push_back(point);
    }
    chain.ends = {ChainEnd::Border, ChainEnd::Tip};
    const LatticePoint bottom{top.x, kSteps * kLatticePerPixel};
    network.chains = {chain};
    network.nodes = {{top, FeatureNodeKind::Border}, {bottom, FeatureNodeKind::Tip}};
    network.segments = {{0, 1, 0, 0, kSteps, straightControlPoints(top, bottom), {.5F, .5F}}};
    return network;
}

// A point of the border that lies beside the feature's end makes a face that rounding would fold.
TEST(CutMesh, LeavesOutPointsThatMakeThinFaces) {
    const Image image(60, 40, 3, .4f);
    std::set<int> onTop;
    for (const LatticePoint p : build(image, noFeatures(image), 200).positions)
        if (p.y == 0) onTop.insert(p.x);
    ASSERT_GT(onTop.size(), 4U);
    const int beside = *std::next(onTop.begin(), 3);
    for (const int steps : {1, 2, 5, 30}) {
        const LatticePoint top{beside + steps, 0};
        const CutMesh cut = build(image, oneFeature(60, 40, top), 200);
        EXPECT_THAT(cutMeshViolations(cut, kTolerancePx), IsEmpty()) << steps;
        EXPECT_EQ(cut.curves.size(), 1U) << steps;
        EXPECT_TRUE(validate(toPatchMesh(cut, 3)).valid());
    }
    // Beside the picture's corner it is the feature that goes.
    const CutMesh cut = build(image, oneFeature(60, 40, {1, 0}), 200);
    EXPECT_THAT(cutMeshViolations(cut, kTolerancePx), IsEmpty());
    EXPECT_TRUE(cut.curves.empty());
}

TEST(CutMesh, HasMorePointsWhereThePictureIsRich) {
    Image image(100, 60, 3, .5f);
    for (int c = 0; c < 3; ++c)
        for (int y = 0; y < 60; ++y)
            for (int x = 50; x < 100; ++x) image.at(x, y, c) = (x / 2 + y / 2) % 2 ? .9f : .1f;
    const CutMesh cut = build(image, noFeatures(image), 400);
    EXPECT_THAT(cutMeshViolations(cut, kTolerancePx), IsEmpty());
    int left = 0, right = 0;
    for (const LatticePoint p : cut.positions) ++(p.x < 44 * kLatticePerPixel ? left : right);
    EXPECT_GT(right, 3 * left);
}

TEST(CutMesh, KindsTellWhereVerticesLie) {
    const CutMesh cut = ofDisc();
    const int far = 80 * kLatticePerPixel;
    int features = 0;
    for (uint32_t v = 0; v < cut.positions.size(); ++v) {
        const LatticePoint p = cut.positions[v];
        const bool x = p.x == 0 || p.x == far, y = p.y == 0 || p.y == far;
        const VertexKind kind = cut.kinds[v];
        EXPECT_EQ(kind == VertexKind::Corner, x && y);
        EXPECT_EQ(kind == VertexKind::Border, x != y);
        EXPECT_EQ(cut.mesh.onBorder(VertexId(v)), x || y);
        features += kind == VertexKind::Feature || kind == VertexKind::FeatureEnd;
    }
    EXPECT_EQ(size_t(features), cut.curves.size());  // one closed chain
}

TEST(CutMesh, TakesTheFeaturesOfADisc) {
    const Image image = disc();
    const FeatureNetwork network = detectedNetwork(image, {});
    ASSERT_GT(network.segments.size(), 2U);
    StageReport report;
    const CutMesh cut = build(virtualSharp(image, network), network, 400, &report);
    EXPECT_THAT(cutMeshViolations(cut, kTolerancePx), IsEmpty());
    EXPECT_GE(cut.curves.size(), network.segments.size());
    size_t edges = 0;
    for (uint32_t e = 0; e < cut.mesh.edgeCapacity(); ++e) {
        const CutCurve* c = cut.curve(EdgeId(e));
        if (!c) continue;
        ++edges;
        for (int k = 0; k <= 10; ++k) {
            const glm::dvec2 p = toPixels(c->controlPoints(c->from, cut.positions)).at(k / 10.0);
            EXPECT_NEAR(std::hypot(p.x - 41.3, p.y - 38.7), 24, .3);
        }
    }
    EXPECT_EQ(edges, cut.curves.size());
    EXPECT_EQ(cut.curve(EdgeId(1000000)), nullptr);
}

TEST(CutMesh, ControlPointsRunFromEitherEnd) {
    const CutMesh cut = ofDisc();
    for (const CutCurve& c : cut.curves) {
        auto there = c.controlPoints(c.from, cut.positions);
        const auto back = c.controlPoints(c.to, cut.positions);
        EXPECT_EQ(there[0], cut.positions[c.from.index]);
        std::reverse(there.begin(), there.end());
        EXPECT_EQ(there, back);
    }
}

TEST(CutMesh, ToPatchMeshIsValidAndKeepsTheFeatures) {
    const CutMesh cut = ofDisc();
    const PatchMesh mesh = toPatchMesh(cut, 3);
    const MeshValidation validation = validate(mesh);
    EXPECT_TRUE(validation.valid()) << (validation.violations.empty() ? "" : validation.violations[0]);
    size_t features = 0;
    mesh.forEachEdge([&](EdgeId e) { features += mesh.curve(e).feature; });
    EXPECT_EQ(features, cut.curves.size());
    EXPECT_EQ(mesh.patchCount(), cut.mesh.faceCount());
}

TEST(CutMesh, Stops) {
    std::stop_source source;
    source.request_stop();
    Progress progress(source.get_token());
    StageReport report;
    const Image image(40, 40, 3, .5f);
    const auto result = buildCutMesh(image, noFeatures(image), 100, {}, report, progress);
    ASSERT_FALSE(result.has_value());
    EXPECT_EQ(result.error().code, ErrorCode::Stopped);
}

TEST(CutMeshViolations, FindWhatIsBroken) {
    const CutMesh sound = ofDisc();
    ASSERT_THAT(cutMeshViolations(sound, kTolerancePx), IsEmpty());
    {
        CutMesh cut = sound;  // a vertex across its star
        for (uint32_t v = 0; v < cut.positions.size(); ++v)
            if (cut.kinds[v] == VertexKind::Interior) {
                cut.positions[v].x += 40 * kLatticePerPixel;
                break;
            }
        EXPECT_FALSE(cutMeshViolations(cut, kTolerancePx).empty());
    }
    {
        CutMesh cut = sound;  // a curve that loops
        for (LatticePoint& p : cut.curves[0].inner) p.x += 30 * kLatticePerPixel;
        EXPECT_FALSE(cutMeshViolations(cut, 1000).empty());
        EXPECT_FALSE(cutMeshViolations(cut, kTolerancePx).empty());
    }
    {
        CutMesh cut = sound;  // two curves at each other's edge
        std::swap(cut.curves[0], cut.curves[1]);
        EXPECT_FALSE(cutMeshViolations(cut, 1000).empty());
    }
    EXPECT_FALSE(cutMeshViolations(sound, 1e-3).empty());
}

}  // namespace
}  // namespace tessera
