// Subpixel features on rendered shapes whose edges are known exactly.
#include "core/vectorize/subpixel_features.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "core/base/parallel.h"
#include "tests/support/blurred_shapes.h"

namespace tessera {
namespace {

std::vector<FeatureChain> detect(const Image& image) {
    StageReport report;
    Progress progress;
    auto chains = detectSubpixelFeatures(image, {}, report, progress);
    EXPECT_TRUE(chains.has_value());
    return chains ? *chains : std::vector<FeatureChain>{};
}

struct Accuracy {
    double mean = 0, largest = 0;      // of the distance to the true edge, px
    double sigmaError = 0, count = 0;  // relative, the largest
};

template <class Distance>
Accuracy measure(const std::vector<FeatureChain>& chains, double sigma, Distance&& distance) {
    Accuracy a;
    for (const FeatureChain& chain : chains)
        for (const FeaturePoint& p : chain.points) {
            const double d = std::abs(distance(p.position));
            a.mean += d;
            a.largest = std::max(a.largest, d);
            a.sigmaError = std::max(a.sigmaError, std::abs(p.sigma / sigma - 1));
            ++a.count;
        }
    a.mean /= std::max(a.count, 1.0);
    return a;
}

void addNoise(Image& image, double deviation, uint32_t seed) {
    std::mt19937 random(seed);
    std::normal_distribution<float> noise(0, float(deviation));
    for (int c = 0; c < image.channels(); ++c)
        for (float& v : image.plane(c)) v += noise(random);
}

TEST(SubpixelFeatures, FindADiscAndItsBlur) {
    const glm::dvec2 centre(32.3, 31.6);
    for (const double radius : {8.0, 20.0})
        for (const double sigma : {.35, .7, 1.2, 2.0}) {
            const auto chains = detect(blurredDisc(64, centre, radius, sigma));
            ASSERT_EQ(chains.size(), 1U) << radius << " " << sigma;
            EXPECT_TRUE(chains[0].closed);
            EXPECT_TRUE(chains[0].corners.empty());
            const Accuracy a =
                measure(chains, sigma, [&](glm::dvec2 p) { return glm::distance(p, centre) - radius; });
            EXPECT_LT(a.mean, .05) << radius << " " << sigma;
            EXPECT_LT(a.largest, .15) << radius << " " << sigma;
            EXPECT_LT(a.sigmaError, .15) << radius << " " << sigma;
            EXPECT_NEAR(lengthPx(chains[0]), 2 * std::acos(-1) * radius, .02 * 6.28 * radius);
        }
}

TEST(SubpixelFeatures, JumpIsThatOfThePositiveSide) {
    const glm::dvec2 centre(32, 32);
    const auto chains = detect(blurredDisc(64, centre, 18, 1));
    ASSERT_EQ(chains.size(), 1U);
    const auto& points = chains[0].points;
    for (size_t i = 1; i + 1 < points.size(); ++i) {
        const glm::dvec2 d = points[i + 1].position - points[i - 1].position;
        const bool inward = glm::dot(glm::dvec2(-d.y, d.x), centre - points[i].position) > 0;
        const float sign = inward ? 1.F : -1.F;
        EXPECT_NEAR(points[i].jump[0], sign * .6F, .02F);
        EXPECT_NEAR(points[i].jump[1], sign * .5F, .02F);
        EXPECT_NEAR(points[i].jump[2], sign * .3F, .02F);
        EXPECT_NEAR(points[i].contrast, std::sqrt(.36 + .25 + .09), .02);
        EXPECT_LT(glm::distance(points[i].position, points[i + 1].position), 1.1);
    }
}

TEST(SubpixelFeatures, ALineRunsFromBorderToBorder) {
    for (const double angle : {.0, .2, .6, 1.1}) {
        const glm::dvec2 normal(std::cos(angle), std::sin(angle));
        const auto distance = [&](glm::dvec2 p) { return glm::dot(p - glm::dvec2(24.37, 24), normal); };
        const auto chains = detect(
            blurredShapes(48, 48, .6, [&](glm::dvec2 p) { return Colour(distance(p) > 0 ? .7 : .3); }));
        ASSERT_EQ(chains.size(), 1U) << angle;
        const Accuracy a = measure(chains, .6, distance);
        EXPECT_LT(a.mean, .05) << angle;
        EXPECT_LT(a.largest, .2) << angle;
        for (const bool last : {false, true}) {
            EXPECT_EQ(chains[0].ends[last], ChainEnd::Border);
            const glm::dvec2 p = last ? chains[0].points.back().position : chains[0].points.front().position;
            EXPECT_TRUE(p.x == 0 || p.y == 0 || p.x == 48 || p.y == 48) << p.x << " " << p.y;
        }
    }
}

TEST(SubpixelFeatures, MoveWithThePictureBySubpixels) {
    double before = 0;
    for (const double shift : {0.0, .25, .5, .75}) {
        const auto chains = detect(blurredDisc(48, {24 + shift, 24}, 12, .6));
        ASSERT_EQ(chains.size(), 1U);
        double x = 0;
        for (const FeaturePoint& p : chains[0].points) x += p.position.x;
        x /= double(chains[0].points.size());
        if (shift > 0) {
            EXPECT_NEAR(x - before, .25, .02);
        }
        before = x;
    }
}

TEST(SubpixelFeatures, ASquareHasFourCorners) {
    const auto inside = [](glm::dvec2 p) {
        const glm::dvec2 q = p - glm::dvec2(32.2, 31.7);
        const double c = std::cos(.3), s = std::sin(.3);
        return std::max(std::abs(c * q.x + s * q.y), std::abs(c * q.y - s * q.x)) < 14;
    };
    const auto chains =
        detect(blurredShapes(64, 64, .5, [&](glm::dvec2 p) { return Colour(inside(p) ? .9 : .2); }));
    ASSERT_EQ(chains.size(), 1U);
    EXPECT_TRUE(chains[0].closed);
    EXPECT_EQ(chains[0].corners.size(), 4U);
    for (const uint32_t corner : chains[0].corners)
        EXPECT_NEAR(glm::distance(chains[0].points[corner].position, glm::dvec2(32.2, 31.7)),
                    14 * std::sqrt(2), 1.2);
}

TEST(SubpixelFeatures, ThreeColoursMeetInAJunction) {
    const glm::dvec2 centre(32.3, 31.8);
    const auto chains = detect(blurredShapes(64, 64, .6, [&](glm::dvec2 p) {
        const double angle = std::atan2(p.y - centre.y, p.x - centre.x) + .4;
        if (angle > 0 && angle < 2.1) return Colour(.9, .2, .2);
        return angle >= 2.1 || angle < -2.09 ? Colour(.2, .8, .2) : Colour(.2, .2, .9);
    }));
    ASSERT_EQ(chains.size(), 3U);
    std::vector<glm::dvec2> junctions;
    for (const FeatureChain& chain : chains)
        for (const bool last : {false, true}) {
            const glm::dvec2 p = last ? chain.points.back().position : chain.points.front().position;
            if (chain.ends[last] == ChainEnd::Junction) junctions.push_back(p);
        }
    ASSERT_EQ(junctions.size(), 3U);
    EXPECT_EQ(junctions[0], junctions[1]);
    EXPECT_EQ(junctions[0], junctions[2]);
    EXPECT_LT(glm::distance(junctions[0], centre), 1.5);
}

TEST(SubpixelFeatures, NoiseHasNone) {
    for (const double deviation : {.002, .02, .08}) {
        Image image(200, 160, 3, .5F);
        addNoise(image, deviation, 7);
        EXPECT_TRUE(detect(image).empty()) << deviation;
    }
}

TEST(SubpixelFeatures, ADiscInNoiseIsOneSmoothChain) {
    const glm::dvec2 centre(48.4, 47.7);
    Image image = blurredDisc(96, centre, 25, .8);
    addNoise(image, .02, 3);
    const auto chains = detect(image);
    ASSERT_EQ(chains.size(), 1U);
    EXPECT_TRUE(chains[0].closed);
    const Accuracy a = measure(chains, .8, [&](glm::dvec2 p) { return glm::distance(p, centre) - 25; });
    EXPECT_LT(a.mean, .06);
    EXPECT_LT(a.sigmaError, .25);
}

TEST(SubpixelFeatures, FaintStepsDoNotCount) {
    const auto step = [](double height) {
        return blurredShapes(48, 48, .5, [=](glm::dvec2 p) { return Colour(p.x < 24.3 ? .5 : .5 + height); });
    };
    EXPECT_TRUE(detect(step(1.5 / 255)).empty());
    EXPECT_FALSE(detect(step(16.0 / 255)).empty());
}

TEST(SubpixelFeatures, ConstantAndTinyPicturesHaveNone) {
    EXPECT_TRUE(detect(Image(40, 30, 3, .3F)).empty());
    for (int w = 1; w <= 3; ++w)
        for (int h = 1; h <= 3; ++h) {
            Image image(w, h, 3, .1F);
            image.at(w - 1, h - 1, 0) = 1;
            EXPECT_TRUE(detect(image).empty()) << w << " " << h;
        }
}

TEST(SubpixelFeatures, SeeTheEdgeOfAlphaAlone) {
    const Image disc = blurredDisc(48, {24, 24}, 12, .7);
    Image image(48, 48, 4, 0);  // black, so that premultiplied colours are zero
    std::copy(disc.plane(0).begin(), disc.plane(0).end(), image.plane(3).begin());
    const auto chains = detect(image);
    ASSERT_EQ(chains.size(), 1U);
    EXPECT_NEAR(std::abs(chains[0].points[0].jump[3]), .6F, .03F);
    EXPECT_EQ(chains[0].points[0].jump[0], 0);
}

TEST(SubpixelFeatures, DoNotDependOnThreads) {
    Image image = blurredShapes(90, 70, .8, [](glm::dvec2 p) {
        return Colour(.5 + .4 * std::sin(.3 * p.x) * (std::cos(.25 * p.y) > 0 ? 1 : -1));
    });
    std::vector<std::vector<FeatureChain>> found;
    for (const int threads : {1, 2, 7}) withThreads(threads, [&] { found.push_back(detect(image)); });
    ASSERT_FALSE(found[0].empty());
    EXPECT_EQ(found[0], found[1]);
    EXPECT_EQ(found[0], found[2]);
}

TEST(SubpixelFeatures, StopWhenAsked) {
    std::stop_source source;
    source.request_stop();
    Progress progress(source.get_token());
    StageReport report;
    const auto chains = detectSubpixelFeatures(blurredDisc(48, {24, 24}, 12, .7), {}, report, progress);
    ASSERT_FALSE(chains);
    EXPECT_EQ(chains.error().code, ErrorCode::Stopped);
}

FeatureChain straight(glm::dvec2 from, glm::dvec2 to, double worth) {
    FeatureChain chain;
    const int steps = int(glm::distance(from, to));
    for (int i = 0; i <= steps; ++i) {
        FeaturePoint p;
        p.position = i == steps ? to : from + (to - from) * (double(i) / steps);
        p.jump = {.5F};
        p.contrast = .5F;
        chain.points.push_back(p);
    }
    chain.importance = worth * steps;
    return chain;
}

TEST(SelectFeatures, KeepTheMostImportantAndJoinWhatIsLeft) {
    FeatureChain left = straight({0, 20}, {20, 20}, 1), right = straight({40, 20}, {20, 20}, 1),
                 spur = straight({20, 20}, {20, 40}, .1);
    left.ends[1] = right.ends[1] = spur.ends[0] = ChainEnd::Junction;
    const std::vector<FeatureChain> all{left, right, spur};
    EXPECT_EQ(selectFeatures(all, 100).size(), 3U);
    const auto kept = selectFeatures(all, 3.2);
    ASSERT_EQ(kept.size(), 1U);
    EXPECT_EQ(kept[0].points.size(), 41U);
    EXPECT_NEAR(lengthPx(kept[0]), 40, 1e-9);
    EXPECT_EQ(kept[0].ends[0], ChainEnd::Tip);
    EXPECT_EQ(kept[0].ends[1], ChainEnd::Tip);
    // The second one was turned around, and its jump with it.
    EXPECT_EQ(kept[0].points[5].jump[0], .5F);
    EXPECT_EQ(kept[0].points[30].jump[0], -.5F);
    EXPECT_TRUE(selectFeatures(all, 1).empty());
}

TEST(SelectFeatures, AChainAloneAtItsJunctionEndsInATip) {
    FeatureChain one = straight({0, 20}, {20, 20}, 1), other = straight({20, 20}, {20, 40}, .1);
    one.ends[1] = other.ends[0] = ChainEnd::Junction;
    const auto kept = selectFeatures({one, other}, 2);
    ASSERT_EQ(kept.size(), 1U);
    EXPECT_EQ(kept[0].ends[1], ChainEnd::Tip);
}

}  // namespace
}  // namespace tessera
