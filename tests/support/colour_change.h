// How much of an edit is seen.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "core/edit/patch_set.h"
#include "core/export/rasterize.h"
#include "core/mesh/patch_query.h"

namespace tessera::testing {

// The mean change of a colour between two states of a picture, in levels of 255, over the pixels of `patches`
// of the later one at twice the size.
inline double meanColourChange(const PatchMesh& before, const PatchMesh& after, const PatchSet& patches) {
    if (patches.empty()) return 0;
    Rect box = controlBounds(after, patches.front());
    for (const PatchId p : patches) {
        const Rect own = controlBounds(after, p);
        box = {glm::min(box.min, own.min), glm::max(box.max, own.max)};
    }
    View view;
    view.scale = {2, 2};
    view.origin = glm::floor(box.min);
    view.width = int(std::ceil(2 * (box.max.x - view.origin.x)));
    view.height = int(std::ceil(2 * (box.max.y - view.origin.y)));
    const auto one = rasterize(before, view), other = rasterize(after, view);
    if (!one || !other) return HUGE_VAL;
    const auto owners = locatePixels(after, view);
    double sum = 0;
    size_t count = 0;
    for (size_t i = 0; i < owners.size(); ++i) {
        if (!owners[i].patch.valid() || !contains(patches, owners[i].patch)) continue;
        for (int c = 0; c < after.channels(); ++c, ++count)
            sum += std::abs(double(one->plane(c)[i]) - double(other->plane(c)[i]));
    }
    return count > 0 ? 255 * sum / double(count) : 0;
}

}  // namespace tessera::testing
