// See canvas_widget.h. Painting is in canvas_paint.cpp.
#include "ui/canvas_widget.h"

#include <QKeyEvent>
#include <QMouseEvent>
#include <QNativeGestureEvent>
#include <QWheelEvent>
#include <cmath>

namespace tessera {

namespace {

constexpr double kFitMarginPx = 24;
// One notch of a wheel: 15 degrees, in eighths.
constexpr double kNotch = 120;
constexpr double kZoomPerNotch = 1.2;
constexpr double kScrollPxPerNotch = 80;

}  // namespace

CanvasWidget::CanvasWidget(QWidget* parent) : QWidget(parent), mColours(canvasColours(Theme::Dark)) {
    setObjectName("canvas");
    setFocusPolicy(Qt::StrongFocus);
    setMouseTracking(true);
    setAttribute(Qt::WA_OpaquePaintEvent);
    setMinimumSize(240, 180);
    connect(&mFrames, &FrameSource::frameReady, this, [this] {
        update();
        reportCursor();
    });
}

void CanvasWidget::setSession(DocumentSession* session) {
    if (mSession) mSession->disconnect(this);
    mSession = session;
    mPeeking = false;
    if (mSession)
        connect(mSession, &DocumentSession::changed, this, [this](const Change& change) {
            if (change.mesh()) reloadMesh();
        });
    reloadMesh();
    fit();
}

void CanvasWidget::reloadMesh() {
    mFrames.setMesh(mSession ? mSession->document().mesh : PatchMesh());
    mOverlay = mSession ? OverlayPainter(mSession->document().mesh) : OverlayPainter();
    requestFrame();
    update();
    reportCursor();
}

void CanvasWidget::setTheme(Theme theme) {
    mColours = canvasColours(theme);
    update();
}

QSizeF CanvasWidget::pictureSize() const {
    return mSession ? QSizeF(mSession->width(), mSession->height()) : QSizeF();
}

bool CanvasWidget::showsPhoto() const {
    if (!mSession || !mSession->photo().pyramid) return false;
    return !mSession->hasMesh() || mShowOriginal || mPeeking;
}

void CanvasWidget::setShowOriginal(bool on) {
    mShowOriginal = on;
    update();
    reportCursor();
}

void CanvasWidget::setOverlays(const OverlayOptions& options) {
    mOverlays = options;
    update();
}

void CanvasWidget::zoomStep(bool larger) {
    zoomTo(ViewTransform::nextScale(mView.scale(), larger));
}

void CanvasWidget::zoomTo(double scale) {
    ViewTransform view = mView;
    view.setScaleAt(deviceRect().center(), scale);
    changeView(view);
}

void CanvasWidget::fit() {
    ViewTransform view = mView;
    view.fit(pictureSize(), deviceSize(), kFitMarginPx * devicePixelRatioF());
    changeView(view);
    mFitted = true;
}

void CanvasWidget::changeView(const ViewTransform& view) {
    mFitted = false;
    mLaidOut = deviceSize();
    mView = view;
    requestFrame();
    update();
    reportCursor();
    emit viewChanged();
}

void CanvasWidget::requestFrame() {
    if (!mSession || !mSession->hasMesh()) return;
    // Only pixels that lie wholly within the picture: what is outside is black or clear, and would darken the
    // border.
    const QRectF part = mView.toScreen(QRectF(QPointF(0, 0), pictureSize())) & deviceRect();
    const double left = std::ceil(part.left()), top = std::ceil(part.top());
    const QPointF origin = mView.toImage({left, top});
    View view;
    view.origin = {origin.x(), origin.y()};
    view.scale = {mView.scale(), mView.scale()};
    view.width = int(std::floor(part.right()) - left);
    view.height = int(std::floor(part.bottom()) - top);
    if (view.width > 0 && view.height > 0) mFrames.request(view);
}

void CanvasWidget::resizeEvent(QResizeEvent*) {
    if (mFitted || mLaidOut.isEmpty()) return fit();
    // What was in the middle stays there.
    ViewTransform view = mView;
    const QSizeF grown = deviceSize() - mLaidOut;
    view.panBy(QPointF(grown.width(), grown.height()) / 2);
    view.keepInView(pictureSize(), deviceSize());
    changeView(view);
}

bool CanvasWidget::event(QEvent* event) {
    if (event->type() != QEvent::NativeGesture) return QWidget::event(event);
    const auto* gesture = static_cast<QNativeGestureEvent*>(event);
    if (gesture->gestureType() != Qt::ZoomNativeGesture || !mSession) return QWidget::event(event);
    ViewTransform view = mView;
    view.zoomAt(gesture->position() * devicePixelRatioF(), 1 + gesture->value());
    changeView(view);
    return true;
}

void CanvasWidget::wheelEvent(QWheelEvent* event) {
    event->accept();
    if (!mSession) return;
    ViewTransform view = mView;
    const QPointF notches = QPointF(event->angleDelta()) / kNotch;
    if (event->modifiers() & Qt::ControlModifier) {
        view.zoomAt(event->position() * devicePixelRatioF(), std::pow(kZoomPerNotch, notches.y()));
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

void CanvasWidget::mousePressEvent(QMouseEvent* event) {
    const bool pan = event->button() == Qt::MiddleButton || (event->button() == Qt::LeftButton && mSpace);
    if (!pan || !mSession) return;
    mPanning = true;
    mCursor = event->position() * devicePixelRatioF();
    updateCursor();
}

void CanvasWidget::mouseMoveEvent(QMouseEvent* event) {
    const QPointF position = event->position() * devicePixelRatioF();
    if (mPanning && mCursor) {
        ViewTransform view = mView;
        view.panBy(position - *mCursor);
        view.keepInView(pictureSize(), deviceSize());
        mCursor = position;
        changeView(view);
        return;
    }
    mCursor = position;
    reportCursor();
}

void CanvasWidget::mouseReleaseEvent(QMouseEvent* event) {
    if (event->button() != Qt::MiddleButton && event->button() != Qt::LeftButton) return;
    mPanning = false;
    updateCursor();
}

void CanvasWidget::leaveEvent(QEvent*) {
    mCursor.reset();
    reportCursor();
}

void CanvasWidget::keyPressEvent(QKeyEvent* event) {
    if (event->key() == Qt::Key_O && event->modifiers() == Qt::NoModifier) {
        mPeeking = true;
        update();
        reportCursor();
    } else if (event->key() == Qt::Key_Space) {
        mSpace = true;
        updateCursor();
    } else {
        QWidget::keyPressEvent(event);
    }
}

void CanvasWidget::keyReleaseEvent(QKeyEvent* event) {
    // A held key repeats as pairs of press and release on X11.
    if (event->isAutoRepeat()) return;
    if (event->key() == Qt::Key_O) {
        mPeeking = false;
        update();
        reportCursor();
    } else if (event->key() == Qt::Key_Space) {
        mSpace = false;
        updateCursor();
    } else {
        QWidget::keyReleaseEvent(event);
    }
}

void CanvasWidget::focusOutEvent(QFocusEvent*) {
    // The releases will go elsewhere.
    mPeeking = mSpace = mPanning = false;
    updateCursor();
    update();
}

void CanvasWidget::updateCursor() {
    if (mPanning)
        setCursor(Qt::ClosedHandCursor);
    else if (mSpace)
        setCursor(Qt::OpenHandCursor);
    else
        unsetCursor();
}

void CanvasWidget::reportCursor() {
    std::optional<QPointF> image;
    if (mCursor && mSession) {
        const QPointF point = mView.toImage(*mCursor);
        if (QRectF(QPointF(0, 0), pictureSize()).contains(point)) image = point;
    }
    emit cursorMoved(image, image ? shownColour(*image) : QColor());
}

}  // namespace tessera
