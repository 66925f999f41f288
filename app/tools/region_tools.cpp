// See region_tools.h.
#include "app/tools/region_tools.h"

#include <array>

#include "core/edit/select.h"

namespace tessera {

namespace {

constexpr double kNearlyAll = .75;

PatchSet selectableOnly(const PatchMesh& mesh, PatchSet set) {
    std::erase_if(set, [&](PatchId p) { return !selectable(mesh, p); });
    return set;
}

}  // namespace

void RegionTool::select(const PatchSet& found, const ToolModifiers& modifiers) {
    session().selection().setPatches(combined(mBefore, found, selectModeOf(modifiers)));
}

void RegionTool::clicked(const ToolEvent& event) {
    const auto hit = session().query().patchAt(event.point);
    select(hit ? selectableOnly(mesh(), {hit->patch}) : PatchSet(), event.modifiers);
}

void RegionTool::selectPolygon(std::span<const glm::dvec2> polygon, const ToolModifiers& modifiers) {
    select(selectableOnly(mesh(), session().query().patchesInPolygon(polygon)), modifiers);
}

void RegionTool::abandoned() {
    session().selection().setPatches(mBefore);
}

void SelectTool::dragged(const ToolEvent& event) {
    mMarquee = {glm::min(start().point, event.point), glm::max(start().point, event.point)};
    const std::array corners{mMarquee.min, glm::dvec2(mMarquee.max.x, mMarquee.min.y), mMarquee.max,
                             glm::dvec2(mMarquee.min.x, mMarquee.max.y)};
    selectPolygon(corners, event.modifiers);
}

void SelectTool::doubleClick(const ToolEvent& event) {
    const auto hit = session().query().patchAt(event.point);
    if (!hit) return;
    // In the way of the modifiers, of what the first of the two clicks has left.
    pressed(event);
    const PatchSet found = enclosedByFeatures(mesh(), hit->patch);
    select(found, event.modifiers);
    if (double(found.size()) > kNearlyAll * double(mesh().patchCount()))
        host().say(
            QObject::tr("The features around this place have gaps, so nearly everything is selected. "
                        "The wand with “Stop at features” keeps to colours too."));
}

ToolOverlay SelectTool::overlay() const {
    ToolOverlay overlay;
    if (dragging()) overlay.marquee = mMarquee;
    return overlay;
}

void LassoTool::dragged(const ToolEvent& event) {
    if (glm::distance(mPolygon.back(), event.point) < event.pxPerScreenPx) return;
    mPolygon.push_back(event.point);
    selectPolygon(mPolygon, event.modifiers);
}

ToolOverlay LassoTool::overlay() const {
    ToolOverlay overlay;
    if (dragging()) overlay.lasso = mPolygon;
    return overlay;
}

void WandTool::clicked(const ToolEvent& event) {
    const auto hit = session().query().patchAt(event.point);
    const PatchSet found = hit ? wand(mesh(), session().colours(), hit->patch, options().wand) : PatchSet();
    Selection& selection = session().selection();
    selection.setPatches(combined(selection.patches(), found, selectModeOf(event.modifiers)));
}

}  // namespace tessera
