// The joint colour fit: planes exactly, centres where detail is, the budget, agreement along seams, features
// that keep their sides apart, and the same colours on any number of threads.
#include "core/vectorize/solve_colors.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/base/parallel.h"
#include "core/export/rasterize.h"
#include "core/image/image_compare.h"
#include "core/mesh/mesh_validate.h"
#include "core/vectorize/site_pursuit.h"

namespace tessera {
namespace {

constexpr int kSize = 32;

LatticePoint at(double x, double y) {
    return toLattice({x, y});
}

// A square of four triangles around a vertex a little off its middle.
PatchMesh square() {
    const std::vector<std::array<uint32_t, 3>> triangles{{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
    const std::vector<LatticePoint> positions{at(0, 0), at(kSize, 0), at(kSize, kSize), at(0, kSize),
                                              at(17, 15)};
    return PatchMesh(kSize, kSize, 3, HalfedgeMesh::fromTriangles(5, triangles), positions);
}

template <class Paint>
Image painted(Paint&& paint) {
    Image image(kSize, kSize, 3);
    for (int c = 0; c < 3; ++c)
        for (int y = 0; y < kSize; ++y)
            for (int x = 0; x < kSize; ++x) image.at(x, y, c) = float(paint(x + .5, y + .5, c));
    return image;
}

PatchMesh solved(const Image& image, const VectorizeSettings& settings, PatchMesh mesh = square()) {
    StageReport report;
    Progress progress;
    const Image opponent = inBasis(image, ColourBasis::Opponent);
    const auto sites = chooseSites(mesh, opponent, settings.termsPerPatch, progress);
    auto result = solveColors(std::move(mesh), FitPicture(opponent), sites, settings, report, progress);
    EXPECT_TRUE(result.has_value());
    return *result;
}

double psnrOf(const PatchMesh& mesh, const Image& image) {
    return compareImages(image, *rasterize(mesh, wholePicture(mesh, {1, 1}), {.samples = 4}))->psnr;
}

double wave(double x, double y, int c) {
    return .5 + .2 * std::sin(.35 * x + c) * std::cos(.3 * y);
}

TEST(SolveColors, APlaneIsExact) {
    const Image image = painted([](double x, double y, int c) { return .1 + .01 * x + .012 * y + .05 * c; });
    const PatchMesh mesh = solved(image, {});
    const Image drawn = *rasterize(mesh, wholePicture(mesh, {1, 1}), {.samples = 4});
    for (int c = 0; c < 3; ++c)
        for (size_t i = 0; i < image.planeSize(); ++i)
            EXPECT_NEAR(drawn.plane(c)[i], image.plane(c)[i], 1e-3);
    EXPECT_TRUE(validate(mesh).violations.empty());
}

TEST(SolveColors, MoreTermsFitBetter) {
    const Image image = painted(wave);
    VectorizeSettings few, many;
    few.termsPerPatch = 12;
    many.termsPerPatch = 60;
    EXPECT_GT(psnrOf(solved(image, many), image), psnrOf(solved(image, few), image) + 6);
}

TEST(SolveColors, KeepsTheBudget) {
    VectorizeSettings settings;
    settings.termsPerPatch = 30;
    const PatchMesh mesh = solved(painted(wave), settings);
    size_t terms = 0;
    mesh.forEachPatch([&](PatchId p) {
        for (size_t c = 0; c < 3; ++c) terms += std::max<size_t>(3, mesh.spline(p).terms[c]);
    });
    EXPECT_LE(terms, 4U * 30U);
    EXPECT_GE(terms, 4U * 20U);
}

TEST(SolveColors, SeamsAreAsWideAsTheyMayBe) {
    // A jump across an edge that is no feature cannot be fitted without a seam.
    const Image image = painted([](double x, double y, int) { return x * 15 > y * 17 ? .8 : .2; });
    VectorizeSettings tight, loose;
    tight.seamMeanLevels = 1;
    tight.seamHighLevels = 3;
    loose.seamMeanLevels = loose.seamHighLevels = 1000;
    EXPECT_LT(measureSeams(solved(image, tight)).mean, 2);
    EXPECT_GT(measureSeams(solved(image, loose)).mean, 4);
}

TEST(SolveColors, AFeatureKeepsItsSidesApart) {
    const auto jump = [](double x, double y, int) { return x * 15 > y * 17 ? .8 : .2; };
    const Image image = painted(jump);
    PatchMesh cut = square();
    cut.forEachEdge([&](EdgeId e) {
        const HalfedgeMesh& m = cut.connectivity();
        const VertexId a = m.origin(HalfedgeMesh::halfedge(e)), b = m.target(HalfedgeMesh::halfedge(e));
        if ((a.index == 0 || b.index == 0) && (a.index == 4 || b.index == 4)) {
            EdgeCurve curve = cut.curve(e);
            curve.feature = true;
            cut.setCurve(e, curve);
        }
    });
    EXPECT_GT(psnrOf(solved(image, {}, cut), image), psnrOf(solved(image, {}), image) + 1);
}

TEST(SolveColors, TheSameOnAnyNumberOfThreads) {
    const Image image = painted(wave);
    PatchMesh one;
    withThreads(1, [&] { one = solved(image, {}); });
    for (const int threads : {2, 7}) {
        PatchMesh other;
        withThreads(threads, [&] { other = solved(image, {}); });
        one.forEachPatch([&](PatchId p) { EXPECT_EQ(one.spline(p), other.spline(p)); });
    }
}

TEST(SitePursuit, CentresGoWhereTheDetailIs) {
    // Flat but for a bump near the middle of the left side, in patch 3 (vertices 3, 0, 4).
    const Image image = painted([](double x, double y, int) {
        const double dx = x - 5, dy = y - 16;
        return .5 + .4 * std::exp(-(dx * dx + dy * dy) / 8);
    });
    Progress progress;
    const auto choices = chooseSites(square(), inBasis(image, ColourBasis::Opponent), 20, progress);
    ASSERT_EQ(choices.size(), 4U);
    EXPECT_GT(choices[3].terms[0], 15);
    EXPECT_LT(choices[1].terms[0], 6);
    for (const SiteChoice& choice : choices) {
        EXPECT_EQ(choice.sites[0], 0);
        EXPECT_EQ(choice.terms[1], 3);  // grey
    }
}

}  // namespace
}  // namespace tessera
