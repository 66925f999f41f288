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

// `document` is the snapshot, with its photo. Where `photoFile` is a file that holds the photo too, it is
// left out; else the document may be the only place where it is. A preview is made where there is none. Not
// stopped by anything but the end of its owner before it has begun to write: the file is then the old one.
Job* startSaveJob(QObject* owner, Document document, const QString& path, const QString& photoFile,
                  std::function<void(Result<Saved>)> deliver);

}  // namespace tessera
