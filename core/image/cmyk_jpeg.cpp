// See cmyk_jpeg.h.
#include "core/image/cmyk_jpeg.h"

#include <array>
#include <csetjmp>
#include <cstdio>
// After cstdio, which it needs but does not include.
#include <jpeglib.h>

namespace tessera {

namespace {

// Everything that must outlive a longjmp out of libjpeg lives here, outside the function that it returns to.
struct Decoder {
    jpeg_error_mgr errors{};
    jpeg_decompress_struct jpeg{};
    std::jmp_buf onError;
    std::string defect;
    CmykPixels pixels;

    Decoder() = default;
    Decoder(const Decoder&) = delete;
    Decoder& operator=(const Decoder&) = delete;
    ~Decoder() { jpeg_destroy_decompress(&jpeg); }
};

std::string messageOf(j_common_ptr jpeg) {
    std::array<char, JMSG_LENGTH_MAX> text{};
    jpeg->err->format_message(jpeg, text.data());
    return text.data();
}

void onFatal(j_common_ptr jpeg) {
    auto* decoder = static_cast<Decoder*>(jpeg->client_data);
    decoder->defect = messageOf(jpeg);
    std::longjmp(decoder->onError, 1);
}

void onMessage(j_common_ptr jpeg, int level) {
    if (level >= 0) return;
    auto* decoder = static_cast<Decoder*>(jpeg->client_data);
    const std::string message = messageOf(jpeg);
    if (decoder->defect.empty() && !isHarmlessJpegWarning(message)) decoder->defect = message;
}

// Leaves its reason in decoder.defect. No object with a destructor may live in here.
void decode(Decoder& decoder, std::span<const uint8_t> bytes) {
    jpeg_decompress_struct& jpeg = decoder.jpeg;
    if (setjmp(decoder.onError) != 0) return;
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
    decoder.jpeg.err = jpeg_std_error(&decoder.errors);
    decoder.jpeg.client_data = &decoder;
    decoder.errors.error_exit = onFatal;
    decoder.errors.emit_message = onMessage;
    decode(decoder, bytes);
    if (!decoder.defect.empty()) return failure(ErrorCode::CannotRead, decoder.defect);
    // Adobe's programs store the amount of paper left, and say so by their marker.
    if (decoder.jpeg.saw_Adobe_marker)
        for (uint8_t& ink : decoder.pixels.ink) ink = uint8_t(255 - ink);
    return std::move(decoder.pixels);
}

}  // namespace tessera
