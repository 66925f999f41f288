// See jpeg_reference.h.
#include "core/image/jpeg_reference.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/image/image_compare.h"
#include "core/image/image_io.h"
#include "core/image/jpeg_errors.h"

namespace tessera {

namespace {

constexpr int kWorst = 1, kBest = 100;

struct Encoder {
    JpegErrors errors;
    jpeg_compress_struct jpeg{};
    unsigned char* bytes = nullptr;
    unsigned long size = 0;

    Encoder() = default;
    Encoder(const Encoder&) = delete;
    Encoder& operator=(const Encoder&) = delete;
    ~Encoder() {
        jpeg_destroy_compress(&jpeg);
        std::free(bytes);
    }
};

// Leaves its reason in encoder.errors. No object with a destructor may live in here.
void encode(Encoder& encoder, uint8_t* rgb, int width, int height, int quality) {
    jpeg_compress_struct& jpeg = encoder.jpeg;
    if (setjmp(encoder.errors.onFatal) != 0) return;
    jpeg_create_compress(&jpeg);
    jpeg_mem_dest(&jpeg, &encoder.bytes, &encoder.size);
    jpeg.image_width = JDIMENSION(width);
    jpeg.image_height = JDIMENSION(height);
    jpeg.input_components = 3;
    jpeg.in_color_space = JCS_RGB;
    jpeg_set_defaults(&jpeg);  // YCbCr, 4:2:0
    jpeg_set_quality(&jpeg, quality, TRUE);
    jpeg.optimize_coding = TRUE;
    jpeg_start_compress(&jpeg, TRUE);
    while (jpeg.next_scanline < jpeg.image_height) {
        JSAMPROW row = rgb + size_t(3) * size_t(width) * jpeg.next_scanline;
        jpeg_write_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_compress(&jpeg);
}

struct Point {
    double logBytes, psnr;
};

Result<Point> pointAt(const Image& image, int quality) {
    const auto bytes = encodeReferenceJpeg(image, quality);
    if (!bytes) return tl::unexpected(bytes.error());
    const auto read = readImage(*bytes, "reference.jpg");
    if (!read) return tl::unexpected(read.error());
    const auto difference = compareImages(image, read->image);
    if (!difference) return tl::unexpected(difference.error());
    return Point{std::log(double(bytes->size())), difference->psnr};
}

}  // namespace

Result<std::vector<uint8_t>> encodeReferenceJpeg(const Image& image, int quality) {
    if (image.empty() || image.channels() < 3 || std::max(image.width(), image.height()) > JPEG_MAX_DIMENSION)
        return failure(ErrorCode::Usage, "a JPEG has from 1 to 65500 pixels a side, in colour");
    if (quality < kWorst || quality > kBest)
        return failure(ErrorCode::Usage, "the quality of a JPEG is a number from 1 to 100");
    std::vector<uint8_t> rgb = rgb8OverWhite(image);
    Encoder encoder;
    encoder.errors.watch(encoder.jpeg);
    encode(encoder, rgb.data(), image.width(), image.height(), quality);
    if (!encoder.errors.defect.empty()) return failure(ErrorCode::Internal, encoder.errors.defect);
    return std::vector<uint8_t>(encoder.bytes, encoder.bytes + encoder.size);
}

Result<std::optional<double>> referenceJpegBytes(const Image& image, double psnr) {
    int low = kWorst, high = kBest;
    auto below = pointAt(image, low), above = pointAt(image, high);
    if (!below) return tl::unexpected(below.error());
    if (!above) return tl::unexpected(above.error());
    if (!(below->psnr <= psnr && psnr <= above->psnr)) return std::optional<double>();
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        const auto point = pointAt(image, middle);
        if (!point) return tl::unexpected(point.error());
        (point->psnr <= psnr ? low : high) = middle;
        (point->psnr <= psnr ? below : above) = point;
    }
    const double rise = above->psnr - below->psnr;
    const double share = rise > 0 && std::isfinite(rise) ? (psnr - below->psnr) / rise : 0;
    return std::exp(below->logBytes + share * (above->logBytes - below->logBytes));
}

}  // namespace tessera
