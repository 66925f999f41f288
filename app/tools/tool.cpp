// See tool.h.
#include "app/tools/tool.h"

#include <cmath>
#include <numbers>

namespace tessera {

glm::dvec2 constrainedTo45(glm::dvec2 offset) {
    constexpr double kStep = std::numbers::pi / 4;
    const double angle = kStep * std::round(std::atan2(offset.y, offset.x) / kStep);
    const glm::dvec2 direction(std::cos(angle), std::sin(angle));
    return direction * glm::dot(offset, direction);
}

SelectMode selectModeOf(const ToolModifiers& modifiers) {
    if (modifiers.shift) return modifiers.alt ? SelectMode::Intersect : SelectMode::Add;
    return modifiers.alt ? SelectMode::Subtract : SelectMode::Replace;
}

bool Tool::mayBegin() const {
    if (!session().editing()) return true;
    report(refusedMeanwhile());
    return false;
}

bool Tool::begin(std::optional<EditSession>& edit, const QString& text) const {
    edit.reset();
    if (!mayBegin()) return false;
    edit.emplace(session(), text);
    return true;
}

void Tool::report(const Result<void>& result) const {
    if (!result) mHost.say(QString::fromStdString(result.error().message));
}

void DragTool::press(const ToolEvent& event) {
    if (mState != State::Rest) cancel();  // its release never came
    mState = State::Pressed;
    mStart = event;
    pressed(event);
    // What it did may have ended the gesture.
    if (mState == State::Pressed && dragsAtOnce()) startDragging(event);
}

void DragTool::startDragging(const ToolEvent& event) {
    mState = State::Dragging;
    dragStarted(event);
    if (dragging()) dragged(event);
}

void DragTool::move(const ToolEvent& event) {
    if (mState == State::Rest) return hovered(event);
    if (dragging()) return dragged(event);
    if (glm::distance(event.point, mStart.point) > kClickRadiusPx * event.pxPerScreenPx) startDragging(event);
}

void DragTool::release(const ToolEvent& event) {
    move(event);
    const State was = mState;
    mState = State::Rest;
    if (was == State::Dragging) dropped(event);
    if (was == State::Pressed) clicked(event);
}

void DragTool::cancel() {
    const bool wasActive = active();
    mState = State::Rest;
    if (wasActive) abandoned();
}

}  // namespace tessera
