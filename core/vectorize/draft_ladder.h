// All patch counts at once, at draft quality: the collapses of a mesh, remembered, so that a slider can run
// through them (progressive meshes, Hoppe 1996).
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "core/mesh/patch_mesh.h"
#include "core/vectorize/cut_mesh.h"
#include "core/vectorize/refine.h"

namespace tessera {

// Immutable; may be shared between threads.
class DraftLadder {
  public:
    // Collapses `initial`, which becomes the top rung, to a handful of patches. Where its features would not
    // let it, rungs below some have none. `sharp` is the picture
    // that it was made for, without the blur of features and in the opponent basis; `fit` is over it.
    // Stopped where progress says so.
    static Result<std::shared_ptr<const DraftLadder>> build(CutMesh initial,
                                                            std::shared_ptr<const Image> sharp,
                                                            const PolynomialFit& fit,
                                                            const VectorizeSettings& settings,
                                                            Progress& progress);

    size_t mostPatches() const { return mFaces.front(); }
    size_t leastPatches() const { return mFaces.back(); }

    // The mesh of the most patches that are no more than `patches` (or the least there is): edges straight
    // but for features, few terms a patch, in the opponent basis. Valid; the same for the same count,
    // whatever the number of threads.
    PatchMesh at(size_t patches) const;

  private:
    DraftLadder() = default;
    // `cut`, which is the initial mesh, after so many collapses.
    void descend(CutMesh& cut, size_t collapses) const;

    CutMesh mInitial;
    std::shared_ptr<const Image> mSharp;
    std::vector<RecordedCollapse> mCollapses;
    std::vector<size_t> mFaces;  // before each collapse, and after the last
    size_t mWithFeatures = 0;    // of the collapses; the others are of the mesh without
};

}  // namespace tessera
