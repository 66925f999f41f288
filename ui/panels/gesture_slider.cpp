// See gesture_slider.h.
#include "ui/panels/gesture_slider.h"

#include <QApplication>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QPainterPath>
#include <QWheelEvent>
#include <algorithm>
#include <cmath>

namespace tessera {

namespace {

// Steps closer than this are one gesture.
constexpr int kRestMs = 400;
constexpr double kHandle = 7;  // its radius
constexpr double kTrack = 4, kGradientTrack = 12;
constexpr int kNotch = 120;  // of a wheel, as Qt counts

// Between ground and text.
QColor quiet(const QPalette& palette, double share) {
    QColor colour = palette.color(QPalette::Active, QPalette::WindowText);
    colour.setAlphaF(float(share));
    return colour;
}

// Lighter than the ground, in both themes.
QColor handleColour(const QPalette& palette) {
    const QColor button = palette.color(QPalette::Button);
    return button.lightnessF() < .5f ? button.lighter(260) : button;
}

}  // namespace

GestureSlider::GestureSlider(QWidget* parent) : QSlider(Qt::Horizontal, parent) {
    setFocusPolicy(Qt::StrongFocus);
    mRest.setSingleShot(true);
    mRest.setInterval(kRestMs);
    connect(&mRest, &QTimer::timeout, this, &GestureSlider::finish);
}

void GestureSlider::setNeutral(int value) {
    mNeutral = value;
    update();
}

void GestureSlider::setGradient(std::function<QColor(double)> colourAt) {
    mGradient = std::move(colourAt);
    update();
}

QSize GestureSlider::sizeHint() const {
    return {140, std::max(22, fontMetrics().height() + 4)};
}

QSize GestureSlider::minimumSizeHint() const {
    return {60, sizeHint().height()};
}

QRectF GestureSlider::track() const {
    const double height = mGradient ? kGradientTrack : kTrack;
    return {kHandle + 1, .5 * (this->height() - height), std::max(1., width() - 2 * kHandle - 2), height};
}

double GestureSlider::xOf(int value) const {
    const QRectF bar = track();
    const double share = maximum() > minimum() ? double(value - minimum()) / (maximum() - minimum()) : 0;
    return bar.left() + share * bar.width();
}

int GestureSlider::valueAt(double x) const {
    const QRectF bar = track();
    const double share = std::clamp((x - bar.left()) / bar.width(), 0., 1.);
    return minimum() + int(std::lround(share * (maximum() - minimum())));
}

void GestureSlider::moveTo(int value) {
    value = std::clamp(value, minimum(), maximum());
    if (value == this->value()) return;
    if (!mUnderWay) {
        mUnderWay = true;
        mBefore = this->value();
        qApp->installEventFilter(this);
        emit begun();
    }
    setValue(value);
    emit moved(value);
}

void GestureSlider::step(int value) {
    moveTo(value);
    if (mUnderWay) mRest.start();
}

bool GestureSlider::endGesture() {
    mRest.stop();
    qApp->removeEventFilter(this);
    return std::exchange(mUnderWay, false);
}

void GestureSlider::finish() {
    if (!endGesture()) return;
    if (value() == mBefore)
        emit cancelled();
    else
        emit ended();
}

void GestureSlider::cancel() {
    mPressed = false;
    if (!endGesture()) return;
    setValue(mBefore);
    emit cancelled();
}

void GestureSlider::mousePressEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton) return event->ignore();
    finish();
    mPressed = true;
    mPressX = event->position().x();
    if (!mNeutral) moveTo(valueAt(mPressX));
    mPressValue = value();
    event->accept();
}

void GestureSlider::mouseMoveEvent(QMouseEvent* event) {
    if (!mPressed) return event->ignore();
    moveTo(valueAt(xOf(mPressValue) + event->position().x() - mPressX));
}

void GestureSlider::mouseReleaseEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton || !std::exchange(mPressed, false)) return event->ignore();
    finish();
}

void GestureSlider::mouseDoubleClickEvent(QMouseEvent* event) {
    if (!mNeutral) return mousePressEvent(event);
    moveTo(*mNeutral);
    finish();
}

void GestureSlider::wheelEvent(QWheelEvent* event) {
    if (!hasFocus() || mPressed) return event->ignore();
    mWheelDelta += event->angleDelta().y() != 0 ? event->angleDelta().y() : event->angleDelta().x();
    const int notches = mWheelDelta / kNotch;
    mWheelDelta -= notches * kNotch;
    step(value() + notches * singleStep());
    event->accept();
}

std::optional<int> GestureSlider::keyTarget(int key) const {
    switch (key) {
        case Qt::Key_Left:
        case Qt::Key_Down:
            return value() - singleStep();
        case Qt::Key_Right:
        case Qt::Key_Up:
            return value() + singleStep();
        case Qt::Key_PageDown:
            return value() - pageStep();
        case Qt::Key_PageUp:
            return value() + pageStep();
        case Qt::Key_Home:
            return minimum();
        case Qt::Key_End:
            return maximum();
        case Qt::Key_Delete:
        case Qt::Key_Backspace:
            return mNeutral;
        default:
            return {};
    }
}

bool GestureSlider::event(QEvent* event) {
    // The keys that it uses are not for the window's shortcuts.
    if (event->type() == QEvent::ShortcutOverride) {
        const auto* key = static_cast<QKeyEvent*>(event);
        const bool isPlain = !(key->modifiers() & ~Qt::KeypadModifier);
        const bool cancels = key->key() == Qt::Key_Escape && mUnderWay;
        if (isPlain && (cancels || keyTarget(key->key()))) {
            event->accept();
            return true;
        }
    }
    return QSlider::event(event);
}

bool GestureSlider::eventFilter(QObject* watched, QEvent* event) {
    if (mPressed || !watched->isWidgetType()) return false;
    if (event->type() == QEvent::ShortcutOverride) {
        // Before a shortcut is looked for: whether there is something to undo may change.
        const int key = static_cast<QKeyEvent*>(event)->key();
        if (key != Qt::Key_Escape && !keyTarget(key)) finish();
    } else if (event->type() == QEvent::MouseButtonPress && watched != this) {
        finish();
    }
    return false;
}

void GestureSlider::keyPressEvent(QKeyEvent* event) {
    if (event->key() == Qt::Key_Escape && mUnderWay) return cancel();
    const auto target = keyTarget(event->key());
    if (!target || mPressed) return event->ignore();
    // A key that is held is not at rest: the gesture ends after its release.
    moveTo(*target);
    mRest.stop();
}

void GestureSlider::keyReleaseEvent(QKeyEvent* event) {
    if (event->isAutoRepeat() || !keyTarget(event->key())) return event->ignore();
    if (mUnderWay && !mPressed) mRest.start();
}

void GestureSlider::focusOutEvent(QFocusEvent* event) {
    if (!mPressed) finish();
    QSlider::focusOutEvent(event);
}

void GestureSlider::hideEvent(QHideEvent* event) {
    mPressed = false;
    finish();
    QSlider::hideEvent(event);
}

void GestureSlider::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    const QRectF bar = track();
    const double handleX = xOf(value());
    const QColor line = palette().color(QPalette::Dark);
    if (mGradient && isEnabled()) {
        constexpr int kStops = 24;
        QLinearGradient gradient(bar.topLeft(), bar.topRight());
        for (int i = 0; i <= kStops; ++i)
            gradient.setColorAt(double(i) / kStops, mGradient(double(i) / kStops));
        painter.setPen(QPen(line, 1));
        painter.setBrush(gradient);
        painter.drawRoundedRect(bar.adjusted(-kHandle + 1.5, .5, kHandle - 1.5, -.5), 3, 3);
    } else {
        painter.setPen(Qt::NoPen);
        painter.setBrush(quiet(palette(), isEnabled() ? .3 : .12));
        painter.drawRoundedRect(bar, 2, 2);
        if (isEnabled()) {
            const double from = mNeutral ? xOf(*mNeutral) : bar.left();
            painter.setBrush(palette().highlight());
            painter.drawRoundedRect(
                QRectF(std::min(from, handleX), bar.top(), std::abs(handleX - from), bar.height()), 2, 2);
        }
    }
    const QPointF centre(handleX, bar.center().y());
    painter.setPen(QPen(hasFocus() ? palette().color(QPalette::Highlight) : line, hasFocus() ? 2 : 1));
    painter.setBrush(isEnabled() ? handleColour(palette()) : palette().color(QPalette::Window));
    painter.drawEllipse(centre, kHandle - 1, kHandle - 1);
}

}  // namespace tessera
