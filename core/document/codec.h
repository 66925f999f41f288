// Documents to and from bytes and files. The format is specified in FORMAT.md beside this file.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/document/document.h"
#include "core/document/format_version.h"

namespace tessera {

struct ChunkSize {
    std::string tag;
    uint64_t bytes = 0;  // as stored, header included
};

// Sets `document.colourStep` where it is missing. The mesh may have deleted elements: they are left out, so
// ids are dense after decoding. encode(decode(encode(d))) is encode(d).
Result<std::vector<uint8_t>> encodeDocument(Document& document);

// Fails with DamagedDocument and a sentence that names the chunk and the offset; never reads past the bytes,
// never takes more memory than their number warrants. What it returns passes validate()'s connectivity,
// border and size checks (certificates are `validate`'s).
Result<Document> decodeDocument(std::span<const uint8_t> bytes);

// The sizes of a document's chunks, in file order.
Result<std::vector<ChunkSize>> chunkSizes(std::span<const uint8_t> bytes);

// The PNG of a document's preview, empty where it has none. Decodes nothing else.
Result<std::vector<uint8_t>> readPreview(std::span<const uint8_t> bytes);

// Whether bytes begin like a document.
bool looksLikeDocument(std::span<const uint8_t> bytes);

// encodeDocument to a temporary file beside `path`, synced and renamed: the file is the old one or the new
// one.
Result<void> saveDocument(Document& document, const std::string& path);
// decodeDocument of a file's bytes; messages name the file.
Result<Document> decodeFile(std::span<const uint8_t> bytes, const std::string& path);
// CannotRead where the file cannot be read, DamagedDocument where it is no sound document; messages name the
// file.
Result<Document> loadDocument(const std::string& path);

}  // namespace tessera
