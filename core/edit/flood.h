// Which patches can be reached from one: what selections are found with.
#pragma once

#include <algorithm>

#include "core/edit/patch_set.h"

namespace tessera {

// The patches that can be reached from the seed over edges and patches that may be passed; with the seed.
template <class MayCross, class MayEnter>
PatchSet flood(const PatchMesh& mesh, PatchId seed, MayCross&& mayCross, MayEnter&& mayEnter) {
    const HalfedgeMesh& c = mesh.connectivity();
    std::vector<uint8_t> seen(c.faceCapacity(), 0);
    PatchSet reached{seed};
    seen[seed.index] = 1;
    for (size_t i = 0; i < reached.size(); ++i)
        for (const HalfedgeId side : c.sides(reached[i])) {
            const PatchId beyond = c.face(HalfedgeMesh::twin(side));
            if (!beyond.valid() || seen[beyond.index] || !mayCross(HalfedgeMesh::edge(side)) ||
                !mayEnter(beyond))
                continue;
            seen[beyond.index] = 1;
            reached.push_back(beyond);
        }
    std::sort(reached.begin(), reached.end());
    return reached;
}

}  // namespace tessera
