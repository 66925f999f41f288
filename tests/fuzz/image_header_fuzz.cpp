// Any bytes at all as a picture: they are read, or refused with a reason, within limits.
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "core/image/image_io.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    constexpr tessera::ReadLimits kLimits{.maxPixels = 1 << 16};
    const std::vector<uint8_t> bytes(data, data + size);
    const tessera::Result<tessera::LoadedImage> loaded = tessera::readImage(bytes, "fuzz", kLimits);
    if (!loaded) {
        if (loaded.error().code != tessera::ErrorCode::CannotRead || loaded.error().message.empty())
            std::abort();
        return 0;
    }
    if (loaded->image.empty() || loaded->image.planeSize() > kLimits.maxPixels) std::abort();
    for (int c = 0; c < loaded->image.channels(); ++c)
        for (const float value : loaded->image.plane(c))
            if (!(value - value == 0)) std::abort();  // neither NaN nor infinite
    return 0;
}
