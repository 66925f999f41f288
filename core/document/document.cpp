// See document.h.
#include "core/document/document.h"

namespace tessera {

void Document::markEdited() {
    std::erase_if(unknownChunks, [](const UnknownChunk& chunk) { return !chunk.safeToCopy; });
    previewPng.reset();
    difference.reset();
}

}  // namespace tessera
