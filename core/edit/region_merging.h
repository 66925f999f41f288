// The region around a place that features and colours hold best: a binary partition tree of the patches
// (Salembier and Garrido 2000).
#pragma once

#include "core/edit/patch_colours.h"
#include "core/edit/patch_set.h"

namespace tessera {

// How well the outline of a region (of patches of `within`) holds it: the mean over its length of 1 where it
// is a feature and of how much the colours beside it differ elsewhere. The picture's border is a weak part of
// it. What `within` leaves out and is not connected to that border is a hole and does not count.
double outlineStrength(const PatchMesh& mesh, const PatchColours& colours, const PatchSet& within,
                       const PatchSet& region);

struct HeldRegion {
    PatchSet patches;
    double strength = 0;  // of its outline
};

// The patches of `within` are merged, neighbours of like colours first, until one region is left. Of the
// regions around the seed on the way, the one with the strongest outline, the larger of equals; an empty one
// where colours differ too little along all those outlines to hold anything.
HeldRegion bestHeld(const PatchMesh& mesh, const PatchColours& colours, const PatchSet& within, PatchId seed);

}  // namespace tessera
