// Edits of the connectivity: splitting edges and patches, merging vertices.
#pragma once

#include "core/base/result.h"
#include "core/edit/patch_set.h"
#include "core/edit/touched.h"
#include "core/mesh/bezier.h"

namespace tessera {

// All fail with Usage and a sentence for a person, and then change nothing. Parts inherit what is known of
// the whole (feature, blur, colour break, attributes). Touched::patches are those that look different or are
// new, and topology is set. Ids that go are never used again.

// Puts a vertex on an edge at t in (0, 1) along HalfedgeMesh::halfedge(e) and joins it to the corners
// opposite. The picture stays as it was but for the lattice and a level of colour.
Result<Touched> splitEdge(PatchMesh& mesh, EdgeId e, double t);

// Puts a vertex into a patch, at parameters inside it, and joins it to its corners. The picture stays
// likewise.
Result<Touched> splitPatch(PatchMesh& mesh, PatchId p, const Barycentric& at);

// Takes an edge away with the patches beside it: one end moves onto the other (a corner of the picture, the
// border, more features stay where they are). Fails where a patch would fold or is locked, or the picture's
// outline would change.
Result<Touched> mergeEdge(PatchMesh& mesh, EdgeId e);

// A set of patches of one mesh of a picture as patches of another one: patches that both have stay in or out;
// a new one is in where it lies in a patch that was.
PatchSet carriedOver(const PatchMesh& before, const PatchMesh& after, const PatchSet& set);

}  // namespace tessera
