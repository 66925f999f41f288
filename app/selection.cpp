// See selection.h.
#include "app/selection.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/edit/split_merge.h"

namespace tessera {

namespace {

template <class T>
std::vector<T> sorted(std::vector<T> values) {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
    return values;
}

template <class Id>
bool has(const HalfedgeMesh& connectivity, Id id, size_t capacity) {
    return id.index < capacity && connectivity.alive(id);
}

std::array<VertexId, 2> endsOf(const HalfedgeMesh& connectivity, EdgeId e) {
    const HalfedgeId h = HalfedgeMesh::halfedge(e);
    return {connectivity.origin(h), connectivity.target(h)};
}

// The curves of `before` in `after`; both halves of one that was split.
std::vector<EdgeId> followed(const HalfedgeMesh& before, const HalfedgeMesh& after,
                             const std::vector<EdgeId>& curves) {
    std::vector<EdgeId> result;
    for (const EdgeId e : curves) {
        if (!has(after, e, after.edgeCapacity())) continue;
        result.push_back(e);
        const auto was = endsOf(before, e), is = endsOf(after, e);
        for (const size_t end : {0, 1}) {
            if (is[end] == was[end] || is[end].index < before.vertexCapacity()) continue;
            const HalfedgeId rest = after.find(is[end], was[end]);
            if (rest.valid()) result.push_back(HalfedgeMesh::edge(rest));
        }
    }
    return result;
}

}  // namespace

PatchSet combined(const PatchSet& set, const PatchSet& found, SelectMode mode) {
    switch (mode) {
        case SelectMode::Replace:
            return found;
        case SelectMode::Add:
            return united(set, found);
        case SelectMode::Subtract:
            return subtracted(set, found);
        case SelectMode::Intersect:
            return intersected(set, found);
    }
    return set;
}

void Selection::setPatches(PatchSet patches) {
    set(sorted(std::move(patches)), mPoints, mCurves);
}

void Selection::setShape(std::vector<ControlPointRef> points, std::vector<EdgeId> curves) {
    set(mPatches, sorted(std::move(points)), sorted(std::move(curves)));
}

void Selection::clear() {
    set({}, {}, {});
}

void Selection::follow(const PatchMesh& before, const PatchMesh& after, const Change& change) {
    if (change.replaced) return clear();
    if (!change.touched.topology || empty()) return;
    std::vector<ControlPointRef> points = mPoints;
    std::erase_if(points, [&](const ControlPointRef& point) { return !alive(after, point); });
    set(carriedOver(before, after, mPatches), std::move(points),
        sorted(followed(before.connectivity(), after.connectivity(), mCurves)));
}

void Selection::set(PatchSet patches, std::vector<ControlPointRef> points, std::vector<EdgeId> curves) {
    if (patches == mPatches && points == mPoints && curves == mCurves) return;
    mPatches = std::move(patches);
    mPoints = std::move(points);
    mCurves = std::move(curves);
    emit changed();
}

}  // namespace tessera
