// See selection.h.
#include "app/selection.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/mesh/patch_query.h"

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

PatchSet remapped(const PatchMesh& before, const PatchMesh& after, const PatchSet& set) {
    std::vector<bool> member(before.connectivity().faceCapacity());
    for (const PatchId p : set) member[p.index] = true;
    std::optional<PatchQuery> query;  // where there is a new patch
    PatchSet result;
    after.forEachPatch([&](PatchId p) {
        std::optional<PatchId> was;
        if (has(before.connectivity(), p, member.size())) {
            was = p;
        } else {
            if (!query) query.emplace(before);
            constexpr Barycentric kCentre(1. / 3, 1. / 3, 1. / 3);
            const glm::dvec2 centre = evaluate(toPixels(after.controlPoints(p)), kCentre);
            if (const auto hit = query->patchAt(centre)) was = hit->patch;
        }
        if (was && member[was->index]) result.push_back(p);
    });
    return result;
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
    std::vector<EdgeId> curves = mCurves;
    const HalfedgeMesh& connectivity = after.connectivity();
    std::erase_if(curves, [&](EdgeId e) { return !has(connectivity, e, connectivity.edgeCapacity()); });
    set(mPatches.empty() ? PatchSet() : remapped(before, after, mPatches), std::move(points),
        std::move(curves));
}

void Selection::set(PatchSet patches, std::vector<ControlPointRef> points, std::vector<EdgeId> curves) {
    if (patches == mPatches && points == mPoints && curves == mCurves) return;
    mPatches = std::move(patches);
    mPoints = std::move(points);
    mCurves = std::move(curves);
    emit changed();
}

}  // namespace tessera
