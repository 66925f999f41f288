// Room between chains of features: parts too close to a more important chain, to the border or to themselves
// go, and blurs that reach over a neighbour shrink.
#pragma once

#include <stop_token>
#include <vector>

#include "core/vectorize/subpixel_features.h"

namespace tessera {

// What is left of the chains, at least minLengthPx long each. Near a junction chains may be close if they
// leave it in different directions.
std::vector<FeatureChain> separated(std::vector<FeatureChain> chains, int width, int height,
                                    double minLengthPx, const std::stop_token& stop);

// Limits each point's sigma to a third of the distance to the nearest point of another feature.
void limitBlur(std::vector<FeatureChain>& chains, const std::stop_token& stop);

}  // namespace tessera
