// Pictures written and read again.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>

#include "core/image/color_management.h"
#include "core/image/image_io.h"
#include "tests/support/temporary_folder.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

class ImageWrite : public tessera::testing::TemporaryFolderTest {
  protected:
    Image writtenAndRead(const Image& image, const std::string& name,
                         const WriteOptions& options = {}) const {
        const Result<void> written = writeImage(image, at(name), options);
        EXPECT_TRUE(written) << written.error().message;
        const Result<LoadedImage> loaded = readImage(at(name));
        EXPECT_TRUE(loaded) << loaded.error().message;
        return loaded ? loaded->image : Image();
    }
};

// Values that `levels` steps can hold, all different from plane to plane.
Image picture(int width, int height, int channels, float levels) {
    Image image(width, height, channels);
    uint32_t state = 1;
    for (int c = 0; c < 3; ++c) {
        for (float& value : image.plane(c)) {
            state = state * 1664525u + 1013904223u;
            value = std::floor(float(state >> 8) / 16777216.f * (levels + 1)) / levels;
        }
    }
    if (channels == 4) {
        for (size_t i = 0; i < image.planeSize(); ++i) {
            const float alpha = float(i % 4) / 3;
            image.plane(3)[i] = alpha;
            for (int c = 0; c < 3; ++c) image.plane(c)[i] *= alpha;
        }
    }
    return image;
}

void expectNear(const Image& a, const Image& b, float tolerance) {
    ASSERT_EQ(a.width(), b.width());
    ASSERT_EQ(a.height(), b.height());
    ASSERT_EQ(a.channels(), b.channels());
    for (int c = 0; c < a.channels(); ++c)
        for (size_t i = 0; i < a.planeSize(); ++i)
            ASSERT_NEAR(a.plane(c)[i], b.plane(c)[i], tolerance) << "plane " << c << " at " << i;
}

TEST_F(ImageWrite, PngIsExact) {
    for (const int bits : {8, 16}) {
        const Image image = picture(37, 23, 3, bits == 8 ? 255 : 65535);
        expectNear(writtenAndRead(image, "a.png", {.bitsPerChannel = bits}), image, 1e-7f);
        EXPECT_EQ(readImage(at("a.png"))->source.bitsPerChannel, bits);
    }
}

TEST_F(ImageWrite, PngKeepsSoftAlpha) {
    const Image image = picture(9, 8, 4, 255);
    expectNear(writtenAndRead(image, "a.png", {.bitsPerChannel = 16}), image, 1.f / 65535);
    expectNear(writtenAndRead(image, "b.png"), image, 1.f / 255);
}

// TIFF names its colour space by a profile, which is recognized as sRGB's.
TEST_F(ImageWrite, TiffIsExact) {
    for (const int bits : {8, 16}) {
        const Image image = picture(37, 23, 3, bits == 8 ? 255 : 65535);
        expectNear(writtenAndRead(image, "a.tif", {.bitsPerChannel = bits}), image, 1e-7f);
        EXPECT_FALSE(readImage(at("a.tif"))->source.iccProfile.empty());
    }
    const Image soft = picture(9, 8, 4, 255);
    expectNear(writtenAndRead(soft, "b.tiff", {.bitsPerChannel = 16}), soft, 1.f / 65535);
}

TEST_F(ImageWrite, ExrKeepsWhatLiesOutsideTheRange) {
    Image image = picture(37, 23, 3, 255);
    image.at(3, 4, 0) = 3.5f;
    image.at(4, 4, 1) = -.25f;
    const Image read = writtenAndRead(image, "a.exr");
    expectNear(read, image, 2e-3f);
    EXPECT_NEAR(read.at(3, 4, 0), 3.5f, 2e-3f);
    EXPECT_NEAR(read.at(4, 4, 1), -.25f, 2e-3f);
    expectNear(writtenAndRead(picture(9, 8, 4, 255), "b.exr"), picture(9, 8, 4, 255), 2e-3f);
}

TEST_F(ImageWrite, JpegComposesOverWhite) {
    Image image(16, 16, 4);
    for (size_t i = 0; i < image.planeSize(); ++i) {
        image.plane(0)[i] = .25f;
        image.plane(3)[i] = .5f;
    }
    const Image read = writtenAndRead(image, "a.jpg");
    ASSERT_EQ(read.channels(), 3);
    EXPECT_NEAR(read.at(8, 8, 0), .75f, .012f);
    EXPECT_NEAR(read.at(8, 8, 1), .5f, .012f);
}

TEST_F(ImageWrite, ComposesOverABackground) {
    Image image(16, 16, 4);
    for (size_t i = 0; i < image.planeSize(); ++i) {
        image.plane(0)[i] = .25f;
        image.plane(3)[i] = .5f;
    }
    const WriteOptions options{.background = std::array{.2f, .4f, 1.f}};
    for (const char* name : {"a.png", "a.tif", "a.exr", "a.jpg"}) {
        const Image read = writtenAndRead(image, name, options);
        ASSERT_EQ(read.channels(), 3) << name;
        EXPECT_NEAR(read.at(8, 8, 0), .35f, .012f) << name;
        EXPECT_NEAR(read.at(8, 8, 1), .2f, .012f) << name;
        EXPECT_NEAR(read.at(8, 8, 2), .5f, .012f) << name;
    }
}

TEST_F(ImageWrite, EmbedsAProfileWhereItIsWanted) {
    const Image image = picture(9, 8, 3, 255);
    for (const char* name : {"a.png", "a.tif", "a.jpg"})
        for (const bool embed : {false, true}) {
            ASSERT_TRUE(writeImage(image, at(name), {.embedProfile = embed}));
            EXPECT_EQ(!readImage(at(name))->source.iccProfile.empty(), embed) << name;
        }
}

// A profile that swaps red and blue, as far as its tags go: whoever honours it sees the picture as it was.
TEST_F(ImageWrite, ConvertsToAProfile) {
    std::vector<uint8_t> icc = srgbProfile();
    const auto find = [&](std::string_view tag) {
        return std::search(icc.begin() + 128, icc.end(), tag.begin(), tag.end());
    };
    const auto red = find("rXYZ"), blue = find("bXYZ");
    ASSERT_TRUE(red != icc.end() && blue != icc.end());
    std::swap_ranges(red, red + 4, blue);
    const Image image = picture(20, 10, 4, 255);
    for (const char* name : {"a.png", "a.tif"}) {
        const WriteOptions options{.bitsPerChannel = 16, .iccProfile = icc};
        expectNear(writtenAndRead(image, name, options), image, .001f);
        EXPECT_EQ(readImage(at(name))->source.iccProfile, icc);
        ASSERT_TRUE(
            writeImage(image, at(name), {.bitsPerChannel = 16, .embedProfile = false, .iccProfile = icc}));
        const Image bare = readImage(at(name))->image;
        EXPECT_NEAR(bare.at(7, 3, 0), image.at(7, 3, 2), .001f) << name;
        EXPECT_NEAR(bare.at(7, 3, 2), image.at(7, 3, 0), .001f) << name;
    }
    const WriteOptions rubbish{.iccProfile = {1, 2, 3}};
    expectNear(writtenAndRead(image, "b.png", rubbish), image, 1.f / 255);
}

TEST_F(ImageWrite, StopsBetweenRowsAndLeavesNothing) {
    const Image image = picture(300, 300, 3, 255);
    std::stop_source stop;
    int reports = 0;
    Progress progress(stop.get_token(), [&](std::string_view, double, double) { ++reports; });
    progress.beginStage("writing", 1);
    ASSERT_TRUE(writeImage(image, at("a.png"), {}, &progress));
    EXPECT_GT(reports, 0);
    fs::remove(at("a.png"));
    stop.request_stop();
    for (const char* name : {"a.png", "a.tif", "a.exr", "a.jpg"}) {
        const Result<void> written = writeImage(image, at(name), {}, &progress);
        ASSERT_FALSE(written) << name;
        EXPECT_EQ(written.error().code, ErrorCode::Stopped) << name;
    }
    EXPECT_TRUE(fs::is_empty(mFolder));
}

TEST_F(ImageWrite, ClampsAndSurvivesNan) {
    Image image(3, 1, 3);
    image.at(0, 0, 0) = 2;
    image.at(1, 0, 0) = -2;
    image.at(2, 0, 0) = std::numeric_limits<float>::quiet_NaN();
    const Image read = writtenAndRead(image, "a.png");
    EXPECT_EQ(read.at(0, 0, 0), 1);
    EXPECT_EQ(read.at(1, 0, 0), 0);
    EXPECT_EQ(read.at(2, 0, 0), 0);
}

TEST_F(ImageWrite, SamePictureGivesTheSameBytes) {
    const Image image = picture(20, 20, 3, 255);
    for (const char* name : {"a.png", "a.jpg", "a.tif", "a.exr"}) {
        ASSERT_TRUE(writeImage(image, at(name)));
        const std::string first = contentOf(name);
        ::usleep(1'100'000);  // a clock with seconds must have moved
        ASSERT_TRUE(writeImage(image, at(name)));
        EXPECT_EQ(contentOf(name), first) << name;
    }
}

TEST_F(ImageWrite, EncodePngIsWhatWriteImageWrites) {
    const Image image = picture(20, 10, 4, 255);
    ASSERT_TRUE(writeImage(image, at("a.png"), {.embedProfile = false}));
    const Result<std::vector<uint8_t>> bytes = encodePng(image);
    ASSERT_TRUE(bytes) << bytes.error().message;
    EXPECT_EQ(std::string(bytes->begin(), bytes->end()), contentOf("a.png"));
}

TEST_F(ImageWrite, FailuresNameTheFileAndLeaveNothing) {
    const Image image = picture(4, 4, 3, 255);
    const Result<void> noFolder = writeImage(image, at("no/folder/a.png"));
    ASSERT_FALSE(noFolder);
    EXPECT_EQ(noFolder.error().code, ErrorCode::CannotWrite);
    EXPECT_NE(noFolder.error().message.find("no/folder/a.png"), std::string::npos);
    EXPECT_EQ(writeImage(Image(), at("a.png")).error().code, ErrorCode::CannotWrite);
    EXPECT_EQ(writeImage(image, at("a.png"), {.bitsPerChannel = 12}).error().code, ErrorCode::CannotWrite);
    EXPECT_EQ(writeImage(image, at("a.jpg"), {.jpegQuality = 0}).error().code, ErrorCode::CannotWrite);
    EXPECT_EQ(writeImage(image, at("a.gif")).error().code, ErrorCode::Usage);
    EXPECT_FALSE(encodePng(Image()));
    EXPECT_TRUE(fs::is_empty(mFolder));
}

TEST(PictureFormatFor, Suffixes) {
    EXPECT_EQ(*pictureFormatFor("x/a.b.PNG"), PictureFormat::Png);
    EXPECT_EQ(*pictureFormatFor("a.jpeg"), PictureFormat::Jpeg);
    EXPECT_EQ(*pictureFormatFor("a.tiff"), PictureFormat::Tiff);
    EXPECT_EQ(*pictureFormatFor("a.exr"), PictureFormat::Exr);
    EXPECT_EQ(pictureFormatFor("png").error().code, ErrorCode::Usage);
    EXPECT_EQ(pictureFormatFor("a.webp").error().code, ErrorCode::Usage);
}

}  // namespace
}  // namespace tessera
