// The dominant colours of a picture, found on a worker.
#pragma once

#include "app/jobs/job.h"
#include "core/edit/palette.h"

namespace tessera {

// `count` and `like` as in palette().
Job* startPaletteJob(QObject* owner, PatchMesh mesh, int count, std::vector<glm::dvec3> like,
                     std::function<void(Result<Palette>)> deliver);

}  // namespace tessera
