// See palette_job.h.
#include "app/jobs/palette_job.h"

namespace tessera {

Job* startPaletteJob(QObject* owner, PatchMesh mesh, int count, std::vector<glm::dvec3> like,
                     std::function<void(Result<Palette>)> deliver) {
    auto* job = new Job(JobKind::Palette, QObject::tr("Finding the palette"), owner);
    job->start<Palette>(
        [mesh = std::move(mesh), count, like = std::move(like)](Progress&) -> Result<Palette> {
            return palette(mesh, PatchColours(mesh), count, like);
        },
        std::move(deliver));
    return job;
}

}  // namespace tessera
