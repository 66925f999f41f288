// Feature detection on pictures of a few pixels, stage by stage.
#include "core/vectorize/features.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <string>

namespace tessera {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

// A binary picture from rows of '.' and '#'.
struct Binary {
    int width = 0;
    int height = 0;
    std::vector<uint8_t> at;

    Binary(std::initializer_list<std::string> rows) {
        for (const std::string& row : rows) {
            width = int(row.size());
            ++height;
            for (const char c : row) at.push_back(c == '#');
        }
    }
};

std::vector<std::string> rowsOf(const std::vector<uint8_t>& at, int width) {
    std::vector<std::string> rows;
    for (size_t i = 0; i < at.size(); ++i) {
        if (i % size_t(width) == 0) rows.emplace_back();
        rows.back() += at[i] ? '#' : '.';
    }
    return rows;
}

template <class Colour>
Image paint(int width, int height, Colour&& colour) {
    Image image(width, height, 3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const glm::dvec3 c = colour(x, y);
            for (int k = 0; k < 3; ++k) image.at(x, y, k) = float(c[k]);
        }
    return image;
}

Image verticalStep(int width, int height, int firstBright) {
    return paint(width, height, [&](int x, int) { return glm::dvec3(x >= firstBright ? 1 : 0); });
}

Image disc(int size, double radius) {
    return paint(size, size, [&](int x, int y) {
        return glm::dvec3(glm::length(glm::dvec2(x + .5, y + .5) - .5 * size) < radius ? .9 : .1);
    });
}

// A field with one magnitude per pixel, for the steps that look at nothing else.
GradientField fieldOf(const std::vector<float>& magnitude, int width) {
    return {width, int(magnitude.size()) / width, magnitude,
            std::vector<glm::vec2>(magnitude.size(), glm::vec2(1, 0))};
}

struct Detected {
    std::vector<PixelChain> chains;
    StageReport report{"features", "canny", 0, {}};
};

Detected detect(const Image& image, const VectorizeSettings& settings = {},
                const std::string& variant = "canny") {
    Detected result;
    result.report.variant = variant;
    Progress progress;
    auto chains = detectFeatures(image, settings, result.report, progress);
    EXPECT_TRUE(chains.has_value());
    if (chains) result.chains = *chains;
    return result;
}

TEST(DiZenzo, ARampHasItsSlopeInEveryChannel) {
    const GradientField field =
        diZenzoGradient(paint(16, 12, [](int x, int) { return glm::dvec3(.01 * x); }), 1);
    ASSERT_EQ(field.width, 16);
    ASSERT_EQ(field.height, 12);
    // Away from the sides, where the smoothing (radius 4 and less) and the difference see nothing but the
    // ramp.
    for (int y = 0; y < 12; ++y)
        for (int x = 6; x < 10; ++x) {
            EXPECT_NEAR(field.at(x, y), .01 * std::sqrt(3), 1e-6);
            EXPECT_NEAR(std::abs(field.direction[size_t(y * 16 + x)].x), 1, 1e-6);
        }
}

TEST(DiZenzo, DirectionOfADiagonalRamp) {
    const GradientField field =
        diZenzoGradient(paint(16, 16, [](int x, int y) { return glm::dvec3(.02 * x - .01 * y, 0, 0); }), 1);
    const glm::dvec2 direction = field.direction[8 * 16 + 8];
    EXPECT_NEAR(std::abs(glm::dot(direction, glm::normalize(glm::dvec2(2, -1)))), 1, 1e-5);
    EXPECT_NEAR(glm::length(direction), 1, 1e-6);
    EXPECT_NEAR(field.at(8, 8), .01 * std::sqrt(5), 1e-6);
}

// Red falls where green rises so that luma (.299, .587, .114) stays: a grey picture would have no edge at
// all.
TEST(DiZenzo, SeesAnEdgeOfColourAlone) {
    const Image image =
        paint(16, 8, [](int x, int) { return x < 8 ? glm::dvec3(.587, 0, .2) : glm::dvec3(0, .299, .2); });
    const GradientField field = diZenzoGradient(image, 1);
    const float peak = field.at(7, 4);
    EXPECT_GT(peak, .15);
    EXPECT_FLOAT_EQ(field.at(8, 4), peak);
    EXPECT_LT(field.at(3, 4), .01 * peak);
    EXPECT_LT(field.at(12, 4), .01 * peak);
    const Detected found = detect(
        paint(32, 32, [](int x, int) { return x < 16 ? glm::dvec3(.587, 0, .2) : glm::dvec3(0, .299, .2); }));
    ASSERT_EQ(found.chains.size(), 1U);
}

// The two channels' gradients cross at right angles: the larger one wins, and their sum would not be a
// direction.
TEST(DiZenzo, TakesTheStrongerOfTwoDirections) {
    const GradientField field =
        diZenzoGradient(paint(16, 16, [](int x, int y) { return glm::dvec3(.02 * x, .01 * y, 0); }), 1);
    EXPECT_NEAR(field.at(8, 8), .02, 1e-6);
    EXPECT_NEAR(std::abs(field.direction[8 * 16 + 8].x), 1, 1e-6);
}

TEST(DiZenzo, AFlatPictureHasNone) {
    const GradientField field = diZenzoGradient(paint(8, 8, [](int, int) { return glm::dvec3(.5); }), 1);
    for (const float m : field.magnitude) EXPECT_EQ(m, 0);
}

// Both pixels beside the step have the same gradient; one line of them is left, but for the outermost rows.
TEST(CannyEdges, AStepIsOneLine) {
    const auto edges = cannyEdges(diZenzoGradient(verticalStep(12, 6, 6), 1), .01, .02);
    EXPECT_THAT(rowsOf(edges, 12), ElementsAre("............", ".....#......", ".....#......", ".....#......",
                                               ".....#......", "............"));
}

TEST(CannyEdges, ThresholdsAreHysteresis) {
    // A step whose height falls from row to row: .5, .45, .. .05.
    const Image image = paint(16, 12, [](int x, int y) { return glm::dvec3(x >= 8 ? .05 * (11 - y) : 0); });
    const GradientField field = diZenzoGradient(image, 1);
    const double top = field.at(7, 2), bottom = field.at(7, 8);
    const auto count = [&](double low, double high) {
        const auto edges = cannyEdges(field, low, high);
        return std::count(edges.begin(), edges.end(), uint8_t(1));
    };
    EXPECT_EQ(count(top * 10, top * 10), 0);
    EXPECT_GT(count(bottom * .99, top * .99), count(top * .99, top * .99))
        << "weak ones go along with a strong one";
    EXPECT_EQ(count(bottom * .99, top * 10), 0) << "weak ones alone do not";
}

TEST(Thin, ALineOfThreePixels) {
    Binary b{"..............", "..............", "..##########..", "..##########..",
             "..##########..", "..............", ".............."};
    thin(b.at, b.width, b.height);
    const auto rows = rowsOf(b.at, b.width);
    for (const size_t y : {0U, 1U, 2U, 4U, 5U, 6U}) EXPECT_EQ(rows[y], "..............") << y;
    EXPECT_NE(rows[3].find("######"), std::string::npos);
}

// Each pixel of a staircase has a neighbour too many for a line, but to take its ends away would eat it
// whole.
TEST(Thin, AStaircaseBecomesADiagonal) {
    Binary b{"........", ".##.....", "..##....", "...##...", "....##..", "........"};
    thin(b.at, b.width, b.height);
    EXPECT_THAT(rowsOf(b.at, b.width),
                ElementsAre("........", ".#......", "..#.....", "...#....", "....##..", "........"));
}

TEST(Thin, LeavesThinLinesAlone) {
    const Binary line{"........", ".######.", "........"},
        diagonal{"#....", ".#...", "..#..", "...#.", "....#"};
    for (const Binary& b : {line, diagonal}) {
        Binary copy = b;
        thin(copy.at, copy.width, copy.height);
        EXPECT_EQ(copy.at, b.at);
    }
}

TEST(RemoveJunctions, TheStemOfATEndsShort) {
    Binary b{".........", ".#######.", "....#....", "....#....", "....#....", "........."};
    std::vector<float> magnitude;
    for (int y = 0; y < b.height; ++y)
        for (int x = 0; x < b.width; ++x) magnitude.push_back(y == 1 ? 1.F : .5F);
    removeJunctions(b.at, fieldOf(magnitude, b.width));
    EXPECT_THAT(rowsOf(b.at, b.width),
                ElementsAre(".........", ".#######.", ".........", "....#....", "....#....", "........."));
}

TEST(RemoveJunctions, LeavesLinesAlone) {
    Binary b{".........", ".####....", ".....##..", ".......#.", "........."};
    const auto before = b.at;
    removeJunctions(b.at, fieldOf(std::vector<float>(b.at.size(), 1.F), b.width));
    EXPECT_EQ(b.at, before);
}

TEST(LinkChains, FollowsALineFromItsEnd) {
    const Binary b{"......", ".##...", "...#..", "...#..", "......"};
    const auto chains = linkChains(b.at, b.width, b.height, 1);
    ASSERT_EQ(chains.size(), 1U);
    EXPECT_FALSE(chains[0].closed);
    EXPECT_THAT(chains[0].pixels,
                ElementsAre(glm::ivec2(1, 1), glm::ivec2(2, 1), glm::ivec2(3, 2), glm::ivec2(3, 3)));
}

TEST(LinkChains, OrderAndLeastLength) {
    const Binary b{"#.#.....", "#.#..##.", "#.......", "........", "..####.."};
    EXPECT_EQ(linkChains(b.at, b.width, b.height, 1).size(), 4U);
    const auto chains = linkChains(b.at, b.width, b.height, 3);
    ASSERT_EQ(chains.size(), 2U);
    EXPECT_EQ(chains[0].pixels.front(), glm::ivec2(0, 0)) << "raster order of their first pixels";
    EXPECT_EQ(chains[0].pixels.size(), 3U);
    EXPECT_EQ(chains[1].pixels.front(), glm::ivec2(2, 4));
    EXPECT_EQ(chains[1].pixels.size(), 4U);
    EXPECT_THAT(linkChains(b.at, b.width, b.height, 5), IsEmpty());
}

TEST(LinkChains, ARingIsClosed) {
    const Binary b{".......", "...#...", "..#.#..", ".#...#.", "..#.#..", "...#...", "......."};
    const auto chains = linkChains(b.at, b.width, b.height, 1);
    ASSERT_EQ(chains.size(), 1U);
    EXPECT_TRUE(chains[0].closed);
    ASSERT_EQ(chains[0].pixels.size(), 8U);
    for (size_t k = 0; k < 8; ++k) {
        const glm::ivec2 d = chains[0].pixels[(k + 1) % 8] - chains[0].pixels[k];
        EXPECT_EQ(d.x * d.x + d.y * d.y, 2) << k;
    }
}

// The discontinuity is between columns 5 and 6; the detected pixels may be either.
TEST(ChooseSide, TheSideOfTheStep) {
    const Image image = verticalStep(12, 8, 6);
    for (const int column : {5, 6})
        for (const bool downwards : {true, false}) {
            PixelChain chain;
            for (int y = 1; y < 7; ++y) chain.pixels.emplace_back(column, downwards ? y : 7 - y);
            chooseSide(chain, image);
            // The normal of direction (0, 1) is (-1, 0): to the left.
            const bool discontinuityOnTheLeft = column == 6;
            EXPECT_EQ(chain.onPositiveSide, discontinuityOnTheLeft == downwards) << column << downwards;
        }
}

TEST(ChooseSide, OnAClosedChain) {
    // A square ring of pixels just inside a bright square: the step lies outside the ring.
    const Image image =
        paint(12, 12, [](int x, int y) { return glm::dvec3(x >= 3 && x < 9 && y >= 3 && y < 9 ? 1 : 0); });
    PixelChain chain;
    chain.closed = true;
    for (int k = 3; k < 8; ++k) chain.pixels.emplace_back(k, 3);
    for (int k = 3; k < 8; ++k) chain.pixels.emplace_back(8, k);
    for (int k = 8; k > 3; --k) chain.pixels.emplace_back(k, 8);
    for (int k = 8; k > 3; --k) chain.pixels.emplace_back(3, k);
    // It runs to the right along the top; its normal (-d.y, d.x) points down, inside.
    chooseSide(chain, image);
    EXPECT_FALSE(chain.onPositiveSide);
    std::reverse(chain.pixels.begin(), chain.pixels.end());
    chooseSide(chain, image);
    EXPECT_TRUE(chain.onPositiveSide);
}

TEST(DetectFeatures, ADiscIsOneClosedChain) {
    const Detected found = detect(disc(40, 12));
    ASSERT_EQ(found.chains.size(), 1U);
    const PixelChain& chain = found.chains[0];
    EXPECT_TRUE(chain.closed);
    // 8-connected: four octants of 2 r / sqrt 2 steps each, about.
    EXPECT_NEAR(double(chain.pixels.size()), 8 * 12 / std::sqrt(2), 6);
    for (const glm::ivec2 p : chain.pixels)
        EXPECT_NEAR(glm::length(glm::dvec2(p) + .5 - 20.0), 12, 1.1) << p.x << ' ' << p.y;
    // Half a pixel off on the chosen side it lies nearer to the circle, on the whole.
    double onSide = 0, offSide = 0;
    const size_t n = chain.pixels.size();
    for (size_t k = 0; k < n; ++k) {
        const glm::dvec2 along =
            glm::normalize(glm::dvec2(chain.pixels[(k + 2) % n] - chain.pixels[(k + n - 2) % n]));
        const glm::dvec2 normal = glm::dvec2(-along.y, along.x) * (chain.onPositiveSide ? .5 : -.5);
        onSide += std::abs(glm::length(glm::dvec2(chain.pixels[k]) + .5 + normal - 20.0) - 12);
        offSide += std::abs(glm::length(glm::dvec2(chain.pixels[k]) + .5 - normal - 20.0) - 12);
    }
    EXPECT_LT(onSide, offSide);
    EXPECT_EQ(found.report.figures[1], (std::pair<std::string, double>("chains", 1)));
}

// Each pixel of a chain touches those before and after it, and no other pixel of any chain; none is
// outermost.
TEST(DetectFeatures, ChainsKeepTheirPromises) {
    const Image image = paint(48, 40, [](int x, int y) {
        return glm::dvec3(.5 + .5 * std::sin(.4 * x) * std::cos(.31 * y), x > 20 ? .8 : .1, y > x ? .3 : .6);
    });
    const Detected found = detect(image);
    ASSERT_GT(found.chains.size(), 1U);
    std::vector<std::pair<glm::ivec2, std::pair<size_t, size_t>>> all;
    for (size_t c = 0; c < found.chains.size(); ++c) {
        const auto& pixels = found.chains[c].pixels;
        EXPECT_GE(pixels.size(), 10U);
        for (size_t k = 0; k < pixels.size(); ++k) {
            EXPECT_TRUE(pixels[k].x >= 1 && pixels[k].y >= 1 && pixels[k].x < 47 && pixels[k].y < 39);
            all.push_back({pixels[k], {c, k}});
        }
    }
    for (const auto& [p, at] : all)
        for (const auto& [q, to] : all) {
            if (at == to) continue;
            const glm::ivec2 d = glm::abs(p - q);
            const auto n = found.chains[at.first].pixels.size();
            const size_t gap = (to.second + n - at.second) % n;
            const bool next =
                at.first == to.first && (at.second + 1 == to.second || to.second + 1 == at.second ||
                                         (found.chains[at.first].closed && (gap == 1 || gap == n - 1)));
            EXPECT_EQ(std::max(d.x, d.y) <= 1, next) << p.x << ' ' << p.y << " and " << q.x << ' ' << q.y;
        }
}

// At 45 degrees both pixels beside the edge are maxima, and Canny's line is a staircase.
TEST(DetectFeatures, ADiagonalEdge) {
    const Detected found =
        detect(paint(40, 40, [](int x, int y) { return glm::dvec3(x + y >= 40 ? .8 : .2); }));
    ASSERT_EQ(found.chains.size(), 1U);
    EXPECT_FALSE(found.chains[0].closed);
    EXPECT_GE(found.chains[0].pixels.size(), 34U);
    for (const glm::ivec2 p : found.chains[0].pixels) EXPECT_NEAR(p.x + p.y, 39.5, 1.6);
}

TEST(DetectFeatures, NothingWhereThereIsNothingToFind) {
    EXPECT_THAT(detect(disc(40, 12), {}, "none").chains, IsEmpty());
    EXPECT_THAT(detect(paint(16, 16, [](int, int) { return glm::dvec3(.3, .5, .7); })).chains, IsEmpty());
    EXPECT_THAT(detect(Image(2, 40, 3)).chains, IsEmpty());
    EXPECT_THAT(detect(Image(1, 1, 3)).chains, IsEmpty());
    EXPECT_THAT(detect(verticalStep(12, 8, 6)).chains, IsEmpty()) << "six pixels are fewer than ten";
    EXPECT_EQ(detect(verticalStep(12, 12, 6)).chains.size(), 1U);
}

TEST(DetectFeatures, StopsOnRequest) {
    std::stop_source stop;
    stop.request_stop();
    Progress progress(stop.get_token());
    StageReport report{"features", "canny", 0, {}};
    const auto result = detectFeatures(disc(40, 12), {}, report, progress);
    ASSERT_FALSE(result.has_value());
    EXPECT_EQ(result.error().code, ErrorCode::Stopped);
}

}  // namespace
}  // namespace tessera
