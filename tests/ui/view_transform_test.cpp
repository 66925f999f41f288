// Zooming, panning and fitting as plain arithmetic.
#include "ui/view_transform.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tessera {
namespace {

double distance(QPointF a, QPointF b) {
    return std::hypot(a.x() - b.x(), a.y() - b.y());
}

TEST(ViewTransformTest, ScreenAndImageAreInverse) {
    ViewTransform view;
    view.setScaleAt({100, 40}, 3.7);
    view.panBy({-12.5, 99});
    const QPointF point(31.25, -7);
    EXPECT_LT(distance(view.toImage(view.toScreen(point)), point), 1e-12);
}

TEST(ViewTransformTest, ZoomKeepsThePointUnderTheCursor) {
    ViewTransform view;
    view.fit({800, 600}, {1000, 700}, 20);
    const QPointF cursor(333, 222);
    const QPointF image = view.toImage(cursor);
    for (int i = 0; i < 60; ++i) {
        view.zoomAt(cursor, i < 40 ? 1.2 : 1 / 1.2);
        if (view.scale() == 1) continue;
        EXPECT_LT(distance(view.toScreen(image), cursor), 1);
    }
}

TEST(ViewTransformTest, ScaleStaysWithinOnePercentAndAHundredThousand) {
    ViewTransform view;
    view.zoomAt({0, 0}, 1e9);
    EXPECT_EQ(view.scale(), 1000);
    view.zoomAt({0, 0}, 1e-9);
    EXPECT_EQ(view.scale(), .01);
}

TEST(ViewTransformTest, AHundredPercentLiesOnWholePixels) {
    ViewTransform view;
    view.fit({4000, 3000}, {1001, 701}, 20);
    const QPointF cursor(500.3, 350.8);
    const QPointF image = view.toImage(cursor);
    view.setScaleAt(cursor, 1);
    EXPECT_EQ(view.scale(), 1);
    EXPECT_EQ(view.origin().x(), std::round(view.origin().x()));
    EXPECT_EQ(view.origin().y(), std::round(view.origin().y()));
    EXPECT_LE(distance(view.toScreen(image), cursor), std::sqrt(.5));
    view.panBy({.4, 10.7});
    EXPECT_EQ(view.origin().y(), std::round(view.origin().y()));
}

TEST(ViewTransformTest, FitShowsAllAndNeverEnlarges) {
    ViewTransform view;
    view.fit({4000, 1000}, {1000, 800}, 20);
    const QRectF shown = view.toScreen(QRectF(0, 0, 4000, 1000));
    EXPECT_NEAR(shown.width(), 960, 1e-9);
    EXPECT_NEAR(shown.center().x(), 500, 1);
    EXPECT_NEAR(shown.center().y(), 400, 1);
    view.fit({10, 10}, {1000, 800}, 20);
    EXPECT_EQ(view.scale(), 1);
}

TEST(ViewTransformTest, FitOfNothingChangesNothing) {
    ViewTransform view;
    const ViewTransform before = view;
    view.fit({0, 0}, {1000, 800}, 20);
    view.fit({10, 10}, {0, 0}, 20);
    EXPECT_EQ(view, before);
}

TEST(ViewTransformTest, PanningCannotLoseTheImage) {
    ViewTransform view;
    view.fit({400, 300}, {1000, 800}, 20);
    for (const QPointF push : {QPointF(1e6, 1e6), QPointF(-1e6, -1e6)}) {
        view.panBy(push);
        view.keepInView({400, 300}, {1000, 800});
        EXPECT_TRUE(view.toScreen(QRectF(0, 0, 400, 300)).intersects(QRectF(0, 0, 1000, 800)));
    }
}

TEST(ViewTransformTest, ZoomLevelsClimbAndFallThroughTheSameValues) {
    double scale = .01;
    int steps = 0;
    while (scale < 1000) {
        const double next = ViewTransform::nextScale(scale, true);
        ASSERT_GT(next, scale);
        ASSERT_LE(next, scale * 2.01);
        EXPECT_EQ(ViewTransform::nextScale(next, false), scale);
        scale = next;
        ++steps;
    }
    EXPECT_GT(steps, 25);
    EXPECT_EQ(ViewTransform::nextScale(1000, true), 1000);
    EXPECT_EQ(ViewTransform::nextScale(.7, true), 1);
    EXPECT_EQ(ViewTransform::nextScale(1.3, false), 1);
}

}  // namespace
}  // namespace tessera
