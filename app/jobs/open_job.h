// Opening a file on a worker.
#pragma once

#include "app/file_service.h"
#include "app/jobs/job.h"

namespace tessera {

Job* startOpenJob(QObject* owner, const QString& path, std::function<void(Result<OpenedFile>)> deliver);

}  // namespace tessera
