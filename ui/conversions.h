// Between the points, colours and files of documents and those of Qt.
#pragma once

#include <QColor>
#include <QPointF>
#include <QRectF>
#include <QStringList>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/mesh/patch_query.h"

class QMimeData;

namespace tessera {

inline QPointF toPoint(glm::dvec2 p) {
    return {p.x, p.y};
}

// With its corners in any order.
inline QRectF toRect(const Rect& rect) {
    return QRectF(toPoint(rect.min), toPoint(rect.max)).normalized();
}

// The local files of what is being dragged or pasted.
QStringList localFiles(const QMimeData* data);

// Gamma-encoded sRGB, of any value in documents.
QColor toQColor(glm::dvec3 srgb);
glm::dvec3 toSrgb(const QColor& colour);

}  // namespace tessera
