// OKLab against the values that its author published, and as a way there and back.
#include "core/image/oklab.h"

#include <gtest/gtest.h>

#include <random>

#include "core/image/color_management.h"

namespace tessera {
namespace {

// The table of pairs in the article that defines OKLab gives XYZ; these are its sRGB corners, to the digits
// that CSS Color 4's examples have.
TEST(Oklab, HasThePublishedValues) {
    struct Known {
        glm::dvec3 srgb, lab;
    };
    const Known table[] = {
        {{1, 1, 1}, {1, 0, 0}},
        {{0, 0, 0}, {0, 0, 0}},
        {{1, 0, 0}, {.62796, .22486, .12585}},
        {{0, 1, 0}, {.86644, -.23389, .17950}},
        {{0, 0, 1}, {.45201, -.03246, -.31153}},
    };
    for (const Known& k : table) {
        const glm::dvec3 lab = toOklab(k.srgb);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(lab[c], k.lab[c], 1e-4);
    }
}

TEST(Oklab, GoesThereAndBackAlsoOutside) {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> value(-.3, 1.4);
    for (int i = 0; i < 2000; ++i) {
        const glm::dvec3 colour(value(random), value(random), value(random));
        const glm::dvec3 lab = fromOklab(toOklab(colour)), lch = fromOklch(toOklch(colour));
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(lab[c], colour[c], 2e-5);
            EXPECT_NEAR(lch[c], colour[c], 2e-5);
        }
    }
}

TEST(Oklab, HueTurnsInDegreesAndGreyHasNone) {
    EXPECT_EQ(toOklch({.5, .5, .5}).z, 0);
    EXPECT_NEAR(toOklch({1, 0, 0}).z, 29.23, .05);
    EXPECT_NEAR(toOklch({0, 0, 1}).z, 264.05, .05);
}

}  // namespace
}  // namespace tessera
