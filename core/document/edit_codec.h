// The chunks of a document that only editing fills: attributes of patches, colour breaks, named selections,
// and in what the mesh differs from the one that was fitted.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/document/document.h"
#include "core/document/file_mesh.h"

namespace tessera {

// The elements of a mesh by the file's ids. Edges are in the direction that the file gives them.
struct FileNumbers {
    std::vector<VertexId> vertices;
    std::vector<HalfedgeId> edges;
    std::vector<PatchId> patches;

    FileNumbers(const HalfedgeMesh& mesh, FileOrder order);
    // Of a mesh that was decoded: ids are the file's.
    explicit FileNumbers(const HalfedgeMesh& decoded);
};

// Each is empty where there is nothing to store.
std::vector<uint8_t> encodePatchAttributes(const PatchMesh& mesh, const FileNumbers& numbers);
std::vector<uint8_t> encodeColourBreaks(const PatchMesh& mesh, const FileNumbers& numbers);
std::vector<uint8_t> encodeSelections(const std::vector<NamedSelection>& selections,
                                      const FileNumbers& numbers);
std::vector<uint8_t> encodeFitted(const PatchMesh& mesh, const PatchMesh& fitted, const FileNumbers& numbers);

// Each returns what is wrong, or empty. `mesh` is as decoded, `version` the file's.
std::string decodePatchAttributes(std::span<const uint8_t> bytes, PatchMesh& mesh);
std::string decodeColourBreaks(std::span<const uint8_t> bytes, PatchMesh& mesh);
std::string decodeSelections(std::span<const uint8_t> bytes, const PatchMesh& mesh,
                             std::vector<NamedSelection>& selections);
std::string decodeFitted(std::span<const uint8_t> bytes, uint32_t version, const PatchMesh& mesh,
                         std::optional<PatchMesh>& fitted);

}  // namespace tessera
