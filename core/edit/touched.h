// What an edit changed, so that listeners look again at that alone.
#pragma once

#include <vector>

#include "core/mesh/patch_mesh.h"

namespace tessera {

// Ids ascend, without repeats.
struct Touched {
    std::vector<VertexId> vertices;
    std::vector<EdgeId> edges;     // their curve or what is known of them
    std::vector<PatchId> patches;  // their geometry, colours or attributes
    bool topology = false;         // ids came or went: look at everything

    bool empty() const { return vertices.empty() && edges.empty() && patches.empty() && !topology; }
    bool operator==(const Touched&) const = default;
};

// From ids in any order, with repeats.
Touched touchedOf(std::vector<VertexId> vertices, std::vector<EdgeId> edges, std::vector<PatchId> patches);
Touched united(const Touched& a, const Touched& b);

}  // namespace tessera
