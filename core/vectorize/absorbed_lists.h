// The absorbed lists of edge contraction (paper section 4.2, Fig. 7): which original vertices each edge's
// path runs through. One list is appended to several others at each contraction, so lists are kept as shared
// concatenations.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/ids.h"

namespace tessera {

class AbsorbedLists {
  public:
    // A list, read forwards or backwards.
    struct List {
        uint32_t node = 0;
        bool backwards = false;

        List reversed() const { return {node, !backwards}; }
    };

    // The list (from, to) of an edge that has absorbed nothing.
    List pair(VertexId from, VertexId to);
    // `first` followed by `second`, which begins where the first ends; the common vertex stands once.
    List joined(List first, List second);

    // The path of a list, pruned of loops and of branches (a branch goes out and comes back through the same
    // vertex): where the path returns to a vertex, everything since then is left out.
    std::vector<VertexId> prunedPath(List list) const;

  private:
    // A pair of vertices where `length` is 2, else two lists with their direction in the lowest bit. A flat
    // list counts with a fixed length.
    struct Node {
        uint32_t first;
        uint32_t second;
        uint32_t length;
    };

    std::vector<Node> mNodes;
    std::vector<std::vector<VertexId>>
        mFlat;  // long lists, pruned on the way; nodes with kFlat refer to them
};

}  // namespace tessera
