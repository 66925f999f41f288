// See open_job.h.
#include "app/jobs/open_job.h"

#include <QFileInfo>

namespace tessera {

Job* startOpenJob(QObject* owner, const QString& path, std::function<void(Result<OpenedFile>)> deliver) {
    auto* job = new Job(JobKind::Open, QObject::tr("Opening %1").arg(QFileInfo(path).fileName()), owner);
    job->start<OpenedFile>([path](Progress& progress) { return openFile(path, progress); },
                           std::move(deliver));
    return job;
}

}  // namespace tessera
