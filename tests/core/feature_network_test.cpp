// The network of cubic segments: its fits, its guarantees, and that the check of them sees what is wrong.
#include "core/vectorize/feature_network.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <random>

#include "core/base/parallel.h"
#include "core/image/image_io.h"
#include "tests/support/blurred_shapes.h"

namespace tessera {
namespace {

using ::testing::HasSubstr;

FeatureChain sampled(int steps, const std::function<glm::dvec2(double)>& at, bool closed = false) {
    FeatureChain chain;
    chain.closed = closed;
    for (int i = 0; i < steps + (closed ? 0 : 1); ++i) {
        FeaturePoint p;
        p.position = at(double(i) / steps);
        p.sigma = 1;
        p.contrast = .5F;
        chain.points.push_back(p);
    }
    chain.importance = lengthPx(chain);
    return chain;
}
FeatureChain line(glm::dvec2 from, glm::dvec2 to) {
    return sampled(int(glm::distance(from, to) / .8), [&](double t) { return from + t * (to - from); });
}
FeatureChain circle(glm::dvec2 centre, double radius) {
    const double full = 2 * std::acos(-1.0);
    return sampled(
        int(full * radius / .8),
        [&](double t) { return centre + radius * glm::dvec2(std::cos(full * t), std::sin(full * t)); }, true);
}
FeatureNetwork build(std::vector<FeatureChain> chains, int size = 100) {
    return buildFeatureNetwork(std::move(chains), size, size, {});
}

TEST(FitChainPart, FollowsAnArcAndItsTangents) {
    const FeatureChain chain = circle({50, 50}, 20);
    const auto curve = fitChainPart(chain, 10, 35, .05);
    ASSERT_TRUE(curve);
    for (int i = 0; i <= 10; ++i) EXPECT_NEAR(glm::distance(curve->at(i / 10.0), glm::dvec2(50)), 20, .02);
    const glm::dvec2 radius = curve->p[0] - glm::dvec2(50), along = curve->derivative(0);
    EXPECT_NEAR(glm::dot(radius, along) / glm::length(radius) / glm::length(along), 0, .01);
}

TEST(FitChainPart, RefusesWhatIsTooFarOrTurnsTooMuch) {
    const FeatureChain chain = circle({50, 50}, 20);
    EXPECT_FALSE(fitChainPart(chain, 0, 50, .3));  // 115 degrees
    EXPECT_TRUE(fitChainPart(chain, 0, 30, .3));
    const FeatureChain wave =
        sampled(50, [](double t) { return glm::dvec2(40 * t, 50 + 1.5 * std::sin(18 * t)); });
    EXPECT_FALSE(fitChainPart(wave, 0, 50, .3));
}

TEST(FitChainPart, WrapsAroundAClosedChain) {
    const FeatureChain chain = circle({50, 50}, 20);
    const auto n = uint32_t(chain.points.size());
    const auto curve = fitChainPart(chain, n - 10, 10, .1);
    ASSERT_TRUE(curve);
    EXPECT_NEAR(glm::distance(curve->at(.5), glm::dvec2(70, 50)), 0, .1);
}

TEST(FeatureNetwork, ACircleIsAFewSmoothSegments) {
    const FeatureNetwork network = build({circle({50, 50}, 25)});
    ASSERT_EQ(network.chains.size(), 1U);
    EXPECT_GE(network.segments.size(), 5U);
    EXPECT_LE(network.segments.size(), 12U);
    EXPECT_EQ(network.nodes.size(), network.segments.size());
    for (const FeatureNode& node : network.nodes) EXPECT_EQ(node.kind, FeatureNodeKind::Smooth);
    for (size_t i = 0; i < network.segments.size(); ++i) {
        const FeatureSegment &s = network.segments[i],
                             &next = network.segments[(i + 1) % network.segments.size()];
        EXPECT_EQ(s.to, next.from);
        EXPECT_EQ(s.last, next.first);
        const glm::dvec2 in = curveOf(network, s).derivative(1), out = curveOf(network, next).derivative(0);
        EXPECT_GT(glm::dot(in, out) / glm::length(in) / glm::length(out), .9999);
        EXPECT_EQ(network.chains[0].points[s.first].position, toPixels(network.nodes[s.from].position));
        EXPECT_LE(curveOf(network, s).length(), 40.5);
        EXPECT_GE(curveOf(network, s).length(), 3.9);
    }
    EXPECT_TRUE(networkViolations(network).empty());
}

TEST(FeatureNetwork, CornersAndEndsAreNodes) {
    FeatureChain chain = sampled(50, [](double t) {
        return t < .5 ? glm::dvec2(20 + 40 * t, 40) : glm::dvec2(40, 40 + 40 * (t - .5));
    });
    chain.corners = {25};
    chain.ends[1] = ChainEnd::Border;
    chain.points.back().position = {40, 60};
    const FeatureNetwork network = buildFeatureNetwork({chain}, 100, 60, {});
    ASSERT_EQ(network.segments.size(), 2U);
    EXPECT_EQ(network.nodes[0].kind, FeatureNodeKind::Tip);
    EXPECT_EQ(network.nodes[1].kind, FeatureNodeKind::Corner);
    EXPECT_EQ(network.nodes[2].kind, FeatureNodeKind::Border);
    EXPECT_EQ(toPixels(network.nodes[1].position), glm::dvec2(40, 40));
}

TEST(FeatureNetwork, ChainsThatMeetShareANode) {
    std::vector<FeatureChain> chains{line({20, 50}, {50, 50}), line({50, 50}, {80, 50}),
                                     line({50, 50}, {50, 80})};
    for (const size_t i : {0, 1, 2}) chains[i].ends[i == 0] = ChainEnd::Junction;
    const FeatureNetwork network = build(chains);
    ASSERT_EQ(network.chains.size(), 3U);
    EXPECT_EQ(std::count_if(network.nodes.begin(), network.nodes.end(),
                            [](const FeatureNode& n) { return n.kind == FeatureNodeKind::Junction; }),
              1);
    EXPECT_TRUE(networkViolations(network).empty());
}

TEST(FeatureNetwork, TheLessImportantOfTwoCloseChainsGivesWay) {
    FeatureChain strong = line({10, 50}, {90, 50}), weak = line({10, 50.8}, {90, 58});
    weak.importance = 1;
    const FeatureNetwork network = build({weak, strong});
    ASSERT_EQ(network.chains.size(), 2U);
    double weakLength = 0;
    for (const FeatureChain& c : network.chains)
        if (c.points.front().position.y != 50) weakLength = lengthPx(c);
    EXPECT_GT(weakLength, 50);
    EXPECT_LT(weakLength, 75);
    EXPECT_TRUE(networkViolations(network).empty());
}

TEST(FeatureNetwork, SigmaIsAThirdOfTheDistanceAtMost) {
    std::vector<FeatureChain> chains{line({10, 50}, {90, 50}), line({10, 54.5}, {90, 54.5})};
    for (FeatureChain& chain : chains)
        for (FeaturePoint& p : chain.points) p.sigma = 3;
    const FeatureNetwork network = build(chains);
    ASSERT_FALSE(network.segments.empty());
    for (const FeatureSegment& s : network.segments)
        for (const float sigma : s.sigma) EXPECT_NEAR(sigma, 1.5, .05);
}

// A network of one straight segment for each pair of points, with its own nodes.
FeatureNetwork handmade(const std::vector<std::array<glm::dvec2, 4>>& curves) {
    FeatureNetwork network{100, 100, {}, {}, {}};
    for (const auto& c : curves) {
        const auto n = uint32_t(network.nodes.size());
        network.nodes.push_back({toLattice(c[0]), FeatureNodeKind::Tip});
        network.nodes.push_back({toLattice(c[3]), FeatureNodeKind::Tip});
        network.segments.push_back(
            {n, n + 1, uint32_t(network.chains.size()), 0, 1, {toLattice(c[1]), toLattice(c[2])}, {1, 1}});
        network.chains.push_back(line(c[0], c[3]));
    }
    return network;
}
std::array<glm::dvec2, 4> straight(glm::dvec2 a, glm::dvec2 b) {
    return straightCurve(a, b).p;
}
std::string firstViolation(const FeatureNetwork& network) {
    const auto found = networkViolations(network);
    return found.empty() ? "" : found[0].what;
}

TEST(NetworkViolations, NoneInASoundNetwork) {
    EXPECT_EQ(firstViolation(handmade({straight({10, 10}, {40, 10}), straight({10, 20}, {40, 30})})), "");
}

TEST(NetworkViolations, SeeNodesOutsideAndOffTheBorder) {
    EXPECT_THAT(firstViolation(handmade({straight({-1, 10}, {40, 10})})), HasSubstr("outside"));
    EXPECT_THAT(firstViolation(handmade({straight({0, 10}, {40, 10})})), HasSubstr("border"));
    FeatureNetwork network = handmade({straight({0, 10}, {40, 10})});
    network.nodes[0].kind = FeatureNodeKind::Border;
    EXPECT_EQ(firstViolation(network), "");
    network.nodes[1].kind = FeatureNodeKind::Border;
    EXPECT_THAT(firstViolation(network), HasSubstr("border"));
}

TEST(NetworkViolations, SeeCloseNodes) {
    EXPECT_THAT(firstViolation(handmade({straight({10, 10}, {40, 10}), straight({40.5, 10.5}, {60, 30})})),
                HasSubstr("nodes are closer"));
}

TEST(NetworkViolations, SeeCrossings) {
    std::string all;
    for (const auto& v :
         networkViolations(handmade({straight({10, 10}, {40, 40}), straight({10, 40}, {40, 10})})))
        all += v.what + ";";
    EXPECT_THAT(all, HasSubstr("chords cross"));
    EXPECT_THAT(all, HasSubstr("curves cross"));
}

TEST(NetworkViolations, SeeCurvesThatAreClose) {
    EXPECT_THAT(firstViolation(handmade({straight({10, 10}, {40, 10}), straight({8, 12}, {42, 9.5})})),
                ::testing::Not(""));
    // The chords are far apart, one curve comes near the other line.
    EXPECT_THAT(firstViolation(handmade(
                    {{glm::dvec2(10, 10), {20, 19}, {30, 19}, {40, 10}}, straight({10, 17.4}, {40, 17.4})})),
                HasSubstr("closer than 1 px"));
}

TEST(NetworkViolations, SeeSharpAngles) {
    FeatureNetwork network = handmade({straight({10, 10}, {40, 10}), straight({10, 10}, {40, 16})});
    network.nodes[2] = network.nodes[3];
    network.nodes.pop_back();
    network.segments[1].from = 0, network.segments[1].to = 2;
    EXPECT_THAT(firstViolation(network), HasSubstr("15 degrees"));
}

TEST(NetworkViolations, SeeWhatLiesBetweenACurveAndItsChord) {
    const std::array<glm::dvec2, 4> bent{glm::dvec2(10, 10), {20, 30}, {30, 30}, {40, 10}};
    EXPECT_THAT(firstViolation(handmade({bent, straight({20, 15}, {30, 15})})),
                HasSubstr("node lies between"));
    std::string all;
    for (const auto& v : networkViolations(handmade({bent, straight({5, 18}, {45, 18})})))
        all += v.what + ";";
    EXPECT_THAT(all, HasSubstr("chord passes between"));
}

// Random lines and circles, many of which cross and touch.
TEST(FeatureNetwork, IsSoundWhateverTheChains) {
    for (uint32_t seed = 0; seed < 12; ++seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> place(0, 100), radius(2, 30);
        std::vector<FeatureChain> chains;
        for (int i = 0; i < 12; ++i) {
            const glm::dvec2 from(place(random), place(random)), to(place(random), place(random));
            if (glm::distance(from, to) > 8) chains.push_back(line(from, to));
            const double r = radius(random);
            const glm::dvec2 c(r + (100 - 2 * r) * place(random) / 100,
                               r + (100 - 2 * r) * place(random) / 100);
            chains.push_back(circle(c, r));
        }
        const FeatureNetwork network = build(chains);
        EXPECT_FALSE(network.segments.empty()) << seed;
        for (const auto& v : networkViolations(network)) ADD_FAILURE() << seed << ": " << v.what;
    }
}

TEST(FeatureNetwork, IsSoundOnPhotographs) {
    const std::string path = std::string(TESSERA_TEST_IMAGES) + "/kodak/kodim05.png";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "no photograph " << path;
    const auto loaded = readImage(path);
    ASSERT_TRUE(loaded);
    const Image& image = loaded->image;
    std::vector<FeatureNetwork> networks;
    for (const int threads : {1, 2, 7})
        withThreads(threads, [&] {
            StageReport report;
            Progress progress;
            auto chains = detectSubpixelFeatures(image, {}, report, progress);
            ASSERT_TRUE(chains);
            networks.push_back(
                buildFeatureNetwork(selectFeatures(*chains, 8000), image.width(), image.height(), {}));
        });
    ASSERT_EQ(networks.size(), 3U);
    EXPECT_EQ(networks[0], networks[1]);
    EXPECT_EQ(networks[0], networks[2]);
    for (const auto& v : networkViolations(networks[0])) ADD_FAILURE() << v.what;
    double length = 0;
    for (const FeatureChain& chain : networks[0].chains) length += lengthPx(chain);
    EXPECT_GT(length, 7000);
}

TEST(FeatureNetwork, OfNothingIsEmpty) {
    EXPECT_EQ(build({}).segments.size(), 0U);
}

}  // namespace
}  // namespace tessera
