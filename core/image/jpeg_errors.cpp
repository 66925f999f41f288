// See jpeg_errors.h.
#include "core/image/jpeg_errors.h"

#include <array>

namespace tessera {

std::string JpegErrors::messageOf(j_common_ptr jpeg) {
    std::array<char, JMSG_LENGTH_MAX> text{};
    jpeg->err->format_message(jpeg, text.data());
    return text.data();
}

void JpegErrors::giveUp(j_common_ptr jpeg) {
    JpegErrors& errors = of(jpeg);
    errors.defect = messageOf(jpeg);
    std::longjmp(errors.onFatal, 1);
}

}  // namespace tessera
