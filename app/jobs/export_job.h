// Drawing a document at any size into a picture file, on a worker.
#pragma once

#include <QSize>
#include <QString>

#include "app/jobs/render_job.h"
#include "core/image/image_io.h"
#include "core/mesh/patch_mesh.h"

namespace tessera {

struct ExportRequest {
    QString path;                   // its suffix chooses the format
    double scale = 1;               // output pixels per image pixel, > 0
    QSize size = {};                // of the output, px; empty: what the scale makes of the picture
    int samples = kPictureSamples;  // per pixel: 1, 4 or 16
    WriteOptions options = {};
};

// The size of the exported picture, at least 1 x 1.
QSize exportSize(QSize picture, const ExportRequest& request);

// The largest picture that is exported, so that the memory for it (16 bytes a pixel and more) can be had.
constexpr double kMaxExportPixels = 200e6;

struct Exported {
    QSize size;  // of the picture that is in the file now
};

// Fails with Usage where the picture would be too large.
Job* startExportJob(QObject* owner, PatchMesh mesh, ExportRequest request,
                    std::function<void(Result<Exported>)> deliver);

}  // namespace tessera
