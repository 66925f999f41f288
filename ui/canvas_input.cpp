// The half of the canvas that listens: wheel, pointer and keys.
#include <QContextMenuEvent>
#include <QGuiApplication>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QNativeGestureEvent>
#include <QWheelEvent>
#include <algorithm>
#include <cmath>

#include "ui/canvas_keys.h"
#include "ui/canvas_widget.h"

namespace tessera {

namespace {

// One notch of a wheel: 15 degrees, in eighths.
constexpr double kNotch = 120;
constexpr double kZoomPerNotch = 1.2;
constexpr double kScrollPxPerNotch = 80;
// How near the line of the split view takes hold of the pointer.
constexpr double kSplitGripPx = 5;

ToolModifiers modifiersOf(Qt::KeyboardModifiers modifiers) {
    return {.shift = modifiers.testFlag(Qt::ShiftModifier),
            .alt = modifiers.testFlag(Qt::AltModifier),
            .control = modifiers.testFlag(Qt::ControlModifier)};
}

ToolKeyCode codeOf(const QKeyEvent& event, const ActionTable& keys) {
    if (event.key() == Qt::Key_Escape) return ToolKeyCode::Escape;
    if (event.key() == Qt::Key_Return || event.key() == Qt::Key_Enter) return ToolKeyCode::Enter;
    for (const auto& [id, code] :
         {std::pair{ActionId::NudgeLeft, ToolKeyCode::Left},
          std::pair{ActionId::NudgeRight, ToolKeyCode::Right}, std::pair{ActionId::NudgeUp, ToolKeyCode::Up},
          std::pair{ActionId::NudgeDown, ToolKeyCode::Down}})
        if (isKeyOf(event, *keys[id])) return code;
    return ToolKeyCode::Other;
}

}  // namespace

bool CanvasWidget::event(QEvent* event) {
    if (event->type() != QEvent::NativeGesture) return QWidget::event(event);
    const auto* gesture = static_cast<QNativeGestureEvent*>(event);
    if (gesture->gestureType() != Qt::ZoomNativeGesture || !mSession) return QWidget::event(event);
    ViewTransform view = mLook.view;
    view.zoomAt(gesture->position() * devicePixelRatioF(), 1 + gesture->value());
    zoomViewOn(view);
    return true;
}

void CanvasWidget::wheelEvent(QWheelEvent* event) {
    event->accept();
    if (!mSession) return;
    ViewTransform view = mLook.view;
    const QPointF notches = QPointF(event->angleDelta()) / kNotch;
    if (event->modifiers() & Qt::ControlModifier) {
        view.zoomAt(event->position() * devicePixelRatioF(), std::pow(kZoomPerNotch, notches.y()));
        return zoomViewOn(view);
    } else {
        // Touchpads say pixels, wheels say notches. Shift turns a wheel sideways.
        QPointF step =
            event->pixelDelta().isNull() ? notches * kScrollPxPerNotch : QPointF(event->pixelDelta());
        if (event->modifiers() & Qt::ShiftModifier) step = {step.x() + step.y(), 0};
        view.panBy(step * devicePixelRatioF());
        view.keepInView(pictureSize(), deviceSize());
    }
    changeView(view);
}

ToolEvent CanvasWidget::toolEvent(QPointF position, Qt::KeyboardModifiers modifiers) const {
    const QPointF image = toImage(position);
    return {.point = {image.x(), image.y()},
            .pxPerScreenPx = devicePixelRatioF() / mLook.view.scale(),
            .modifiers = modifiersOf(modifiers),
            .onPhoto = seesPhoto(position * devicePixelRatioF())};
}

bool CanvasWidget::seesPhoto(QPointF devicePosition) const {
    if (!hasOriginal()) return false;
    // A document is shown as its photo until its first frame is there.
    if (showsPhoto() || !showsAnyFrame()) return true;
    const bool inLens =
        mXRay && mCursor && QLineF(*mCursor, devicePosition).length() < kLensPx * devicePixelRatioF();
    return inLens || (mSplit && devicePosition.x() < std::round(mSplitAt * deviceSize().width()));
}

ToolKey CanvasWidget::toolKey(const QKeyEvent& event) const {
    return {.code = codeOf(event, *mKeys),
            .modifiers = modifiersOf(event.modifiers()),
            .pxPerScreenPx = devicePixelRatioF() / mLook.view.scale()};
}

bool CanvasWidget::overSplitLine(QPointF devicePosition) const {
    return mSplit && hasOriginal() && mSession->hasMesh() &&
           std::abs(devicePosition.x() - mSplitAt * deviceSize().width()) <
               kSplitGripPx * devicePixelRatioF();
}

bool CanvasWidget::dragsView(const QMouseEvent& event) const {
    return event.button() == Qt::MiddleButton || (event.button() == Qt::LeftButton && mPanHeld);
}

void CanvasWidget::mousePressEvent(QMouseEvent* event) {
    if (!mSession || mPanning || mPressed) return;
    mCursor = event->position() * devicePixelRatioF();
    if (dragsView(*event)) {
        mPanning = true;
    } else if (event->button() != Qt::LeftButton) {
        return;
    } else if (overSplitLine(*mCursor)) {
        mDraggingSplit = true;
    } else if (mDrafting) {
        emit draftPressed();
    } else if (mTools) {
        mPressed = true;
        mTools->press(toolEvent(event->position(), event->modifiers()));
    }
    updateCursor();
}

void CanvasWidget::mouseDoubleClickEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton || mPanHeld || !toolsInUse()) return mousePressEvent(event);
    mPressed = true;
    mTools->doubleClick(toolEvent(event->position(), event->modifiers()));
}

void CanvasWidget::dragView(QPointF position) {
    ViewTransform view = mLook.view;
    view.panBy(position - *mCursor);
    view.keepInView(pictureSize(), deviceSize());
    mCursor = position;
    changeView(view);
}

void CanvasWidget::mouseMoveEvent(QMouseEvent* event) {
    const QPointF position = event->position() * devicePixelRatioF();
    if (mPanning && mCursor) return dragView(position);
    mCursor = position;
    if (mDraggingSplit) {
        mSplitAt = std::clamp(position.x() / deviceSize().width(), 0., 1.);
        update();
    } else if (toolsInUse()) {
        mTools->move(toolEvent(event->position(), event->modifiers()));
    }
    if (mXRay) update();
    updateCursor();
    reportCursor();
}

void CanvasWidget::mouseReleaseEvent(QMouseEvent* event) {
    if (event->button() != Qt::MiddleButton && event->button() != Qt::LeftButton) return;
    mPanning = mDraggingSplit = false;
    if (mPressed && event->button() == Qt::LeftButton) {
        mPressed = false;
        mTools->release(toolEvent(event->position(), event->modifiers()));
    }
    updateCursor();
}

void CanvasWidget::contextMenuEvent(QContextMenuEvent* event) {
    if (toolsInUse() && mSession->hasMesh()) emit contextMenuWanted(event->globalPos());
}

void CanvasWidget::leaveEvent(QEvent*) {
    mCursor.reset();
    if (mTools) mTools->leave();
    if (mXRay) update();
    reportCursor();
}

void CanvasWidget::setPeeking(bool on) {
    if (mPeeking == on) return;
    mPeeking = on;
    lookAgain();
}

void CanvasWidget::lookAgain() {
    update();
    reportCursor();
    hoverAgain(QGuiApplication::keyboardModifiers());
}

void CanvasWidget::hoverAgain(Qt::KeyboardModifiers modifiers) {
    if (mCursor && toolsInUse() && !mTools->active())
        mTools->move(toolEvent(*mCursor / devicePixelRatioF(), modifiers));
}

void CanvasWidget::setPanHeld(bool on) {
    mPanHeld = on;
    updateCursor();
}

void CanvasWidget::keyPressEvent(QKeyEvent* event) {
    // Its own event does not have it among its modifiers yet.
    if (event->key() == Qt::Key_Alt) hoverAgain(event->modifiers() | Qt::AltModifier);
    if (mDrafting && event->key() == Qt::Key_Escape)
        emit draftLeft();
    else if (!toolsInUse() || !mTools->keyPress(toolKey(*event)))
        QWidget::keyPressEvent(event);
}

void CanvasWidget::keyReleaseEvent(QKeyEvent* event) {
    // A held key repeats as pairs of press and release on X11.
    if (event->isAutoRepeat()) return;
    if (event->key() == Qt::Key_Alt) hoverAgain(event->modifiers() & ~Qt::AltModifier);
    if (!toolsInUse() || !mTools->keyRelease(toolKey(*event))) QWidget::keyReleaseEvent(event);
}

void CanvasWidget::focusOutEvent(QFocusEvent*) {
    // The releases will go elsewhere.
    mPanning = mPressed = mDraggingSplit = false;
    if (mTools) mTools->cancel();
    updateCursor();
    update();
}

}  // namespace tessera
