// Which part of a picture is looked at, and how large.
#pragma once

#include <glm/vec2.hpp>

#include "core/mesh/patch_mesh.h"

namespace tessera {

// Which part of the picture fills an output of width x height pixels: output pixel (i, j) has its centre at
// image point origin + ((i + .5) / scale.x, (j + .5) / scale.y).
struct View {
    glm::dvec2 origin{0, 0};  // image coordinates (px) of the output's upper left corner
    glm::dvec2 scale{1, 1};   // output pixels per image pixel
    int width = 0;
    int height = 0;
};

// The whole picture at `scale`, its output size rounded to whole pixels (at least 1 x 1).
View wholePicture(const PatchMesh& mesh, glm::dvec2 scale);

}  // namespace tessera
