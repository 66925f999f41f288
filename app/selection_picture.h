// The selected patches as a picture for the clipboard.
#pragma once

#include <QImage>

#include "app/jobs/job.h"
#include "core/edit/patch_set.h"
#include "core/mesh/patch_mesh.h"

namespace tessera {

// At one pixel for each of the picture's, just as large as the set, transparent beside it (anti-aliased); the
// whole picture where the set is empty. The mesh has patches.
Job* startSelectionPictureJob(QObject* owner, PatchMesh mesh, PatchSet set,
                              std::function<void(Result<QImage>)> deliver);

}  // namespace tessera
