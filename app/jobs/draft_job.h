// Drafts of a photo on workers: their ladder, and single rungs of it.
#pragma once

#include <memory>

#include "app/jobs/job.h"
#include "core/image/image.h"
#include "core/vectorize/draft_ladder.h"

namespace tessera {

// Rungs from twice `settings.patches` down, with the settings' share of features; the method must be
// "default".
Job* startLadderJob(QObject* owner, const QString& name, std::shared_ptr<const Image> photo,
                    const VectorizeSettings& settings,
                    std::function<void(Result<std::shared_ptr<const DraftLadder>>)> deliver);

Job* startRungJob(QObject* owner, std::shared_ptr<const DraftLadder> ladder, size_t patches,
                  std::function<void(Result<PatchMesh>)> deliver);

}  // namespace tessera
