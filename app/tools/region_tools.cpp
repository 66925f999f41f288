// See region_tools.h.
#include "app/tools/region_tools.h"

#include <array>

#include "core/edit/enclosed_region.h"

namespace tessera {

namespace {

// Of all patches: a shape that somebody means is rarely that large, a leak through a gap mostly is.
constexpr double kTooMany = .5;

}  // namespace

ToolOverlay SelectingTool::overlay() const {
    ToolOverlay overlay;
    overlay.lock = mLock;
    return overlay;
}

std::optional<OverlayLock> SelectingTool::lockAt(glm::dvec2 point) const {
    const auto hit = session().query().patchAt(point);
    if (!hit || !mesh().attributes(hit->patch).locked) return {};
    return OverlayLock{hit->patch, point};
}

void SelectingTool::hovered(const ToolEvent& event) {
    mLock = lockAt(event.point);
}

std::optional<PatchId> SelectingTool::patchClicked(const ToolEvent& event) {
    mLock = lockAt(event.point);
    if (mLock) {
        host().say(QObject::tr("This patch is locked. Unlock All, in the menu Patches, frees it."));
        return {};
    }
    const auto hit = session().query().patchAt(event.point);
    return hit ? std::optional(hit->patch) : std::nullopt;
}

void RegionTool::pressed(const ToolEvent& event) {
    SelectingTool::pressed(event);
    mBefore = session().selection().patches();
}

void RegionTool::select(const PatchSet& found, const ToolModifiers& modifiers) {
    session().selection().setPatches(combined(mBefore, found, selectModeOf(modifiers)));
}

void RegionTool::clicked(const ToolEvent& event) {
    const auto hit = patchClicked(event);
    select(hit ? selectableOf(mesh(), {*hit}) : PatchSet(), event.modifiers);
}

void RegionTool::selectPolygon(std::span<const glm::dvec2> polygon, const ToolModifiers& modifiers) {
    select(selectableOf(mesh(), session().query().patchesInPolygon(polygon)), modifiers);
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
    if (!hit || mesh().attributes(hit->patch).locked) return;
    // In the way of the modifiers, of what the first of the two clicks has left.
    pressed(event);
    const PatchSet found = enclosedByFeatures(mesh(), session().colours(), hit->patch, options().gapPx);
    select(found, event.modifiers);
    if (double(found.size()) > kTooMany * double(mesh().patchCount()))
        host().say(QObject::tr(
            "The features around this place have gaps, so most of the picture is selected. Close wider gaps "
            "in the tool's options, or take the wand, which keeps to colours."));
}

ToolOverlay SelectTool::overlay() const {
    ToolOverlay overlay = RegionTool::overlay();
    if (dragging()) overlay.marquee = mMarquee;
    return overlay;
}

void LassoTool::dragged(const ToolEvent& event) {
    if (glm::distance(mPolygon.back(), event.point) < event.pxPerScreenPx) return;
    mPolygon.push_back(event.point);
    selectPolygon(mPolygon, event.modifiers);
}

ToolOverlay LassoTool::overlay() const {
    ToolOverlay overlay = RegionTool::overlay();
    if (dragging()) overlay.lasso = mPolygon;
    return overlay;
}

void WandTool::clicked(const ToolEvent& event) {
    const auto hit = patchClicked(event);
    const PatchSet found = hit ? wand(mesh(), session().colours(), *hit, options().wand) : PatchSet();
    Selection& selection = session().selection();
    selection.setPatches(combined(selection.patches(), found, selectModeOf(event.modifiers)));
}

}  // namespace tessera
