// Overlays: legible on any ground, of constant size, and only where they were asked for.
#include "ui/overlay_painter.h"

#include <gtest/gtest.h>

#include <QElapsedTimer>
#include <QImage>
#include <algorithm>

#include "core/mesh/patch_query.h"
#include "tests/support/test_meshes.h"
#include "ui/centres_painter.h"

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

// The lengths of the runs of one colour along a row, those at its ends left out.
std::vector<int> runsAlong(const QImage& image, int y, QColor colour) {
    std::vector<int> runs;
    int run = 0;
    bool whole = false;
    for (int x = 0; x < image.width(); ++x) {
        if (image.pixelColor(x, y) == colour) {
            ++run;
            continue;
        }
        if (run > 0 && whole) runs.push_back(run);
        run = 0;
        whole = true;
    }
    return runs;
}

TEST(OverlayPainterTest, DashesAreAsLongOnShortEdgesAsOnLongOnes) {
    // A row of straight edges, each a few px long on the screen, and the ends of half of them turned.
    for (const int columns : {100, 37, 4}) {
        const PatchMesh mesh = testing::gridMesh(100, 100, columns, 2);
        std::vector<std::pair<double, EdgeId>> row;
        mesh.forEachEdge([&](EdgeId e) {
            const auto p = toPixels(mesh.controlPoints(HalfedgeMesh::halfedge(e))).p;
            if (p[0].y == 50 && p[3].y == 50) row.emplace_back(std::min(p[0].x, p[3].x), e);
        });
        std::sort(row.begin(), row.end());
        std::vector<EdgeId> edges;
        for (const auto& [x, e] : row) edges.push_back(e);
        QImage image(400, 400, QImage::Format_RGB32);
        image.fill(Qt::gray);
        QPainter painter(&image);
        const LineStyle dashed{Qt::white, Qt::black, 2, 4, true};
        OverlayPainter(mesh).paintOutline(painter, scaled(4), QRectF(image.rect()), 1, edges, dashed);
        painter.end();
        const std::vector<int> runs = runsAlong(image, 200, Qt::white);
        ASSERT_GT(runs.size(), 20U) << columns;
        const auto [least, most] = std::minmax_element(runs.begin(), runs.end());
        EXPECT_LE(*most - *least, 2) << columns;
    }
}

// Two columns of cells of one colour each, a feature between them.
PatchMesh twoColours(float left, float right) {
    PatchMesh mesh = testing::gridMesh(100, 100, 2, 1);
    mesh.forEachPatch([&](PatchId p) {
        const bool isLeft = controlBounds(mesh, p).max.x < 51;
        const std::array<float, 3> grey{isLeft ? left : right, isLeft ? left : right, isLeft ? left : right};
        mesh.setSpline(p, constantSpline(grey));
    });
    mesh.forEachEdge([&](EdgeId e) {
        const auto p = mesh.controlPoints(HalfedgeMesh::halfedge(e));
        EdgeCurve curve = mesh.curve(e);
        curve.feature = toPixels(p[0]).x == 50 && toPixels(p[3]).x == 50;
        mesh.setCurve(e, curve);
    });
    return mesh;
}

TEST(OverlayPainterTest, TheColourOfAFeatureSaysHowFarColoursJump) {
    constexpr OverlayOptions kImportance{.features = true, .tint = FeatureTint::Importance};
    const auto hueOf = [&](const OverlayPainter& overlay) {
        return paint(overlay, scaled(4), {400, 400}, Qt::black, kImportance).pixelColor(200, 200).hue();
    };
    const auto measured = [](const PatchMesh& mesh) {
        OverlayPainter overlay(mesh);
        overlay.measureJumps(mesh);
        return overlay;
    };
    const PatchMesh strong = twoColours(.1F, .9F), faint = twoColours(.5F, .51F);
    OverlayPainter overlay = measured(strong);
    const int yellow = hueOf(overlay);
    EXPECT_NEAR(yellow, 45, 15);
    EXPECT_NEAR(hueOf(measured(faint)), 218, 15);
    std::vector<EdgeId> all;
    faint.forEachEdge([&](EdgeId e) { all.push_back(e); });
    overlay.update(faint, all);
    EXPECT_NEAR(hueOf(overlay), 218, 15) << "an edit left the old jump";
}

TEST(CentresPainterTest, CentresAppearWhereThereIsRoomAndKeepTheirSize) {
    const PatchMesh mesh = testing::gridMesh(100, 100, 1, 1);
    const auto marks = [&](double scale, QPointF at) {
        QImage image(400, 400, QImage::Format_RGB32);
        image.fill(Qt::gray);
        ViewTransform view = scaled(scale);
        view.panBy(QPointF(200, 200) - view.toScreen(at));
        QPainter painter(&image);
        paintCentres(painter, mesh, view, QRectF(image.rect()), 1);
        painter.end();
        int count = 0;
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x)
                count += image.pixelColor(x, y) != QColor(Qt::gray) ? 1 : 0;
        return count;
    };
    EXPECT_EQ(marks(.3, {50, 50}), 0) << "they hide what they belong to";
    EXPECT_GT(marks(4, {50, 50}), 200);
    // The one in the corner, alone in view.
    const int near = marks(40, {0, 0});
    EXPECT_GT(near, 15);
    EXPECT_LT(near, 120);
    EXPECT_NEAR(marks(300, {0, 0}), near, 12);
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
