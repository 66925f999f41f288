// Writing a snapshot of a document on a worker.
#pragma once

#include <optional>

#include "app/jobs/job.h"
#include "core/document/document.h"

namespace tessera {

// What the codec chose while it wrote, for the document to keep.
struct Saved {
    std::optional<double> colourStep;
};

// `document` is the snapshot. A preview is made for it where it has none. Not stopped by anything but the end
// of its owner before it has begun to write: the file is then the old one.
Job* startSaveJob(QObject* owner, Document document, const QString& path,
                  std::function<void(Result<Saved>)> deliver);

}  // namespace tessera
