// See patch_marks.h.
#include "app/patch_marks.h"

#include <algorithm>

namespace tessera {

namespace {

// Takes over for each of `patches` whether it is in the set.
void follow(PatchSet& set, const PatchMesh& mesh, const PatchSet& patches, bool PatchAttributes::* mark) {
    PatchSet come, gone;
    for (const PatchId p : patches) {
        const bool marked = mesh.attributes(p).*mark;
        if (marked != std::binary_search(set.begin(), set.end(), p)) (marked ? come : gone).push_back(p);
    }
    if (!gone.empty()) set = subtracted(set, gone);
    if (!come.empty()) set = united(set, come);
}

}  // namespace

PatchMarks::PatchMarks(const PatchMesh& mesh) {
    mesh.forEachPatch([&](PatchId p) {
        const PatchAttributes& attributes = mesh.attributes(p);
        if (attributes.hidden) mHidden.push_back(p);
        if (attributes.locked) mLocked.push_back(p);
        if (attributes.cutOut) mCutOut.push_back(p);
    });
}

void PatchMarks::update(const PatchMesh& mesh, const PatchSet& patches) {
    follow(mHidden, mesh, patches, &PatchAttributes::hidden);
    follow(mLocked, mesh, patches, &PatchAttributes::locked);
    follow(mCutOut, mesh, patches, &PatchAttributes::cutOut);
}

}  // namespace tessera
