// The driver of section 4: photograph in, patches out.
#pragma once

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "core/mesh/patch_mesh.h"
#include "core/vectorize/settings.h"

namespace tessera {

struct VectorImage {
    PatchMesh mesh;
    VectorizeReport report;
};

// Vectorizes a picture of at least 1 x 1 pixels. The same bytes for the same image and settings, whatever the number
// of threads. Fails with Usage for settings out of range or variants that do not exist, and with Stopped within 50 ms
// of a request to stop.
Result<VectorImage> vectorize(const Image& image, const VectorizeSettings& settings, Progress& progress);

}  // namespace tessera
