// How a picture changes across its features: the width of the blur and the jump of the colours.
#pragma once

#include <stop_token>
#include <vector>

#include "core/image/image.h"
#include "core/vectorize/subpixel_features.h"

namespace tessera {

// Sets sigma, jump and contrast of all points by a least-squares fit of step * Phi(distance / sigma) to the
// pixels beside them, nearer to them than to other features, smoothed along the chains. The points' sigma is
// where the fit starts. Ends early, with points unfitted, where `stop` is asked for.
void fitProfiles(const Image& image, std::vector<FeatureChain>& chains, const std::stop_token& stop);

}  // namespace tessera
