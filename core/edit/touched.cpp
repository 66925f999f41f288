// See touched.h.
#include "core/edit/touched.h"

#include <algorithm>

namespace tessera {

namespace {

template <class IdType>
void makeSet(std::vector<IdType>& ids) {
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
}

template <class IdType>
std::vector<IdType> unitedIds(const std::vector<IdType>& a, const std::vector<IdType>& b) {
    std::vector<IdType> all;
    std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(all));
    return all;
}

}  // namespace

Touched touchedOf(std::vector<VertexId> vertices, std::vector<EdgeId> edges, std::vector<PatchId> patches) {
    makeSet(vertices);
    makeSet(edges);
    makeSet(patches);
    return {std::move(vertices), std::move(edges), std::move(patches), false};
}

Touched united(const Touched& a, const Touched& b) {
    return {unitedIds(a.vertices, b.vertices), unitedIds(a.edges, b.edges), unitedIds(a.patches, b.patches),
            a.topology || b.topology};
}

}  // namespace tessera
