// Curvilinear features at pixel resolution (paper section 4.1): Canny's edges, thinned, linked, free of
// T-junctions.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <stop_token>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "core/vectorize/settings.h"

namespace tessera {

// Detected pixels in order, each an 8-neighbour of the one before and of no other pixel of any chain. None
// lies on the outermost pixels of the picture.
struct PixelChain {
    std::vector<glm::ivec2> pixels;
    bool closed = false;
    // Whether the true discontinuity lies half a pixel off on the positive side of the chain's direction d,
    // that of the normal (-d.y, d.x), rather than on the negative one.
    bool onPositiveSide = false;

    bool operator==(const PixelChain&) const = default;
};

// Gradient of all channels at once (Di Zenzo 1986): magnitude is the square root of the larger eigenvalue of
// the sum of the channels' structure tensors, direction its eigenvector. Row by row, one value a pixel.
struct GradientField {
    int width = 0;
    int height = 0;
    std::vector<float> magnitude;
    std::vector<glm::vec2> direction;  // of unit length; its sign means nothing

    float at(int x, int y) const { return magnitude[size_t(y) * size_t(width) + size_t(x)]; }
};
// The work of this and the next functions ends early, with something unfinished, where `stop` is asked for.
GradientField diZenzoGradient(const Image& image, double sigmaPx, const std::stop_token& stop = {});

// One byte a pixel, 1 on edges: local maxima of the magnitude along its direction above `high`, and those
// above `low` that are connected to them (Canny 1986). Thresholds are absolute.
std::vector<uint8_t> cannyEdges(const GradientField& gradient, double low, double high,
                                const std::stop_token& stop = {});

// Thins a binary picture to lines of one pixel (Zhang and Suen 1984, with Lu and Wang's condition of 1986
// that spares diagonals), then removes the corner pixels of staircases.
void thin(std::vector<uint8_t>& edges, int width, int height, const std::stop_token& stop = {});

// Removes, at each pixel with more than two 8-neighbours, the weakest of them until two are left.
void removeJunctions(std::vector<uint8_t>& edges, const GradientField& gradient);

// Chains of at least minPixels pixels; open ones first, each set in raster order of their first pixels.
std::vector<PixelChain> linkChains(const std::vector<uint8_t>& edges, int width, int height, int minPixels);

// Sets onPositiveSide: the side with the larger sum of colour differences from the chain's pixels to one
// pixel off. One side for a whole chain: changes along it would put steps of a pixel into the feature, and
// each costs patches.
void chooseSide(PixelChain& chain, const Image& image);

// Stage "features", variant "canny": all of the above. Variant "none" finds nothing.
Result<std::vector<PixelChain>> detectFeatures(const Image& image, const VectorizeSettings& settings,
                                               StageReport& report, Progress& progress);

}  // namespace tessera
