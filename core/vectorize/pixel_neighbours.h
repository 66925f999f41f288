// The 8 neighbours of a pixel.
#pragma once

#include <array>
#include <glm/vec2.hpp>

namespace tessera {

// In order of positive rotation from +x; direct neighbours at even places.
constexpr std::array<glm::ivec2, 8> kNeighbours8{glm::ivec2(1, 0),  {1, 1},   {0, 1},  {-1, 1},
                                                 glm::ivec2(-1, 0), {-1, -1}, {0, -1}, {1, -1}};

}  // namespace tessera
