// See image.h.
#include "core/image/image.h"

#include <algorithm>
#include <cmath>

namespace tessera {

float bilinear(const Image& image, int c, double x, double y) {
    const double px = std::clamp(x - .5, 0.0, double(image.width() - 1));
    const double py = std::clamp(y - .5, 0.0, double(image.height() - 1));
    const int x0 = std::min(int(px), std::max(0, image.width() - 2));
    const int y0 = std::min(int(py), std::max(0, image.height() - 2));
    const int x1 = std::min(x0 + 1, image.width() - 1);
    const int y1 = std::min(y0 + 1, image.height() - 1);
    const double fx = px - x0;
    const double fy = py - y0;
    const double top = (1 - fx) * image.at(x0, y0, c) + fx * image.at(x1, y0, c);
    const double bottom = (1 - fx) * image.at(x0, y1, c) + fx * image.at(x1, y1, c);
    return float((1 - fy) * top + fy * bottom);
}

}  // namespace tessera
