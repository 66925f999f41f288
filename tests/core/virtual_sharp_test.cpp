// The picture without blur, against shapes that never had any.
#include "core/vectorize/virtual_sharp.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "core/base/parallel.h"
#include "core/image/resample.h"
#include "tests/support/blurred_shapes.h"

namespace tessera {
namespace {

FeatureNetwork networkOf(const Image& image) {
    StageReport report;
    Progress progress;
    auto chains = detectSubpixelFeatures(image, {}, report, progress);
    EXPECT_TRUE(chains);
    return buildFeatureNetwork(std::move(*chains), image.width(), image.height(), {});
}

TEST(VirtualSharp, ABlurredDiscBecomesHard) {
    const glm::dvec2 centre(32.3, 31.6);
    const Colour inside(.8, .7, .6), outside(.2, .2, .3);
    for (const double sigma : {.4, .8, 1.5}) {
        const Image blurred = blurredDisc(64, centre, 18, sigma, inside, outside);
        const Image sharp = virtualSharp(blurred, networkOf(blurred));
        double worst = 0, worstBefore = 0;
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x) {
                const double d = glm::distance(glm::dvec2(x + .5, y + .5), centre) - 18;
                if (std::abs(d) < .8) continue;
                for (int c = 0; c < 3; ++c) {
                    const double hard = d < 0 ? inside[c] : outside[c];
                    worst = std::max(worst, std::abs(sharp.at(x, y, c) - hard));
                    worstBefore = std::max(worstBefore, std::abs(blurred.at(x, y, c) - hard));
                }
            }
        EXPECT_LT(worst, 6.0 / 255) << sigma;
        EXPECT_GT(worstBefore, sigma > .5 ? 4 * worst : 0) << sigma;
    }
}

// Also where the curve passes through a pixel its centre's side counts, and nothing overshoots far.
TEST(VirtualSharp, CrossedPixelsTakeTheSideOfTheirCentre) {
    const glm::dvec2 centre(32.3, 31.6);
    const Image blurred = blurredDisc(64, centre, 18, 1, Colour(.8), Colour(.2));
    const Image sharp = virtualSharp(blurred, networkOf(blurred));
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            const double d = glm::distance(glm::dvec2(x + .5, y + .5), centre) - 18;
            if (std::abs(d) < .1) continue;
            EXPECT_NEAR(sharp.at(x, y, 0), d < 0 ? .8 : .2, .05) << x << " " << y;
        }
}

// A picture enlarged, whose blur is wider in its own pixels, with the network of the picture before.
TEST(VirtualSharp, AnEnlargedPictureBecomesHardToo) {
    const glm::dvec2 centre(32.3, 31.6);
    const Image blurred = blurredDisc(64, centre, 18, .8, Colour(.8), Colour(.2));
    const Image sharp = virtualSharp(enlargedMeans(blurred, 2), networkOf(blurred));
    ASSERT_EQ(sharp.width(), 128);
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 128; ++x) {
            const double d = glm::distance(glm::dvec2(x + .5, y + .5) / 2.0, centre) - 18;
            if (std::abs(d) < .3) continue;
            EXPECT_NEAR(sharp.at(x, y, 0), d < 0 ? .8 : .2, .06) << x << " " << y;
        }
}

TEST(VirtualSharp, IsTheSamePictureWithoutFeatures) {
    const Image image = blurredDisc(40, {20, 20}, 12, 1);
    EXPECT_EQ(virtualSharp(image, FeatureNetwork{40, 40, {}, {}, {}}), image);
    const Image one(1, 1, 3, .5F);
    EXPECT_EQ(virtualSharp(one, FeatureNetwork{1, 1, {}, {}, {}}), one);
}

TEST(VirtualSharp, FadesTowardATip) {
    // The right half of a vertical step, so that the feature ends in the picture's middle.
    const Image image = blurredShapes(80, 80, 1.2, [](glm::dvec2 p) {
        return Colour(p.y < 40.2 ? .5 : .5 + .4 / (1 + std::exp(-(p.x - 40) / 3)));
    });
    const FeatureNetwork network = networkOf(image);
    ASSERT_EQ(network.chains.size(), 1U);
    const Image sharp = virtualSharp(image, network);
    double tip = 80;
    for (const FeatureNode& node : network.nodes)
        if (node.kind == FeatureNodeKind::Tip) tip = std::min(tip, toPixels(node.position).x);
    ASSERT_LT(tip, 60);
    const int x = int(tip);
    EXPECT_EQ(sharp.at(x - 2, 40, 0), image.at(x - 2, 40, 0));
    EXPECT_NEAR(sharp.at(x + 1, 40, 0), image.at(x + 1, 40, 0), .02);
    EXPECT_GT(sharp.at(70, 40, 0), image.at(70, 40, 0) + .1);
    // The other end is on the border and keeps its step.
    EXPECT_NEAR(sharp.at(79, 41, 0), .9, .03);
}

TEST(VirtualSharp, DoesNotDependOnThreads) {
    const Image image = blurredDisc(64, {32.3, 31.6}, 18, 1);
    const FeatureNetwork network = networkOf(image);
    std::vector<Image> sharp;
    for (const int threads : {1, 2, 7})
        withThreads(threads, [&] { sharp.push_back(virtualSharp(image, network)); });
    EXPECT_EQ(sharp[0], sharp[1]);
    EXPECT_EQ(sharp[0], sharp[2]);
}

}  // namespace
}  // namespace tessera
