// Points of chains by place: which of them lie within a few px.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/vec2.hpp>
#include <unordered_map>
#include <vector>

#include "core/vectorize/subpixel_features.h"

namespace tessera {

class PointGrid {
  public:
    struct Entry {
        uint32_t chain;
        uint32_t point;
    };

    explicit PointGrid(const std::vector<FeatureChain>& chains) {
        for (uint32_t c = 0; c < chains.size(); ++c) add(chains[c], c);
    }
    void add(const FeatureChain& chain, uint32_t number) {
        for (uint32_t i = 0; i < chain.points.size(); ++i)
            mCells[key(cell(chain.points[i].position.x), cell(chain.points[i].position.y))].push_back(
                {number, i});
    }

    // Calls visit(Entry) for at least all points within radiusPx of `p`, in a fixed order.
    template <class Visit>
    void near(glm::dvec2 p, double radiusPx, Visit&& visit) const {
        for (int y = cell(p.y - radiusPx); y <= cell(p.y + radiusPx); ++y)
            for (int x = cell(p.x - radiusPx); x <= cell(p.x + radiusPx); ++x)
                if (const auto at = mCells.find(key(x, y)); at != mCells.end())
                    for (const Entry& entry : at->second) visit(entry);
    }

  private:
    static constexpr double kCellPx = 4;
    static int cell(double v) { return int(std::floor(v / kCellPx)); }
    static uint64_t key(int x, int y) { return uint64_t(uint32_t(y)) << 32 | uint32_t(x); }

    std::unordered_map<uint64_t, std::vector<Entry>> mCells;
};

}  // namespace tessera
