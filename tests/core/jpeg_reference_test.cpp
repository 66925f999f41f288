// The JPEG that documents are compared with: what is in it, and its bytes at a given error.
#include "core/image/jpeg_reference.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/image/image_compare.h"
#include "core/image/image_io.h"
#include "tests/support/painted_image.h"

namespace tessera {
namespace {

Image ripples() {
    return testing::paint(128, 96, 3, [](double x, double y, int c) {
        return .5 + .3 * std::sin(.01 * x * y + c) * std::cos(.3 * x) + .1 * std::sin(3 * x + 5 * y);
    });
}

struct File {
    double bytes, psnr;
};
File fileOf(const Image& image, int quality) {
    const auto bytes = encodeReferenceJpeg(image, quality);
    EXPECT_TRUE(bytes) << bytes.error().message;
    const auto read = readImage(*bytes, "a.jpg");
    EXPECT_TRUE(read) << read.error().message;
    return {double(bytes->size()), compareImages(image, read->image)->psnr};
}

TEST(JpegReference, HalvesColoursBothWays) {
    const auto bytes = encodeReferenceJpeg(ripples(), 80);
    ASSERT_TRUE(bytes);
    constexpr std::array<uint8_t, 2> kBaseline{0xFF, 0xC0};
    const auto frame = std::ranges::search(*bytes, kBaseline).begin();
    ASSERT_GT(bytes->end() - frame, 19);
    EXPECT_EQ(frame[9], 3);  // components: number, sampling factors, table
    EXPECT_EQ(frame[11], 0x22);
    EXPECT_EQ(frame[14], 0x11);
    EXPECT_EQ(frame[17], 0x11);
}

TEST(JpegReference, HasTablesOfItsOwn) {
    // The usual Huffman tables alone take 420 bytes.
    const Image flat = testing::paint(64, 64, 3, [](double, double, int) { return .4; });
    EXPECT_LT(fileOf(flat, 80).bytes, 400);
}

TEST(JpegReference, TakesTheBytesOfAQualityAtItsError) {
    const Image image = ripples();
    for (const int quality : {10, 50, 75, 90}) {
        const File file = fileOf(image, quality);
        const auto bytes = referenceJpegBytes(image, file.psnr);
        ASSERT_TRUE(bytes && *bytes);
        EXPECT_NEAR(**bytes, file.bytes, 1e-6 * file.bytes);
    }
}

TEST(JpegReference, InterpolatesLogBytesBetweenQualities) {
    const Image image = ripples();
    const File low = fileOf(image, 60), high = fileOf(image, 61);
    ASSERT_LT(low.psnr, high.psnr);
    const auto bytes = referenceJpegBytes(image, .25 * low.psnr + .75 * high.psnr);
    ASSERT_TRUE(bytes && *bytes);
    EXPECT_NEAR(std::log(**bytes), .25 * std::log(low.bytes) + .75 * std::log(high.bytes), 1e-9);
}

TEST(JpegReference, HasNoneBeyondTheQualities) {
    const Image image = ripples();
    for (const double psnr : {3.0, 90.0, HUGE_VAL, std::nan("")}) {
        const auto bytes = referenceJpegBytes(image, psnr);
        ASSERT_TRUE(bytes);
        EXPECT_FALSE(*bytes) << psnr;
    }
}

TEST(JpegReference, RefusesWhatIsNoJpeg) {
    const Image image = ripples();
    for (const int quality : {0, 101}) EXPECT_FALSE(encodeReferenceJpeg(image, quality));
    for (const Image& bad : {Image(), Image(65501, 1, 3)}) {
        const auto bytes = encodeReferenceJpeg(bad, 80);
        ASSERT_FALSE(bytes);
        EXPECT_EQ(bytes.error().code, ErrorCode::Usage);
        EXPECT_FALSE(referenceJpegBytes(bad, 30));
    }
}

}  // namespace
}  // namespace tessera
