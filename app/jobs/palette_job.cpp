// See palette_job.h.
#include "app/jobs/palette_job.h"

namespace tessera {

Job* startPaletteJob(QObject* owner, PatchMesh mesh, int count,
                     std::function<void(Result<Palette>)> deliver) {
    auto* job = new Job(JobKind::Palette, QObject::tr("Finding the palette"), owner);
    job->start<Palette>(
        [mesh = std::move(mesh), count](Progress&) -> Result<Palette> {
            return palette(mesh, PatchColours(mesh), count);
        },
        std::move(deliver));
    return job;
}

}  // namespace tessera
