// The nearest change of a patch's colours that needs no fit: affine in colour, and linear in place.
#pragma once

#include "core/edit/colour_fan.h"
#include "core/edit/site_planes.h"
#include "core/edit/spline_edit.h"

namespace tessera {

struct PlacedChange {
    AffineColour change;
    CornerValues corners{};  // added after it
    double mean = 0;         // what it is off, over the channels and sites
    double most = 0;

    // The one nearest to what makes `targets` of a patch's `colours` (R, G, B at all sites), near a guess.
    // What is left of them goes into `rest`, whose planes are filled up with zeros.
    static PlacedChange nearest(const AffineColour& guess, const SitePlanes& colours,
                                const SitePlanes& targets, SitePlanes& rest);
};

}  // namespace tessera
