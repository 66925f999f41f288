// Overlays: legible on any ground, of constant size, and only where they were asked for.
#include "ui/overlay_painter.h"

#include <gtest/gtest.h>

#include <QElapsedTimer>
#include <QImage>
#include <algorithm>

#include "tests/support/test_meshes.h"

namespace tessera {
namespace {

constexpr OverlayOptions kEdges{.edges = true};

QImage paint(const OverlayPainter& overlay, const ViewTransform& view, QSize size, QColor ground,
             const OverlayOptions& options) {
    QImage image(size, QImage::Format_RGB32);
    image.fill(ground);
    QPainter painter(&image);
    overlay.paint(painter, view, QRectF(image.rect()), 1, options);
    return image;
}

// How many pixels of a column are not the ground.
int touched(const QImage& image, int x, QColor ground) {
    int count = 0;
    for (int y = 0; y < image.height(); ++y) count += image.pixelColor(x, y) != ground ? 1 : 0;
    return count;
}

int strongestContrast(const QImage& image, QColor ground) {
    int strongest = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            strongest =
                std::max(strongest, std::abs(image.pixelColor(x, y).lightness() - ground.lightness()));
    return strongest;
}

ViewTransform scaled(double scale) {
    ViewTransform view;
    view.setScaleAt({0, 0}, scale);
    return view;
}

TEST(OverlayPainterTest, CanBeSeenOnBlackWhiteAndGrey) {
    PatchMesh mesh = testing::gridMesh(100, 100, 2, 2);
    mesh.forEachEdge([&](EdgeId e) {
        EdgeCurve curve = mesh.curve(e);
        curve.feature = true;
        mesh.setCurve(e, curve);
    });
    const OverlayPainter overlay(mesh);
    for (const OverlayOptions& options :
         {kEdges, OverlayOptions{.features = true}, OverlayOptions{.controlPoints = true}})
        for (const int grey : {0, 60, 128, 190, 255}) {
            const QColor ground(grey, grey, grey);
            EXPECT_GT(strongestContrast(paint(overlay, scaled(4), {400, 400}, ground, options), ground), 55)
                << grey;
        }
}

TEST(OverlayPainterTest, NothingAskedNothingDrawn) {
    const OverlayPainter overlay(testing::curvedMesh(100, 100, 3, 3, 1));
    EXPECT_EQ(strongestContrast(paint(overlay, scaled(4), {400, 400}, Qt::black, {}), Qt::black), 0);
}

TEST(OverlayPainterTest, LinesKeepTheirWidthAtAnyZoom) {
    // One horizontal line inside, at the middle of the picture, crossed well away from the diagonals.
    const OverlayPainter overlay(testing::gridMesh(100, 100, 1, 2));
    const int near = touched(paint(overlay, scaled(4), {400, 400}, Qt::gray, kEdges), 30, Qt::gray);
    for (const double scale : {64., 1000.}) {
        ViewTransform view = scaled(scale);
        view.panBy(QPointF(0, 200 - 50 * scale));
        EXPECT_LE(touched(paint(overlay, view, {400, 400}, Qt::gray, kEdges), 30, Qt::gray), near) << scale;
        EXPECT_GT(touched(paint(overlay, view, {400, 400}, Qt::gray, kEdges), 30, Qt::gray), 0) << scale;
    }
}

TEST(OverlayPainterTest, TwentyThousandPatchesInOneView) {
    const OverlayPainter overlay(testing::gridMesh(1400, 900, 125, 80));
    ViewTransform view;
    QElapsedTimer timer;
    timer.start();
    const QImage image =
        paint(overlay, view, {1400, 900}, Qt::gray, {.features = true, .edges = true, .controlPoints = true});
    RecordProperty("milliseconds", int(timer.elapsed()));
    EXPECT_GT(strongestContrast(image, Qt::gray), 0);
    // A guard against drawing without culling or by the pixel, not a benchmark: an idle core takes a tenth of
    // it.
    EXPECT_LT(timer.elapsed(), 3000);
    // Deep inside, only what is in view costs anything.
    view = scaled(200);
    timer.restart();
    for (int i = 0; i < 20; ++i) paint(overlay, view, {1400, 900}, Qt::gray, kEdges);
    RecordProperty("millisecondsDeep", int(timer.elapsed() / 20));
}

}  // namespace
}  // namespace tessera
