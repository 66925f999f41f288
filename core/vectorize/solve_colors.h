// Patch colours by area-weighted least squares over pixel squares, with as many spline terms for each patch
// and channel as pay, and one joint solve in which neighbours agree along edges that are no features.
#pragma once

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "core/mesh/patch_mesh.h"
#include "core/vectorize/settings.h"

namespace tessera {

struct ColorSolveOptions {
    double termsPerPatch = 48;  // over all channels, on the average
    int maxTerms = 40;
    double termsPerPixel = .7;
    double weightC0 = .3;
    double weightC1 = .1;
    double ridge = 1e-5;
    int samplesPerSide = 2;
    int maxIterations = 60;
};

Result<PatchMesh> solveColors(PatchMesh mesh, const Image& image, const ColorSolveOptions& options,
                              StageReport& report, Progress& progress);

}  // namespace tessera
