// Opening a file on a worker.
#pragma once

#include "app/file_service.h"
#include "app/jobs/job.h"

namespace tessera {

using ReadFile = std::function<Result<OpenedFile>(Progress&)>;

// `read` runs on the worker; `name` says to a person what it reads.
Job* startOpenJob(QObject* owner, const QString& name, ReadFile read,
                  std::function<void(Result<OpenedFile>)> deliver, JobKind kind = JobKind::Open);

}  // namespace tessera
