// Sets of patches: what a selection is.
#pragma once

#include <vector>

#include "core/mesh/patch_mesh.h"

namespace tessera {

// By ascending id, without repeats.
using PatchSet = std::vector<PatchId>;

// A set from patches in any order, with repeats.
PatchSet patchSet(std::vector<PatchId> patches);

bool contains(const PatchSet& set, PatchId p);
PatchSet united(const PatchSet& a, const PatchSet& b);
PatchSet subtracted(const PatchSet& a, const PatchSet& b);
PatchSet intersected(const PatchSet& a, const PatchSet& b);

// Whether tools may select the patch: it is neither hidden nor locked.
bool selectable(const PatchMesh& mesh, PatchId p);
PatchSet allSelectable(const PatchMesh& mesh);
PatchSet selectableOf(const PatchMesh& mesh, PatchSet set);  // of a set of living ones
// The selectable patches that are not in the set.
PatchSet inverted(const PatchMesh& mesh, const PatchSet& set);
// Those of the set that the mesh still has.
PatchSet alive(const PatchMesh& mesh, const PatchSet& set);
// Those of the set that edits may change: alive and not locked.
PatchSet editable(const PatchMesh& mesh, const PatchSet& set);
// By patch id, 1 for those of the set: for many questions.
std::vector<uint8_t> membership(const PatchMesh& mesh, const PatchSet& set);

}  // namespace tessera
