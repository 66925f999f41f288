// The painting half of the canvas, in device pixels throughout.
#include <QLocale>
#include <QPainter>
#include <QPainterPath>
#include <algorithm>
#include <cmath>

#include "app/heat_map.h"
#include "ui/canvas_tags.h"
#include "ui/canvas_widget.h"
#include "ui/centres_painter.h"
#include "ui/tool_overlay_painter.h"

namespace tessera {

namespace {

constexpr int kCheckPx = 8;
constexpr double kGridFromScale = 8;
constexpr double kTagGapPx = 8;
const LineStyle kSelection{QColor(64, 169, 255), QColor(255, 255, 255, 235), 1.6, 3.8};
const LineStyle kCutOut{QColor(255, 255, 255), QColor(40, 44, 52), 1.2, 2.6, true};
const LineStyle kHighlight{QColor(255, 255, 255), QColor(0, 0, 0, 200), 1.8, 4.2};

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

Legend featureLegend(FeatureTint tint) {
    const bool blur = tint == FeatureTint::Blur;
    const QLocale locale;
    const auto name = [&](float value) {
        return blur ? locale.toString(double(value), 'f', 1) : locale.toString(std::lround(255 * value));
    };
    Legend legend{blur ? CanvasWidget::tr("Blur, px") : CanvasWidget::tr("Jump of colour, levels"), {}};
    const auto shades = featureShades(tint);
    for (size_t i = 0; i < shades.size(); ++i) {
        const QString from = name(shades[i].from);
        legend.rows.push_back(
            {shades[i].colour, i + 1 < shades.size()
                                   ? CanvasWidget::tr("%1 to %2").arg(from, name(shades[i + 1].from))
                                   : CanvasWidget::tr("%1 and more").arg(from)});
    }
    return legend;
}

Legend heatLegend() {
    constexpr int kRows = 4;
    Legend legend{CanvasWidget::tr("Error, levels"), {}};
    for (int i = 1; i <= kRows; ++i) {
        const double levels = kHeatFromLevels + (kHeatFullLevels - kHeatFromLevels) * i / kRows;
        const QString text = QLocale().toString(std::lround(levels));
        legend.rows.push_back({QColor::fromRgba(qUnpremultiply(heatColour(levels))),
                               i < kRows ? text : CanvasWidget::tr("%1 and more").arg(text)});
    }
    return legend;
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
    painter.setClipRect(mLook.view.toScreen(QRectF(QPointF(0, 0), pictureSize())) & deviceRect());
    mToScreen ? paintPictureManaged(painter) : paintPicture(painter);
    if (!mHeatMap.isNull() && !mDrafting)
        drawClipped(painter, mHeatMap, mLook.view.toScreen(QRectF(QPointF(0, 0), pictureSize())),
                    deviceRect());
    if (mLook.view.scale() >= kGridFromScale * ratio) paintPixelGrid(painter);
    painter.setClipping(false);
    paintOverlays(painter);
    painter.setRenderHint(QPainter::Antialiasing);
    if (mDrafting && !showsPhoto()) paintDraftTag(painter);
    paintLegends(painter);
}

void CanvasWidget::paintDraftTag(QPainter& painter) const {
    const double ratio = devicePixelRatioF(), gap = kTagGapPx * ratio;
    const QRectF shown = mLook.view.toScreen(QRectF(QPointF(0, 0), pictureSize())) & deviceRect();
    drawTag(painter, shown.topLeft() + QPointF(gap, gap), tr("Draft"), false, ratio);
}

void CanvasWidget::paintLegends(QPainter& painter) const {
    std::vector<Legend> legends;
    if (mMesh.patchCount() > 0 && mOverlays.features && mOverlays.tint != FeatureTint::Plain)
        legends.push_back(featureLegend(mOverlays.tint));
    if (!mHeatMap.isNull() && !mDrafting) legends.push_back(heatLegend());
    if (legends.empty()) return;
    const double ratio = devicePixelRatioF(), gap = kTagGapPx * ratio;
    drawLegends(painter, {gap, deviceSize().height() - gap}, legends, ratio);
}

void CanvasWidget::paintPictureManaged(QPainter& painter) const {
    const QRect area = painter.clipBoundingRect().toAlignedRect();
    if (area.isEmpty()) return;
    QImage picture(area.size(), QImage::Format_ARGB32_Premultiplied);
    picture.fill(Qt::transparent);
    QPainter inner(&picture);
    inner.translate(-area.topLeft());
    paintPicture(inner);
    inner.end();
    picture.applyColorTransform(*mToScreen);
    painter.drawImage(area.topLeft(), picture);
}

void CanvasWidget::paintPicture(QPainter& painter) const {
    if (showsPhoto() || (!showsAnyFrame() && hasOriginal())) return paintPhoto(painter);
    paintVector(painter);
    if (!hasOriginal()) return;
    if (mSplit) paintSplit(painter);
    if (mXRay && mCursor) paintLens(painter);
}

void CanvasWidget::paintSplit(QPainter& painter) const {
    const double ratio = devicePixelRatioF(), x = std::round(mSplitAt * deviceSize().width());
    painter.save();
    painter.setClipRect(QRectF(0, 0, x, deviceSize().height()), Qt::IntersectClip);
    paintPhoto(painter);
    painter.restore();
    const double height = deviceSize().height();
    painter.fillRect(QRectF(x - 1.5 * ratio, 0, 3 * ratio, height), QColor(0, 0, 0, 140));
    painter.fillRect(QRectF(x - .5 * ratio, 0, ratio, height), Qt::white);
    painter.save();
    painter.setRenderHint(QPainter::Antialiasing);
    // What the line is dragged by, to the eye; it can be taken hold of anywhere.
    painter.setPen(QPen(QColor(0, 0, 0, 140), ratio));
    painter.setBrush(Qt::white);
    painter.drawRoundedRect(QRectF(x - 3 * ratio, height / 2 - 18 * ratio, 6 * ratio, 36 * ratio), 3 * ratio,
                            3 * ratio);
    const double gap = kTagGapPx * ratio, top = std::max(0., mLook.view.toScreen(QPointF(0, 0)).y()) + gap;
    drawTag(painter, QPointF(x - gap, top), tr("Photo"), true, ratio);
    drawTag(painter, QPointF(x + gap, top), tr("Vector image"), false, ratio);
    painter.restore();
}

void CanvasWidget::paintLens(QPainter& painter) const {
    const double ratio = devicePixelRatioF(), radius = kLensPx * ratio;
    const QRectF lens(mCursor->x() - radius, mCursor->y() - radius, 2 * radius, 2 * radius);
    painter.save();
    QPainterPath circle;
    circle.addEllipse(lens);
    painter.setClipPath(circle, Qt::IntersectClip);
    paintPhoto(painter);
    painter.restore();
    painter.save();
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setPen(QPen(QColor(0, 0, 0, 150), 3 * ratio));
    painter.drawEllipse(lens);
    painter.setPen(QPen(Qt::white, ratio));
    painter.drawEllipse(lens);
    painter.restore();
}

void CanvasWidget::paintPixelGrid(QPainter& painter) const {
    const QRectF part = visiblePart();
    std::vector<QLineF> lines;
    const QRectF area = mLook.view.toScreen(part);
    for (double x = std::ceil(part.left()); x <= part.right(); ++x) {
        const double at = std::round(mLook.view.toScreen(QPointF(x, 0)).x()) + .5;
        lines.emplace_back(at, area.top(), at, area.bottom());
    }
    for (double y = std::ceil(part.top()); y <= part.bottom(); ++y) {
        const double at = std::round(mLook.view.toScreen(QPointF(0, y)).y()) + .5;
        lines.emplace_back(area.left(), at, area.right(), at);
    }
    painter.setPen(QColor(128, 128, 128, 70));
    painter.drawLines(lines.data(), int(lines.size()));
}

void CanvasWidget::paintOverlays(QPainter& painter) const {
    if (mMesh.patchCount() == 0) return;
    const double ratio = devicePixelRatioF();
    mOverlay.paint(painter, mLook.view, deviceRect(), ratio, mOverlays);
    if (mOverlays.centres) paintCentres(painter, mMesh, mLook.view, deviceRect(), ratio);
    // Tells what is cut out from what is hidden, where nothing is drawn either.
    mOverlay.paintOutline(painter, mLook.view, deviceRect(), ratio, mCutOutOutline, kCutOut);
    mOverlay.paintOutline(painter, mLook.view, deviceRect(), ratio, mHighlightOutline, kHighlight);
    mOverlay.paintOutline(painter, mLook.view, deviceRect(), ratio, mSelectionOutline, kSelection);
    if (toolsInUse())
        paintToolOverlay(painter, mTools->overlay(), mOverlay, mMesh, mLook.view, deviceRect(), ratio);
}

void CanvasWidget::paintGround(QPainter& painter) {
    painter.fillRect(deviceRect(), mColours.ground);
    if (!mSession) return;
    const double ratio = devicePixelRatioF();
    const QRectF area = mLook.view.toScreen(QRectF(QPointF(0, 0), pictureSize()));
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
    const QImage& level = mSession->photo().pyramid->levelFor(mLook.view.scale());
    // Zoomed in, pixels stay what they are: square.
    painter.setRenderHint(QPainter::SmoothPixmapTransform, mLook.view.scale() < 1);
    drawClipped(painter, level, mLook.view.toScreen(QRectF(QPointF(0, 0), pictureSize())), deviceRect());
}

void CanvasWidget::paintVector(QPainter& painter) const {
    const auto& latest = mFrames.latest();
    const QRectF inner = latest ? shownArea(mLook.view, *latest) : QRectF();
    const QRectF picture = mLook.view.toScreen(QRectF(QPointF(0, 0), pictureSize())) & deviceRect();
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
    const QRectF area = shownArea(mLook.view, frame);
    if (frame.view.scale.x == mLook.view.scale()) {
        // Drawn for this zoom: pixel on pixel, moved by whole ones where the view has been panned since.
        painter.drawImage(QPointF(std::round(area.left()), std::round(area.top())), frame.image);
        return;
    }
    painter.setRenderHint(QPainter::SmoothPixmapTransform);
    drawClipped(painter, frame.image, area, deviceRect());
}

QColor CanvasWidget::shownColour(QPointF devicePosition) const {
    const QPointF image = mLook.view.toImage(devicePosition);
    if (seesPhoto(devicePosition))
        return mSession->photo().pyramid->full().pixelColor(int(image.x()), int(image.y()));
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
