// Colours around a vertex: which patches agree there, and how a patch's colour at a corner is raised so that
// they go on to.
#pragma once

#include <array>
#include <vector>

#include "core/mesh/patch_mesh.h"

namespace tessera {

// Whether colours may jump across an edge: a feature or a colour break.
bool separatesColours(const PatchMesh& mesh, HalfedgeId h);

// The patches around the origin of `side` that are joined with the patch of `side` there, across edges that
// are neither features nor colour breaks; each by its side that leaves the vertex, that of `side` first.
std::vector<HalfedgeId> fanOf(const PatchMesh& mesh, HalfedgeId side);

// Values at the corners of a patch, of R, G and B premultiplied: planes of three.
using CornerValues = std::array<std::array<float, 3>, 3>;

// Adds what is linear between values at the corners. Along an edge that two patches share, both get the same
// where they get the same at its ends.
PatchSpline withCornersRaised(PatchSpline spline, ColourBasis basis, CornerValues values);

}  // namespace tessera
