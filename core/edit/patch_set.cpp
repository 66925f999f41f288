// See patch_set.h.
#include "core/edit/patch_set.h"

#include <algorithm>

namespace tessera {

PatchSet patchSet(std::vector<PatchId> patches) {
    std::sort(patches.begin(), patches.end());
    patches.erase(std::unique(patches.begin(), patches.end()), patches.end());
    return patches;
}

bool contains(const PatchSet& set, PatchId p) {
    return std::binary_search(set.begin(), set.end(), p);
}

PatchSet united(const PatchSet& a, const PatchSet& b) {
    PatchSet result;
    std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(result));
    return result;
}

PatchSet subtracted(const PatchSet& a, const PatchSet& b) {
    PatchSet result;
    std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(result));
    return result;
}

PatchSet intersected(const PatchSet& a, const PatchSet& b) {
    PatchSet result;
    std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(result));
    return result;
}

bool selectable(const PatchMesh& mesh, PatchId p) {
    const PatchAttributes& a = mesh.attributes(p);
    return !a.hidden && !a.locked;
}

PatchSet allSelectable(const PatchMesh& mesh) {
    PatchSet all;
    mesh.forEachPatch([&](PatchId p) {
        if (selectable(mesh, p)) all.push_back(p);
    });
    return all;
}

PatchSet selectableOf(const PatchMesh& mesh, PatchSet set) {
    std::erase_if(set, [&](PatchId p) { return !selectable(mesh, p); });
    return set;
}

PatchSet inverted(const PatchMesh& mesh, const PatchSet& set) {
    return subtracted(allSelectable(mesh), set);
}

PatchSet alive(const PatchMesh& mesh, const PatchSet& set) {
    PatchSet result;
    for (const PatchId p : set)
        if (p.index < mesh.connectivity().faceCapacity() && mesh.connectivity().alive(p)) result.push_back(p);
    return result;
}

PatchSet editable(const PatchMesh& mesh, const PatchSet& set) {
    PatchSet result = alive(mesh, set);
    std::erase_if(result, [&](PatchId p) { return mesh.attributes(p).locked; });
    return result;
}

std::vector<uint8_t> membership(const PatchMesh& mesh, const PatchSet& set) {
    std::vector<uint8_t> member(mesh.connectivity().faceCapacity(), 0);
    for (const PatchId p : set) member[p.index] = 1;
    return member;
}

}  // namespace tessera
