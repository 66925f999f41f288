// Shapes with a known blur, as a camera would see them: convolved with a Gaussian, averaged over pixels.
#pragma once

#include <cmath>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "core/image/image.h"

namespace tessera {

using Colour = glm::dvec3;

// The picture of `colourAt`, which is also asked outside of it. By kFine x kFine samples a pixel, so places
// are exact to a few thousandths of a pixel once sigma is .3 or more.
inline Image blurredShapes(int width, int height, double sigmaPx,
                           const std::function<Colour(glm::dvec2)>& colourAt) {
    constexpr int kFine = 8;
    const int margin = int(std::ceil(4 * sigmaPx)) + 1;
    const int w = (width + 2 * margin) * kFine, h = (height + 2 * margin) * kFine;
    const int radius = int(std::ceil(4 * sigmaPx * kFine));
    // Gaussian and box in one kernel, so that each pixel is one sum along x and one along y.
    const int reach = radius + kFine / 2;
    std::vector<double> kernel(size_t(2 * reach), 0);
    double total = 0;
    for (int i = 0; i < 2 * reach; ++i)
        for (int k = 0; k < kFine; ++k) {
            const double d = (i + .5 - reach) - (k + .5 - .5 * kFine);
            const double g = std::exp(-.5 * d * d / (sigmaPx * sigmaPx * kFine * kFine));
            kernel[size_t(i)] += g;
            total += g;
        }
    for (double& k : kernel) k /= total;
    std::vector<Colour> along(size_t(width) * size_t(h));
    std::vector<Colour> row(static_cast<size_t>(w));
    for (int y = 0; y < h; ++y) {
        for (int x = 0; x < w; ++x)
            row[size_t(x)] = colourAt({(x + .5) / kFine - margin, (y + .5) / kFine - margin});
        for (int x = 0; x < width; ++x) {
            const int first = (x + margin) * kFine + kFine / 2 - reach;
            Colour sum(0);
            for (int i = 0; i < 2 * reach; ++i) sum += kernel[size_t(i)] * row[size_t(first + i)];
            along[size_t(y) * size_t(width) + size_t(x)] = sum;
        }
    }
    Image image(width, height, 3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const int first = (y + margin) * kFine + kFine / 2 - reach;
            Colour sum(0);
            for (int i = 0; i < 2 * reach; ++i)
                sum += kernel[size_t(i)] * along[size_t(first + i) * size_t(width) + size_t(x)];
            for (int c = 0; c < 3; ++c) image.at(x, y, c) = float(sum[c]);
        }
    return image;
}

inline Image blurredDisc(int size, glm::dvec2 centre, double radius, double sigmaPx,
                         Colour inside = Colour(.8, .7, .6), Colour outside = Colour(.2, .2, .3)) {
    return blurredShapes(size, size, sigmaPx, [=](glm::dvec2 p) {
        return std::hypot(p.x - centre.x, p.y - centre.y) < radius ? inside : outside;
    });
}

}  // namespace tessera
