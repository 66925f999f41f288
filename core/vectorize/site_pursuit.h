// Which centres each patch's spline gets, and how many of them each channel uses: chosen where they pay (the
// paper's future work), by orthogonal matching pursuit (Pati et al. 1993), under one budget for the picture.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/progress.h"
#include "core/image/image.h"
#include "core/mesh/patch_mesh.h"

namespace tessera {

struct SiteChoice {
    std::vector<uint8_t> sites;             // as in PatchSpline, the corners first
    std::array<int, kMaxChannels> terms{};  // factors of each channel, 3 .. sites.size()
};

// By patch id. A channel of a patch has no more terms than there are sites, nor than the patch has of its
// pixels, but three at least; over all channels termsPerPatch on the average, at most. `picture`, the mesh's or that enlarged by
// a whole factor, is in the mesh's basis and has hard steps at features. Empty where progress says stop.
std::vector<SiteChoice> chooseSites(const PatchMesh& mesh, const Image& picture, double termsPerPatch,
                                    const ProgressPart& progress);

// What a search for so many terms a patch chooses from, the corners first: a lattice of candidateSteps a
// side.
std::vector<uint8_t> candidateSites(double termsPerPatch);
int candidateSteps(double termsPerPatch);

}  // namespace tessera
