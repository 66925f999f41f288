// Where in a view features are blurred: so that the many other pixels are shaded by a program without blur.
#pragma once

#include <glm/vec4.hpp>
#include <vector>

#include "core/mesh/edge_blur.h"
#include "core/mesh/view.h"

namespace tessera::render {

// Rectangles of the view's pixels (x0, y0, x1, y1), rows from the top, that cover it once: first the `plain`
// ones, none of whose pixels has a point within reach of a blurred feature; then the others.
struct BlurTiles {
    std::vector<glm::ivec4> rects;
    size_t plain = 0;
};

BlurTiles blurTiles(const EdgeBlur& blur, const View& view);

}  // namespace tessera::render
