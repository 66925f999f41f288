// See swatch_button.h.
#include "ui/panels/swatch_button.h"

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <algorithm>

namespace tessera {

namespace {

constexpr int kSide = 24;
constexpr double kCorner = 4;

}  // namespace

SwatchButton::SwatchButton(QWidget* parent) : QToolButton(parent) {
    setFocusPolicy(Qt::TabFocus);
    setAttribute(Qt::WA_Hover);
    connect(this, &QToolButton::clicked, this, [this] { emit picked(mModifiers); });
}

void SwatchButton::setColour(const QColor& colour) {
    mColour = colour;
    update();
}

void SwatchButton::setCaption(const QString& caption) {
    mCaption = caption;
    updateGeometry();
    update();
}

QSize SwatchButton::sizeHint() const {
    if (mCaption.isEmpty()) return {kSide, kSide};
    const int text = fontMetrics().horizontalAdvance(mCaption) + 4;
    return {std::max(2 * kSide, text), kSide + 6 + fontMetrics().height()};
}

QSize SwatchButton::minimumSizeHint() const {
    return sizeHint();
}

void SwatchButton::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    QRectF face = QRectF(rect()).adjusted(1.5, 1.5, -1.5, -1.5);
    if (!mCaption.isEmpty()) face.setBottom(face.bottom() - fontMetrics().height() - 2);
    const bool marked = isEnabled() && (underMouse() || hasFocus());
    painter.setPen(QPen(palette().color(marked ? QPalette::Highlight : QPalette::Dark), marked ? 2 : 1));
    painter.setBrush(isEnabled() ? QBrush(mColour) : palette().window());
    painter.drawRoundedRect(face, kCorner, kCorner);
    if (mCaption.isEmpty()) return;
    painter.setPen(
        palette().color(isEnabled() ? QPalette::Active : QPalette::Disabled, QPalette::WindowText));
    painter.drawText(QRectF(0, face.bottom(), width(), height() - face.bottom()), Qt::AlignCenter, mCaption);
}

void SwatchButton::enterEvent(QEnterEvent* event) {
    QToolButton::enterEvent(event);
    emit hovered(true);
}

void SwatchButton::leaveEvent(QEvent* event) {
    QToolButton::leaveEvent(event);
    emit hovered(false);
}

void SwatchButton::mouseReleaseEvent(QMouseEvent* event) {
    mModifiers = event->modifiers();
    QToolButton::mouseReleaseEvent(event);
}

void SwatchButton::mouseDoubleClickEvent(QMouseEvent* event) {
    if (event->button() == Qt::LeftButton) emit editRequested();
}

void SwatchButton::keyPressEvent(QKeyEvent* event) {
    mModifiers = event->modifiers();
    if (event->key() == Qt::Key_Return || event->key() == Qt::Key_Enter) return emit editRequested();
    QToolButton::keyPressEvent(event);
}

}  // namespace tessera
