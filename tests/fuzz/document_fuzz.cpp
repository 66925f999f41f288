// Any bytes as a document: an error, or a document that can be stored, and stored again to the same bytes.
#include <array>
#include <cstdlib>
#include <string>

#include "core/document/chunk_file.h"
#include "core/document/codec.h"
#include "core/mesh/mesh_validate.h"

namespace {

using namespace tessera;

// Decodes; what decodes must encode, and that must be stable.
void tryDocument(std::span<const uint8_t> bytes) {
    auto document = decodeDocument(bytes);
    if (!document) {
        if (document.error().code != ErrorCode::DamagedDocument || document.error().message.empty())
            std::abort();
        return;
    }
    validate(document->mesh);  // may find anything, but overflow nowhere
    const auto stored = encodeDocument(*document);
    if (!stored) std::abort();
    auto again = decodeDocument(*stored);
    if (!again) std::abort();
    const auto twice = encodeDocument(*again);
    if (!twice || *twice != *stored) std::abort();
}

}  // namespace

// A first byte that is even gives the rest to the reader as it is. Else the rest is cut into chunks (tag
// number, length in two bytes, content) under checksums that are right: no mutation would find those. The
// byte's next two bits are their version.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    if (size == 0) return 0;
    const std::span<const uint8_t> rest(data + 1, size - 1);
    if (data[0] % 2 == 0) {
        tryDocument(rest);
        return 0;
    }
    static const std::string kTags = "MESHGEOMCURVCOLRSETTREPTSRCEICCPEMBDPREVDIFFnew1ATTRBRKSSELSFITD";
    std::vector<Chunk> chunks;
    for (size_t at = 0; at + 3 <= rest.size();) {
        const size_t tag = rest[at] % (kTags.size() / 4) * 4;
        const size_t length =
            std::min<size_t>(rest[at + 1] | size_t(rest[at + 2]) << 8, rest.size() - at - 3);
        chunks.push_back({{kTags[tag], kTags[tag + 1], kTags[tag + 2], kTags[tag + 3]},
                          false,
                          rest.subspan(at + 3, length)});
        at += 3 + length;
    }
    constexpr std::array<uint32_t, 4> kVersions{1, kFormatVersion, 2, 3};
    tryDocument(packChunks(kVersions[data[0] >> 1 & 3], chunks));
    return 0;
}
