// See export_job.h.
#include "app/jobs/export_job.h"

#include <QFileInfo>

#include "app/jobs/render_job.h"

namespace tessera {

namespace {

Result<Exported> run(const PatchMesh& mesh, const ExportRequest& request, Progress& progress) {
    progress.beginStage("drawing", .8);
    const View view = wholePicture(mesh, {request.scale, request.scale});
    const Result<Image> image = rasterize(mesh, view, {.samples = kPictureSamples}, &progress);
    if (!image) return tl::unexpected<Error>(image.error());
    progress.beginStage("writing", .2);
    if (!progress.step(0)) return stopped();
    if (auto written = writeImage(*image, request.path.toStdString(), request.options); !written)
        return tl::unexpected<Error>(written.error());
    return Exported{};
}

}  // namespace

Job* startExportJob(QObject* owner, PatchMesh mesh, ExportRequest request,
                    std::function<void(Result<Exported>)> deliver) {
    const QString name = QFileInfo(request.path).fileName();
    auto* job = new Job(JobKind::Export, QObject::tr("Exporting %1").arg(name), owner);
    job->start<Exported>([mesh = std::move(mesh), request = std::move(request)](
                             Progress& progress) { return run(mesh, request, progress); },
                         std::move(deliver));
    return job;
}

}  // namespace tessera
