// Words on the canvas, on dark ground so that they can be read over any picture.
#pragma once

#include <QColor>
#include <QPainter>
#include <QString>
#include <vector>

namespace tessera {

// A word, with its corner nearest to `at` there: right of it, or left where `leftOf`. In device pixels, of
// which `ratio` make a pixel of the screen, here and below.
void drawTag(QPainter& painter, QPointF at, const QString& text, bool leftOf, double ratio);

// What colours mean: a heading, and each colour with its words.
struct Legend {
    struct Row {
        QColor colour;
        QString text;
    };
    QString heading;
    std::vector<Row> rows;
};

// Draws legends side by side, from a lower left corner on.
void drawLegends(QPainter& painter, QPointF corner, const std::vector<Legend>& legends, double ratio);

}  // namespace tessera
