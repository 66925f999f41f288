// See vectorize_job.h.
#include "app/jobs/vectorize_job.h"

#include "app/jobs/render_job.h"
#include "core/export/rasterize.h"

namespace tessera {

namespace {

Result<Vectorized> run(const Image& photo, const VectorizeSettings& settings, Progress& progress) {
    Result<VectorImage> result = vectorize(photo, settings, progress);
    if (!result) return tl::unexpected<Error>(result.error());
    Vectorized vectorized{.result = std::move(*result), .difference = {}};
    const PatchMesh& mesh = vectorized.result.mesh;
    // With as many samples as when it is saved: the file rounds colours as finely as this error deserves.
    const Result<Image> rendering =
        rasterize(mesh, wholePicture(mesh, {1, 1}), {.samples = kPictureSamples}, &progress);
    if (!rendering) return tl::unexpected<Error>(rendering.error());
    if (const auto difference = compareImages(photo, *rendering)) vectorized.difference = *difference;
    return vectorized;
}

}  // namespace

Job* startVectorizeJob(QObject* owner, const QString& name, std::shared_ptr<const Image> photo,
                       VectorizeSettings settings, std::function<void(Result<Vectorized>)> deliver) {
    auto* job = new Job(JobKind::Vectorize, QObject::tr("Vectorizing %1").arg(name), owner);
    job->start<Vectorized>([photo = std::move(photo), settings = std::move(settings)](
                               Progress& progress) { return run(*photo, settings, progress); },
                           std::move(deliver));
    return job;
}

}  // namespace tessera
