// Drawing a document at any size into a picture file, on a worker.
#pragma once

#include <QString>

#include "app/jobs/job.h"
#include "core/image/image_io.h"
#include "core/mesh/patch_mesh.h"

namespace tessera {

struct ExportRequest {
    QString path;      // its suffix chooses the format
    double scale = 1;  // output pixels per image pixel, > 0
    WriteOptions options;
};

// The largest picture that is exported, so that the memory for it (16 bytes a pixel and more) can be had.
constexpr double kMaxExportPixels = 200e6;

// What is written: nothing, but the Result<void> would have no value to take out of a future.
struct Exported {};

Job* startExportJob(QObject* owner, PatchMesh mesh, ExportRequest request,
                    std::function<void(Result<Exported>)> deliver);

}  // namespace tessera
