// A vectorization with as many patches as an error asks for, found by drafts of it.
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
constexpr double kErrorTolerance = .03;
// There is never more than one patch for so many pixels.
constexpr double kLeastPixelsPerPatch = 6;

// Finds settings.patches: by one to three drafts, which take about a fifth of the time, then by a run as
// the settings say, and by up to three more where that has missed the error by more than kErrorTolerance. The
// report begins with a stage "search" with the patches and the error of each draft, ordered by patches, and
// of each run; where the last has missed too, its shortfall says why. `observe` sees the runs, not the
// drafts. Fails as vectorize() and the measure do, and with Usage where the goal is not positive or the
// method has no draft.
Result<VectorImage> vectorizeToError(const Image& image, VectorizeSettings& settings, const ErrorGoal& goal,
                                     Progress& progress, const StageObserver& observe = {});

}  // namespace tessera
