// See centres_painter.h.
#include "ui/centres_painter.h"

#include <cmath>
#include <vector>

#include "core/mesh/patch_query.h"
#include "ui/conversions.h"

namespace tessera {

namespace {

// Centres of a patch appear where each has a square of this side for itself.
constexpr double kSpacingPx = 13;
constexpr double kMarkPx = 8;
const QColor kFill(150, 255, 170);
const QColor kOutline(0, 24, 8, 230);

bool legible(const QRectF& box, size_t count, double pixelRatio) {
    // A triangle fills about half of its box.
    return std::sqrt(.5 * box.width() * box.height() / double(count)) >= kSpacingPx * pixelRatio;
}

}  // namespace

void paintCentres(QPainter& painter, const PatchMesh& mesh, const ViewTransform& view, const QRectF& visible,
                  double pixelRatio) {
    std::vector<QPointF> centres;
    mesh.forEachPatch([&](PatchId p) {
        const QRectF box = view.toScreen(toRect(controlBounds(mesh, p)));
        const PatchSpline& spline = mesh.spline(p);
        const size_t count = spline.centreCount();
        if (count == 0 || !box.intersects(visible) || !legible(box, count, pixelRatio)) return;
        const BezierTriangle triangle = toPixels(mesh.controlPoints(p));
        for (size_t i = 0; i < count; ++i) {
            const Barycentric at = barycentricOf(spline.centre(int(i)));
            centres.push_back(view.toScreen(toPoint(evaluate(triangle, at))));
        }
    });
    painter.save();
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setPen(QPen(kOutline, 1.2 * pixelRatio));
    painter.setBrush(kFill);
    const double radius = .5 * kMarkPx * pixelRatio;
    for (const QPointF centre : centres) {
        // Diamonds: handles are round, vertices square.
        const QPointF corners[] = {centre + QPointF(0, -radius), centre + QPointF(radius, 0),
                                   centre + QPointF(0, radius), centre + QPointF(-radius, 0)};
        if (visible.contains(centre)) painter.drawPolygon(corners, 4);
    }
    painter.restore();
}

}  // namespace tessera
