// See export_job.h.
#include "app/jobs/export_job.h"

#include <QFileInfo>
#include <algorithm>
#include <cmath>

namespace tessera {

namespace {

Result<Exported> run(const PatchMesh& mesh, const ExportRequest& request, Progress& progress) {
    const QSize size = exportSize({mesh.width(), mesh.height()}, request);
    if (double(size.width()) * size.height() > kMaxExportPixels)
        return failure(ErrorCode::Usage, QObject::tr("A picture of %1 × %2 pixels is too large to export; "
                                                     "at most %3 megapixels are possible.")
                                             .arg(size.width())
                                             .arg(size.height())
                                             .arg(kMaxExportPixels / 1e6)
                                             .toStdString());
    progress.beginStage("drawing", .8);
    const View view{.origin = {0, 0},
                    .scale = {double(size.width()) / mesh.width(), double(size.height()) / mesh.height()},
                    .width = size.width(),
                    .height = size.height()};
    const Result<Image> image = rasterize(mesh, view, {.samples = request.samples}, &progress);
    if (!image) return tl::unexpected<Error>(image.error());
    progress.beginStage("writing", .2);
    if (auto written = writeImage(*image, request.path.toStdString(), request.options, &progress); !written)
        return tl::unexpected<Error>(written.error());
    return Exported{size};
}

}  // namespace

QSize exportSize(QSize picture, const ExportRequest& request) {
    if (!request.size.isEmpty()) return request.size;
    // A scale that no picture can have shall not overflow: the check of the size refuses it.
    constexpr double kMostPx = 1e9;
    const auto scaled = [&](int px) { return int(std::clamp(std::round(px * request.scale), 1., kMostPx)); };
    return {scaled(picture.width()), scaled(picture.height())};
}

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
