// The folder of difficult pictures: each one is read right or refused with a sentence that helps.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "core/base/parallel.h"
#include "core/image/image_compare.h"
#include "core/image/image_io.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

const std::string kFolder = std::string(TESSERA_TEST_IMAGES) + "/hard/";

class HardPictures : public testing::Test {
  protected:
    void SetUp() override {
        if (!fs::exists(kFolder)) GTEST_SKIP() << "no test photographs at " << kFolder;
    }
    static LoadedImage read(const std::string& name) {
        Result<LoadedImage> loaded = readImage(kFolder + name);
        EXPECT_TRUE(loaded) << loaded.error().message;
        return loaded ? std::move(*loaded) : LoadedImage{Image(1, 1, 3), {}};
    }
    static double meanDifference(const Image& a, const Image& b) {
        const Result<ImageDifference> difference = compareImages(a, b);
        EXPECT_TRUE(difference) << difference.error().message;
        return difference ? difference->mae : 1e9;
    }
};

struct Expected {
    const char* name;
    const char* format;
    int width, height, channels, bits;
    std::array<float, 4>
        middle;  // of 255, at (width / 2, height / 2), by Pillow where that reads the file alike
};

constexpr Expected kReadable[] = {
    {"1x1.png", "png", 1, 1, 3, 8, {166.00f, 169.00f, 135.00f}},
    {"1x100.png", "png", 1, 100, 3, 8, {125.00f, 156.00f, 83.00f}},
    {"3x3.png", "png", 3, 3, 3, 8, {176.00f, 176.00f, 145.00f}},
    {"checker1px.png", "png", 256, 256, 3, 8, {0.00f, 0.00f, 0.00f}},
    {"cmyk.jpg", "jpeg", 768, 512, 3, 8, {105.00f, 133.00f, 63.00f}},
    {"constant.png", "png", 64, 48, 3, 8, {120.00f, 60.00f, 30.00f}},
    {"exif_orient6.jpg", "jpeg", 512, 768, 3, 8, {87.00f, 62.00f, 55.00f}},
    {"gradient.png", "png", 512, 256, 3, 8, {127.00f, 127.00f, 128.00f}},
    {"grey16.png", "png", 510, 532, 3, 16, {72.43f, 72.43f, 72.43f}},
    {"grey8.png", "png", 768, 512, 3, 8, {73.00f, 73.00f, 73.00f}},
    {"palette64.png", "png", 768, 512, 3, 8, {92.00f, 74.00f, 59.00f}},
    {"rgba_soft.png", "png", 768, 512, 4, 8, {105.00f, 132.00f, 63.00f, 255.00f}},
    {"rgb16.png", "png", 510, 532, 3, 16, {128.00f, 51.00f, 121.00f}},
};

TEST_F(HardPictures, EachIsReadRight) {
    for (const Expected& expected : kReadable) {
        SCOPED_TRACE(expected.name);
        const LoadedImage loaded = read(expected.name);
        const Image& image = loaded.image;
        EXPECT_EQ(loaded.source.format, expected.format);
        EXPECT_EQ(loaded.source.bitsPerChannel, expected.bits);
        EXPECT_EQ(loaded.source.byteSize, fs::file_size(kFolder + expected.name));
        ASSERT_EQ(image.width(), expected.width);
        ASSERT_EQ(image.height(), expected.height);
        ASSERT_EQ(image.channels(), expected.channels);
        for (int c = 0; c < image.channels(); ++c)
            EXPECT_NEAR(image.at(image.width() / 2, image.height() / 2, c) * 255, expected.middle[size_t(c)],
                        .6)
                << "channel " << c;
    }
}

// The rotated file holds kodim15 or kodim23 turned; upright again it must look like one of them.
TEST_F(HardPictures, OrientationSixIsTurnedClockwise) {
    const Image turned = read("exif_orient6.jpg").image;
    const std::string stored = kFolder + "exif_orient6.jpg";
    std::ifstream file(stored, std::ios::binary);
    std::vector<uint8_t> bytes{std::istreambuf_iterator<char>(file), {}};
    // The same file with another name of its EXIF segment is the picture as stored.
    const std::string_view mark = "Exif";
    const auto found = std::search(bytes.begin(), bytes.end(), mark.begin(), mark.end());
    ASSERT_NE(found, bytes.end());
    *found = 'X';
    const Result<LoadedImage> plain = readImage(bytes, "stored.jpg");
    ASSERT_TRUE(plain) << plain.error().message;
    ASSERT_EQ(plain->image.width(), turned.height());
    for (int y = 0; y < plain->image.height(); y += 7)
        for (int x = 0; x < plain->image.width(); x += 5)
            ASSERT_EQ(turned.at(turned.width() - 1 - y, x, 1), plain->image.at(x, y, 1));
}

TEST_F(HardPictures, CmykJpegIsNotInverted) {
    const Image original = readImage(std::string(TESSERA_TEST_IMAGES) + "/kodak/kodim23.png")->image;
    const Image other = readImage(std::string(TESSERA_TEST_IMAGES) + "/kodak/kodim15.png")->image;
    const Image cmyk = read("cmyk.jpg").image;
    EXPECT_LT(std::min(meanDifference(cmyk, original), meanDifference(cmyk, other)), 4);
}

TEST_F(HardPictures, WideGamutKeepsItsOverflow) {
    const LoadedImage ring = read("icc_p3_ring.png");
    EXPECT_EQ(ring.source.iccProfile.size(), 500u);
    const auto [low, high] = std::ranges::minmax(ring.image.plane(0));
    EXPECT_LT(low, -.4f);
    EXPECT_GT(high, 1.05f);
}

TEST_F(HardPictures, HighDynamicRangeIsKept) {
    const LoadedImage hdr = read("hdr.exr");
    EXPECT_GT(std::ranges::max(hdr.image.plane(0)), 2.f);
}

TEST_F(HardPictures, UnreadableOnesSayWhy) {
    struct Case {
        const char* name;
        const char* part;
    };
    const Case cases[] = {{"empty.png", "empty"},
                          {"not_an_image.png", "claims"},
                          {"truncated.jpg", "cut off"},
                          {"huge_header.png", "100000 x 100000"},
                          {"missing.png", "check the name"},
                          {"", "folder"}};
    testing::internal::CaptureStderr();
    for (const Case& c : cases) {
        const Result<LoadedImage> result = readImage(kFolder + c.name);
        ASSERT_FALSE(result) << c.name;
        EXPECT_EQ(result.error().code, ErrorCode::CannotRead);
        EXPECT_NE(result.error().message.find(kFolder + c.name), std::string::npos);
        EXPECT_NE(result.error().message.find(c.part), std::string::npos) << result.error().message;
        EXPECT_NE(result.error().message.find("; "), std::string::npos) << result.error().message;
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(HardPictures, HugeHeaderTakesNoMemory) {
    rusage before{};
    rusage after{};
    ASSERT_FALSE(readImage(kFolder + "not_an_image.png"));  // whatever is set up once
    ::getrusage(RUSAGE_SELF, &before);
    ASSERT_FALSE(readImage(kFolder + "huge_header.png"));
    ::getrusage(RUSAGE_SELF, &after);
    constexpr long kKilobytes = 16 * 1024;
    EXPECT_LT(after.ru_maxrss - before.ru_maxrss, kKilobytes);
}

TEST_F(HardPictures, EveryTruncatedJpegFails) {
    std::ifstream file(kFolder + "exif_orient6.jpg", std::ios::binary);
    const std::vector<uint8_t> whole{std::istreambuf_iterator<char>(file), {}};
    for (size_t size = 0; size + 2 < whole.size(); size += 6007) {
        const std::vector<uint8_t> cut(whole.begin(), whole.begin() + ptrdiff_t(size));
        EXPECT_FALSE(readImage(cut, "cut.jpg")) << size;
    }
    EXPECT_FALSE(readImage(std::vector<uint8_t>(whole.begin(), whole.end() - 2), "cut.jpg"));
    std::ifstream inks(kFolder + "cmyk.jpg", std::ios::binary);
    const std::vector<uint8_t> cmyk{std::istreambuf_iterator<char>(inks), {}};
    EXPECT_FALSE(readImage(std::vector<uint8_t>(cmyk.begin(), cmyk.begin() + 100000), "cut.jpg"));
}

TEST_F(HardPictures, ThreadsDoNotMatter) {
    const Image many = read("icc_p3_ring.png").image;
    withThreads(1, [&] { EXPECT_EQ(read("icc_p3_ring.png").image, many); });
}

TEST_F(HardPictures, WithoutPermissionToRead) {
    if (::geteuid() == 0) GTEST_SKIP() << "root may read everything";
    const fs::path path = fs::path(testing::TempDir()) / ("tessera-locked-" + std::to_string(::getpid()));
    fs::copy_file(kFolder + "1x1.png", path);
    fs::permissions(path, fs::perms::none);
    const Result<LoadedImage> result = readImage(path.string());
    fs::remove(path);
    ASSERT_FALSE(result);
    EXPECT_NE(result.error().message.find("permission"), std::string::npos);
}

}  // namespace
}  // namespace tessera
