// See open_job.h.
#include "app/jobs/open_job.h"

namespace tessera {

Job* startOpenJob(QObject* owner, const QString& name, ReadFile read,
                  std::function<void(Result<OpenedFile>)> deliver, JobKind kind) {
    auto* job = new Job(kind, QObject::tr("Opening %1").arg(name), owner);
    job->start<OpenedFile>(std::move(read), std::move(deliver));
    return job;
}

}  // namespace tessera
