// The edges of a picture by a detector that is no part of the method, for `tessera-cli bench`: what every
// method's features are measured against.
#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "core/image/image.h"

namespace tessera {

// Pixels in order, each an 8-neighbour of the one before; no pixel is in two chains.
using EdgeChain = std::vector<glm::ivec2>;

// OpenCV's Canny (Sobel 3 x 3, Euclidean norm) on the Rec. 601 luma of the picture's 8-bit values over white,
// first smoothed by a Gaussian of sigmaPx (0: not at all), linked into chains of at least minPixels pixels. A
// step of h levels has a gradient of 4 h in the unit of the thresholds. At a junction one chain goes on, the
// others end beside it.
std::vector<EdgeChain> referenceEdges(const Image& image, double sigmaPx, double low, double high,
                                      int minPixels);

// The length of the steps from pixel centre to pixel centre; 0 below two pixels.
double lengthPx(const EdgeChain& chain);

}  // namespace tessera
