// Curvilinear features at subpixel position with the width of their blur, over several scales (after
// Lindeberg 1998, Elder 1999), and the choice of those that matter most.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "core/mesh/tps.h"
#include "core/vectorize/settings.h"

namespace tessera {

// Sigma of a feature's blur, in px: the least and the most that is told apart.
constexpr float kLeastBlurPx = .1F, kMostBlurPx = 4;

// Image coordinates in px. The blur is that of the picture before its pixels averaged it over their squares:
// the standard deviation in px of the Gaussian that makes a step what is seen. jump is the colour on the
// positive side of the chain's direction d, that of the normal (-d.y, d.x), minus that on the other, channel
// by channel; contrast is its Euclidean norm.
struct FeaturePoint {
    glm::dvec2 position{};
    float sigma = kLeastBlurPx;
    float contrast = 0;
    std::array<float, kMaxChannels> jump{};

    bool operator==(const FeaturePoint&) const = default;
};

enum class ChainEnd : uint8_t { Tip, Junction, Border };

// At least 2 points (3 where closed), at most about 1 px apart; a closed chain does not repeat its first and
// has no ends. Chains meet only at their ends, where the positions are the same to the bit; an end that
// meets no other is a Tip, or Border where it lies on the picture's border.
struct FeatureChain {
    std::vector<FeaturePoint> points;
    bool closed = false;
    std::array<ChainEnd, 2> ends{ChainEnd::Tip, ChainEnd::Tip};
    std::vector<uint32_t> corners;  // points where the direction turns by more than settings.cornerDegrees
    // The integral along the chain of the cube of the gradient at a scale at which fine texture is gone: what
    // counts is steep from some distance, and long.
    double importance = 0;

    bool operator==(const FeatureChain&) const = default;
};

double lengthPx(const FeatureChain& chain);

// Stage "features", variant "subpixel". Open chains that meet nothing are at least settings.minChainPixels
// long. The same chains whatever the number of threads.
Result<std::vector<FeatureChain>> detectSubpixelFeatures(const Image& image,
                                                         const VectorizeSettings& settings,
                                                         StageReport& report, Progress& progress);

// About how many cubics a chain takes: by its length and by how much it turns.
double segmentsNeeded(const FeatureChain& chain);

// The chains with the most importance for the segments that they need, as many as segmentBudget holds, in
// their order; each is judged by the whole line that it is part of. Chains that continue each other where all
// others of a junction are gone become one.
std::vector<FeatureChain> selectFeatures(std::vector<FeatureChain> chains, double segmentBudget);

}  // namespace tessera
