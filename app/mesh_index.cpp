// See mesh_index.h.
#include "app/mesh_index.h"

#include <algorithm>

namespace tessera {

namespace {

// Recolouring touches patches too, and leaves all places as they are.
bool moved(const PatchMesh& before, const PatchMesh& after, const Touched& touched) {
    return !touched.vertices.empty() || !touched.edges.empty() ||
           std::any_of(touched.patches.begin(), touched.patches.end(),
                       [&](PatchId p) { return before.interior(p) != after.interior(p); });
}

}  // namespace

void MeshIndex::follow(const PatchMesh& mesh, const Change& change) {
    if (change.replaced || change.touched.topology) {
        mQuery.reset();
        mColours.reset();
        mStale.clear();
        return;
    }
    if (mQuery && moved(mQuery->mesh(), mesh, change.touched)) mQuery.reset();
    if (mColours) mStale = united(mStale, change.touched.patches);
}

const PatchQuery& MeshIndex::query(const PatchMesh& mesh) {
    if (!mQuery) mQuery.emplace(mesh);
    return *mQuery;
}

const PatchColours& MeshIndex::colours(const PatchMesh& mesh) {
    if (!mColours) mColours.emplace(mesh);
    if (!mStale.empty()) mColours->update(mesh, mStale);
    mStale.clear();
    return *mColours;
}

}  // namespace tessera
