// The fast renderer against the paper's, and the promises of rasterize.h.
#include "core/export/rasterize.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "core/base/parallel.h"
#include "core/mesh/patch_query.h"
#include "tests/support/test_meshes.h"

namespace tessera {
namespace {

constexpr double kLevel = 1.0 / 255;

Image render(const PatchMesh& mesh, const View& view, int samples = 1) {
    Result<Image> image = rasterize(mesh, view, {samples});
    EXPECT_TRUE(image);
    return image ? std::move(*image) : Image();
}

// How two renders of a view differ.
struct Comparison {
    size_t pixels = 0;
    size_t uncovered = 0;  // left out by the reference, in a crack between pieces cut to different depths
    size_t apart = 0;      // by more than 1/255, the uncovered among them
    size_t apartFarInside = 0;  // by more than 2/255, further than an output pixel from any patch's side

    bool agree() const { return double(apart) <= 1e-4 * double(pixels) && apartFarInside == 0; }
};

// `a` from the reference.
Comparison compare(const PatchMesh& mesh, const View& view, const Image& a, const Image& b) {
    const PatchQuery query(mesh);
    const std::vector<PixelOwner> owners = locatePixelsReference(mesh, view);
    const double pixel = 1 / std::min(view.scale.x, view.scale.y);
    Comparison result;
    for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x) {
            double difference = 0;
            for (int c = 0; c < a.channels(); ++c)
                difference = std::max(difference, std::abs(double(a.at(x, y, c)) - double(b.at(x, y, c))));
            ++result.pixels;
            if (difference <= kLevel) continue;
            ++result.apart;
            if (!owners[size_t(y) * size_t(view.width) + size_t(x)].patch.valid()) {
                ++result.uncovered;
                continue;
            }
            const glm::dvec2 centre = view.origin + glm::dvec2(x + .5, y + .5) / view.scale;
            if (difference > 2 * kLevel && !query.nearestCurve(centre, pixel)) ++result.apartFarInside;
        }
    return result;
}

struct RasterizeTest : ::testing::Test {
    PatchMesh mesh = testing::curvedMesh(384, 256, 6, 4, 3);

    View viewAt(double scale, glm::dvec2 origin) const {
        return {origin, glm::dvec2(scale), mesh.width(), mesh.height()};
    }
};

TEST_F(RasterizeTest, AgreesWithTheReference) {
    for (const View& view :
         {viewAt(1, {.37, -.21}), viewAt(3.7, {101.37, 77.21}), viewAt(16, {203.3, 61.7})}) {
        const Image reference = rasterizeReference(mesh, view), fast = render(mesh, view);
        const Comparison c = compare(mesh, view, reference, fast);
        EXPECT_TRUE(c.agree()) << "scale " << view.scale.x << ": " << c.apart << " of " << c.pixels
                               << ", far inside " << c.apartFarInside;
    }
}

TEST_F(RasterizeTest, TheComparisonDetectsOneAlteredPatch) {
    const View view = viewAt(1, {0, 0});
    const Image reference = rasterizeReference(mesh, view);
    PatchMesh altered = mesh;
    PatchSpline spline = altered.spline(PatchId(17));
    spline.coefficients[0] += 4 * float(kLevel);
    altered.setSpline(PatchId(17), spline);
    const Comparison colour = compare(mesh, view, reference, render(altered, view));
    EXPECT_FALSE(colour.agree());
    EXPECT_GT(colour.apartFarInside, 0u);

    altered = mesh;
    altered.setInterior(PatchId(17), mesh.interior(PatchId(17)) + LatticePoint{2 * kLatticePerPixel, 0});
    EXPECT_FALSE(compare(mesh, view, reference, render(altered, view)).agree());
}

// Every pixel centre in the picture has an owner, also on its left and upper border; none outside has.
void expectCovered(const PatchMesh& mesh, const View& view) {
    const std::vector<PixelOwner> owners = locatePixels(mesh, view);
    size_t missing = 0, extra = 0;
    for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x) {
            const glm::dvec2 p = view.origin + glm::dvec2(x + .5, y + .5) / view.scale;
            const bool in = p.x >= 0 && p.y >= 0 && p.x < mesh.width() && p.y < mesh.height();
            const bool owned = owners[size_t(y) * size_t(view.width) + size_t(x)].patch.valid();
            missing += in && !owned;
            extra += !in && owned;
        }
    EXPECT_EQ(missing, 0u);
    EXPECT_EQ(extra, 0u);
}

// The largest distance (px) between a pixel's centre and the point of the parameters found for it.
double largestError(const PatchMesh& mesh, const View& view) {
    const std::vector<PixelOwner> owners = locatePixels(mesh, view);
    double worst = 0;
    for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x) {
            const PixelOwner& owner = owners[size_t(y) * size_t(view.width) + size_t(x)];
            if (!owner.patch.valid()) continue;
            const double v = double(owner.v), w = double(owner.w);
            EXPECT_TRUE(v >= 0 && w >= 0 && v + w <= 1 + 1e-6);
            const glm::dvec2 centre = view.origin + glm::dvec2(x + .5, y + .5) / view.scale;
            const BezierTriangle t = toPixels(mesh.controlPoints(owner.patch));
            worst = std::max(worst, glm::distance(evaluate(t, {1 - v - w, v, w}), centre));
        }
    return worst;
}

// Patches that count as affine are off by the lattice's rounding.
constexpr double kAffineError = 1.5 / kLatticePerPixel;

// So where the two renderers disagree on an owner, it is the reference's chords.
TEST(Rasterize, OwnersHoldTheirPixelCentres) {
    const PatchMesh mesh = testing::curvedMesh(192, 128, 10, 7, 5);
    EXPECT_LT(largestError(mesh, {{.3, .1}, {1.4, 1.1}, 268, 140}), kAffineError);
    EXPECT_LT(largestError(mesh, {{57.3, 43.1}, {200, 300}, 300, 200}), kAffineError);
}

// Bent again and again, as far as the patches just stay certified.
TEST(Rasterize, NearlyFoldedPatches) {
    for (unsigned seed = 0; seed < 4; ++seed) {
        PatchMesh mesh = testing::curvedMesh(200, 150, 5, 4, seed);
        const HalfedgeMesh& c = mesh.connectivity();
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> offset(-15, 15);
        for (int round = 0; round < 6; ++round)
            mesh.forEachEdge([&](EdgeId e) {
                if (c.onBorder(e)) return;
                const HalfedgeId h = HalfedgeMesh::halfedge(e);
                const auto points = mesh.controlPoints(h);
                PatchMesh trial = mesh;
                trial.setInnerControlPoints(h, points[1] + toLattice({offset(random), offset(random)}),
                                            points[2] + toLattice({offset(random), offset(random)}));
                for (const PatchId p : {c.face(h), c.face(HalfedgeMesh::twin(h))}) {
                    const auto interior = certifiedInterior(trial.controlPoints(p));
                    if (!interior) return;
                    trial.setInterior(p, *interior);
                }
                mesh = trial;
            });
        for (const double scale : {.37, 1.0, 7.3}) {
            const View view{{-.2, .13}, {scale, 1.1 * scale}, int(210 * scale), int(175 * scale)};
            EXPECT_LT(largestError(mesh, view), kAffineError) << "seed " << seed << " scale " << scale;
            expectCovered(mesh, view);
        }
    }
}

TEST(Rasterize, CoversThePictureAtAnyScaleAndOrigin) {
    const PatchMesh mesh = testing::curvedMesh(300, 200, 9, 6, 8);
    for (const double scale : {.01, .13, .5, 1.0, 2.0, 3.7, 64.0, 1000.0})
        for (const glm::dvec2 origin :
             {glm::dvec2(0, 0), {-20, -10}, {150.3, 99.7}, {299.5, 199.5}, {-.5, -.5}})
            expectCovered(mesh, {origin, {scale, scale}, 160, 120});
    expectCovered(mesh, {{-10, -10}, {.37, 5.3}, 130, 1200});
    expectCovered(mesh, {{-10, -10}, {5.3, .37}, 1700, 90});
}

// All vertices, straight sides and the picture's borders on pixel centres.
TEST(Rasterize, TiesHaveOneOwner) {
    const PatchMesh mesh = testing::gridMesh(32, 24, 8, 6);
    for (const double scale : {1.0, 2.0, .25, 3.0})
        for (const glm::dvec2 origin : {glm::dvec2(-.5, -.5), {0, 0}, {.5, .5}, {-1.5, 2.5}})
            expectCovered(mesh, {origin / scale, {scale, scale}, 40, 40});
    // To the right of a curve and below it. Cell (1, 1) begins at (4, 4), whose diagonal runs down to the
    // right.
    const auto owner = [&](glm::dvec2 p) { return locatePixels(mesh, {p - .5, {1, 1}, 1, 1})[0].patch; };
    const PatchId upperRight(2 * (1 * 8 + 1)), lowerLeft(2 * (1 * 8 + 1) + 1);
    EXPECT_EQ(owner({6, 6}), upperRight);
    EXPECT_EQ(owner({4, 6}), lowerLeft);
    EXPECT_EQ(owner({6, 4}), upperRight);
}

// Sizes of a pixel and less, where a patch's sides round to the same grid points.
TEST(Rasterize, DenseMeshIsCovered) {
    expectCovered(testing::curvedMesh(24, 16, 36, 24, 4), {{0, 0}, {1, 1}, 24, 16});
    expectCovered(testing::curvedMesh(24, 16, 36, 24, 4), {{-1, -1}, {.3, .3}, 24, 16});
}

TEST_F(RasterizeTest, ThreadsDoNotShow) {
    const View view = viewAt(1.3, {3.1, -4.7});
    std::optional<Image> first;
    for (const int threads : {1, 2, 7})
        withThreads(threads, [&] {
            for (const int samples : {1, 4}) {
                const Image image = render(mesh, view, samples);
                if (samples == 4) continue;
                if (!first) first = image;
                EXPECT_TRUE(image == *first) << threads << " threads";
            }
        });
}

TEST_F(RasterizeTest, TilesEqualTheWhole) {
    for (const double scale : {1.0, 2.3}) {
        const View whole = viewAt(scale, {5.3, 9.1});
        const Image image = render(mesh, whole);
        for (int y0 = 0; y0 < whole.height; y0 += 101)
            for (int x0 = 0; x0 < whole.width; x0 += 67) {
                View tile = whole;
                tile.origin += glm::dvec2(x0, y0) / scale;
                tile.width = std::min(67, whole.width - x0);
                tile.height = std::min(101, whole.height - y0);
                const Image part = render(mesh, tile);
                size_t different = 0;
                for (int c = 0; c < 3; ++c)
                    for (int y = 0; y < tile.height; ++y)
                        for (int x = 0; x < tile.width; ++x)
                            different += part.at(x, y, c) != image.at(x0 + x, y0 + y, c);
                EXPECT_EQ(different, 0u) << "tile at " << x0 << ", " << y0;
            }
    }
}

TEST_F(RasterizeTest, SamplesAreTheMeanOfShiftedRenders) {
    const View view{{10.2, 20.4}, {1.5, 1.25}, 131, 77};
    for (const int n : {2, 4}) {
        Image mean(view.width, view.height, 3);
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
                View shifted = view;
                shifted.origin += (glm::dvec2(i + .5, j + .5) / double(n) - .5) / view.scale;
                const Image one = render(mesh, shifted);
                for (int c = 0; c < 3; ++c)
                    for (size_t k = 0; k < mean.planeSize(); ++k)
                        mean.plane(c)[k] += one.plane(c)[k] / float(n * n);
            }
        const Image image = render(mesh, view, n * n);
        size_t apart = 0;
        for (int c = 0; c < 3; ++c)
            for (size_t k = 0; k < mean.planeSize(); ++k)
                apart += std::abs(image.plane(c)[k] - mean.plane(c)[k]) > 1e-4f;
        EXPECT_LE(apart, 1u);  // a sub-pixel centre within rounding of a curve
    }
}

TEST_F(RasterizeTest, OutsideThePictureIsZero) {
    PatchMesh opaque = testing::curvedMesh(40, 30, 3, 2, 2, 4);
    const Image image = render(opaque, {{-10, -10}, {1, 1}, 60, 50});
    ASSERT_EQ(image.channels(), 4);
    for (int y = 0; y < 50; ++y)
        for (int x = 0; x < 60; ++x) {
            const bool in = x >= 10 && x < 50 && y >= 10 && y < 40;
            if (in) continue;
            for (int c = 0; c < 4; ++c) ASSERT_EQ(image.at(x, y, c), 0);
        }
    for (const glm::dvec2 far : {glm::dvec2(1e6, 0), {-1e9, 1e9}, {1e300, 1e300}}) {
        const Image away = render(opaque, {far, {1000, 1000}, 8, 8});
        EXPECT_TRUE(away == Image(8, 8, 4));
    }
    EXPECT_TRUE(render(opaque, {{0, 0}, {1, 1}, 0, 0}).empty());
}

TEST(Rasterize, ColoursAreNotClamped) {
    PatchMesh mesh = testing::gridMesh(8, 8, 1, 1);
    const std::array<float, 3> colour{1.5f, -.25f, .5f};
    mesh.forEachPatch([&](PatchId p) { mesh.setSpline(p, constantSpline(colour)); });
    const Image image = render(mesh, wholePicture(mesh, {1, 1}));
    for (int c = 0; c < 3; ++c)
        for (const float v : image.plane(c)) EXPECT_EQ(v, colour[size_t(c)]);
}

TEST(Rasterize, WholePictureRoundsItsSize) {
    const PatchMesh mesh = testing::gridMesh(33, 10, 2, 1);
    const View view = wholePicture(mesh, {.5, .01});
    EXPECT_EQ(view.width, 17);
    EXPECT_EQ(view.height, 1);
    EXPECT_EQ(view.origin, glm::dvec2(0, 0));
    EXPECT_EQ(wholePicture(mesh, {3, 3}).width, 99);
}

TEST_F(RasterizeTest, StopsAndReportsProgress) {
    std::stop_source source;
    double last = 0;
    Progress watched({}, [&](std::string_view, double fraction, double) { last = std::max(last, fraction); });
    watched.beginStage("render", 1);
    EXPECT_TRUE(rasterize(mesh, viewAt(1, {0, 0}), {}, &watched));

    Progress stopping(source.get_token(), {});
    source.request_stop();
    const Result<Image> result = rasterize(mesh, viewAt(1, {0, 0}), {}, &stopping);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ErrorCode::Stopped);
}

TEST(Rasterize, LeavesOutWhatIsCutOutOrHidden) {
    PatchMesh mesh = testing::curvedMesh(60, 40, 3, 2, 8);
    const View view = wholePicture(mesh, {2, 2});
    const auto whole = rasterize(mesh, view);
    mesh.setAttributes(PatchId(3), {true, false, false});
    EXPECT_EQ(*rasterize(mesh, view), *whole);
    mesh.setAttributes(PatchId(4), {false, false, true});
    const auto owners = locatePixels(mesh, view);
    for (const bool showHidden : {true, false}) {
        RasterizeOptions options;
        options.showHidden = showHidden;
        const auto image = rasterize(mesh, view, options);
        ASSERT_EQ(image->channels(), 4);
        for (int y = 0; y < view.height; ++y)
            for (int x = 0; x < view.width; ++x) {
                const PatchId p = owners[size_t(y) * size_t(view.width) + size_t(x)].patch;
                const bool out = p == PatchId(4) || (p == PatchId(3) && !showHidden);
                ASSERT_EQ(image->at(x, y, 3), out ? 0 : 1);
                for (int c = 0; c < 3; ++c) ASSERT_EQ(image->at(x, y, c), out ? 0 : whole->at(x, y, c));
            }
    }
    RasterizeOptions four;
    four.samples = 4;
    EXPECT_EQ(rasterize(mesh, view, four)->channels(), 4);
}

}  // namespace
}  // namespace tessera
