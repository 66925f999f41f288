// See absorbed_lists.h.
#include "core/vectorize/absorbed_lists.h"

#include <algorithm>
#include <unordered_map>

namespace tessera {

namespace {

// Loops may double a list at each contraction; past this length it is pruned at once instead of at the end.
constexpr uint32_t kLongest = 4096;
constexpr uint32_t kFlat = 0;  // the length of a node that stands for a flat list
// What a flat list adds to the length of those that hold it: not its own length, or a path that is long
// without loops would be pruned, and kept, anew at each contraction.
constexpr uint32_t kFlatShare = 64;

uint32_t packed(AbsorbedLists::List list) {
    return list.node << 1 | uint32_t(list.backwards);
}
AbsorbedLists::List unpacked(uint32_t bits) {
    return {bits >> 1, (bits & 1) != 0};
}

}  // namespace

AbsorbedLists::List AbsorbedLists::pair(VertexId from, VertexId to) {
    mNodes.push_back({from.index, to.index, 2});
    return {uint32_t(mNodes.size() - 1), false};
}

AbsorbedLists::List AbsorbedLists::joined(List first, List second) {
    const auto length = [&](List list) {
        const uint32_t own = mNodes[list.node].length;
        return own == kFlat ? kFlatShare : own;
    };
    const List list{uint32_t(mNodes.size()), false};
    mNodes.push_back({packed(first), packed(second), length(first) + length(second) - 1});
    if (mNodes.back().length > kLongest) {
        std::vector<VertexId> path = prunedPath(list);
        mNodes.back() = {uint32_t(mFlat.size()), 0, kFlat};
        mFlat.push_back(std::move(path));
    }
    return list;
}

std::vector<VertexId> AbsorbedLists::prunedPath(List list) const {
    std::vector<VertexId> path;
    std::unordered_map<VertexId, size_t> place;
    const auto visit = [&](VertexId v) {
        const auto found = place.find(v);
        if (found == place.end()) {
            place.emplace(v, path.size());
            path.push_back(v);
            return;
        }
        while (path.size() > found->second + 1) {
            place.erase(path.back());
            path.pop_back();
        }
    };
    std::vector<List> open{list};
    while (!open.empty()) {
        const List top = open.back();
        open.pop_back();
        const Node& node = mNodes[top.node];
        if (node.length == 2) {
            visit(VertexId(top.backwards ? node.second : node.first));
            visit(VertexId(top.backwards ? node.first : node.second));
        } else if (node.length == kFlat) {
            const auto& flat = mFlat[node.first];
            if (top.backwards)
                std::for_each(flat.rbegin(), flat.rend(), visit);
            else
                std::for_each(flat.begin(), flat.end(), visit);
        } else {
            const List first = unpacked(node.first), second = unpacked(node.second);
            open.push_back(top.backwards ? first.reversed() : second);
            open.push_back(top.backwards ? second.reversed() : first);
        }
    }
    return path;
}

}  // namespace tessera
