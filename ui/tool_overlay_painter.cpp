// See tool_overlay_painter.h.
#include "ui/tool_overlay_painter.h"

#include <array>

#include "ui/conversions.h"

namespace tessera {

namespace {

const QColor kAccent(64, 169, 255);
const QColor kDark(8, 16, 26, 200);
const QColor kStop(255, 84, 70);
const LineStyle kSelectedCurve{kAccent, kDark, 2.2, 4.6};
const LineStyle kHoveredCurve{QColor(255, 255, 255), kDark, 1.8, 4.2};
const LineStyle kBlocking{kStop, QColor(40, 0, 0, 190), 2.2, 5};
const LineStyle kLocked{QColor(255, 255, 255), kDark, 1.4, 3.6, true};
constexpr double kVertexPx = 8, kControlPx = 7, kBlurPx = 10, kHoverFactor = 1.35;
constexpr double kSwatchPx = 44, kSwatchOffsetPx = 18;
constexpr double kLockPx = 26, kLockOffsetPx = 12;

class Painter {
  public:
    Painter(QPainter& painter, const ViewTransform& view, double ratio)
        : mPainter(painter), mView(view), mRatio(ratio) {}

    void line(const OverlayLine& line) {
        twoTone([&] { mPainter.drawLine(at(line.from), at(line.to)); }, kAccent, 1.2);
    }

    void marquee(const Rect& rect) {
        const QRectF area = QRectF(at(rect.min), at(rect.max)).normalized();
        mPainter.fillRect(area, QColor(64, 169, 255, 36));
        mPainter.setBrush(Qt::NoBrush);
        twoTone([&] { mPainter.drawRect(area); }, Qt::white, 1, Qt::DashLine);
    }

    void lasso(const std::vector<glm::dvec2>& points) {
        QPolygonF polygon;
        for (const glm::dvec2 p : points) polygon << at(p);
        mPainter.setPen(Qt::NoPen);
        mPainter.setBrush(QColor(64, 169, 255, 36));
        mPainter.drawPolygon(polygon);
        mPainter.setBrush(Qt::NoBrush);
        twoTone([&] { mPainter.drawPolygon(polygon); }, Qt::white, 1, Qt::DashLine);
    }

    void handle(const OverlayHandle& handle) {
        const double grown = handle.hovered ? kHoverFactor * mRatio : mRatio;
        mPainter.setPen(QPen(QColor(10, 12, 16), 1.5 * mRatio));
        const bool square = handle.shape == OverlayHandle::Shape::Vertex;
        const bool blur = handle.shape == OverlayHandle::Shape::Blur;
        mPainter.setBrush(handle.selected ? kAccent : square ? QColor(Qt::white) : QColor(180, 225, 255));
        const QRectF mark = box(handle.at, (square ? kVertexPx : blur ? kBlurPx : kControlPx) * grown);
        square ? mPainter.drawRect(mark) : mPainter.drawEllipse(mark);
        if (blur) {
            mPainter.setBrush(Qt::NoBrush);
            twoTone([&] { mPainter.drawEllipse(box(handle.at, 1.9 * kBlurPx * grown)); }, Qt::white, 1);
        }
    }

    void ring(const OverlayRing& ring) {
        mPainter.setBrush(Qt::NoBrush);
        for (const double radius : {ring.radiusPx, ring.innerRadiusPx}) {
            if (radius <= 0) continue;
            const Qt::PenStyle style = radius == ring.radiusPx ? Qt::SolidLine : Qt::DotLine;
            twoTone([&] { mPainter.drawEllipse(box(ring.centre, 2 * radius * mView.scale())); }, Qt::white, 1,
                    style);
        }
    }

    void gradient(const OverlayGradient& gradient) {
        line(gradient.line);
        mPainter.setPen(QPen(Qt::white, 2 * mRatio));
        for (const auto& [where, colour] : {std::pair{gradient.line.from, gradient.fromColour},
                                            std::pair{gradient.line.to, gradient.toColour}}) {
            mPainter.setBrush(toQColor(colour));
            mPainter.drawEllipse(box(where, 14 * mRatio));
        }
    }

    void swatch(const OverlaySwatch& swatch) {
        const QPointF corner = at(swatch.at) + QPointF(kSwatchOffsetPx, kSwatchOffsetPx) * mRatio;
        mPainter.setPen(QPen(Qt::white, 2 * mRatio));
        mPainter.setBrush(toQColor(swatch.colour));
        mPainter.drawEllipse(QRectF(corner, QSizeF(kSwatchPx, kSwatchPx) * mRatio));
    }

    // A padlock on a dark disc, beside the pointer.
    void lock(glm::dvec2 where) {
        const double size = kLockPx * mRatio;
        const QRectF disc(at(where) + QPointF(kLockOffsetPx, kLockOffsetPx) * mRatio, QSizeF(size, size));
        const auto part = [&](double x, double y, double width, double height) {
            return QRectF(disc.topLeft() + QPointF(x, y) * size, QSizeF(width, height) * size);
        };
        mPainter.setPen(QPen(Qt::white, mRatio));
        mPainter.setBrush(QColor(8, 16, 26, 225));
        mPainter.drawEllipse(disc);
        mPainter.setPen(Qt::NoPen);
        mPainter.setBrush(Qt::white);
        mPainter.drawRoundedRect(part(.29, .46, .42, .3), .05 * size, .05 * size);
        mPainter.setBrush(Qt::NoBrush);
        mPainter.setPen(QPen(Qt::white, .08 * size, Qt::SolidLine, Qt::FlatCap));
        mPainter.drawArc(part(.37, .24, .26, .34), 0, 180 * 16);
        mPainter.drawLine(part(.37, .41, 0, .06).topLeft(), part(.37, .41, 0, .06).bottomLeft());
        mPainter.drawLine(part(.63, .41, 0, .06).topLeft(), part(.63, .41, 0, .06).bottomLeft());
    }

  private:
    QPointF at(glm::dvec2 image) const { return mView.toScreen(toPoint(image)); }
    QRectF box(glm::dvec2 centre, double size) const {
        const QPointF c = at(centre);
        return {c.x() - size / 2, c.y() - size / 2, size, size};
    }

    // Dark below, the colour above: legible on any ground.
    template <class Draw>
    void twoTone(const Draw& draw, const QColor& core, double width, Qt::PenStyle style = Qt::SolidLine) {
        mPainter.setPen(QPen(kDark, (width + 2) * mRatio));
        draw();
        mPainter.setPen(QPen(core, width * mRatio, style));
        draw();
    }

    QPainter& mPainter;
    const ViewTransform& mView;
    double mRatio;
};

}  // namespace

void paintToolOverlay(QPainter& painter, const ToolOverlay& overlay, const OverlayPainter& curves,
                      const PatchMesh& mesh, const ViewTransform& view, const QRectF& visible,
                      double pixelRatio) {
    const auto outline = [&](std::span<const EdgeId> edges, const LineStyle& style) {
        curves.paintOutline(painter, view, visible, pixelRatio, edges, style);
    };
    outline(overlay.curves, kSelectedCurve);
    if (overlay.hoveredCurve) outline(std::array{*overlay.hoveredCurve}, kHoveredCurve);
    const auto outlinePatch = [&](PatchId p, const LineStyle& style) {
        std::vector<EdgeId> sides;
        for (const HalfedgeId h : mesh.connectivity().sides(p)) sides.push_back(HalfedgeMesh::edge(h));
        outline(sides, style);
    };
    if (overlay.blocking) outlinePatch(*overlay.blocking, kBlocking);
    if (overlay.lock) outlinePatch(overlay.lock->patch, kLocked);
    painter.save();
    painter.setRenderHint(QPainter::Antialiasing);
    Painter tool(painter, view, pixelRatio);
    for (const OverlayLine& line : overlay.handleLines) tool.line(line);
    for (const OverlayHandle& handle : overlay.handles) tool.handle(handle);
    if (overlay.marquee) tool.marquee(*overlay.marquee);
    if (!overlay.lasso.empty()) tool.lasso(overlay.lasso);
    if (overlay.lock) tool.lock(overlay.lock->at);
    if (overlay.ring) tool.ring(*overlay.ring);
    if (overlay.gradient) tool.gradient(*overlay.gradient);
    if (overlay.swatch) tool.swatch(*overlay.swatch);
    painter.restore();
}

}  // namespace tessera
