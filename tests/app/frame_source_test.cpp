// Which views are drawn, and when: with a drawer that counts them, and one that fails.
#include "app/frame_source.h"

#include <gtest/gtest.h>

#include <QSignalSpy>
#include <QTest>

#include "core/edit/recolour.h"
#include "tests/support/test_meshes.h"

namespace tessera {
namespace {

struct Drawn {
    std::vector<View> views;
    bool fails = false;
};

class CountingDrawer : public FrameDrawer {
  public:
    explicit CountingDrawer(Drawn& drawn) : mDrawn(drawn) {}
    void setMesh(const PatchMesh&) override {}
    void update(const PatchMesh&, std::span<const PatchId>) override {}
    Result<QImage> draw(const View& view) override {
        if (mDrawn.fails) return failure(ErrorCode::Internal, "the graphics card was reset");
        mDrawn.views.push_back(view);
        return QImage(view.width, view.height, QImage::Format_RGB32);
    }

  private:
    Drawn& mDrawn;
};

struct FrameSourceTest : ::testing::Test {
    FrameSourceTest() {
        source.setDrawer(std::make_unique<CountingDrawer>(drawn));
        source.setMesh(mesh);
        source.request(view(0));
    }
    // A part of the picture, moved by some pixels.
    static View view(double x) { return {.origin = {x, 0}, .scale = {2, 2}, .width = 100, .height = 80}; }
    bool drawnAll() {
        return QTest::qWaitFor([&] { return source.settled() && source.overview(); }, 2000);
    }
    size_t overviews() const {
        return size_t(std::count_if(drawn.views.begin(), drawn.views.end(),
                                    [](const View& v) { return v.scale == glm::dvec2(1, 1); }));
    }

    PatchMesh mesh = testing::curvedMesh(120, 90, 5, 4, 3);
    Drawn drawn;
    FrameSource source;
};

TEST_F(FrameSourceTest, TheViewIsDrawnFirstAndTheOverviewAfterwards) {
    ASSERT_TRUE(drawnAll());
    ASSERT_EQ(drawn.views.size(), 2u);
    EXPECT_TRUE(sameView(drawn.views[0], view(0)));
    EXPECT_EQ(overviews(), 1u);
}

TEST_F(FrameSourceTest, APanDrawsOneViewAStep) {
    ASSERT_TRUE(drawnAll());
    drawn.views.clear();
    for (int i = 1; i <= 10; ++i) {
        source.request(view(i));
        QTest::qWait(1);
    }
    ASSERT_TRUE(drawnAll());
    QTest::qWait(200);
    EXPECT_EQ(drawn.views.size(), 10u);
    EXPECT_EQ(overviews(), 0u) << "nothing in it has changed";
}

TEST_F(FrameSourceTest, AnEditDrawsTheOverviewOnceItRests) {
    ASSERT_TRUE(drawnAll());
    drawn.views.clear();
    QSignalSpy overviewReady(&source, &FrameSource::overviewReady);
    for (int i = 1; i <= 5; ++i) {
        const Touched touched = recolour(mesh, {PatchId(0)}, Levels{.brightness = .05 * i, .contrast = 0});
        source.updateMesh(mesh, touched);
        QTest::qWait(1);
    }
    ASSERT_TRUE(drawnAll());
    EXPECT_EQ(overviews(), 1u);
    EXPECT_EQ(overviewReady.count(), 1);
    EXPECT_LE(drawn.views.size(), 6u);
}

TEST_F(FrameSourceTest, WorkersTakeOverFromADrawerThatFails) {
    ASSERT_TRUE(drawnAll());
    QSignalSpy lost(&source, &FrameSource::drawerLost);
    drawn.fails = true;
    source.request(view(5));
    ASSERT_TRUE(drawnAll());
    ASSERT_EQ(lost.count(), 1);
    EXPECT_EQ(lost[0][0].toString(), "the graphics card was reset");
    EXPECT_FALSE(source.hasDrawer());
    EXPECT_TRUE(sameView(source.latest()->view, view(5)));
    const auto expected = rasterize(mesh, view(5), {.samples = kPictureSamples});
    ASSERT_TRUE(expected.has_value());
    EXPECT_NEAR(source.latest()->image.pixelColor(50, 40).redF(), expected->at(50, 40, 0), 1. / 255);
}

}  // namespace
}  // namespace tessera
