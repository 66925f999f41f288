// OKLab against the values that its author published, and as a way there and back.
#include "core/image/oklab.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
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

// The planes are what single colours are, and the way back; a count that is no multiple of a vector's.
TEST(Oklab, PlanesAreAsSingleColours) {
    constexpr size_t kCount = 157;
    std::mt19937 random(9);
    std::uniform_real_distribution<double> value(0, 1), size(0, 2);
    std::array<std::array<float, kCount>, 3> planes;
    float* const pointers[] = {planes[0].data(), planes[1].data(), planes[2].data()};
    std::array<glm::dvec3, kCount> colours;
    for (size_t i = 0; i < kCount; ++i) {
        // Dark ones too, and black and white.
        colours[i] = i < 2 ? glm::dvec3(double(i)) : glm::dvec3(value(random), value(random), value(random));
        if (i > 100) colours[i] *= std::pow(10, -size(random));
        for (int c = 0; c < 3; ++c) planes[size_t(c)][i] = float(colours[i][c]);
    }
    toOklab(pointers, kCount);
    for (size_t i = 0; i < kCount; ++i)
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(planes[size_t(c)][i], toOklab(colours[i])[c], 2e-6) << i;
    fromOklab(pointers, kCount);
    for (size_t i = 0; i < kCount; ++i)
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(planes[size_t(c)][i], colours[i][c], 4e-5) << i;
    // Beyond 0..1 the curves go on.
    float beyond[3] = {1.3F, -.2F, .6F};
    float* const single[] = {beyond, beyond + 1, beyond + 2};
    toOklab(single, 1);
    const glm::dvec3 lab = toOklab({1.3, -.2, .6});
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(beyond[c], lab[c], 2e-5);
}

TEST(Oklab, HueTurnsInDegreesAndGreyHasNone) {
    EXPECT_EQ(toOklch({.5, .5, .5}).z, 0);
    EXPECT_NEAR(toOklch({1, 0, 0}).z, 29.23, .05);
    EXPECT_NEAR(toOklch({0, 0, 1}).z, 264.05, .05);
}

}  // namespace
}  // namespace tessera
