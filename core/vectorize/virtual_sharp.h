// The picture with the blur of its features taken out (after Elder 1999): what the patches are fitted to,
// since the blur is added again when they are drawn.
#pragma once

#include <stop_token>

#include "core/image/image.h"
#include "core/vectorize/feature_network.h"

namespace tessera {

// `image` is the network's picture, or that enlarged by a whole factor with the blur of its pixels' squares.
// Adds to each pixel near a segment's curve what the blur took from its side: blurShare(d / s) times the
// jump, where d is the distance of the pixel's centre from the curve and s^2 the blur's variance and that of
// a square of 1 px. This fades out toward tips and junctions (blurFade), where sides are not defined. The
// result has steps at the curves and nothing of the blur. Ends early, with rows missing, where `stop` is
// asked for.
Image virtualSharp(const Image& image, const FeatureNetwork& network, const std::stop_token& stop = {});

}  // namespace tessera
