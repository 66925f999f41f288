// The measures of image_compare.h: by hand on small pictures, and on photographs against an independent
// program.
#include "core/image/image_compare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "core/base/parallel.h"
#include "core/image/image_io.h"

namespace tessera {
namespace {

Image filled(int width, int height, std::array<float, 3> bytes) {
    Image image(width, height, 3);
    for (int c = 0; c < 3; ++c)
        for (float& value : image.plane(c)) value = bytes[size_t(c)] / 255;
    return image;
}

TEST(CompareImages, EqualPictures) {
    const Image image = filled(12, 11, {10, 20, 30});
    const Result<ImageDifference> difference = compareImages(image, image);
    ASSERT_TRUE(difference);
    EXPECT_EQ(difference->mae, 0);
    EXPECT_EQ(difference->euclid, 0);
    EXPECT_EQ(difference->psnr, std::numeric_limits<double>::infinity());
    EXPECT_EQ(difference->psnrLuma, std::numeric_limits<double>::infinity());
    ASSERT_TRUE(difference->ssim);
    EXPECT_DOUBLE_EQ(*difference->ssim, 1);
}

// The comparer must fail: every measure sees one changed value.
TEST(CompareImages, OneChangedPixelIsSeen) {
    const Image a = filled(12, 12, {100, 100, 100});
    Image b = a;
    b.at(6, 6, 1) = 101.f / 255;
    const Result<ImageDifference> difference = compareImages(a, b);
    ASSERT_TRUE(difference);
    EXPECT_DOUBLE_EQ(difference->mae, 1. / (144 * 3));
    EXPECT_EQ(difference->maeChannel[0], 0);
    EXPECT_DOUBLE_EQ(difference->maeChannel[1], 1. / 144);
    EXPECT_DOUBLE_EQ(difference->euclid, 1. / 144);
    EXPECT_LT(difference->psnr, 100);
    EXPECT_LT(*difference->ssim, 1);
}

TEST(CompareImages, ByHand) {
    // Two pixels: (3, 4, 0) apart, and (0, 0, 12).
    const Image a = filled(2, 1, {50, 60, 70});
    Image b = a;
    b.at(0, 0, 0) = 53.f / 255;
    b.at(0, 0, 1) = 56.f / 255;
    b.at(1, 0, 2) = 82.f / 255;
    const Result<ImageDifference> difference = compareImages(a, b);
    ASSERT_TRUE(difference);
    EXPECT_DOUBLE_EQ(difference->mae, 19. / 6);
    EXPECT_DOUBLE_EQ(difference->maeChannel[2], 6);
    EXPECT_DOUBLE_EQ(difference->euclid, (5. + 12) / 2);
    EXPECT_DOUBLE_EQ(difference->rmse, std::sqrt(169. / 6));
    EXPECT_NEAR(difference->psnr, 10 * std::log10(255. * 255 * 6 / 169), 1e-12);
    const double first = .299 * 3 - .587 * 4;
    const double second = .114 * 12;
    EXPECT_NEAR(difference->maeLuma, (std::abs(first) + second) / 2, 1e-12);
    EXPECT_NEAR(difference->psnrLuma, 10 * std::log10(255. * 255 * 2 / (first * first + second * second)),
                1e-9);
    EXPECT_FALSE(difference->ssim);
}

// Two flat pictures have no variance: what is left of SSIM is the term of the means.
TEST(CompareImages, SsimOfFlatPicturesAndWhereItIsMissing) {
    const Image a = filled(11, 11, {100, 100, 100});
    const Image b = filled(11, 11, {150, 150, 150});
    constexpr double kC1 = 2.55 * 2.55;
    const double expected = (2 * 100. * 150 + kC1) / (100. * 100 + 150. * 150 + kC1);
    EXPECT_NEAR(*compareImages(a, b)->ssim, expected, 1e-9);
    EXPECT_FALSE(compareImages(filled(11, 10, {1, 1, 1}), filled(11, 10, {2, 2, 2}))->ssim);
    EXPECT_FALSE(compareImages(filled(10, 11, {1, 1, 1}), filled(10, 11, {2, 2, 2}))->ssim);
}

TEST(CompareImages, RoundsClampsAndComposesOverWhite) {
    Image a(3, 1, 3);
    a.at(0, 0, 0) = 100.4f / 255;
    a.at(1, 0, 0) = 1.7f;
    a.at(2, 0, 0) = std::numeric_limits<float>::quiet_NaN();
    Image b(3, 1, 4);
    for (int x = 0; x < 3; ++x) b.at(x, 0, 3) = 1;
    b.at(0, 0, 0) = 99.6f / 255;
    b.at(1, 0, 0) = 1;
    b.at(2, 0, 0) = -3;
    EXPECT_EQ(compareImages(a, b)->mae, 0);
    // Clear pixels are white, however dark.
    EXPECT_EQ(compareImages(Image(3, 1, 4), filled(3, 1, {255, 255, 255}))->mae, 0);
    EXPECT_EQ(compareImages(Image(3, 1, 4), filled(3, 1, {0, 0, 0}))->mae, 255);
}

TEST(CompareImages, RefusesDifferentSizes) {
    const Result<ImageDifference> result = compareImages(Image(3, 2, 3), Image(2, 3, 3));
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ErrorCode::Usage);
    EXPECT_FALSE(compareImages(Image(), Image()));
}

struct Reference {
    const char* a;
    const char* b;
    double mae, maeR, maeG, maeB, euclid, rmse, psnr, maeLuma, psnrLuma, ssim;
};

// From: measure.py A B (numpy, Pillow and scikit-image 0.19.3), five decimals.
constexpr Reference kReferences[] = {
    {"kodak/kodim01.png", "kodak/kodim03.png", 45.03404, 42.57796, 47.04494, 45.4792, 84.3237, 56.25785,
     13.12714, 41.66939, 13.80518, 0.20657},
    {"hard/rgba_soft.png", "kodak/kodim23.png", 56.20819, 52.53325, 52.4913, 63.60001, 99.08105, 86.24553,
     9.41607, 53.77024, 9.84848, 0.84014},
    {"hard/palette64.png", "hard/grey8.png", 16.59767, 23.87424, 11.79793, 14.12084, 31.71862, 24.12321,
     20.4821, 2.69929, 34.94862, 0.94847},
};

TEST(CompareImages, AgreesWithAnIndependentProgram) {
    const std::string folder = TESSERA_TEST_IMAGES;
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no test photographs at " << folder;
    for (const Reference& reference : kReferences) {
        const Result<LoadedImage> a = readImage(folder + "/" + reference.a);
        const Result<LoadedImage> b = readImage(folder + "/" + reference.b);
        ASSERT_TRUE(a && b) << reference.a;
        const Result<ImageDifference> d = compareImages(a->image, b->image);
        ASSERT_TRUE(d);
        constexpr double kRounding = .6e-5;
        EXPECT_NEAR(d->mae, reference.mae, kRounding) << reference.a;
        EXPECT_NEAR(d->maeChannel[0], reference.maeR, kRounding);
        EXPECT_NEAR(d->maeChannel[1], reference.maeG, kRounding);
        EXPECT_NEAR(d->maeChannel[2], reference.maeB, kRounding);
        EXPECT_NEAR(d->euclid, reference.euclid, kRounding);
        EXPECT_NEAR(d->rmse, reference.rmse, kRounding);
        EXPECT_NEAR(d->psnr, reference.psnr, kRounding);
        EXPECT_NEAR(d->maeLuma, reference.maeLuma, kRounding);
        EXPECT_NEAR(d->psnrLuma, reference.psnrLuma, kRounding);
        ASSERT_TRUE(d->ssim);
        EXPECT_NEAR(*d->ssim, reference.ssim, kRounding);
        withThreads(1, [&] { EXPECT_EQ(*compareImages(a->image, b->image)->ssim, *d->ssim); });
    }
}

}  // namespace
}  // namespace tessera
