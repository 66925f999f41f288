// The basis in which a mesh's splines have their values, and the way from it to the working space of Image.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tessera {

// Rgb is the working space itself. Opponent is a fixed orthonormal transform of it:
//   channel 0 = (R + G + B) / sqrt 3,  1 = (R - B) / sqrt 2,  2 = (R - 2 G + B) / sqrt 6;
// alpha, channel 3, is the same in both. So squared errors are equal in both bases, and detail of brightness,
// which is most of a photograph's, is in one channel.
enum class ColourBasis : uint8_t { Rgb, Opponent };

// Converts `count` values of each of the first three planes in place; nothing happens for Rgb. A value does
// not depend on its neighbours.
void toWorking(ColourBasis basis, float* const* planes, size_t count);
void fromWorking(ColourBasis basis, float* const* planes, size_t count);

}  // namespace tessera
