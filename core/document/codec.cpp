// See codec.h.
#include "core/document/codec.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/base/atomic_file.h"
#include "core/document/chunk_file.h"
#include "core/document/edit_codec.h"
#include "core/document/info_codec.h"
#include "core/document/mesh_codec.h"

namespace tessera {

namespace {

constexpr ChunkTag kConnectivity{'M', 'E', 'S', 'H'}, kGeometry{'G', 'E', 'O', 'M'},
    kCurves{'C', 'U', 'R', 'V'}, kColours{'C', 'O', 'L', 'R'}, kSettings{'S', 'E', 'T', 'T'},
    kReport{'R', 'E', 'P', 'T'}, kSource{'S', 'R', 'C', 'E'}, kProfile{'I', 'C', 'C', 'P'},
    kEmbedded{'E', 'M', 'B', 'D'}, kPreview{'P', 'R', 'E', 'V'}, kDifference{'D', 'I', 'F', 'F'},
    kAttributes{'A', 'T', 'T', 'R'}, kBreaks{'B', 'R', 'K', 'S'}, kSelections{'S', 'E', 'L', 'S'},
    kFitted{'F', 'I', 'T', 'D'};
constexpr std::array kKnownTags{kConnectivity, kGeometry,   kCurves,  kColours,    kSettings,
                                kReport,       kSource,     kProfile, kEmbedded,   kPreview,
                                kDifference,   kAttributes, kBreaks,  kSelections, kFitted};

tl::unexpected<Error> damagedChunk(const Chunk& chunk, const std::string& what) {
    return failure(ErrorCode::DamagedDocument,
                   "chunk " + tagText(chunk.tag) + " at byte " + std::to_string(chunk.offset) + " " + what);
}

// The chunks of a document, by tag.
class ChunkIndex {
  public:
    explicit ChunkIndex(const std::vector<Chunk>& chunks) : mChunks(chunks) {}

    const Chunk* find(const ChunkTag& tag) const {
        const auto at =
            std::find_if(mChunks.begin(), mChunks.end(), [&](const Chunk& c) { return c.tag == tag; });
        return at == mChunks.end() ? nullptr : &*at;
    }

    // Reads a chunk that may be missing. `read` returns what is wrong, or empty.
    template <class Read>
    Result<void> optional(const ChunkTag& tag, Read&& read) const {
        const Chunk* chunk = find(tag);
        if (!chunk) return {};
        if (const std::string wrong = read(chunk->bytes); !wrong.empty()) return damagedChunk(*chunk, wrong);
        return {};
    }

  private:
    const std::vector<Chunk>& mChunks;
};

Result<void> decodeMeshChunks(const ChunkIndex& index, uint32_t version, Document& document) {
    std::array<const Chunk*, 4> chunks{};
    const std::array tags{kConnectivity, kGeometry, kCurves, kColours};
    for (size_t i = 0; i < tags.size(); ++i) {
        chunks[i] = index.find(tags[i]);
        if (!chunks[i]) return failure(ErrorCode::DamagedDocument, "it has no chunk " + tagText(tags[i]));
    }
    auto mesh = decodeMesh({chunks[0]->bytes, chunks[1]->bytes, chunks[2]->bytes, chunks[3]->bytes}, version);
    if (!mesh) return damagedChunk(*chunks[size_t(mesh.error().chunk)], mesh.error().what);
    document.mesh = std::move(mesh->mesh);
    document.colourStep = mesh->colourStep;
    return {};
}

std::string readInflated(std::span<const uint8_t> bytes, std::vector<uint8_t>& out) {
    auto all = inflated(bytes);
    if (!all) return all.error().message;
    out = std::move(*all);
    return {};
}

Result<void> decodeInfoChunks(const ChunkIndex& index, Document& d) {
    const auto shared = [](std::span<const uint8_t> bytes, std::shared_ptr<const std::vector<uint8_t>>& out) {
        std::vector<uint8_t> all;
        std::string wrong = readInflated(bytes, all);
        if (wrong.empty()) out = std::make_shared<const std::vector<uint8_t>>(std::move(all));
        return wrong;
    };
    using Bytes = std::span<const uint8_t>;
    return index.optional(kSettings, [&](Bytes b) { return decodeSettings(b, d.settings); })
        .and_then([&] { return index.optional(kReport, [&](Bytes b) { return decodeReport(b, d.report); }); })
        .and_then([&] { return index.optional(kSource, [&](Bytes b) { return decodeSource(b, d.source); }); })
        .and_then([&] {
            return index.optional(kProfile, [&](Bytes b) { return readInflated(b, d.source.iccProfile); });
        })
        .and_then(
            [&] { return index.optional(kEmbedded, [&](Bytes b) { return shared(b, d.embeddedSource); }); })
        .and_then([&] { return index.optional(kPreview, [&](Bytes b) { return shared(b, d.previewPng); }); })
        .and_then([&] {
            return index.optional(kDifference,
                                  [&](Bytes b) { return decodeDifference(b, d.difference.emplace()); });
        });
}

Result<void> decodeEditChunks(const ChunkIndex& index, uint32_t version, Document& d) {
    const auto packed = [&](const ChunkTag& tag, auto&& decode) {
        return index.optional(tag, [&](std::span<const uint8_t> bytes) {
            std::vector<uint8_t> all;
            std::string wrong = readInflated(bytes, all);
            return wrong.empty() ? decode(all) : wrong;
        });
    };
    using Bytes = const std::vector<uint8_t>&;
    return packed(kAttributes, [&](Bytes b) { return decodePatchAttributes(b, d.mesh); })
        .and_then([&] { return packed(kBreaks, [&](Bytes b) { return decodeColourBreaks(b, d.mesh); }); })
        .and_then([&] {
            return packed(kSelections, [&](Bytes b) { return decodeSelections(b, d.mesh, d.selections); });
        })
        .and_then([&] {
            return packed(kFitted, [&](Bytes b) { return decodeFitted(b, version, d.mesh, d.fitted); });
        });
}

std::string quoted(const std::string& path) {
    return "'" + path + "'";
}

}  // namespace

Result<std::vector<uint8_t>> encodeDocument(Document& document) {
    if (!document.colourStep)
        document.colourStep = chooseColourStep(
            document.mesh, document.difference ? std::optional(document.difference->psnr) : std::nullopt);
    const auto mesh = encodeMesh(document.mesh, *document.colourStep);
    if (!mesh) return tl::unexpected<Error>(mesh.error());

    std::vector<std::vector<uint8_t>> owned;
    owned.reserve(kKnownTags.size());
    std::vector<Chunk> chunks{{kConnectivity, false, mesh->connectivity, 0},
                              {kGeometry, false, mesh->geometry, 0},
                              {kCurves, false, mesh->curves, 0},
                              {kColours, false, mesh->colours, 0}};
    // What tells of the source stays true when the mesh changes; what tells of the mesh does not.
    const auto add = [&](const ChunkTag& tag, bool safeToCopy, std::vector<uint8_t> bytes) {
        owned.push_back(std::move(bytes));
        chunks.push_back({tag, safeToCopy, owned.back(), 0});
    };
    add(kSettings, true, encodeSettings(document.settings));
    if (document.report != VectorizeReport{}) add(kReport, true, encodeReport(document.report));
    SourceInfo named = document.source;
    named.iccProfile.clear();
    if (named != SourceInfo{}) add(kSource, true, encodeSource(document.source));
    if (!document.source.iccProfile.empty()) add(kProfile, true, deflated(document.source.iccProfile));
    if (document.difference) add(kDifference, false, encodeDifference(*document.difference));
    if (document.previewPng) add(kPreview, false, deflated(*document.previewPng));
    if (document.embeddedSource) add(kEmbedded, true, deflated(*document.embeddedSource));
    const FileNumbers numbers(document.mesh.connectivity(), mesh->order);
    const auto addEdits = [&](const ChunkTag& tag, const std::vector<uint8_t>& bytes) {
        if (!bytes.empty()) add(tag, false, deflated(bytes));
    };
    addEdits(kAttributes, encodePatchAttributes(document.mesh, numbers));
    addEdits(kBreaks, encodeColourBreaks(document.mesh, numbers));
    addEdits(kSelections, encodeSelections(document.selections, numbers));
    if (document.fitted) addEdits(kFitted, encodeFitted(document.mesh, *document.fitted, numbers));
    for (const UnknownChunk& chunk : document.unknownChunks)
        chunks.push_back({chunk.tag, chunk.safeToCopy, chunk.bytes, 0});
    return packChunks(kFormatVersion, chunks);
}

Result<Document> decodeDocument(std::span<const uint8_t> bytes) {
    const auto chunks = unpackChunks(bytes, kFormatVersion);
    if (!chunks) return tl::unexpected<Error>(chunks.error());
    const ChunkIndex index(*chunks);
    Document document;
    for (const Chunk& chunk : *chunks) {
        const bool known = std::find(kKnownTags.begin(), kKnownTags.end(), chunk.tag) != kKnownTags.end();
        if (!known)
            document.unknownChunks.push_back(
                {chunk.tag, chunk.safeToCopy, std::vector<uint8_t>(chunk.bytes.begin(), chunk.bytes.end())});
        else if (index.find(chunk.tag) != &chunk)
            return damagedChunk(chunk, "is there twice");
    }
    const uint32_t version = chunkFileVersion(bytes);
    return decodeMeshChunks(index, version, document)
        .and_then([&] { return decodeInfoChunks(index, document); })
        .and_then([&] { return decodeEditChunks(index, version, document); })
        .map([&] { return std::move(document); });
}

Result<std::vector<ChunkSize>> chunkSizes(std::span<const uint8_t> bytes) {
    return unpackChunks(bytes, kFormatVersion).map([](const std::vector<Chunk>& chunks) {
        std::vector<ChunkSize> sizes;
        for (const Chunk& chunk : chunks)
            sizes.push_back({tagText(chunk.tag), kChunkEntrySize + chunk.bytes.size()});
        return sizes;
    });
}

Result<std::vector<uint8_t>> readPreview(std::span<const uint8_t> bytes) {
    const auto chunks = unpackChunks(bytes, kFormatVersion);
    if (!chunks) return tl::unexpected<Error>(chunks.error());
    std::vector<uint8_t> png;
    const auto read = ChunkIndex(*chunks).optional(
        kPreview, [&](std::span<const uint8_t> b) { return readInflated(b, png); });
    if (!read) return tl::unexpected<Error>(read.error());
    return png;
}

bool looksLikeDocument(std::span<const uint8_t> bytes) {
    return startsLikeChunkFile(bytes);
}

Result<void> saveDocument(Document& document, const std::string& path) {
    const auto bytes = encodeDocument(document);
    if (!bytes) return failure(bytes.error().code, quoted(path) + " was not saved: " + bytes.error().message);
    return writeFileAtomically(path, *bytes);
}

Result<Document> decodeFile(std::span<const uint8_t> bytes, const std::string& path) {
    auto document = decodeDocument(bytes);
    if (!document)
        return failure(document.error().code,
                       quoted(path) + " is no sound document: " + document.error().message);
    return document;
}

Result<Document> loadDocument(const std::string& path) {
    std::error_code error;
    const bool plain = std::filesystem::is_regular_file(path, error);
    std::ifstream file(path, std::ios::binary);
    if (!plain || !file)
        return failure(ErrorCode::CannotRead,
                       quoted(path) + " cannot be read; check that it is a file and allows it");
    const auto size = std::filesystem::file_size(path, error);
    if (error) return failure(ErrorCode::CannotRead, quoted(path) + " cannot be read: " + error.message());
    std::vector<uint8_t> bytes(size);
    if (!file.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(size)))
        return failure(ErrorCode::CannotRead, quoted(path) + " cannot be read to its end");
    return decodeFile(bytes, path);
}

}  // namespace tessera
