// A renderer that draws views at once, on the UI thread: a graphics card's.
#pragma once

#include <QImage>
#include <span>

#include "core/base/result.h"
#include "core/mesh/patch_mesh.h"
#include "core/mesh/view.h"

namespace tessera {

class FrameDrawer {
  public:
    virtual ~FrameDrawer() = default;

    virtual void setMesh(const PatchMesh& mesh) = 0;
    // The mesh has changed in these patches alone.
    virtual void update(const PatchMesh& mesh, std::span<const PatchId> patches) = 0;
    // What the view shows at full quality, without hidden patches. An error is for good: the context is lost.
    virtual Result<QImage> draw(const View& view) = 0;
};

}  // namespace tessera
