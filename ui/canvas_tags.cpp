// See canvas_tags.h.
#include "ui/canvas_tags.h"

#include <QFontMetricsF>
#include <algorithm>
#include <cmath>

namespace tessera {

namespace {

constexpr double kTextPx = 12, kGapPx = 8, kSwatchPx = 14;

QFontMetricsF takeFont(QPainter& painter, double ratio) {
    QFont font = painter.font();
    font.setPixelSize(int(std::lround(kTextPx * ratio)));
    painter.setFont(font);
    return QFontMetricsF(font);
}

void drawGround(QPainter& painter, const QRectF& box, double ratio) {
    painter.setPen(Qt::NoPen);
    painter.setBrush(QColor(0, 0, 0, 150));
    painter.drawRoundedRect(box, 4 * ratio, 4 * ratio);
    painter.setPen(Qt::white);
}

}  // namespace

void drawTag(QPainter& painter, QPointF at, const QString& text, bool leftOf, double ratio) {
    const QFontMetricsF metrics = takeFont(painter, ratio);
    QRectF box(at, QSizeF(metrics.horizontalAdvance(text) + 12 * ratio, metrics.height() + 4 * ratio));
    if (leftOf) box.moveRight(at.x());
    drawGround(painter, box, ratio);
    painter.drawText(box, Qt::AlignCenter, text);
}

void drawLegends(QPainter& painter, QPointF corner, const std::vector<Legend>& legends, double ratio) {
    const QFontMetricsF metrics = takeFont(painter, ratio);
    const double gap = kGapPx * ratio, swatch = kSwatchPx * ratio, line = metrics.height() + 2 * ratio;
    for (const Legend& legend : legends) {
        double width = metrics.horizontalAdvance(legend.heading);
        for (const auto& [colour, text] : legend.rows)
            width = std::max(width, swatch + gap + metrics.horizontalAdvance(text));
        const QSizeF size(width + 2 * gap, double(legend.rows.size() + 1) * line + gap);
        const QRectF box(corner - QPointF(0, size.height()), size);
        drawGround(painter, box, ratio);
        QRectF row(box.left() + gap, box.top() + gap / 2, width, line);
        painter.drawText(row, Qt::AlignVCenter | Qt::AlignLeft, legend.heading);
        for (const auto& [colour, text] : legend.rows) {
            row.translate(0, line);
            painter.fillRect(QRectF(row.left(), row.center().y() - swatch / 4, swatch, swatch / 2), colour);
            painter.drawText(row.adjusted(swatch + gap, 0, 0, 0), Qt::AlignVCenter | Qt::AlignLeft, text);
        }
        corner.rx() += size.width() + gap;
    }
}

}  // namespace tessera
