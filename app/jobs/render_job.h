// Drawing what a view of a document shows, on a worker, as a picture that Qt can put on the screen.
#pragma once

#include <QImage>

#include "app/jobs/job.h"
#include "core/export/rasterize.h"

namespace tessera {

// Samples per pixel of what is finally shown, and of exports: the preview is the result.
constexpr int kPictureSamples = 4;

// A drawn part of the picture: `image` is what `view` shows, one of its pixels for each of the screen's.
struct Frame {
    QImage image;
    View view;
    int samples = 0;
};

// Without hidden patches.
Job* startRenderJob(QObject* owner, PatchMesh mesh, const View& view, int samples,
                    std::function<void(Result<Frame>)> deliver);

}  // namespace tessera
