// See save_job.h.
#include "app/jobs/save_job.h"

#include <QFile>
#include <QFileInfo>
#include <algorithm>

#include "core/document/codec.h"
#include "core/export/rasterize.h"
#include "core/image/image_io.h"

namespace tessera {

namespace {

constexpr double kPreviewPx = 512;

void addPreview(Document& document) {
    const PatchMesh& mesh = document.mesh;
    const double scale = std::min(1.0, kPreviewPx / std::max(mesh.width(), mesh.height()));
    const Result<Image> image = rasterize(mesh, wholePicture(mesh, {scale, scale}), {.samples = 4});
    if (!image) return;
    // A file without a preview is still a good file.
    if (auto png = encodePng(*image))
        document.previewPng = std::make_shared<const std::vector<uint8_t>>(std::move(*png));
}

bool holds(const QString& path, const std::vector<uint8_t>& bytes) {
    QFile file(path);
    if (!file.open(QIODevice::ReadOnly) || file.size() != qint64(bytes.size())) return false;
    const QByteArray held = file.readAll();
    return std::equal(bytes.begin(), bytes.end(), held.begin(), held.end(),
                      [](uint8_t a, char b) { return a == uint8_t(b); });
}

Result<Saved> run(Document document, const QString& path, const QString& photoFile, Progress& progress) {
    if (!photoFile.isEmpty() && document.embeddedSource && holds(photoFile, *document.embeddedSource))
        document.embeddedSource.reset();
    progress.beginStage("drawing the preview", .5);
    if (!document.previewPng && document.mesh.patchCount() > 0) addPreview(document);
    progress.beginStage("writing", .5);
    if (!progress.step(0)) return stopped();
    if (auto written = saveDocument(document, path.toStdString()); !written)
        return tl::unexpected<Error>(written.error());
    return Saved{document.colourStep};
}

}  // namespace

Job* startSaveJob(QObject* owner, Document document, const QString& path, const QString& photoFile,
                  std::function<void(Result<Saved>)> deliver) {
    auto* job = new Job(JobKind::Save, QObject::tr("Saving %1").arg(QFileInfo(path).fileName()), owner);
    job->start<Saved>([document = std::move(document), path,
                       photoFile](Progress& progress) { return run(document, path, photoFile, progress); },
                      std::move(deliver));
    return job;
}

}  // namespace tessera
