// See navigator.h.
#include "ui/panels/navigator.h"

#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QLocale>
#include <QMouseEvent>
#include <QPainter>
#include <QPainterPath>
#include <QVBoxLayout>
#include <QWheelEvent>
#include <algorithm>
#include <cmath>

#include "ui/panels/gesture_slider.h"
#include "ui/panels/panel_parts.h"
#include "ui/view_transform.h"

namespace tessera {

namespace {

// The slider's value: halvings and doublings of the scale.
constexpr int kTicksPerOctave = 20;
constexpr double kOctavesPerNotch = .25;
// Of the visible part, by which an arrow key moves.
constexpr double kKeyStep = .1;
// As light as the canvas's checks.
const QColor kUnderTransparent(139, 139, 139);

int tickOf(double scale) {
    return int(std::lround(std::log2(scale) * kTicksPerOctave));
}

QString percentText(double scale) {
    const double percent = 100 * scale;
    return QObject::tr("%1 %").arg(QLocale().toString(percent, 'f', percent < 10 ? 1 : 0));
}

}  // namespace

Navigator::Navigator(QWidget* parent)
    : QWidget(parent), mView(new NavigatorView), mZoom(new GestureSlider), mPercent(new QLabel) {
    setAccessibleName(tr("Navigator"));
    mZoom->setObjectName("zoom");
    mZoom->setAccessibleName(tr("Zoom"));
    mZoom->setToolTip(tr("Zoom"));
    // A tick beyond both ends, which request() cuts: they can be reached.
    mZoom->setRange(tickOf(ViewTransform::kMinScale) - 1, tickOf(ViewTransform::kMaxScale) + 1);
    mZoom->setSingleStep(kTicksPerOctave / 4);
    mZoom->setPageStep(kTicksPerOctave);
    mPercent->setMinimumWidth(
        mPercent->fontMetrics().horizontalAdvance(percentText(ViewTransform::kMaxScale)));
    mPercent->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
    auto* row = new QHBoxLayout;
    row->addWidget(mZoom, 1);
    row->addWidget(mPercent);
    auto* column = panelColumn(this);
    column->addWidget(mView, 1);
    column->addLayout(row);
    connect(mView, &NavigatorView::moveRequested, this, &Navigator::moveRequested);
    connect(mView, &NavigatorView::zoomStepRequested, this,
            [this](double notches) { request(mScale * std::exp2(notches * kOctavesPerNotch)); });
    connect(mZoom, &GestureSlider::moved, this,
            [this](int tick) { request(std::exp2(double(tick) / kTicksPerOctave)); });
    setScale(1);
    setPicture({});
}

void Navigator::setPicture(const QImage& picture) {
    mView->setPicture(picture);
    mView->setEnabled(!picture.isNull());
    mZoom->setEnabled(!picture.isNull());
    mPercent->setEnabled(!picture.isNull());
}

void Navigator::setVisibleRect(const QRectF& imagePx, QSizeF pictureSize) {
    mView->setVisibleRect(imagePx, pictureSize);
}

void Navigator::request(double scale) {
    setScale(std::clamp(scale, ViewTransform::kMinScale, ViewTransform::kMaxScale));
    emit zoomRequested(mScale);
}

void Navigator::setScale(double scale) {
    mScale = scale;
    mZoom->setValue(tickOf(scale));
    mPercent->setText(percentText(scale));
}

NavigatorView::NavigatorView(QWidget* parent) : QWidget(parent) {
    setObjectName("view");
    setAccessibleName(tr("The picture, with a frame around what is visible"));
    setToolTip(tr("Drag to move the view; turn the wheel to zoom"));
    setMinimumSize(80, 60);
    setFocusPolicy(Qt::TabFocus);
}

void NavigatorView::setPicture(const QImage& picture) {
    mPicture = picture;
    mScaled = {};
    if (mSize.isEmpty()) mSize = picture.size();
    update();
}

void NavigatorView::setVisibleRect(const QRectF& imagePx, QSizeF pictureSize) {
    mVisible = imagePx;
    mSize = pictureSize;
    update();
}

QRectF NavigatorView::pictureRect() const {
    if (mPicture.isNull() || mSize.isEmpty()) return {};
    const QSizeF size = mSize.scaled(QSizeF(this->size()) - QSizeF(2, 2), Qt::KeepAspectRatio);
    return {.5 * (width() - size.width()), .5 * (height() - size.height()), size.width(), size.height()};
}

QPointF NavigatorView::toImage(QPointF widget) const {
    const QRectF rect = pictureRect();
    const QPointF from = widget - rect.topLeft();
    return {from.x() * mSize.width() / rect.width(), from.y() * mSize.height() / rect.height()};
}

QPointF NavigatorView::toWidget(QPointF image) const {
    const QRectF rect = pictureRect();
    return rect.topLeft() +
           QPointF(image.x() * rect.width() / mSize.width(), image.y() * rect.height() / mSize.height());
}

QRectF NavigatorView::frameRect() const {
    const QRectF rect = pictureRect();
    if (rect.isEmpty() || mVisible.isEmpty()) return {};
    return QRectF(toWidget(mVisible.topLeft()), toWidget(mVisible.bottomRight())).intersected(rect);
}

void NavigatorView::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    const QRectF rect = pictureRect();
    if (rect.isEmpty()) return;
    const double ratio = devicePixelRatioF();
    const QSize size = (rect.size() * ratio).toSize();
    if (mScaled.size() != size)
        mScaled = mPicture.scaled(size, Qt::IgnoreAspectRatio, Qt::SmoothTransformation);
    painter.fillRect(rect, kUnderTransparent);
    painter.drawImage(rect, mScaled);
    const QRectF frame = frameRect();
    painter.setRenderHint(QPainter::Antialiasing);
    if (!frame.isEmpty() && frame != rect) {
        QPainterPath outside;
        outside.addRect(rect);
        outside.addRect(frame);
        painter.fillPath(outside, QColor(0, 0, 0, 110));
    }
    painter.setBrush(Qt::NoBrush);
    painter.setPen(QPen(palette().color(QPalette::Dark), 1));
    painter.drawRect(rect.adjusted(-.5, -.5, .5, .5));
    if (frame.isEmpty()) return;
    // Light within dark: visible on any picture. A frame of a few patches' size is still seen.
    constexpr double kLeast = 5;
    QRectF seen(0, 0, std::max(frame.width(), kLeast), std::max(frame.height(), kLeast));
    seen.moveCenter(frame.center());
    painter.setPen(QPen(QColor(0, 0, 0, 160), 3));
    painter.drawRect(seen);
    painter.setPen(QPen(hasFocus() ? palette().color(QPalette::Highlight) : QColor(255, 255, 255), 1.5));
    painter.drawRect(seen);
}

void NavigatorView::mousePressEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton || pictureRect().isEmpty()) return event->ignore();
    mDragging = true;
    const QPointF at = toImage(event->position());
    const bool onFrame = frameRect().contains(event->position());
    mGrip = onFrame ? mVisible.center() - at : QPointF();
    if (!onFrame) emit moveRequested(at);
}

void NavigatorView::mouseMoveEvent(QMouseEvent* event) {
    if (!mDragging) return event->ignore();
    const QPointF centre = toImage(event->position()) + mGrip;
    emit moveRequested(
        {std::clamp(centre.x(), 0., mSize.width()), std::clamp(centre.y(), 0., mSize.height())});
}

void NavigatorView::mouseReleaseEvent(QMouseEvent* event) {
    if (event->button() == Qt::LeftButton) mDragging = false;
}

void NavigatorView::wheelEvent(QWheelEvent* event) {
    emit zoomStepRequested(event->angleDelta().y() / 120.);
    event->accept();
}

void NavigatorView::keyPressEvent(QKeyEvent* event) {
    QPointF step;
    switch (event->key()) {
        case Qt::Key_Left:
            step.setX(-1);
            break;
        case Qt::Key_Right:
            step.setX(1);
            break;
        case Qt::Key_Up:
            step.setY(-1);
            break;
        case Qt::Key_Down:
            step.setY(1);
            break;
        default:
            return QWidget::keyPressEvent(event);
    }
    emit moveRequested(mVisible.center() +
                       kKeyStep * QPointF(step.x() * mVisible.width(), step.y() * mVisible.height()));
}

}  // namespace tessera
