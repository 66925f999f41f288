// How soft a feature may be made: as far as the next one leaves it room.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/mesh/patch_query.h"

namespace tessera {

// By feature, the sigmas (px) at both ends of its curve that its blur can have: at most kWidestBlurPx; a
// third of the distance to the next feature, as where features are found (feature_separation.h), so that it
// does not reach over that; and so much of the way to the nearest tip or junction that it has not begun to
// fade out there (kBlurFade), or wider would be sharper. What can be reached along features by a way of
// little more than three times the distance is no next one.
std::vector<std::array<double, 2>> blurRoom(const PatchQuery& query, std::span<const EdgeId> features);

}  // namespace tessera
