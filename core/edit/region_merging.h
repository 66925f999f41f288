// The region around a place that features and colours hold best: a binary partition tree of the patches
// (Salembier and Garrido 2000).
#pragma once

#include "core/edit/patch_colours.h"
#include "core/edit/patch_set.h"

namespace tessera {

// The patches of `within` are merged, neighbours of like colours first, until one region is left. Of the
// regions around the seed on the way, the one with the strongest outline, the larger of equals; or `region`
// (of patches of `within`, with the seed), where features hold nearly all of its outline, where none is
// stronger, or where colours differ too little along those outlines to hold anything.
//
// An outline's strength is the mean over its length of 1 where it is a feature and of how much the colours
// beside it differ elsewhere. The picture's border is a weak part of it. What `within` leaves out and is not
// connected to that border is a hole and does not count.
PatchSet betterHeld(const PatchMesh& mesh, const PatchColours& colours, const PatchSet& within,
                    PatchSet region, PatchId seed);

}  // namespace tessera
