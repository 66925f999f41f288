// See cmyk_jpeg.h.
#include "core/image/cmyk_jpeg.h"

#include "core/image/jpeg_errors.h"

namespace tessera {

namespace {

struct Decoder {
    JpegErrors errors;
    jpeg_decompress_struct jpeg{};
    CmykPixels pixels;

    Decoder() = default;
    Decoder(const Decoder&) = delete;
    Decoder& operator=(const Decoder&) = delete;
    ~Decoder() { jpeg_destroy_decompress(&jpeg); }
};

void onMessage(j_common_ptr jpeg, int level) {
    if (level >= 0) return;
    std::string& defect = JpegErrors::of(jpeg).defect;
    const std::string message = JpegErrors::messageOf(jpeg);
    if (defect.empty() && !isHarmlessJpegWarning(message)) defect = message;
}

// Leaves its reason in decoder.errors. No object with a destructor may live in here.
void decode(Decoder& decoder, std::span<const uint8_t> bytes) {
    jpeg_decompress_struct& jpeg = decoder.jpeg;
    if (setjmp(decoder.errors.onFatal) != 0) return;
    jpeg_create_decompress(&jpeg);
    jpeg_mem_src(&jpeg, bytes.data(), static_cast<unsigned long>(bytes.size()));
    jpeg_read_header(&jpeg, TRUE);
    jpeg.out_color_space = JCS_CMYK;
    jpeg_start_decompress(&jpeg);
    const size_t rowBytes = size_t(jpeg.output_width) * 4;
    decoder.pixels.width = int(jpeg.output_width);
    decoder.pixels.height = int(jpeg.output_height);
    decoder.pixels.ink.resize(rowBytes * jpeg.output_height);
    while (jpeg.output_scanline < jpeg.output_height) {
        JSAMPROW row = decoder.pixels.ink.data() + rowBytes * jpeg.output_scanline;
        jpeg_read_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_decompress(&jpeg);
}

}  // namespace

bool isHarmlessJpegWarning(const std::string& message) {
    return message.find("extraneous bytes before marker") != std::string::npos ||
           message.find("Invalid SOS parameters for sequential JPEG") != std::string::npos;
}

Result<CmykPixels> readCmykJpeg(std::span<const uint8_t> bytes) {
    Decoder decoder;
    decoder.errors.watch(decoder.jpeg);
    decoder.errors.manager.emit_message = onMessage;
    decode(decoder, bytes);
    if (!decoder.errors.defect.empty()) return failure(ErrorCode::CannotRead, decoder.errors.defect);
    // Adobe's programs store the amount of paper left, and say so by their marker.
    if (decoder.jpeg.saw_Adobe_marker)
        for (uint8_t& ink : decoder.pixels.ink) ink = uint8_t(255 - ink);
    return std::move(decoder.pixels);
}

}  // namespace tessera
