// See direct_tool.h.
#include "app/tools/direct_tool.h"

#include <algorithm>

#include "app/tools/photo_patches.h"
#include "core/edit/refit.h"

namespace tessera {

namespace {

// A refit is a least squares over whole patches: beyond this many a release would be felt as a pause.
constexpr size_t kMostRefitted = 60;

glm::dvec2 pixelPosition(const PatchMesh& mesh, const ControlPointRef& point) {
    return toPixels(position(mesh, point));
}

bool isVertex(const ControlPointRef& point) {
    return point.kind == ControlPointHit::Kind::Vertex;
}

// In or out, whichever it was not.
template <class T>
void flip(std::vector<T>& values, const T& value) {
    if (std::erase(values, value) == 0) values.push_back(value);
}

std::optional<glm::dvec2> arrow(ToolKeyCode code) {
    switch (code) {
        case ToolKeyCode::Left:
            return glm::dvec2(-1, 0);
        case ToolKeyCode::Right:
            return glm::dvec2(1, 0);
        case ToolKeyCode::Up:
            return glm::dvec2(0, -1);
        case ToolKeyCode::Down:
            return glm::dvec2(0, 1);
        default:
            return {};
    }
}

}  // namespace

std::vector<ControlPointRef> DirectTool::shownPoints() const {
    const Selection& selection = session().selection();
    const HalfedgeMesh& connectivity = mesh().connectivity();
    std::vector<ControlPointRef> shown = selection.points();
    for (const ControlPointRef& point : selection.points()) {
        VertexId vertex = point.vertex;  // or that of a handle, whose others stay
        if (point.halfedge.valid()) vertex = connectivity.origin(point.halfedge);
        if (vertex.valid())
            connectivity.forEachOutgoing(vertex,
                                         [&](HalfedgeId h) { shown.push_back(ControlPointRef::of(h)); });
    }
    for (const EdgeId e : selection.curves())
        for (const ControlPointRef& point : controlPointsOf(mesh(), e)) shown.push_back(point);
    std::sort(shown.begin(), shown.end());
    shown.erase(std::unique(shown.begin(), shown.end()), shown.end());
    return shown;
}

std::optional<ControlPointRef> DirectTool::nearestShown(glm::dvec2 point, double radiusPx) const {
    std::optional<ControlPointRef> nearest;
    for (const ControlPointRef& candidate : shownPoints()) {
        const double distance = glm::distance(pixelPosition(mesh(), candidate), point);
        if (distance > radiusPx) continue;
        radiusPx = distance;
        nearest = candidate;
    }
    return nearest;
}

std::optional<ControlPointRef> DirectTool::nearestVertex(glm::dvec2 point, double radiusPx) const {
    std::optional<ControlPointRef> nearest;
    const Rect around{point - radiusPx, point + radiusPx};
    for (const PatchId p : session().query().patchesIn(around))
        for (const VertexId v : mesh().connectivity().corners(p)) {
            const double distance = glm::distance(toPixels(mesh().position(v)), point);
            if (distance >= radiusPx) continue;
            radiusPx = distance;
            nearest = ControlPointRef::of(v);
        }
    return nearest;
}

DirectTool::Target DirectTool::targetAt(const ToolEvent& event) const {
    const double radius = kHandleRadiusPx * event.pxPerScreenPx;
    Target target;
    target.point = nearestShown(event.point, radius);
    if (!target.point && options().allHandles) {
        if (const auto hit = session().query().nearestControlPoint(event.point, radius))
            target.point = ControlPointRef::of(*hit);
    }
    if (!target.point) target.point = nearestVertex(event.point, radius);
    if (!target.point)
        target.curve = session().query().nearestCurve(event.point, kCurveRadiusPx * event.pxPerScreenPx);
    return target;
}

void DirectTool::forgetHover() {
    mHover = {};
}

void DirectTool::hovered(const ToolEvent& event) {
    mHover = targetAt(event);
}

void DirectTool::pressed(const ToolEvent& event) {
    if (mEdit) finish();  // nudges
    mHover = {};
    mHeld = targetAt(event);
    mPointsBefore = session().selection().points();
    mCurvesBefore = session().selection().curves();
}

void DirectTool::toggle(const Target& target) {
    std::vector<ControlPointRef> points = mPointsBefore;
    std::vector<EdgeId> curves = mCurvesBefore;
    if (target.point) flip(points, *target.point);
    if (target.curve) flip(curves, target.curve->edge);
    session().selection().setShape(points, curves);
}

void DirectTool::clicked(const ToolEvent& event) {
    if (event.modifiers.shift) return toggle(mHeld);
    Selection& selection = session().selection();
    if (mHeld.point)
        selection.setShape({*mHeld.point}, {});
    else if (mHeld.curve)
        selection.setShape({}, {mHeld.curve->edge});
    else
        selection.setShape({}, {});
}

std::vector<ControlPointRef> DirectTool::movable() const {
    const Selection& selection = session().selection();
    std::vector<ControlPointRef> points = selection.points();
    for (const EdgeId e : selection.curves())
        for (const ControlPointRef& point : controlPointsOf(mesh(), e)) points.push_back(point);
    return points;
}

bool DirectTool::openDrag(const QString& text, ShapeDrag drag) {
    if (!begin(mEdit, text)) return false;
    mDrag.emplace(std::move(drag));
    mOffset = {0, 0};
    mBreakJoins = false;
    return true;
}

void DirectTool::dragStarted(const ToolEvent&) {
    Selection& selection = session().selection();
    if (mHeld.point) {
        const std::vector<ControlPointRef> selected = movable();
        // A point that is not selected is dragged alone, and selected with that.
        if (std::find(selected.begin(), selected.end(), *mHeld.point) == selected.end())
            selection.setShape({*mHeld.point}, {});
        const bool handle = !isVertex(*mHeld.point);
        openDrag(handle ? QObject::tr("Move Handle") : QObject::tr("Move Points"),
                 ShapeDrag(mesh(), movable()));
    } else if (mHeld.curve) {
        selection.setShape({}, {mHeld.curve->edge});
        constexpr double kNearEnd = .05;  // where bending would throw the handles far away
        const double t = std::clamp(mHeld.curve->t, kNearEnd, 1 - kNearEnd);
        openDrag(QObject::tr("Bend Curve"), ShapeDrag::bend(mesh(), mHeld.curve->edge, t));
    }
}

void DirectTool::dragged(const ToolEvent& event) {
    if (!mHeld.any()) return selectMarquee(event);
    if (!mDrag) return;
    glm::dvec2 offset = event.point - start().point;
    if (event.modifiers.shift) offset = constrainedTo45(offset);
    showDrag(offset, event.modifiers.alt);
}

void DirectTool::showDrag(glm::dvec2 offset, bool breakJoins) {
    mOffset = offset;
    mBreakJoins = breakJoins;
    report(mEdit->preview([&](PatchMesh& mesh) {
        mResult = mDrag->drag(mesh, offset, breakJoins);
        return mResult.touched;
    }));
}

void DirectTool::selectMarquee(const ToolEvent& event) {
    const Rect marquee{glm::min(start().point, event.point), glm::max(start().point, event.point)};
    mMarquee = marquee;
    std::vector<ControlPointRef> points;
    for (const PatchId p : session().query().patchesIn(marquee))
        for (const VertexId v : mesh().connectivity().corners(p)) {
            const glm::dvec2 at = toPixels(mesh().position(v));
            if (glm::all(glm::greaterThanEqual(at, marquee.min)) &&
                glm::all(glm::lessThanEqual(at, marquee.max)))
                points.push_back(ControlPointRef::of(v));
        }
    if (event.modifiers.shift) points.insert(points.end(), mPointsBefore.begin(), mPointsBefore.end());
    session().selection().setShape(points, event.modifiers.shift ? mCurvesBefore : std::vector<EdgeId>());
}

void DirectTool::dropped(const ToolEvent&) {
    mMarquee.reset();
    finish();
}

void DirectTool::finish() {
    mNudging = false;
    if (!mEdit) return;
    const std::shared_ptr<const Image> photo = session().photo().image;
    const PatchSet& moved = mResult.touched.patches;
    if (options().refitAfterReshape && photo && photo->channels() == mesh().channels() &&
        moved.size() <= kMostRefitted) {
        // What shows the photo is asked of the start: the reshape itself has moved colours off it.
        const auto& fitted = session().document().fitted;
        const PatchSet refitted =
            showingPhoto(mEdit->start(), fitted ? *fitted : mEdit->start(), *photo, moved);
        if (!refitted.empty())
            report(mEdit->preview([&](PatchMesh& mesh) {
                const Touched dragged = mDrag->drag(mesh, mOffset, mBreakJoins).touched;
                return united(dragged, refitColours(mesh, *photo, refitted));
            }));
    }
    mEdit->commit();
    abandoned();
}

void DirectTool::abandoned() {
    if (mMarquee) session().selection().setShape(mPointsBefore, mCurvesBefore);
    mMarquee.reset();
    mEdit.reset();
    mDrag.reset();
    mResult = {};
    mHeld = {};
    mNudging = false;
}

bool DirectTool::keyPress(const ToolKey& key) {
    const auto direction = arrow(key.code);
    if (!direction || DragTool::active()) return false;
    const std::vector<ControlPointRef> points = movable();
    if (points.empty()) return false;
    if (!mNudging && !openDrag(QObject::tr("Nudge Points"), ShapeDrag(mesh(), points))) return true;
    mNudging = true;
    const double step = key.modifiers.alt ? key.pxPerScreenPx : key.modifiers.shift ? 10 : 1;
    showDrag(mOffset + step * *direction, false);
    return true;
}

bool DirectTool::keyRelease(const ToolKey& key) {
    if (!mNudging || !arrow(key.code)) return false;
    finish();
    return true;
}

ToolOverlay DirectTool::overlay() const {
    ToolOverlay overlay;
    overlay.marquee = mMarquee;
    overlay.blocking = mEdit ? mResult.blocking : std::nullopt;
    const Selection& selection = session().selection();
    overlay.curves = selection.curves();
    if (mHover.curve) overlay.hoveredCurve = mHover.curve->edge;
    const auto add = [&](const ControlPointRef& point, bool hovered) {
        const bool selected = std::binary_search(selection.points().begin(), selection.points().end(), point);
        overlay.handles.push_back(
            {.shape = isVertex(point) ? OverlayHandle::Shape::Vertex : OverlayHandle::Shape::Control,
             .at = pixelPosition(mesh(), point),
             .selected = selected,
             .hovered = hovered});
        if (point.kind != ControlPointHit::Kind::CurveInner) return;
        const VertexId end = mesh().connectivity().origin(point.halfedge);
        overlay.handleLines.push_back({toPixels(mesh().position(end)), overlay.handles.back().at});
    };
    bool hoverShown = !mHover.point;
    for (const ControlPointRef& point : shownPoints()) {
        const bool hovered = mHover.point == point;
        hoverShown = hoverShown || hovered;
        add(point, hovered);
    }
    if (!hoverShown) add(*mHover.point, true);
    return overlay;
}

}  // namespace tessera
