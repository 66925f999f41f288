// See colour_tools.h.
#include "app/tools/colour_tools.h"

#include <algorithm>

#include "app/tools/colour_at.h"
#include "core/edit/drag_colour.h"

namespace tessera {

void EyedropperTool::hovered(const ToolEvent& event) {
    ColourSource source = event.onPhoto ? ColourSource::Original : options().eyedropper;
    if (event.modifiers.alt)
        source = source == ColourSource::Vector ? ColourSource::Original : ColourSource::Vector;
    const auto colour = colourAt(session(), event.point, source);
    mSwatch = colour ? std::optional(OverlaySwatch{event.point, *colour}) : std::nullopt;
}

void EyedropperTool::dropped(const ToolEvent& event) {
    if (!mSwatch) return;
    ToolOptions changed = options();
    changed.colour = glm::clamp(mSwatch->colour, 0., 1.);
    host().setOptions(changed);
    const PatchSet& selected = session().selection().patches();
    if (!event.modifiers.shift || selected.empty()) return;
    const Result<Touched> done = applyEdit(session(), QObject::tr("Replace Colour"), [&](PatchMesh& mesh) {
        return recolour(mesh, selected, ReplaceColour{changed.colour}, {changed.featherPx});
    });
    if (!done) host().say(QString::fromStdString(done.error().message));
}

ToolOverlay EyedropperTool::overlay() const {
    ToolOverlay overlay;
    overlay.swatch = mSwatch;
    return overlay;
}

void BrushTool::dragStarted(const ToolEvent&) {
    mStroke.clear();
    if (!begin(mEdit, QObject::tr("Brush"))) return;
    const ToolOptions& o = options();
    mPainting.emplace(mEdit->start(), session().query(),
                      BrushOptions{.radiusPx = o.brushRadiusPx,
                                   .hardness = o.brushHardness,
                                   .colour = o.colour,
                                   .strength = o.brushStrength,
                                   .keepShading = o.brushKeepsShading});
}

void BrushTool::dragged(const ToolEvent& event) {
    mPointer = event.point;
    const ToolOptions& o = options();
    // Points closer than what the brush can show add nothing but work.
    const double step = std::max(.1 * o.brushRadiusPx, event.pxPerScreenPx);
    if (!mEdit || (!mStroke.empty() && glm::distance(mStroke.back(), event.point) < step)) return;
    mStroke.push_back(event.point);
    report(mEdit->preview([&](PatchMesh& mesh) { return mPainting->draw(mesh, mStroke); }));
}

void BrushTool::dropped(const ToolEvent&) {
    if (mEdit) mEdit->commit();
    abandoned();
}

ToolOverlay BrushTool::overlay() const {
    ToolOverlay overlay;
    const ToolOptions& o = options();
    if (mPointer) overlay.ring = OverlayRing{*mPointer, o.brushRadiusPx, o.brushHardness * o.brushRadiusPx};
    return overlay;
}

void DragColourTool::lay(glm::dvec2 point, glm::dvec3 colour) {
    const auto hit = session().query().patchAt(point);
    if (!mEdit || !hit) return;
    report(mEdit->preview([&](PatchMesh& mesh) { return dragColour(mesh, hit->patch, hit->at, colour); }));
}

void DragColourTool::clicked(const ToolEvent& event) {
    begin(mEdit, QObject::tr("Edit Colour"));
    lay(event.point, options().colour);
    dropped(event);
}

void DragColourTool::dragStarted(const ToolEvent&) {
    const auto colour = colourAt(session(), start().point, ColourSource::Vector);
    if (!colour) return;
    mColour = *colour;
    begin(mEdit, QObject::tr("Drag Colour"));
}

void DragColourTool::dragged(const ToolEvent& event) {
    mPointer = event.point;
    lay(event.point, mColour);
}

void DragColourTool::dropped(const ToolEvent&) {
    if (mEdit) mEdit->commit();
    mEdit.reset();
}

void DragColourTool::abandoned() {
    mEdit.reset();
}

ToolOverlay DragColourTool::overlay() const {
    ToolOverlay overlay;
    if (mEdit) overlay.swatch = OverlaySwatch{mPointer, mColour};
    return overlay;
}

void GradientTool::clicked(const ToolEvent&) {
    if (session().selection().patches().empty())
        host().say(QObject::tr("Select the patches first; then drag the gradient's line across them."));
}

void GradientTool::dragStarted(const ToolEvent& event) {
    clicked(event);
    if (session().selection().patches().empty() || !mayBegin()) return;
    mGesture.emplace(session(), QObject::tr("Gradient"), RecolourOptions{.featherPx = options().featherPx});
}

void GradientTool::dragged(const ToolEvent& event) {
    glm::dvec2 offset = event.point - start().point;
    if (event.modifiers.shift) offset = constrainedTo45(offset);
    mLine = {start().point, start().point + offset};
    if (!mGesture || mLine.from == mLine.to) return;
    const ToolOptions& o = options();
    mGesture->show(GradientRecolour{mLine.from, mLine.to, o.colour, o.secondColour, o.gradientStrength});
}

void GradientTool::dropped(const ToolEvent&) {
    if (mGesture) mGesture->commit(host().finish());
    mGesture.reset();
}

void GradientTool::abandoned() {
    mGesture.reset();
}

ToolOverlay GradientTool::overlay() const {
    ToolOverlay overlay;
    if (mGesture && dragging())
        overlay.gradient = OverlayGradient{mLine, options().colour, options().secondColour};
    return overlay;
}

}  // namespace tessera
