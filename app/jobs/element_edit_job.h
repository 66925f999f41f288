// Edits of many elements, on a worker.
#pragma once

#include "app/element_edits.h"
#include "app/jobs/job.h"

namespace tessera {

struct EditedMesh {
    PatchMesh mesh;
    EditedElements edited;
};

Job* startElementEditJob(QObject* owner, PatchMesh mesh, ElementEdit edit,
                         std::function<void(Result<EditedMesh>)> deliver);

}  // namespace tessera
