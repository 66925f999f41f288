// How chains of features meet: tips that continue each other become one chain, others end at a junction.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "core/vectorize/subpixel_features.h"

namespace tessera {

constexpr uint32_t kNoEnd = ~0U;

// End 2c is the first point of chain c, end 2c + 1 its last.
inline const FeaturePoint& endPoint(const std::vector<FeatureChain>& chains, uint32_t end) {
    const auto& points = chains[end / 2].points;
    return end % 2 ? points.back() : points.front();
}
// Arc length from the first point to each.
std::vector<double> arcLengths(const FeatureChain& chain);

// Unit vector out of the chain at its end, over about `spanPx` of it.
glm::dvec2 outward(const FeatureChain& chain, bool last, double spanPx = 3.5);

// Turns a chain around; its jumps change sign.
void reverse(FeatureChain& chain);

// The parts of at least 2 points that are left of a chain without some of its points; where it was cut they
// end in tips.
std::vector<FeatureChain> withoutPoints(FeatureChain chain, std::vector<bool> drop);

// Connects end e to end partner[e] (which must name e; kNoEnd: to none). A chain that closes on itself
// becomes a closed one. Gaps are filled with points on the straight line.
std::vector<FeatureChain> connect(std::vector<FeatureChain> chains, const std::vector<uint32_t>& partner);

// Connects tips within 4 px that point at each other.
std::vector<FeatureChain> joinTips(std::vector<FeatureChain> chains);

// Moves each tip that is within 2 px of another chain, or runs into it within 3 px, onto it, and cuts that
// chain there.
std::vector<FeatureChain> joinJunctions(std::vector<FeatureChain> chains);

// Names the ends anew by what meets there, after chains were dropped, and connects the two chains of a
// junction without others where one continues the other.
std::vector<FeatureChain> settleJunctions(std::vector<FeatureChain> chains);

// For each chain the number of its line: chains that continue each other through junctions are one, at each
// junction by pairs, the straightest first.
std::vector<uint32_t> throughLines(const std::vector<FeatureChain>& chains);

}  // namespace tessera
