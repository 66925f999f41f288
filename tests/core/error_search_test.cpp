// The search for an error: reached, missed with a reason, bounded.
#include "core/vectorize/error_search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/export/rasterize.h"
#include "core/image/image_compare.h"
#include "tests/support/painted_image.h"

namespace tessera {
namespace {

using tessera::testing::paint;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

Image waves() {
    return paint(160, 120, 3, [](double x, double y, int c) {
        return .5 + .2 * std::sin(.12 * x + c) * std::cos(.001 * y * y) + .1 * std::sin(.002 * x * y);
    });
}

ErrorGoal meanError(double error, const Image& image) {
    return {error, [&image](const PatchMesh& mesh, Progress& progress) -> Result<double> {
                const auto drawn = rasterize(mesh, wholePicture(mesh, {1, 1}), {.samples = 4}, &progress);
                if (!drawn) return tl::unexpected(drawn.error());
                return compareImages(image, *drawn)->mae;
            }};
}

// Figures of the stage "search" whose names end so.
std::vector<double> figures(const VectorizeReport& report, const std::string& end) {
    std::vector<double> found;
    for (const auto& [name, value] : report.stages.front().figures)
        if (name.ends_with(end)) found.push_back(value);
    return found;
}

TEST(ErrorSearch, ReachesTheErrorOrSaysWhyNot) {
    const Image image = waves();
    for (const double wanted : {.4, .8}) {
        VectorizeSettings settings;
        Progress progress;
        const ErrorGoal goal = meanError(wanted, image);
        const auto result = vectorizeToError(image, settings, goal, progress);
        ASSERT_TRUE(result) << result.error().message;
        const double error = *goal.measure(result->mesh, progress);
        ASSERT_EQ(result->report.stages.front().stage, "search");
        const auto errors = figures(result->report, " error"), patches = figures(result->report, " patches");
        ASSERT_GE(patches.size(), 2u);
        EXPECT_LE(patches.size(), 7u);
        EXPECT_EQ(patches.back(), double(result->mesh.patchCount()));
        EXPECT_EQ(errors.back(), error);
        EXPECT_EQ(errors.front(), wanted);
        EXPECT_NEAR(settings.patches, patches.back(), 2);
        EXPECT_EQ(result->report.shortfall.empty(), std::abs(error / wanted - 1) <= kErrorTolerance);
        // The settings that were found give the same again.
        const auto again = vectorize(image, settings, progress);
        ASSERT_TRUE(again);
        EXPECT_EQ(*goal.measure(again->mesh, progress), error);
    }
}

TEST(ErrorSearch, SaysWhyItCannot) {
    const Image image = waves();
    VectorizeSettings settings;
    Progress progress;
    const auto tooFine = vectorizeToError(image, settings, meanError(1e-6, image), progress);
    ASSERT_TRUE(tooFine);
    EXPECT_LE(settings.patches * kLeastPixelsPerPatch, double(image.planeSize()));
    EXPECT_THAT(tooFine->report.shortfall, HasSubstr("6 pixels"));
    const auto tooCoarse = vectorizeToError(image, settings, meanError(200, image), progress);
    ASSERT_TRUE(tooCoarse);
    EXPECT_THAT(tooCoarse->report.shortfall, HasSubstr("2 patches"));
}

TEST(ErrorSearch, RefusesWhatMakesNoSense) {
    const Image image = waves();
    Progress progress;
    VectorizeSettings settings, paper;
    paper.method = "paper";
    for (const double error : {0.0, -1.0, std::nan("")}) {
        const auto result = vectorizeToError(image, settings, meanError(error, image), progress);
        ASSERT_FALSE(result);
        EXPECT_EQ(result.error().code, ErrorCode::Usage);
    }
    EXPECT_FALSE(vectorizeToError(image, paper, meanError(2, image), progress));
    EXPECT_FALSE(vectorizeToError(Image(), settings, meanError(2, image), progress));
}

TEST(ErrorSearch, HandsOnFailuresAndStops) {
    const Image image = waves();
    VectorizeSettings settings;
    Progress progress;
    const ErrorGoal broken{2, [](const PatchMesh&, Progress&) -> Result<double> {
                               return failure(ErrorCode::Internal, "no ruler");
                           }};
    const auto failed = vectorizeToError(image, settings, broken, progress);
    ASSERT_FALSE(failed);
    EXPECT_EQ(failed.error().message, "no ruler");
    std::stop_source stop;
    stop.request_stop();
    Progress stopping(stop.get_token());
    const auto stoppedSearch = vectorizeToError(image, settings, meanError(2, image), stopping);
    ASSERT_FALSE(stoppedSearch);
    EXPECT_EQ(stoppedSearch.error().code, ErrorCode::Stopped);
}

}  // namespace
}  // namespace tessera
