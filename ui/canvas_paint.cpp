// The painting half of the canvas, in device pixels throughout.
#include <QPainter>
#include <algorithm>
#include <cmath>

#include "ui/canvas_widget.h"

namespace tessera {

namespace {

constexpr int kCheckPx = 8;

// Draws the part of `image`, which fills `area` (screen), that is within `clip`. Only that part: scaling a
// whole picture a thousandfold leaves the range that QPainter computes in.
void drawClipped(QPainter& painter, const QImage& image, const QRectF& area, const QRectF& clip) {
    const double pixelX = area.width() / image.width(), pixelY = area.height() / image.height();
    const QRectF wanted = area & clip;
    if (wanted.isEmpty()) return;
    const double left = std::floor((wanted.left() - area.left()) / pixelX);
    const double top = std::floor((wanted.top() - area.top()) / pixelY);
    const double right = std::min<double>(image.width(), std::ceil((wanted.right() - area.left()) / pixelX));
    const double bottom =
        std::min<double>(image.height(), std::ceil((wanted.bottom() - area.top()) / pixelY));
    const QRectF source(QPointF(left, top), QPointF(right, bottom));
    const QRectF target(area.left() + left * pixelX, area.top() + top * pixelY, source.width() * pixelX,
                        source.height() * pixelY);
    painter.drawImage(target, image, source);
}

QRectF shownArea(const ViewTransform& view, const Frame& frame) {
    const QPointF origin(frame.view.origin.x, frame.view.origin.y);
    return view.toScreen(QRectF(
        origin, QSizeF(frame.view.width / frame.view.scale.x, frame.view.height / frame.view.scale.y)));
}

}  // namespace

void CanvasWidget::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    const double ratio = devicePixelRatioF();
    painter.scale(1 / ratio, 1 / ratio);
    paintGround(painter);
    if (!mSession) return;
    painter.setClipRect(mView.toScreen(QRectF(QPointF(0, 0), pictureSize())) & deviceRect());
    // A document is shown as its photo until its first frame is there.
    if (showsPhoto() || (!mFrames.overview() && mSession->photo().pyramid))
        paintPhoto(painter);
    else
        paintVector(painter);
    painter.setClipping(false);
    if (mSession->hasMesh()) mOverlay.paint(painter, mView, deviceRect(), ratio, mOverlays);
}

void CanvasWidget::paintGround(QPainter& painter) {
    painter.fillRect(deviceRect(), mColours.ground);
    if (!mSession) return;
    const double ratio = devicePixelRatioF();
    const QRectF area = mView.toScreen(QRectF(QPointF(0, 0), pictureSize()));
    const QRectF shown = area & deviceRect();
    painter.fillRect(area.adjusted(-ratio, -ratio, ratio, ratio) & deviceRect().adjusted(-2, -2, 2, 2),
                     mColours.frame);
    if (!mSession->hasAlpha()) return;
    const int check = int(std::lround(kCheckPx * ratio));
    QPixmap tile(2 * check, 2 * check);
    tile.fill(mColours.checkLight);
    QPainter tilePainter(&tile);
    tilePainter.fillRect(0, 0, check, check, mColours.checkDark);
    tilePainter.fillRect(check, check, check, check, mColours.checkDark);
    tilePainter.end();
    // Fixed to the picture's corner, so that it moves along when the picture is panned.
    const auto phase = [&](double from, double to) { return std::fmod(std::round(from - to), 2.0 * check); };
    painter.drawTiledPixmap(shown, tile, {phase(shown.left(), area.left()), phase(shown.top(), area.top())});
}

void CanvasWidget::paintPhoto(QPainter& painter) const {
    const QImage& level = mSession->photo().pyramid->levelFor(mView.scale());
    // Zoomed in, pixels stay what they are: square.
    painter.setRenderHint(QPainter::SmoothPixmapTransform, mView.scale() < 1);
    drawClipped(painter, level, mView.toScreen(QRectF(QPointF(0, 0), pictureSize())), deviceRect());
}

void CanvasWidget::paintVector(QPainter& painter) const {
    const auto& latest = mFrames.latest();
    const QRectF inner = latest ? shownArea(mView, *latest) : QRectF();
    const QRectF picture = mView.toScreen(QRectF(QPointF(0, 0), pictureSize())) & deviceRect();
    // Beside, not below: where the picture is transparent, two layers would add up.
    if (mFrames.overview() && !inner.contains(picture)) {
        painter.save();
        if (latest) {
            QRegion region(picture.toAlignedRect());
            painter.setClipRegion(region - (inner & deviceRect()).toRect(), Qt::IntersectClip);
        }
        paintFrame(painter, *mFrames.overview());
        painter.restore();
    }
    if (latest) paintFrame(painter, *latest);
}

void CanvasWidget::paintFrame(QPainter& painter, const Frame& frame) const {
    const QRectF area = shownArea(mView, frame);
    if (frame.view.scale.x == mView.scale()) {
        // Drawn for this zoom: pixel on pixel, moved by whole ones where the view has been panned since.
        painter.drawImage(QPointF(std::round(area.left()), std::round(area.top())), frame.image);
        return;
    }
    painter.setRenderHint(QPainter::SmoothPixmapTransform);
    drawClipped(painter, frame.image, area, deviceRect());
}

QColor CanvasWidget::shownColour(QPointF image) const {
    if (showsPhoto() || !mFrames.overview()) {
        if (!mSession->photo().pyramid) return {};
        return mSession->photo().pyramid->full().pixelColor(int(image.x()), int(image.y()));
    }
    for (const auto* frame : {&mFrames.latest(), &mFrames.overview()}) {
        if (!*frame) continue;
        const View& view = (*frame)->view;
        const QPoint pixel(int(std::floor((image.x() - view.origin.x) * view.scale.x)),
                           int(std::floor((image.y() - view.origin.y) * view.scale.y)));
        if ((*frame)->image.rect().contains(pixel)) return (*frame)->image.pixelColor(pixel);
    }
    return {};
}

}  // namespace tessera
