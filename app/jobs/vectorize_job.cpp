// See vectorize_job.h.
#include "app/jobs/vectorize_job.h"

#include "app/jobs/render_job.h"
#include "core/export/rasterize.h"
#include "core/vectorize/error_search.h"

namespace tessera {

namespace {

// With as many samples as when it is saved: the file rounds colours as finely as this error deserves.
Result<ImageDifference> differenceFrom(const Image& photo, const PatchMesh& mesh, Progress& progress) {
    const auto rendering =
        rasterize(mesh, wholePicture(mesh, {1, 1}), {.samples = kPictureSamples}, &progress);
    if (!rendering) return tl::unexpected<Error>(rendering.error());
    return compareImages(photo, *rendering);
}

Result<Vectorized> run(const Image& photo, VectorizeSettings settings, std::optional<double> meanError,
                       Progress& progress) {
    const auto measure = [&](const PatchMesh& mesh, Progress& measuring) {
        return differenceFrom(photo, mesh, measuring).map([](const ImageDifference& d) { return d.mae; });
    };
    Result<VectorImage> result =
        meanError ? vectorizeToError(photo, settings, {.error = *meanError, .measure = measure}, progress)
                  : vectorize(photo, settings, progress);
    if (!result) return tl::unexpected<Error>(result.error());
    const auto difference = differenceFrom(photo, result->mesh, progress);
    if (!difference) return tl::unexpected<Error>(difference.error());
    return Vectorized{
        .result = std::move(*result), .settings = std::move(settings), .difference = *difference};
}

}  // namespace

Job* startVectorizeJob(QObject* owner, const QString& name, std::shared_ptr<const Image> photo,
                       VectorizeSettings settings, std::optional<double> meanError,
                       std::function<void(Result<Vectorized>)> deliver) {
    auto* job = new Job(JobKind::Vectorize, QObject::tr("Vectorizing %1").arg(name), owner);
    job->start<Vectorized>([photo = std::move(photo), settings = std::move(settings), meanError](
                               Progress& progress) { return run(*photo, settings, meanError, progress); },
                           std::move(deliver));
    return job;
}

}  // namespace tessera
