// Reading small pictures that are put together byte by byte: kinds of samples, orientation, colour, damage.
#include "core/image/image_io.h"

#include <gtest/gtest.h>
#include <lcms2.h>
#include <sys/resource.h>

#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <numeric>

#include "core/base/sha256.h"
#include "tests/core/tiny_pictures.h"

namespace tessera {
namespace {

using test::append;
using test::Bytes;

Image imageOf(const Bytes& bytes) {
    const Result<LoadedImage> loaded = readImage(bytes, "folder/tiny.dat");
    EXPECT_TRUE(loaded) << loaded.error().message;
    return loaded ? loaded->image : Image(1, 1, 3, -99);
}

float byteAt(const Image& image, int x, int y, int c) {
    return image.at(x, y, c) * 255;
}

TEST(ReadImage, GreyBecomesThreeEqualChannels) {
    const Image image = imageOf(test::pngOf({.width = 2, .colorType = 0, .rows = {0, 10, 200}}));
    ASSERT_EQ(image.channels(), 3);
    for (int c = 0; c < 3; ++c) {
        EXPECT_FLOAT_EQ(byteAt(image, 0, 0, c), 10);
        EXPECT_FLOAT_EQ(byteAt(image, 1, 0, c), 200);
    }
}

TEST(ReadImage, DepthsOfPng) {
    const Image sixteen = imageOf(test::pngOf({.depth = 16, .rows = {0, 0x12, 0x34, 0xff, 0xff, 0, 1}}));
    EXPECT_FLOAT_EQ(sixteen.at(0, 0, 0), float(0x1234) / 65535);
    EXPECT_FLOAT_EQ(sixteen.at(0, 0, 1), 1);
    EXPECT_FLOAT_EQ(sixteen.at(0, 0, 2), 1.f / 65535);
    const Image two = imageOf(test::pngOf({.width = 4, .depth = 2, .colorType = 0, .rows = {0, 0x1b}}));
    for (int x = 0; x < 4; ++x) EXPECT_FLOAT_EQ(two.at(x, 0, 1), float(x) / 3);
}

TEST(ReadImage, PaletteWithTransparency) {
    test::PngRecipe recipe{.width = 3, .colorType = 3, .rows = {0, 0, 1, 2}};
    append(recipe.beforeData, test::pngChunk("PLTE", {10, 20, 30, 40, 50, 60, 200, 100, 0}));
    const Image opaque = imageOf(test::pngOf(recipe));
    ASSERT_EQ(opaque.channels(), 3);
    EXPECT_FLOAT_EQ(byteAt(opaque, 1, 0, 2), 60);
    append(recipe.beforeData, test::pngChunk("tRNS", {255, 255, 51}));
    const Image clear = imageOf(test::pngOf(recipe));
    ASSERT_EQ(clear.channels(), 4);
    EXPECT_FLOAT_EQ(clear.at(2, 0, 3), .2f);
    EXPECT_FLOAT_EQ(byteAt(clear, 2, 0, 0), 40);
}

TEST(ReadImage, AlphaIsKeptOnlyWhereItSaysSomething) {
    EXPECT_EQ(imageOf(test::pngOf({.width = 2, .colorType = 4, .rows = {0, 9, 255, 8, 255}})).channels(), 3);
    const Image soft = imageOf(test::pngOf({.width = 2, .colorType = 4, .rows = {0, 100, 255, 50, 51}}));
    ASSERT_EQ(soft.channels(), 4);
    for (int c = 0; c < 3; ++c) EXPECT_FLOAT_EQ(byteAt(soft, 1, 0, c), 10);
}

TEST(ReadImage, AssociatedAndUnassociatedTiffAgree) {
    const Image straight =
        imageOf(test::tiffOf({.width = 1, .channels = 4, .extraSample = 2, .samples = {200, 100, 50, 51}}));
    const Image multiplied =
        imageOf(test::tiffOf({.width = 1, .channels = 4, .extraSample = 1, .samples = {40, 20, 10, 51}}));
    ASSERT_EQ(straight.channels(), 4);
    ASSERT_EQ(multiplied.channels(), 4);
    for (int c = 0; c < 4; ++c) EXPECT_NEAR(straight.at(0, 0, c), multiplied.at(0, 0, c), 1e-6f);
    EXPECT_FLOAT_EQ(byteAt(straight, 0, 0, 0), 40);
}

// A picture of 5 x 5 shades in the seven passes of Adam7.
TEST(ReadImage, InterlacedPng) {
    constexpr std::array<std::array<int, 4>, 7> kPasses = {
        {{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4}, {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2}}};
    test::PngRecipe recipe{.width = 5, .height = 5, .colorType = 0, .interlace = 1};
    for (const auto& [x0, y0, dx, dy] : kPasses) {
        for (int y = y0; y < 5; y += dy) {
            if (x0 >= 5) continue;
            recipe.rows.push_back(0);
            for (int x = x0; x < 5; x += dx) recipe.rows.push_back(uint8_t(10 * y + x));
        }
    }
    const Image image = imageOf(test::pngOf(recipe));
    for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 5; ++x) EXPECT_FLOAT_EQ(byteAt(image, x, y, 0), float(10 * y + x));
}

// The stored picture is 1 2 3 / 4 5 6; how EXIF says that it shall be seen.
TEST(ReadImage, AllOrientations) {
    struct Case {
        int width, height;
        std::vector<int> seen;
    };
    const Case cases[] = {{3, 2, {1, 2, 3, 4, 5, 6}}, {3, 2, {3, 2, 1, 6, 5, 4}}, {3, 2, {6, 5, 4, 3, 2, 1}},
                          {3, 2, {4, 5, 6, 1, 2, 3}}, {2, 3, {1, 4, 2, 5, 3, 6}}, {2, 3, {4, 1, 5, 2, 6, 3}},
                          {2, 3, {6, 3, 5, 2, 4, 1}}, {2, 3, {3, 6, 2, 5, 1, 4}}};
    for (uint16_t orientation = 1; orientation <= 8; ++orientation) {
        const Case& expected = cases[orientation - 1];
        const Result<LoadedImage> loaded = readImage(test::tiffOf({.width = 3,
                                                                   .height = 2,
                                                                   .channels = 1,
                                                                   .photometric = 1,
                                                                   .orientation = orientation,
                                                                   .samples = {1, 2, 3, 4, 5, 6}}),
                                                     "turned.tif");
        ASSERT_TRUE(loaded) << loaded.error().message;
        EXPECT_EQ(loaded->source.width, expected.width);
        EXPECT_EQ(loaded->source.height, expected.height);
        std::vector<int> seen;
        for (const float value : loaded->image.plane(0)) seen.push_back(int(std::lround(value * 255)));
        EXPECT_EQ(seen, expected.seen) << "orientation " << orientation;
    }
}

TEST(ReadImage, CmykWithoutProfile) {
    const Image image = imageOf(test::tiffOf({.channels = 4, .photometric = 5, .samples = {0, 51, 255, 51}}));
    ASSERT_EQ(image.channels(), 3);
    EXPECT_NEAR(image.at(0, 0, 0), .8f, 1e-6f);
    EXPECT_NEAR(image.at(0, 0, 1), .64f, 1e-6f);
    EXPECT_NEAR(image.at(0, 0, 2), 0, 1e-6f);
}

Bytes saved(cmsHPROFILE profile) {
    cmsUInt32Number size = 0;
    EXPECT_TRUE(cmsSaveProfileToMem(profile, nullptr, &size));
    Bytes bytes(size);
    EXPECT_TRUE(cmsSaveProfileToMem(profile, bytes.data(), &size));
    cmsCloseProfile(profile);
    return bytes;
}

// Inks whose lightness falls evenly with black and with the mean of the others, without any colour.
Bytes cmykProfile() {
    cmsHPROFILE profile = cmsCreateProfilePlaceholder(nullptr);
    cmsSetProfileVersion(profile, 4.3);
    cmsSetDeviceClass(profile, cmsSigOutputClass);
    cmsSetColorSpace(profile, cmsSigCmykData);
    cmsSetPCS(profile, cmsSigLabData);
    cmsPipeline* pipeline = cmsPipelineAlloc(nullptr, 4, 3);
    cmsStage* table = cmsStageAllocCLut16bit(nullptr, 5, 4, 3, nullptr);
    const auto sample = [](const cmsUInt16Number in[], cmsUInt16Number out[], void*) -> cmsInt32Number {
        const double ink = (double(in[0]) + in[1] + in[2]) / 3 / 65535;
        const cmsCIELab lab = {100 * (1 - ink) * (1 - in[3] / 65535.), 0, 0};
        cmsFloat2LabEncoded(out, &lab);
        return 1;
    };
    EXPECT_TRUE(cmsStageSampleCLut16bit(table, sample, nullptr, 0));
    cmsPipelineInsertStage(pipeline, cmsAT_END, cmsStageAllocToneCurves(nullptr, 4, nullptr));
    cmsPipelineInsertStage(pipeline, cmsAT_END, table);
    cmsPipelineInsertStage(pipeline, cmsAT_END, cmsStageAllocToneCurves(nullptr, 3, nullptr));
    EXPECT_TRUE(cmsWriteTag(profile, cmsSigAToB0Tag, pipeline));
    EXPECT_TRUE(cmsWriteTag(profile, cmsSigAToB1Tag, pipeline));
    cmsPipelineFree(pipeline);
    return saved(profile);
}

// Half lightness is 118.9 of 255 in sRGB; the rule of thumb would have said 127.5.
TEST(ReadImage, CmykWithProfile) {
    const Bytes icc = cmykProfile();
    const Result<LoadedImage> loaded = readImage(
        test::tiffOf({.channels = 4, .photometric = 5, .icc = icc, .samples = {0, 0, 0, 128}}), "inks.tif");
    ASSERT_TRUE(loaded) << loaded.error().message;
    EXPECT_EQ(loaded->source.iccProfile, icc);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(byteAt(loaded->image, 0, 0, c), 118.4, 1);
}

// A photograph in inks with the same profile put into it: all colour must go, which the rule of thumb would
// keep.
TEST(ReadImage, CmykJpegWithProfile) {
    const std::string path = std::string(TESSERA_TEST_IMAGES) + "/hard/cmyk.jpg";
    std::ifstream file(path, std::ios::binary);
    if (!file) GTEST_SKIP() << "no test photograph at " << path;
    const Bytes plain{std::istreambuf_iterator<char>(file), {}};
    const Bytes icc = cmykProfile();
    Bytes segment = {0xff, 0xe2};
    const size_t length = 16 + icc.size();
    ASSERT_LT(length, 65536u);
    append(segment, Bytes{uint8_t(length >> 8), uint8_t(length)});
    append(segment, std::string_view("ICC_PROFILE\0\1\1", 14));
    append(segment, icc);
    Bytes tagged = plain;
    tagged.insert(tagged.begin() + 2, segment.begin(), segment.end());
    const Result<LoadedImage> loaded = readImage(tagged, "inks.jpg");
    ASSERT_TRUE(loaded) << loaded.error().message;
    EXPECT_EQ(loaded->source.iccProfile, icc);
    const Image colored = imageOf(plain);
    float chroma = 0;
    for (int x = 0; x < loaded->image.width(); ++x) {
        EXPECT_NEAR(loaded->image.at(x, 300, 0), loaded->image.at(x, 300, 2), 2e-3f);
        chroma = std::max(chroma, std::abs(colored.at(x, 300, 0) - colored.at(x, 300, 2)));
    }
    EXPECT_GT(chroma, .2f);
}

// Display P3's pure red, linear: (1.2249, -.0421, -.0196) by its published matrix.
TEST(ReadImage, WideGamutIsNotClipped) {
    const cmsCIExyY white = {.3127, .3290, 1};
    const cmsCIExyYTRIPLE primaries = {{.680, .320, 1}, {.265, .690, 1}, {.150, .060, 1}};
    cmsToneCurve* line = cmsBuildGamma(nullptr, 1);
    cmsToneCurve* curves[] = {line, line, line};
    const Bytes icc = saved(cmsCreateRGBProfile(&white, &primaries, curves));
    cmsFreeToneCurve(line);
    const Image image =
        imageOf(test::tiffOf({.width = 2, .icc = icc, .samples = {255, 0, 0, 255, 255, 255}}));
    EXPECT_NEAR(image.at(0, 0, 0), 1.0931f, 1e-3f);
    EXPECT_NEAR(image.at(0, 0, 1), -.2267f, 1e-3f);
    EXPECT_NEAR(image.at(0, 0, 2), -.1502f, 1e-3f);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(image.at(1, 0, c), 1, 1e-3f);
}

TEST(ReadImage, SrgbProfileChangesNothing) {
    Bytes samples(256 * 3);
    for (size_t i = 0; i < samples.size(); ++i) samples[i] = uint8_t(i / 3);
    const Image image =
        imageOf(test::tiffOf({.width = 256, .icc = saved(cmsCreate_sRGBProfile()), .samples = samples}));
    for (int x = 0; x < 256; ++x)
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(byteAt(image, x, 0, c), x, 1e-4);
}

TEST(ReadImage, GreyProfileAndUnfitProfile) {
    cmsToneCurve* line = cmsBuildGamma(nullptr, 1);
    const Bytes icc = saved(cmsCreateGrayProfile(cmsD50_xyY(), line));
    cmsFreeToneCurve(line);
    const Image grey = imageOf(test::tiffOf({.channels = 1, .photometric = 1, .icc = icc, .samples = {55}}));
    // 55 of 255 in linear light: sRGB 128.0
    EXPECT_NEAR(byteAt(grey, 0, 0, 1), 128.0, .3);
    EXPECT_EQ(grey.at(0, 0, 0), grey.at(0, 0, 1));
    EXPECT_EQ(grey.at(0, 0, 2), grey.at(0, 0, 1));
    EXPECT_FLOAT_EQ(byteAt(imageOf(test::tiffOf({.icc = icc, .samples = {1, 2, 3}})), 0, 0, 2), 3);
    EXPECT_FLOAT_EQ(byteAt(imageOf(test::tiffOf({.icc = {1, 2, 3}, .samples = {1, 2, 3}})), 0, 0, 2), 3);
}

TEST(ReadImage, GammaOfPng) {
    Bytes one;
    test::appendBig(one, 100000);
    const Image linear =
        imageOf(test::pngOf({.colorType = 0, .rows = {0, 55}, .beforeData = test::pngChunk("gAMA", one)}));
    EXPECT_NEAR(byteAt(linear, 0, 0, 0), 128.0, .3);
    Bytes usual;
    test::appendBig(usual, 45455);
    const Image plain =
        imageOf(test::pngOf({.colorType = 0, .rows = {0, 55}, .beforeData = test::pngChunk("gAMA", usual)}));
    EXPECT_FLOAT_EQ(byteAt(plain, 0, 0, 0), 55);
}

// A portable float map, one grey pixel a case, little-endian.
TEST(ReadImage, LinearFloatsAreEncodedOddSymmetrically) {
    const auto read = [](float value) {
        Bytes bytes;
        append(bytes, "PF\n1 1\n-1.0\n");
        for (int c = 0; c < 3; ++c) {
            uint32_t bits = 0;
            std::memcpy(&bits, &value, 4);
            test::appendLittle(bytes, bits, 4);
        }
        return imageOf(bytes).at(0, 0, 0);
    };
    EXPECT_NEAR(read(.5f), .735357f, 1e-5f);
    EXPECT_NEAR(read(-.5f), -.735357f, 1e-5f);
    EXPECT_NEAR(read(.001f), .01292f, 1e-6f);
    EXPECT_NEAR(read(4), 1.055 * std::pow(4, 1 / 2.4) - .055, 1e-5);
    EXPECT_EQ(read(std::numeric_limits<float>::quiet_NaN()), 0);
    EXPECT_EQ(read(-std::numeric_limits<float>::infinity()), 0);
}

TEST(ReadImage, DescribesItsSource) {
    const Bytes bytes = test::pngOf({.width = 2, .colorType = 0, .rows = {0, 10, 200}});
    const Result<LoadedImage> loaded = readImage(bytes, "some/folder/wrong.jpg");
    ASSERT_TRUE(loaded);
    EXPECT_EQ(loaded->source.fileName, "wrong.jpg");
    EXPECT_EQ(loaded->source.format, "png");
    EXPECT_EQ(loaded->source.byteSize, bytes.size());
    EXPECT_EQ(loaded->source.sha256, sha256Hex(bytes));
    EXPECT_EQ(loaded->source.bitsPerChannel, 8);
    EXPECT_TRUE(loaded->source.iccProfile.empty());
}

TEST(ReadImage, LimitOfPixels) {
    const Bytes bytes = test::pngOf({.width = 2, .colorType = 0, .rows = {0, 10, 200}});
    EXPECT_TRUE(readImage(bytes, "a", {.maxPixels = 2}));
    const Result<LoadedImage> refused = readImage(bytes, "a", {.maxPixels = 1});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::CannotRead);
    const Bytes tiff = test::tiffOf({.width = 30000, .height = 30000, .samples = {1, 2, 3}});
    EXPECT_NE(readImage(tiff, "a").error().message.find("30000 x 30000"), std::string::npos);
}

// Every beginning of a file fails, and every file with one byte changed is read or fails; all in silence,
// though libpng by itself would print.
TEST(ReadImage, CutOffAndChangedFilesFailSilently) {
    Bytes rows;
    for (int y = 0; y < 4; ++y) {
        rows.push_back(0);
        for (int x = 0; x < 15; ++x) rows.push_back(uint8_t(x * y));
    }
    const Bytes png = test::pngOf({.width = 5, .height = 4, .rows = rows});
    const Bytes tiff = test::tiffOf({.width = 2, .height = 1, .samples = {1, 2, 3, 4, 5, 6}});
    testing::internal::CaptureStderr();
    testing::internal::CaptureStdout();
    for (const Bytes& whole : {png, tiff}) {
        for (size_t size = 0; size < whole.size() - 4; ++size) {
            const Result<LoadedImage> cut =
                readImage(Bytes(whole.begin(), whole.begin() + ptrdiff_t(size)), "cut");
            ASSERT_FALSE(cut) << size << " of " << whole.size();
            EXPECT_EQ(cut.error().code, ErrorCode::CannotRead);
            EXPECT_NE(cut.error().message.find("\"cut\""), std::string::npos);
        }
        for (size_t i = 0; i < whole.size(); ++i) {
            Bytes changed = whole;
            changed[i] ^= 0x41;
            (void)readImage(changed, "changed", {.maxPixels = 10000});
        }
    }
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

// OpenEXR would take the 1.8 GB that this attribute claims.
TEST(ReadImage, ExrAttributeLongerThanItsFile) {
    Bytes bytes = {0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0};
    append(bytes, std::string_view("owner\0string\0", 13));
    test::appendLittle(bytes, 0x70000000, 4);
    bytes.resize(200, 'x');
    rusage before{};
    rusage after{};
    ::getrusage(RUSAGE_SELF, &before);
    EXPECT_FALSE(readImage(bytes, "claims.exr"));
    ::getrusage(RUSAGE_SELF, &after);
    EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 64 * 1024);
}

// Sound checksums around a stream that is wrong inside: what libpng would find only while decoding.
TEST(ReadImage, WrongStreamsFailSilently) {
    testing::internal::CaptureStderr();
    EXPECT_FALSE(readImage(test::pngOf({.width = 2, .colorType = 0, .rows = {0, 1}}), "short"));
    EXPECT_FALSE(readImage(test::pngOf({.colorType = 0, .rows = {9, 1}}), "filter"));
    EXPECT_FALSE(readImage(test::pngOf({.colorType = 3, .rows = {0, 0}}), "no palette"));
    EXPECT_FALSE(readImage(test::pngOf({.depth = 7, .rows = {0, 0, 0, 0}}), "depth"));
    EXPECT_TRUE(readImage(test::pngOf({.colorType = 0, .rows = {0, 1, 2, 3}}), "too long is harmless"));
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace tessera
