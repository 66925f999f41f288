// The cells that the colour fit asks of a picture, and that finer ones tell it what lies between pixels.
#include "core/vectorize/fit_picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/export/rasterize.h"
#include "core/image/image_compare.h"
#include "core/image/resample.h"
#include "core/vectorize/patch_cells.h"
#include "core/vectorize/solve_colors.h"
#include "core/vectorize/vectorize.h"
#include "tests/support/painted_image.h"
#include "tests/support/test_meshes.h"

namespace tessera {
namespace {

using testing::paint;

constexpr int kSize = 16;

// Two triangles, whose diagonal is a feature with this blur, or none.
PatchMesh halves(bool feature, float sigma = 0) {
    const std::vector<std::array<uint32_t, 3>> triangles{{0, 1, 2}, {0, 2, 3}};
    const auto at = [](int x, int y) { return toLattice({double(x), double(y)}); };
    const std::vector<LatticePoint> positions{at(0, 0), at(kSize, 0), at(kSize, kSize), at(0, kSize)};
    PatchMesh mesh(kSize, kSize, 3, HalfedgeMesh::fromTriangles(4, triangles), positions);
    mesh.forEachEdge([&](EdgeId e) {
        if (mesh.connectivity().onBorder(e)) return;
        EdgeCurve curve = mesh.curve(e);
        curve.feature = feature;
        curve.blurSigma = {sigma, sigma};
        mesh.setCurve(e, curve);
    });
    return mesh;
}

Image ramp() {
    return paint(kSize, kSize, 3, [](double x, double y, int c) { return .02 * x + .01 * y + .1 * c; });
}

// With so many the halves, 11.3 px wide, have closer rows of places for centres than of pixels.
constexpr double kManyTerms = 70;

FitPicture finer(const PatchMesh& mesh, int perSide, double termsPerPatch = kManyTerms) {
    return {mesh, termsPerPatch, ramp(), enlargedMeans(ramp(), perSide)};
}

TEST(FitPicture, SquaresAreCellsAwayFromFeatures) {
    const FitPicture picture = finer(halves(false), 3);
    EXPECT_EQ(picture.grid.perSide, 3);
    EXPECT_EQ(picture.grid.cellAt(31, 7), 7U * 3 * kSize + 31);
    EXPECT_FLOAT_EQ(picture.grid.area(picture.grid.cellAt(31, 7)), 1.0F / 9);
}

TEST(FitPicture, PixelsNearFeaturesStayWhole) {
    const Image image = ramp();
    for (const float sigma : {.1F, 2.0F}) {
        const FitPicture picture = finer(halves(true, sigma), 2);
        const double reach = std::max(2.0, 3.0 * double(sigma));
        for (int y = 0; y < kSize; ++y)
            for (int x = 0; x < kSize; ++x) {
                const double distance = std::abs(x - y) / std::sqrt(2.0);
                const uint32_t first = picture.grid.cellAt(2 * x, 2 * y);
                const bool whole = picture.grid.cellAt(2 * x + 1, 2 * y + 1) == first;
                if (std::abs(distance - reach) > .2) {
                    EXPECT_EQ(whole, distance < reach) << x << " " << y;
                }
                EXPECT_EQ(picture.grid.area(first), whole ? 1 : .25F);
                if (whole) {
                    EXPECT_EQ(picture.means.plane(1)[first], image.at(x, y, 1));
                }
            }
    }
}

TEST(FitPicture, PixelsOfWidePatchesStayWhole) {
    const Image image = ramp();
    const FitPicture picture = finer(halves(false), 2, 12);
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            const uint32_t first = picture.grid.cellAt(2 * x, 2 * y);
            EXPECT_EQ(picture.grid.cellAt(2 * x + 1, 2 * y + 1), first) << x << " " << y;
            EXPECT_EQ(picture.means.plane(2)[first], image.at(x, y, 2));
        }
}

TEST(FitPicture, PatchesShareOutEachCellsSamples) {
    const PatchMesh mesh = halves(true);
    const FitPicture picture = finer(mesh, 2);
    const CellSampler sampler(mesh, picture.grid, 1);
    std::vector<double> covered(picture.means.planeSize(), 0);
    PatchCells cells;
    double area = 0;
    for (size_t i = 0; i < sampler.patches().size(); ++i) {
        sampler.sample(i, cells);
        std::set<uint32_t> numbers;
        for (const PatchCells::Cell& cell : cells.cells) {
            EXPECT_TRUE(numbers.insert(cell.number).second);
            EXPECT_EQ(cell.area, picture.grid.area(cell.number));
            covered[cell.number] += double(cell.coverage);
            area += double(cell.coverage) * double(cell.area);
        }
    }
    EXPECT_NEAR(area, kSize * kSize, 1e-3);
    for (int row = 0; row < 2 * kSize; ++row)
        for (int column = 0; column < 2 * kSize; ++column)
            EXPECT_NEAR(covered[picture.grid.cellAt(column, row)], 1, 1e-5);
}

TEST(FitPicture, SquaresGoWithPatchesAndTerms) {
    const auto squares = [](int cellsPerSide, double termsPerPatch) {
        return squaresPerSide(testing::gridMesh(240, 240, cellsPerSide, cellsPerSide), termsPerPatch);
    };
    EXPECT_EQ(squares(20, kManyTerms), 3);  // 72 px a patch
    EXPECT_EQ(squares(8, kManyTerms), 2);   // 450 px
    EXPECT_EQ(squares(6, kManyTerms), 1);   // 800 px
    EXPECT_EQ(squares(8, 12), 1);           // few terms have few places
}

// How well splines that were fitted to a small picture's pixels, or to parts of them, show the large one.
TEST(FitPicture, PartsOfPixelsTellWhatLiesBetween) {
    const Image large = paint(128, 128, 3, [](double x, double y, int c) {
        return .5 + .1 * std::sin(.33 * x + .11 * y + c) + .1 * std::cos(.3 * y - .15 * x);
    });
    const Image small = boxDownsample(large, 4);
    VectorizeSettings settings;
    settings.patches = 30;  // fewer than 40 pixels each
    settings.termsPerPatch = 100;
    Progress progress;
    const PatchMesh mesh = vectorize(small, settings, progress).value().mesh;
    const auto magnified = [&](const Image& picture, const FitPicture& means) {
        StageReport report;
        const auto sites = chooseSites(mesh, picture, settings.termsPerPatch, progress);
        const PatchMesh solved = solveColors(mesh, means, sites, settings, report, progress).value();
        return compareImages(large, *rasterize(solved, wholePicture(solved, {4, 4}), {.samples = 4}))->psnr;
    };
    const Image whole = inBasis(small, ColourBasis::Opponent);
    const Image fine = inBasis(enlargedMeans(small, 3), ColourBasis::Opponent);
    EXPECT_GT(magnified(fine, FitPicture(mesh, settings.termsPerPatch, whole, fine)),
              magnified(whole, FitPicture(whole)) + 1);
}

}  // namespace
}  // namespace tessera
