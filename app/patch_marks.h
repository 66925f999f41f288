// Which patches of a mesh are hidden, locked or cut out, kept with its changes.
#pragma once

#include "core/edit/patch_set.h"

namespace tessera {

class PatchMarks {
  public:
    PatchMarks() = default;
    explicit PatchMarks(const PatchMesh& mesh);

    // `patches` of the mesh, of the same connectivity, may be marked otherwise than before. The work goes
    // with them.
    void update(const PatchMesh& mesh, const PatchSet& patches);

    const PatchSet& hidden() const { return mHidden; }
    const PatchSet& locked() const { return mLocked; }
    const PatchSet& cutOut() const { return mCutOut; }
    // Whether one sees through the picture somewhere on the canvas.
    bool leavesHoles() const { return !mHidden.empty() || !mCutOut.empty(); }

  private:
    PatchSet mHidden;
    PatchSet mLocked;
    PatchSet mCutOut;
};

}  // namespace tessera
