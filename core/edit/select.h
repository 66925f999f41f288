// Selections by colour, and how a selection grows, shrinks and is outlined.
#pragma once

#include <vector>

#include "core/edit/patch_colours.h"
#include "core/edit/patch_set.h"

namespace tessera {

// Hidden and locked patches are in none of the results; floods pass through them.

struct WandOptions {
    double tolerance = .1;        // distance in OKLab from the seed's mean colour
    bool contiguous = true;       // else the whole picture is searched
    bool stopAtFeatures = false;  // a contiguous search does not cross features
};

// The patches whose mean colour is like the seed's; with the seed where it is selectable.
PatchSet wand(const PatchMesh& mesh, const PatchColours& colours, PatchId seed, const WandOptions& options);
PatchSet wand(const PatchMesh& mesh, PatchId seed, const WandOptions& options);

// The set with the patches that share an edge with it; without those that share an edge with others.
PatchSet grown(const PatchMesh& mesh, const PatchSet& set);
PatchSet shrunk(const PatchMesh& mesh, const PatchSet& set);

// The border of the set as closed loops of halfedges, each the side of a patch of the set beyond which there
// is none of it, in the direction in which they follow each other. Loops begin at their smallest halfedge and
// ascend by it.
std::vector<std::vector<HalfedgeId>> outline(const PatchMesh& mesh, const PatchSet& set);

}  // namespace tessera
