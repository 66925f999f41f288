// See view.h.
#include "core/mesh/view.h"

#include <algorithm>
#include <cmath>

namespace tessera {

View wholePicture(const PatchMesh& mesh, glm::dvec2 scale) {
    View view;
    view.scale = scale;
    view.width = std::max(1, int(std::lround(mesh.width() * scale.x)));
    view.height = std::max(1, int(std::lround(mesh.height() * scale.y)));
    return view;
}

}  // namespace tessera
