// What libjpeg reports, for its callers in this folder.
#pragma once

#include <csetjmp>
#include <cstdio>
#include <string>
// After cstdio, which it needs but does not include.
#include <jpeglib.h>

namespace tessera {

// Lives, with all that must outlive a longjmp out of libjpeg, outside the function that calls
// setjmp(onFatal); no object with a destructor may live in that one.
struct JpegErrors {
    jpeg_error_mgr manager{};
    std::jmp_buf onFatal;
    std::string defect;  // why libjpeg gave up; empty where it did not

    JpegErrors() = default;
    JpegErrors(const JpegErrors&) = delete;
    JpegErrors& operator=(const JpegErrors&) = delete;

    // Of a jpeg_compress_struct or a jpeg_decompress_struct before it is created; fatal errors go to onFatal
    // from then on.
    template <class Jpeg>
    void watch(Jpeg& jpeg) {
        jpeg.err = jpeg_std_error(&manager);
        jpeg.client_data = this;
        manager.error_exit = giveUp;
    }
    static JpegErrors& of(j_common_ptr jpeg) { return *static_cast<JpegErrors*>(jpeg->client_data); }
    // What it is about to say.
    static std::string messageOf(j_common_ptr jpeg);

  private:
    static void giveUp(j_common_ptr jpeg);
};

}  // namespace tessera
