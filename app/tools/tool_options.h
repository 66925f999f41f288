// The settings of all tools, as one value that a bar edits and tools read.
#pragma once

#include <glm/vec3.hpp>

#include "core/edit/brush.h"
#include "core/edit/select.h"

namespace tessera {

enum class ColourSource { Vector, Original };

// Colours gamma-encoded sRGB, not premultiplied.
struct ToolOptions {
    glm::dvec3 colour{.85, .45, .15};  // what brush, eyedropper and dragged colours share
    glm::dvec3 secondColour{1, 1, 1};  // the other end of gradients
    WandOptions wand;
    double gapPx = 32;  // narrower gaps of features do not let a double click through, image px
    ColourSource eyedropper = ColourSource::Vector;
    double brushRadiusPx = 16;  // image px
    double brushHardness = .5;
    double brushStrength = 1;
    bool brushKeepsShading = true;
    double gradientStrength = 1;
    double featherPx = 0;     // of recolourings of the selection
    bool allHandles = false;  // the direct-selection tool reaches handles that are not shown by selection
    bool refitAfterReshape = true;  // colours from the photo, where patches still show it
    bool wholeFeatures = true;      // the blur handle takes the feature up to its next junctions
};

}  // namespace tessera
