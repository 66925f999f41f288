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
    VectorizeSettings settings;  // as asked, with the patches that were found for a wanted error
    ImageDifference difference;  // of the x1 rendering from the photo
};

// With as many patches as leave `meanError` (levels of 255), where it is given, else those of the settings.
Job* startVectorizeJob(QObject* owner, const QString& name, std::shared_ptr<const Image> photo,
                       VectorizeSettings settings, std::optional<double> meanError,
                       std::function<void(Result<Vectorized>)> deliver);

}  // namespace tessera
