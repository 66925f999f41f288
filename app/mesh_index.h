// What tools look up in a document's mesh, built when it is asked for and kept up to date.
#pragma once

#include <optional>

#include "app/change.h"
#include "core/edit/patch_colours.h"
#include "core/mesh/patch_query.h"

namespace tessera {

class MeshIndex {
  public:
    // What was changed in the mesh since the last call.
    void follow(const PatchMesh& mesh, const Change& change);

    // Of `mesh`, which is the one that has been followed. References hold until the next follow().
    const PatchQuery& query(const PatchMesh& mesh);
    const PatchColours& colours(const PatchMesh& mesh);

  private:
    std::optional<PatchQuery> mQuery;
    std::optional<PatchColours> mColours;
    PatchSet mStale;  // of mColours
};

}  // namespace tessera
