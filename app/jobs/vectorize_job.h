// Turning a photo into patches on a worker, and measuring how far they are from it.
#pragma once

#include <memory>
#include <optional>

#include "app/jobs/job.h"
#include "core/image/image_compare.h"
#include "core/vectorize/vectorize.h"

namespace tessera {

struct Vectorized {
    VectorImage result;
    std::optional<ImageDifference> difference;  // of the x1 rendering from the photo
};

Job* startVectorizeJob(QObject* owner, const QString& name, std::shared_ptr<const Image> photo,
                       VectorizeSettings settings, std::function<void(Result<Vectorized>)> deliver);

}  // namespace tessera
