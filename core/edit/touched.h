// What an edit changed, so that listeners look again only at that.
#pragma once

#include <vector>

#include "core/base/ids.h"

namespace tessera {

// Ids ascend, without repeats.
struct Touched {
    std::vector<VertexId> vertices;
    std::vector<EdgeId> edges;
    std::vector<PatchId> patches;  // geometry or colour changed
    bool topology = false;         // ids came or went: look at everything
};

}  // namespace tessera
