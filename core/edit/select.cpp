// See select.h.
#include "core/edit/select.h"

#include <algorithm>

#include "core/edit/flood.h"

namespace tessera {

PatchSet wand(const PatchMesh& mesh, const PatchColours& colours, PatchId seed, const WandOptions& options) {
    const auto like = [&](PatchId p) {
        return p == seed || colourDistance(colours[seed], colours[p]) <= options.tolerance;
    };
    PatchSet found;
    if (options.contiguous)
        found = flood(
            mesh, seed, [&](EdgeId e) { return !options.stopAtFeatures || !mesh.curve(e).feature; }, like);
    else
        mesh.forEachPatch([&](PatchId p) {
            if (like(p)) found.push_back(p);
        });
    return selectableOf(mesh, std::move(found));
}

PatchSet wand(const PatchMesh& mesh, PatchId seed, const WandOptions& options) {
    return wand(mesh, PatchColours(mesh), seed, options);
}

PatchSet grown(const PatchMesh& mesh, const PatchSet& set) {
    const HalfedgeMesh& c = mesh.connectivity();
    std::vector<PatchId> all(set.begin(), set.end());
    for (const PatchId p : set)
        for (const HalfedgeId side : c.sides(p)) {
            const PatchId beyond = c.face(HalfedgeMesh::twin(side));
            if (beyond.valid()) all.push_back(beyond);
        }
    return selectableOf(mesh, patchSet(std::move(all)));
}

PatchSet shrunk(const PatchMesh& mesh, const PatchSet& set) {
    const HalfedgeMesh& c = mesh.connectivity();
    const auto member = membership(mesh, set);
    PatchSet result;
    for (const PatchId p : set) {
        const auto sides = c.sides(p);
        const bool inside = std::all_of(sides.begin(), sides.end(), [&](HalfedgeId side) {
            const PatchId beyond = c.face(HalfedgeMesh::twin(side));
            return !beyond.valid() || member[beyond.index];
        });
        if (inside) result.push_back(p);
    }
    return selectableOf(mesh, std::move(result));
}

std::vector<std::vector<HalfedgeId>> outline(const PatchMesh& mesh, const PatchSet& set) {
    const HalfedgeMesh& c = mesh.connectivity();
    const auto member = membership(mesh, set);
    const auto inside = [&](HalfedgeId h) { return c.face(h).valid() && member[c.face(h).index]; };
    std::vector<HalfedgeId> border;
    for (const PatchId p : set)
        for (const HalfedgeId side : c.sides(p))
            if (!inside(HalfedgeMesh::twin(side))) border.push_back(side);
    std::sort(border.begin(), border.end());
    std::vector<uint8_t> used(2 * c.edgeCapacity(), 0);
    std::vector<std::vector<HalfedgeId>> loops;
    for (const HalfedgeId first : border) {
        if (used[first.index]) continue;
        std::vector<HalfedgeId>& loop = loops.emplace_back();
        HalfedgeId h = first;
        do {
            used[h.index] = 1;
            loop.push_back(h);
            // Around the target, through patches of the set, to the side where the set ends again.
            h = c.next(h);
            while (inside(HalfedgeMesh::twin(h))) h = c.next(HalfedgeMesh::twin(h));
        } while (h != first);
    }
    return loops;
}

}  // namespace tessera
