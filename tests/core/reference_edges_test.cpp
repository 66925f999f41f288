// The reference edges of the bench, and its smaller and larger pictures.
#include "core/image/reference_edges.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "core/image/image_compare.h"
#include "core/image/resample.h"
#include "tests/support/painted_image.h"

namespace tessera {
namespace {

using testing::paint;

double total(const std::vector<EdgeChain>& chains) {
    double sum = 0;
    for (const EdgeChain& chain : chains) sum += lengthPx(chain);
    return sum;
}

// A step of `levels` at x = 20, over rows [0, rows).
Image step(double levels, int rows) {
    return paint(48, 40, 3,
                 [&](double x, double y, int) { return .25 + (x > 20 && y < rows ? levels / 255 : 0); });
}

TEST(ReferenceEdges, FollowACircle) {
    const Image disc =
        paint(80, 80, 3, [](double x, double y, int) { return std::hypot(x - 40, y - 40) < 25 ? .9 : .1; });
    const auto chains = referenceEdges(disc, 0, 100, 200, 20);
    ASSERT_FALSE(chains.empty());
    std::set<std::pair<int, int>> seen;
    for (const EdgeChain& chain : chains)
        for (size_t i = 0; i < chain.size(); ++i) {
            EXPECT_NEAR(std::hypot(chain[i].x + .5 - 40, chain[i].y + .5 - 40), 25, 1.2);
            EXPECT_TRUE(seen.insert({chain[i].x, chain[i].y}).second);
            if (i == 0) continue;
            EXPECT_EQ(std::max(std::abs(chain[i].x - chain[i - 1].x), std::abs(chain[i].y - chain[i - 1].y)),
                      1);
        }
    const double around = 2 * std::numbers::pi * 25;
    EXPECT_NEAR(total(chains), around, .15 * around);
}

TEST(ReferenceEdges, KeepWhatIsAboveTheThresholdsAndLongEnough) {
    EXPECT_NEAR(total(referenceEdges(step(60, 40), 0, 100, 200, 20)), 39, 2);
    EXPECT_TRUE(referenceEdges(step(40, 40), 0, 100, 200, 20).empty());  // 4 x 40 is below 200
    EXPECT_FALSE(referenceEdges(step(40, 40), 0, 100, 150, 20).empty());
    EXPECT_TRUE(referenceEdges(step(0, 40), 0, 100, 200, 1).empty());
    // Eleven rows and the end of the bar.
    // Smoothed by 1.4 px, a step has half the gradient.
    EXPECT_TRUE(referenceEdges(step(80, 40), 1.4, 100, 200, 20).empty());
    EXPECT_FALSE(referenceEdges(step(120, 40), 1.4, 100, 200, 20).empty());
    EXPECT_TRUE(referenceEdges(step(60, 11), 0, 100, 200, 60).empty());
    EXPECT_FALSE(referenceEdges(step(60, 11), 0, 100, 200, 10).empty());
}

TEST(ReferenceEdges, MeasureSteps) {
    EXPECT_EQ(lengthPx({}), 0);
    EXPECT_EQ(lengthPx({{3, 4}}), 0);
    EXPECT_NEAR(lengthPx({{0, 0}, {1, 0}, {2, 1}}), 1 + std::numbers::sqrt2, 1e-12);
}

TEST(Resample, BoxesAreMeansAndDropTheRest) {
    const Image image = paint(11, 9, 4, [](double x, double y, int c) { return x + 10 * y + 100 * c; });
    const Image small = boxDownsample(image, 4);
    ASSERT_EQ(small.width(), 2);
    ASSERT_EQ(small.height(), 2);
    ASSERT_EQ(small.channels(), 4);
    for (int c = 0; c < 4; ++c)
        for (int y = 0; y < 2; ++y)
            for (int x = 0; x < 2; ++x)
                EXPECT_NEAR(small.at(x, y, c), 4 * x + 2 + 10 * (4 * y + 2) + 100 * c, 1e-3);
    const Image part = cropped(image, 8, 8);
    ASSERT_EQ(part.width(), 8);
    EXPECT_EQ(part.at(7, 7, 3), image.at(7, 7, 3));
}

TEST(Resample, MagnifiesARampExactlyAwayFromTheBorder) {
    const Image small =
        paint(16, 16, 3, [](double x, double y, int c) { return .02 * x + .01 * y + .1 * c; });
    for (const ResampleFilter filter : {ResampleFilter::Bicubic, ResampleFilter::Lanczos}) {
        const Image large = upsample(small, 4, filter);
        ASSERT_EQ(large.width(), 64);
        double worst = 0;
        for (int y = 20; y < 44; ++y)
            for (int x = 20; x < 44; ++x)
                worst = std::max(
                    worst, std::abs(large.at(x, y, 1) - (.02 * (x + .5) / 4 + .01 * (y + .5) / 4 + .1)));
        // Neither reproduces ramps to the last bit; half a pixel off would be .0075.
        EXPECT_LT(worst, .003);
    }
}

TEST(Resample, EnlargedMeansHaveTheSameMeans) {
    const Image large = paint(96, 96, 3, [](double x, double y, int c) {
        return .5 + .2 * std::sin(.4 * x + c) + .2 * std::cos(.3 * y - .2 * x);
    });
    const Image small = boxDownsample(large, 3);
    const Image enlarged = enlargedMeans(small, 3), bicubic = upsample(small, 3, ResampleFilter::Bicubic);
    const auto off = [](const Image& a, const Image& b) { return compareImages(a, b)->rmse; };
    EXPECT_LT(off(boxDownsample(enlarged, 3), small), .05 * off(boxDownsample(bicubic, 3), small));
    EXPECT_LT(off(enlarged, large), .8 * off(bicubic, large));
}

TEST(Resample, TheFiltersDiffer) {
    const Image edge = step(100, 40);
    EXPECT_NE(upsample(edge, 4, ResampleFilter::Bicubic), upsample(edge, 4, ResampleFilter::Lanczos));
}

}  // namespace
}  // namespace tessera
