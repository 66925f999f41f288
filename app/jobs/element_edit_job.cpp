// See element_edit_job.h.
#include "app/jobs/element_edit_job.h"

namespace tessera {

Job* startElementEditJob(QObject* owner, PatchMesh mesh, ElementEdit edit,
                         std::function<void(Result<EditedMesh>)> deliver) {
    auto* job = new Job(JobKind::Edit, edit.text, owner);
    job->start<EditedMesh>(
        [mesh = std::move(mesh), edit = std::move(edit)](Progress& progress) -> Result<EditedMesh> {
            EditedMesh result{mesh, {}};
            Result<EditedElements> edited = edit.run(result.mesh, progress);
            if (!edited) return tl::unexpected<Error>(edited.error());
            result.edited = std::move(*edited);
            return result;
        },
        std::move(deliver));
    return job;
}

}  // namespace tessera
