// The canvas drawn with OpenGL, software's where there is no other: what it shows is what the CPU would draw.
#include <gtest/gtest.h>

#include "app/edit_session.h"
#include "core/edit/recolour.h"
#include "core/export/rasterize.h"
#include "tests/ui/main_window_fixture.h"
#include "ui/gl_drawer.h"

namespace tessera {
namespace {

class GlCanvas : public MainWindowTest {
  protected:
    void SetUp() override {
        qputenv("TESSERA_RENDERER", "gl");
        MainWindowTest::SetUp();
        qunsetenv("TESSERA_RENDERER");
        if (!canvas().drawnWithOpenGl()) GTEST_SKIP() << "no OpenGL 4.5 on this display";
        openPhoto();
        vectorize();
        QTest::keyClick(&canvas(), Qt::Key_1, Qt::ControlModifier);
        ASSERT_TRUE(settled());
    }

    QImage shown() { return grab().copy(QRect(canvas().view().origin().toPoint(), QSize(160, 120))); }
    QImage drawnByTheCpu() {
        const PatchMesh& mesh = session()->document().mesh;
        const auto drawn =
            rasterize(mesh, wholePicture(mesh, {1, 1}), {.samples = kPictureSamples, .showHidden = false});
        return toQImage(*drawn).convertToFormat(QImage::Format_RGB32);
    }
};

TEST_F(GlCanvas, ShowsWhatTheCpuDraws) {
    EXPECT_LT(difference(shown(), drawnByTheCpu()), .5);
    EXPECT_GT(difference(shown(), drawnByTheCpu().mirrored()), 5) << "the comparison sees nothing";
}

// Bytes are read back: each is the one that the CPU's frame would have been rounded to, or the next.
TEST_F(GlCanvas, TransparencyIsThatOfTheCpu) {
    session()->selection().setPatches({PatchId(0), PatchId(1), PatchId(2), PatchId(3)});
    action(ActionId::CutOut)->trigger();
    ASSERT_TRUE(settled());
    const auto drawer = makeCanvasRenderer(true).drawer;
    const PatchMesh& mesh = session()->document().mesh;
    drawer->setMesh(mesh);
    const View view = wholePicture(mesh, {1, 1});
    const auto frame = drawer->draw(view);
    ASSERT_TRUE(frame.has_value()) << frame.error().message;
    const auto drawn = rasterize(mesh, view, {.samples = kPictureSamples, .showHidden = false});
    const QImage expected = toQImage(*drawn);
    ASSERT_EQ(frame->format(), QImage::Format_ARGB32_Premultiplied);
    ASSERT_EQ(frame->size(), expected.size());
    int clear = 0, far = 0;
    for (int y = 0; y < expected.height(); ++y)
        for (int x = 0; x < expected.width(); ++x) {
            const QRgb a = frame->pixel(x, y), b = expected.pixel(x, y);
            clear += qAlpha(a) == 0 ? 1 : 0;
            far += std::abs(qRed(a) - qRed(b)) > 2 || std::abs(qGreen(a) - qGreen(b)) > 2 ||
                           std::abs(qBlue(a) - qBlue(b)) > 2 || std::abs(qAlpha(a) - qAlpha(b)) > 2
                       ? 1
                       : 0;
        }
    EXPECT_GT(clear, 0);
    EXPECT_LT(far, expected.width() * expected.height() / 200);
}

TEST_F(GlCanvas, FollowsEdits) {
    const QImage before = shown();
    const auto touched = applyEdit(*session(), "Levels", [](PatchMesh& mesh) -> Result<Touched> {
        return recolour(mesh, {PatchId(0), PatchId(1), PatchId(2)}, Levels{.brightness = .3, .contrast = 0});
    });
    ASSERT_TRUE(touched.has_value());
    ASSERT_TRUE(settled());
    EXPECT_GT(difference(shown(), before), 0);
    EXPECT_LT(difference(shown(), drawnByTheCpu()), .5);
    session()->history().undo();
    ASSERT_TRUE(settled());
    EXPECT_EQ(difference(shown(), before), 0);
}

}  // namespace
}  // namespace tessera

int main(int argc, char** argv) {
    return tessera::runWindowTests(argc, argv);
}
