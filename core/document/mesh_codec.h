// A PatchMesh to and from the four mesh chunks of a document.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "core/document/file_mesh.h"
#include "core/mesh/patch_mesh.h"

namespace tessera {

struct MeshChunks {
    std::vector<uint8_t> connectivity, geometry, curves, colours;
    FileOrder order;  // which element got which id
};

// The step for a mesh that is stored for the first time: for splines of the default centres
// defaultColourStep(); for splines on sites the one by which the mesh's picture loses .09 dB of its PSNR, which
// counts as 45 dB where it is not known and as 60 dB where it is more, but no channel of it more than .7
// levels, root mean square.
double chooseColourStep(const PatchMesh& mesh, std::optional<double> psnr);

// Fails with Internal where the mesh is not one that decodeMesh would accept; the message says why.
Result<MeshChunks> encodeMesh(const PatchMesh& mesh, double colourStep);

struct MeshChunkBytes {
    std::span<const uint8_t> connectivity, geometry, curves, colours;
};
struct DecodedMesh {
    PatchMesh mesh;
    double colourStep = 0;
};
// Which of the chunks is wrong, and how.
struct MeshDamage {
    enum { Connectivity, Geometry, Curves, Colours } chunk = Connectivity;
    std::string what;
};
tl::expected<DecodedMesh, MeshDamage> decodeMesh(const MeshChunkBytes& chunks, uint32_t version);

}  // namespace tessera
