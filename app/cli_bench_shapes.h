// Pictures whose every detail is known, for the x4 test: shapes with sharp and smooth borders, drawn from
// formulas.
#pragma once

#include <string>
#include <vector>

#include "core/image/image.h"

namespace tessera::cli {

constexpr int kShapeSidePx = 512;
constexpr int kShapeSamplesPerSide = 16;

const std::vector<std::string>& shapeNames();

// The shape of that name, kShapeSidePx square; a pixel is the mean of kShapeSamplesPerSide squared samples.
Image drawShape(const std::string& name);

}  // namespace tessera::cli
