// Splines on sites through the codec: what the picture loses, what a file takes, and that the step is the
// reason.
#include <gtest/gtest.h>

#include <cmath>

#include "core/document/codec.h"
#include "core/document/factor_codec.h"
#include "core/export/rasterize.h"
#include "core/mesh/mesh_validate.h"
#include "core/vectorize/solve_colors.h"
#include "tests/support/painted_image.h"
#include "tests/support/random_documents.h"

namespace tessera {
namespace {

// A texture of several scales, so that the fit is good but not perfect.
Image texture(int width, int height) {
    return testing::paint(width, height, 3, [](double x, double y, int c) {
        return .5 + .2 * std::sin(x / 9 + .3 * c) * std::cos(y / 7) + .08 * std::sin(.9 * x + .4 * y) +
               .03 * std::sin(2.1 * x - 1.3 * y + c) + (x + y > 110 ? .1 : 0);
    });
}

double meanSquare(const Image& a, const Image& b) {
    double sum = 0;
    for (int c = 0; c < 3; ++c)
        for (size_t i = 0; i < a.planeSize(); ++i) {
            const double d = double(a.plane(c)[i]) - double(b.plane(c)[i]);
            sum += d * d;
        }
    return sum / (3 * double(a.planeSize()));
}

Image drawn(const PatchMesh& mesh) {
    auto image = rasterize(mesh, wholePicture(mesh, glm::dvec2(1)));
    EXPECT_TRUE(image);
    return std::move(*image);
}

double psnrOf(const PatchMesh& mesh, const Image& image) {
    return -10 * std::log10(meanSquare(drawn(mesh), image));
}

class FittedDocument : public ::testing::Test {
  protected:
    static void SetUpTestSuite() {
        Progress progress;
        StageReport report;
        image = texture(128, 96);
        Document d;
        const Image opponent = inBasis(image, ColourBasis::Opponent);
        const PatchMesh grid = testing::gridMesh(128, 96, 8, 6);
        auto mesh = solveColors(grid, FitPicture(opponent), chooseSites(grid, opponent, 48, progress), {},
                                report, progress);
        ASSERT_TRUE(mesh);
        d.mesh = *mesh;
        d.difference.emplace();
        d.difference->psnr = psnrOf(*mesh, image);
        fitted = d;
    }
    static inline Image image;
    static inline Document fitted;
};

TEST_F(FittedDocument, LosesATenthOfADecibel) {
    Document d = fitted;
    const auto bytes = encodeDocument(d);
    ASSERT_TRUE(bytes);
    const auto back = decodeDocument(*bytes);
    ASSERT_TRUE(back);
    const double loss = d.difference->psnr - psnrOf(back->mesh, image);
    EXPECT_LE(loss, .1);
    EXPECT_GE(loss, .03);  // as much as is allowed is used
    // The step is what decides: twice as large it makes four times the squared error.
    Document coarse = fitted;
    coarse.colourStep = 2 * *d.colourStep;
    const auto fewer = encodeDocument(coarse);
    ASSERT_TRUE(fewer);
    EXPECT_LT(fewer->size(), bytes->size());
    EXPECT_NEAR((d.difference->psnr - psnrOf(decodeDocument(*fewer)->mesh, image)) / loss, 4, .6);
}

TEST_F(FittedDocument, TakesAboutAByteAFactorAndItsSite) {
    Document d = fitted;
    const auto bytes = encodeDocument(d);
    ASSERT_TRUE(bytes);
    size_t factors = 0;
    d.mesh.forEachPatch([&](PatchId p) {
        for (size_t c = 0; c < 3; ++c) factors += std::max<size_t>(3, d.mesh.spline(p).terms[c]);
    });
    EXPECT_LT(double(bytes->size()), 1.1 * double(factors));
}

TEST_F(FittedDocument, OfALargeErrorRoundsNoCoarserThanSeamsBear) {
    Document d = fitted;
    d.difference->psnr = 20;
    const auto bytes = encodeDocument(d);
    ASSERT_TRUE(bytes);
    const PatchMesh back = decodeDocument(*bytes)->mesh;
    const auto inFit = [](const PatchMesh& mesh) { return inBasis(drawn(mesh), ColourBasis::Opponent); };
    EXPECT_NEAR(255 * std::sqrt(meanSquare(inFit(back), inFit(fitted.mesh))), .7, .15);
    EXPECT_LT(measureSeams(back).mean, measureSeams(fitted.mesh).mean + 1);
    // A step by the error alone would not keep them.
    d.colourStep = 5 * *d.colourStep;
    EXPECT_GT(measureSeams(decodeDocument(*encodeDocument(d))->mesh).mean,
              measureSeams(fitted.mesh).mean + 1);
}

TEST_F(FittedDocument, OfUnknownErrorLosesLess) {
    Document d = fitted;
    d.difference.reset();
    const auto bytes = encodeDocument(d);
    ASSERT_TRUE(bytes);
    EXPECT_LT(fitted.difference->psnr - psnrOf(decodeDocument(*bytes)->mesh, image), .03);
}

TEST_F(FittedDocument, KeepsTheSumOfTheSquaredErrorsForAllPatchSizes) {
    // What the step promises, measured: the mean over a patch of the squared error of rounding.
    const double step = .01;
    double promised = 0, measured = 0;
    for (const double area : {.25, 1.0, 4.0})
        fitted.mesh.forEachPatch([&](PatchId p) {
            const PatchSpline& spline = fitted.mesh.spline(p);
            const FactorColour colour = quantizedFactors(spline, 3, step, area);
            ASSERT_FALSE(colour.exact);
            const PatchSpline back =
                FactorBasis(kFormatVersion, colour, 3, step, area).spline(colour.factors);
            constexpr int kGrid = 30;
            for (int c = 0; c < 3; ++c) {
                promised += 1 / std::pow(factorStep(1, colour.counts[size_t(c)]) / step, 2);
                for (int i = 0; i < kGrid; ++i)
                    for (int j = 0; i + j < kGrid; ++j) {
                        const double v = (i + 1.0 / 3) / kGrid, w = (j + 1.0 / 3) / kGrid;
                        const glm::dvec2 at = domainPoint({1 - v - w, v, w});
                        const double off = evaluateSpline(spline, c, at) - evaluateSpline(back, c, at);
                        measured += off * off * area * 2 / (kGrid * (kGrid + 1));
                    }
            }
        });
    EXPECT_NEAR(measured / promised, 1, .15);
}

TEST(FactorStep, GoesByTheErrorOfAFactor) {
    EXPECT_NEAR(factorStep(4, 1), 2 * factorStep(1, 1), 1e-12);
    EXPECT_NEAR(factorStep(1, 4), .5 * factorStep(1, 1), 1e-12);
}

}  // namespace
}  // namespace tessera
