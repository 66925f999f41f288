// See mirror_buffer.h.
#include "render/mirror_buffer.h"

#include <algorithm>

namespace tessera::render {

std::vector<IndexRange> coalesced(std::vector<uint32_t>& indices, size_t count, size_t gap) {
    std::sort(indices.begin(), indices.end());
    std::vector<IndexRange> ranges;
    for (const uint32_t i : indices) {
        if (i >= count) break;
        if (ranges.empty() || i > ranges.back().end + gap)
            ranges.push_back({i, size_t(i) + 1});
        else
            ranges.back().end = std::max(ranges.back().end, size_t(i) + 1);
    }
    return ranges;
}

}  // namespace tessera::render
