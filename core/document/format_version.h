// The version of the format that is written; all up to it are read (FORMAT.md).
#pragma once

#include <cstdint>

namespace tessera {

constexpr uint32_t kFormatVersion = 4;
// From this version on the step of a factor follows from where the sites lie, not from its norm.
constexpr uint32_t kForetoldNormsVersion = 4;

}  // namespace tessera
