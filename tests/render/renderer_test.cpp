// The OpenGL renderer draws what the CPU renderer draws, at every zoom; and a comparison that must fail
// fails.
#include "render/renderer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/mesh/newton_basis.h"
#include "tests/support/gl.h"
#include "tests/support/test_meshes.h"

namespace tessera {
namespace {

using render::DrawOptions;
using render::Renderer;
using tessera::testing::differenceFromCpu;
using tessera::testing::drawOffscreen;
using tessera::testing::expectSamePicture;
using tessera::testing::FrameDifference;
using tessera::testing::zoomedView;

constexpr int kWidth = 320, kHeight = 240;

// Curved patches with random splines; a third of the edges are features, with blurs of 0 to 3 px.
PatchMesh blurredMesh(int channels = 3) {
    PatchMesh mesh = testing::curvedMesh(300, 220, 11, 8, 5, channels);
    std::mt19937 random(3);
    std::uniform_real_distribution<float> sigma(0, 3);
    mesh.forEachEdge([&](EdgeId e) {
        EdgeCurve curve = mesh.curve(e);
        if (!curve.feature || e.index % 2 == 0) return;
        curve.blurSigma = {sigma(random), sigma(random)};
        mesh.setCurve(e, curve);
    });
    return mesh;
}

// Splines over sites of their own in the opponent basis, chroma with fewer terms than brightness.
PatchMesh siteMesh() {
    PatchMesh mesh = blurredMesh();
    mesh.setColourBasis(ColourBasis::Opponent);
    std::mt19937 random(8);
    std::uniform_real_distribution<double> unit(-1, 1);
    mesh.forEachPatch([&](PatchId p) {
        std::vector<uint8_t> sites{0, 1, 2};
        const size_t count = 3 + random() % 20;
        while (sites.size() < count) {
            const auto site = uint8_t(3 + random() % (kCentreSites - 3));
            if (std::find(sites.begin(), sites.end(), site) == sites.end()) sites.push_back(site);
        }
        std::array<std::vector<double>, 3> factors;
        std::array<std::span<const double>, 3> spans;
        for (size_t c = 0; c < 3; ++c) {
            factors[c].resize(c == 0 ? count : 3 + random() % (count - 2));
            for (size_t k = 0; k < factors[c].size(); ++k)
                factors[c][k] = (c == 0 ? .9 : 0) * (k < 3) + .1 * unit(random);
            spans[c] = factors[c];
        }
        mesh.setSpline(p, NewtonBasis(sites).spline(spans));
    });
    return mesh;
}

struct Case {
    double zoom;
    int samples;
};
void PrintTo(const Case& c, std::ostream* out) {
    *out << "x" << c.zoom << ", " << c.samples << " samples";
}

class RendererAtZoom : public testing::GlTest, public ::testing::WithParamInterface<Case> {};

TEST_P(RendererAtZoom, DrawsCurvedMeshes) {
    const PatchMesh mesh = blurredMesh();
    expectSamePicture(mesh, zoomedView(mesh, GetParam().zoom, kWidth, kHeight),
                      {.samples = GetParam().samples});
}

TEST_P(RendererAtZoom, DrawsHardFeatures) {
    const PatchMesh mesh = blurredMesh();
    expectSamePicture(mesh, zoomedView(mesh, GetParam().zoom, kWidth, kHeight),
                      {.samples = GetParam().samples, .sharpen = 0});
}

TEST_P(RendererAtZoom, DrawsSitesInTheOpponentBasis) {
    const PatchMesh mesh = siteMesh();
    expectSamePicture(mesh, zoomedView(mesh, GetParam().zoom, kWidth, kHeight),
                      {.samples = GetParam().samples});
}

INSTANTIATE_TEST_SUITE_P(, RendererAtZoom,
                         ::testing::Values(Case{1, 1}, Case{3.7, 1}, Case{32, 1}, Case{1000, 1}, Case{3.7, 4},
                                           Case{32, 4}));

class RendererTest : public testing::GlTest {};

// Beside a bend of a chain two of its edges have the same nearest point, and other patches beside it.
TEST_F(RendererTest, DrawsTheBlurBesideABend) {
    PatchMesh mesh = testing::gridMesh(60, 60, 6, 6);
    const HalfedgeMesh& c = mesh.connectivity();
    for (const auto& [from, to] : {std::pair(17U, 24U), std::pair(24U, 25U)}) {
        const EdgeId e = HalfedgeMesh::edge(c.find(VertexId(from), VertexId(to)));
        EdgeCurve curve = mesh.curve(e);
        curve.feature = true;
        curve.blurSigma = {2, 2};
        mesh.setCurve(e, curve);
    }
    std::mt19937 random(4);
    mesh.forEachPatch([&](PatchId p) { mesh.setSpline(p, testing::randomSpline(3, random)); });
    View view;
    view.scale = {32, 32};
    view.width = kWidth;
    view.height = kHeight;
    view.origin = {23.0123, 26.0377};  // the bend is at (30, 30)
    expectSamePicture(mesh, view, {.samples = 1});
}

TEST_F(RendererTest, DrawsAlphaAndNothingOutsideThePicture) {
    const PatchMesh mesh = blurredMesh(4);
    View view = wholePicture(mesh, {1, 1});
    view.origin = {-20.3, -30.6};
    view.width += 50;
    expectSamePicture(mesh, view, {.samples = 1});
    const Image frame = drawOffscreen(mesh, view, {.samples = 1});
    for (int c = 0; c < 4; ++c) EXPECT_EQ(frame.at(5, 5, c), 0);
}

TEST_F(RendererTest, AlphaIsFullWhereAPictureHasNone) {
    const PatchMesh mesh = blurredMesh();
    const render::OffscreenTarget target(kWidth, kHeight);
    target.bind();
    auto renderer = Renderer::create();
    ASSERT_TRUE(renderer);
    renderer->setMesh(mesh);
    for (const int samples : {1, 4}) {
        ASSERT_TRUE(renderer->draw(zoomedView(mesh, 3, kWidth, kHeight), {.samples = samples}));
        const Image alpha = target.read(4);
        EXPECT_THAT(alpha.plane(3), ::testing::Each(1.0F));
    }
}

TEST_F(RendererTest, ComputeSubdivisionDrawsTheSame) {
    const PatchMesh mesh = blurredMesh();
    for (const double zoom : {1.0, 3.7, 32.0, 1000.0}) {
        const View view = zoomedView(mesh, zoom, kWidth, kHeight);
        const Image frame = drawOffscreen(mesh, view, {.samples = 1, .computeSubdivision = true});
        // Cracks inside patches are the method's own.
        EXPECT_LE(differenceFromCpu(mesh, view, frame, {1}).badShare, .0005) << zoom;
    }
}

TEST_F(RendererTest, OneAlteredPatchIsFound) {
    PatchMesh mesh = blurredMesh();
    const View view = zoomedView(mesh, 1, kWidth, kHeight);
    PatchMesh altered = mesh;
    const PatchId p(77);
    PatchSpline spline = mesh.spline(p);
    spline.coefficients[0] += .02F;  // 5 levels of one channel
    altered.setSpline(p, spline);
    const Image frame = drawOffscreen(altered, view, {.samples = 1});
    const FrameDifference difference = differenceFromCpu(mesh, view, frame, {1});
    EXPECT_GT(difference.badShare, .001);
    EXPECT_GT(difference.worstInside, FrameDifference::kTolerance);
    EXPECT_GT(difference.inside.size(), 1000U);
}

TEST_F(RendererTest, UpdatesEqualAFreshMesh) {
    PatchMesh mesh = blurredMesh();
    const View view = zoomedView(mesh, 2.5, kWidth, kHeight);
    auto renderer = Renderer::create();
    ASSERT_TRUE(renderer);
    renderer->setMesh(mesh);
    (void)drawOffscreen(*renderer, mesh, view, {});
    // A spline of other length, and a vertex, with the patches around it.
    const PatchId recoloured(60);
    const std::array<float, 3> grey{.5F, .5F, .5F};
    mesh.setSpline(recoloured, constantSpline(grey));
    std::vector<PatchId> patches{recoloured};
    const VertexId v(40);
    mesh.setPosition(v, mesh.position(v) + LatticePoint{300, -200});
    mesh.connectivity().forEachOutgoing(
        v, [&](HalfedgeId h) { patches.push_back(mesh.connectivity().face(h)); });
    renderer->update(mesh, patches);
    EXPECT_EQ(drawOffscreen(*renderer, mesh, view, {}), drawOffscreen(mesh, view, {}));
}

TEST_F(RendererTest, LeavesOutWhatIsHiddenOrCutOut) {
    PatchMesh mesh = blurredMesh();
    const View view = wholePicture(mesh, {1, 1});
    auto renderer = Renderer::create();
    ASSERT_TRUE(renderer);
    renderer->setMesh(mesh);
    const PatchId hidden(50), cutOut(90);
    mesh.setAttributes(hidden, {.hidden = true});
    mesh.setAttributes(cutOut, {.cutOut = true});
    renderer->update(mesh, std::array{hidden, cutOut});
    const render::OffscreenTarget target(view.width, view.height);
    target.bind();
    for (const bool showHidden : {true, false}) {
        ASSERT_TRUE(renderer->draw(view, {.samples = 1, .showHidden = showHidden}));
        const Image frame = target.read(4);
        const auto expected = rasterize(mesh, view, {.samples = 1, .showHidden = showHidden});
        ASSERT_TRUE(expected);
        ASSERT_EQ(expected->channels(), 4);
        size_t blank = 0, different = 0;
        for (size_t i = 0; i < frame.planeSize(); ++i) {
            blank += frame.plane(3)[i] == 0;
            different += frame.plane(3)[i] != expected->plane(3)[i];
        }
        EXPECT_GT(blank, showHidden ? 200U : 400U);
        EXPECT_LT(different, 20U);  // at their edges
    }
}

TEST_F(RendererTest, OneEvaluationAPixelOutsideBlur) {
    const PatchMesh mesh = blurredMesh();
    const View view = zoomedView(mesh, 1, 260, 180);  // the picture fills it
    const render::OffscreenTarget target(view.width, view.height);
    target.bind();
    auto renderer = Renderer::create();
    ASSERT_TRUE(renderer);
    renderer->setMesh(mesh);
    const auto one = renderer->drawCounted(view, {.samples = 1}), four = renderer->drawCounted(view, {});
    ASSERT_TRUE(one && four);
    const double pixels = double(view.width) * view.height;
    EXPECT_EQ(one->colours, uint32_t(pixels));
    EXPECT_GT(one->blur, 0U);
    EXPECT_LE(four->colours, 1.2 * pixels);
    const auto hard = renderer->drawCounted(view, {.samples = 1, .sharpen = 0});
    ASSERT_TRUE(hard);
    EXPECT_EQ(hard->blur, 0U);
}

}  // namespace
}  // namespace tessera
