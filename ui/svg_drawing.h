// The part of SVG that line icons are drawn in, as painter paths (so that the program needs no SVG module).
#pragma once

#include <QByteArray>
#include <QColor>
#include <QPainterPath>
#include <QRectF>
#include <optional>
#include <vector>

class QPainter;

namespace tessera {

// Stroked and filled shapes in one colour, the SVG's `currentColor`.
struct SvgDrawing {
    struct Shape {
        QPainterPath path;
        bool stroked = true;
        bool filled = false;
        double opacity = 1;
    };

    double side = 0;  // of the square viewBox, whose origin is 0, 0
    double strokeWidth = 0;
    std::vector<Shape> shapes;

    // Into `target`, which is square; joins and caps are round.
    void paint(QPainter& painter, const QRectF& target, const QColor& colour) const;
};

// Understands <path> with M L H V C A Z in absolute coordinates (arcs of circles only), <circle>, <rect> with
// rx, and of their attributes fill, stroke and opacity. None where anything else turns up.
std::optional<SvgDrawing> readSvgDrawing(const QByteArray& svg);

// The `d` of a <path>, as above.
std::optional<QPainterPath> readSvgPath(QStringView d);

}  // namespace tessera
