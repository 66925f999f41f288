// Chains of features as a planar network of cubic segments, which a triangulation can take as it is.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "core/mesh/bezier.h"
#include "core/mesh/lattice.h"
#include "core/vectorize/settings.h"
#include "core/vectorize/subpixel_features.h"

namespace tessera {

enum class FeatureNodeKind : uint8_t { Tip, Smooth, Corner, Junction, Border };

struct FeatureNode {
    LatticePoint position;
    FeatureNodeKind kind = FeatureNodeKind::Tip;

    bool operator==(const FeatureNode&) const = default;
};

// One cubic, from node `from` to node `to`: points first..last of its chain, in steps of one, wrapping where
// the chain is closed. The chain's points at nodes lie exactly on them.
struct FeatureSegment {
    uint32_t from = 0, to = 0;
    uint32_t chain = 0, first = 0, last = 0;
    std::array<LatticePoint, 2> inner;
    std::array<float, 2> sigma{};  // of the blur at both ends, px

    bool operator==(const FeatureSegment&) const = default;
};

struct FeatureNetwork {
    int width = 0, height = 0;  // of the picture
    std::vector<FeatureChain> chains;
    std::vector<FeatureNode> nodes;
    std::vector<FeatureSegment> segments;  // those of a chain one after the other

    bool operator==(const FeatureNetwork&) const = default;
};

BezierCurve curveOf(const FeatureNetwork& network, const FeatureSegment& segment);

// The network of `chains`, of which parts are left out where the network would not be as networkViolations
// asks. Segments are as long as settings.featureTolerancePx allows, about 4 to 40 px; sigmas are at most a
// third of the distance to the next feature. Ends early, with chains missing, where `stop` is asked for.
FeatureNetwork buildFeatureNetwork(std::vector<FeatureChain> chains, int width, int height,
                                   const VectorizeSettings& settings, const std::stop_token& stop = {});

// The cubic for points first..last, whose end tangents are those of the chain (so that smooth joins are G1),
// or none if a point is further than tolerancePx from it or it turns by more than 75 degrees in all.
std::optional<BezierCurve> fitChainPart(const FeatureChain& chain, uint32_t first, uint32_t last,
                                        double tolerancePx);

// What a network must not have: nodes outside the picture, Border nodes off its border, nodes closer than
// 1 px to each other; curves or chords that cross; curves closer than 1 px further than 4 px from a common
// node, or at less than 15 degrees in one; nodes or chords of others between a segment's curve and its
// chord. `weaker` is the segment to give up, `other` the second one (or the same); splitting `weaker` may
// help where mayNeedSplit.
struct NetworkViolation {
    std::string what;
    uint32_t weaker = 0;
    uint32_t other = 0;
    bool mayNeedSplit = false;
};
std::vector<NetworkViolation> networkViolations(const FeatureNetwork& network);

}  // namespace tessera
