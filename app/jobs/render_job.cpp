// See render_job.h.
#include "app/jobs/render_job.h"

#include "app/picture_pyramid.h"

namespace tessera {

Job* startRenderJob(QObject* owner, PatchMesh mesh, const View& view, int samples,
                    std::function<void(Result<Frame>)> deliver) {
    auto* job = new Job(JobKind::Render, QObject::tr("Drawing"), owner);
    job->start<Frame>(
        [mesh = std::move(mesh), view, samples](Progress& progress) -> Result<Frame> {
            progress.beginStage("drawing", 1);
            const Result<Image> image = rasterize(mesh, view, {.samples = samples, .showHidden = false}, &progress);
            if (!image) return tl::unexpected<Error>(image.error());
            return Frame{toQImage(*image), view, samples};
        },
        std::move(deliver));
    return job;
}

}  // namespace tessera
