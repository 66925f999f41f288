// Photographs as meshes, for the comparison of the renderers.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "core/image/image_io.h"
#include "core/image/resample.h"
#include "core/vectorize/vectorize.h"
#include "tests/support/gl.h"

namespace tessera::testing {

// The mesh of a test photograph, made smaller by a whole factor first; none where it cannot be read.
inline std::optional<PatchMesh> meshOfPhotograph(const std::string& path, int factor, int patches) {
    const auto photograph = readImage(path);
    if (!photograph) return {};
    VectorizeSettings settings;
    settings.patches = patches;
    Progress progress;
    auto result = vectorize(boxDownsample(photograph->image, factor), settings, progress);
    EXPECT_TRUE(result) << path;
    if (!result) return {};
    return std::move(result->mesh);
}

// x1, x3.7 and x32 with a fractional pan, one sample a pixel and four.
inline void expectSamePictures(const PatchMesh& mesh) {
    for (const double zoom : {1.0, 3.7, 32.0})
        for (const int samples : {1, 4}) {
            SCOPED_TRACE(::testing::Message() << "x" << zoom << ", " << samples << " samples");
            const View view =
                zoomedView(mesh, zoom, std::min(mesh.width(), 768), std::min(mesh.height(), 768));
            expectSamePicture(mesh, view, {.samples = samples});
            if (samples == 1) expectSamePicture(mesh, view, {.samples = samples, .sharpen = 0});
        }
}

}  // namespace tessera::testing
