// A vectorization with as many patches as an error asks for, found by secants.
#pragma once

#include <functional>

#include "core/vectorize/vectorize.h"

namespace tessera {

struct ErrorGoal {
    double error = 1;  // wanted, > 0
    // Of a mesh from the picture, in the unit of `error`.
    std::function<Result<double>(const PatchMesh&, Progress&)> measure;
};

// How far from the wanted error a result may be to count as reached.
constexpr double kErrorTolerance = .05;
// There is never more than one patch for so many pixels.
constexpr double kLeastPixelsPerPatch = 6;

// Finds settings.patches: first at draft quality, then as the settings say; at most three runs in all, and
// the last is as the settings say. The report begins with a stage "search" with the patches and the error of
// each run; where the error was missed by more than kErrorTolerance, its shortfall says why. `observe` sees
// the runs that are as the settings say. Fails as vectorize() and the measure do, and with Usage where the
// goal is not positive or the method has no draft.
Result<VectorImage> vectorizeToError(const Image& image, VectorizeSettings& settings, const ErrorGoal& goal,
                                     Progress& progress, const StageObserver& observe = {});

}  // namespace tessera
