// What the first bytes of a file say about the picture in it, found before any decoder is let near them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tessera {

struct ImageProbe {
    std::string format;  // OpenImageIO's name; empty where the bytes are no picture that we know
    // As the header claims; 0 where it is left to the decoder, which for these formats takes no memory to
    // find out.
    uint64_t width = 0;
    uint64_t height = 0;
    int jpegComponents = 0;
    // False where the header claims parts that the file is too short for.
    bool sound = true;
    // From containers that OpenImageIO does not look into; 0 and empty where there is none.
    int orientation = 0;
    std::vector<uint8_t> iccProfile;
};

// Never fails and never takes memory by what the header claims.
ImageProbe probeImage(std::span<const uint8_t> bytes);

// Why a file that claims to be a PNG is not a whole and sound one, as the end of a sentence; empty if it is.
// libpng, as OpenImageIO drives it, prints its fatal errors to stderr, and reads on past a missing end: so
// what would stop it (structure, checksums, the compressed stream) is found here first.
std::string pngDefect(std::span<const uint8_t> bytes);

}  // namespace tessera
