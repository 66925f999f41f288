// Least-squares fits of splines to values at all sites. What the functions of the sites have in common at the
// sites themselves is the same for all patches, so that a fit looks up its normal equations.
#pragma once

#include <cstdint>
#include <vector>

#include "core/edit/site_planes.h"
#include "core/mesh/tps.h"

namespace tessera {

// What a fit may be off on the weighted mean of the channels and sites.
constexpr double kFitTolerance = .5 / 255;

// The spline with values at the sites added, channel by channel in its own basis, as nearly as its sites can:
// with the first of them where those do, with further ones where all of them are off by more than
// kFitTolerance. Only sites that begin with the corners can be added to; of a spline that has terms at others
// all is fitted anew.
PatchSpline withAdded(const PatchSpline& spline, int channels, const SitePlanes& values);

// A spline with the sites of another, for values at the sites.
PatchSpline fittedLike(const PatchSpline& like, int channels, const SitePlanes& values);

// The places among the sites that are nearest to the default centres, the corners first.
std::vector<uint8_t> usualSites();

}  // namespace tessera
