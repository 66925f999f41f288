// Editing through the window with real events, from the photo to the exported picture.
#include <gtest/gtest.h>

#include <QFile>
#include <QSlider>
#include <QTabBar>

#include "app/edit_actions.h"
#include "core/document/codec.h"
#include "core/export/rasterize.h"
#include "core/mesh/mesh_validate.h"
#include "tests/ui/main_window_fixture.h"
#include "ui/panels/gesture_slider.h"
#include "ui/status_bar.h"
#include "ui/theme.h"

namespace tessera {
namespace {

class Editing : public MainWindowTest {
  protected:
    void SetUp() override {
        MainWindowTest::SetUp();
        openPhoto();
        vectorize();
    }

    QPoint at(double x, double y) { return canvas().toWidget({x, y}).toPoint(); }
    void key(Qt::Key key, Qt::KeyboardModifiers modifiers = {}) {
        QTest::keyClick(&canvas(), key, modifiers);
    }
    void click(QPoint position, Qt::KeyboardModifiers modifiers = {}) {
        QTest::mouseClick(&canvas(), Qt::LeftButton, modifiers, position);
    }
    void drag(QPoint from, const std::vector<QPoint>& path) {
        QTest::mousePress(&canvas(), Qt::LeftButton, {}, from);
        for (const QPoint position : path) QTest::mouseMove(&canvas(), position);
        QTest::mouseRelease(&canvas(), Qt::LeftButton, {}, path.back());
    }
    std::vector<uint8_t> bytes() {
        Document copy = session()->document();
        return encodeDocument(copy).value();
    }
    const PatchMesh& mesh() { return session()->document().mesh; }
    std::vector<std::string> violations() { return validate(mesh()).violations; }
    // A vertex inside the picture, and where it is.
    VertexId innerVertex() {
        VertexId found;
        mesh().forEachVertex([&](VertexId v) {
            const glm::dvec2 p = toPixels(mesh().position(v));
            if (!found.valid() && p.x > 20 && p.y > 20 && p.x < 140 && p.y < 100) found = v;
        });
        return found;
    }
};

TEST_F(Editing, FromThePhotoToTheExport) {
    // Zoom at the cursor, select the disk with the wand, and paint it.
    wheel(QPointF(at(80, 60)), 4, Qt::ControlModifier);
    key(Qt::Key_Y);
    click(at(80, 60));
    const PatchSet disk = session()->selection().patches();
    ASSERT_FALSE(disk.empty());
    EXPECT_LT(disk.size(), mesh().patchCount());
    const std::vector<uint8_t> before = bytes();

    key(Qt::Key_B);
    const int steps = session()->history().count();
    drag(at(75, 60), {at(78, 61), at(82, 62), at(86, 60)});
    EXPECT_EQ(session()->history().count(), steps + 1) << "a stroke is one step";
    EXPECT_NE(bytes(), before);
    key(Qt::Key_Z, Qt::ControlModifier);
    EXPECT_EQ(bytes(), before);

    // Drag a vertex far beyond what its patches allow: they never fold.
    key(Qt::Key_0, Qt::ControlModifier);
    key(Qt::Key_A);
    const VertexId vertex = innerVertex();
    ASSERT_TRUE(vertex.valid());
    const glm::dvec2 from = toPixels(mesh().position(vertex));
    const QPoint grip = at(from.x, from.y);
    QTest::mousePress(&canvas(), Qt::LeftButton, {}, grip);
    for (int i = 1; i <= 20; ++i) {
        QTest::mouseMove(&canvas(), grip + QPoint(i * 25, i * 5));
        EXPECT_EQ(violations(), std::vector<std::string>()) << i;
    }
    EXPECT_TRUE(window->tools().overlay().blocking.has_value()) << "nobody says why it goes no further";
    QTest::mouseRelease(&canvas(), Qt::LeftButton, {}, grip + QPoint(500, 100));
    EXPECT_NE(toPixels(mesh().position(vertex)), from);
    EXPECT_EQ(violations(), std::vector<std::string>());

    // Save, close, open: the same bytes.
    const QString path = folder.filePath("edited.tessera");
    window->saveTo(path);
    ASSERT_TRUE(idle());
    QFile file(path);
    ASSERT_TRUE(file.open(QIODevice::ReadOnly));
    const QByteArray content = file.readAll();
    const std::vector<uint8_t> saved(content.begin(), content.end());
    key(Qt::Key_W, Qt::ControlModifier);
    ASSERT_EQ(session(), nullptr);
    window->open(path);
    ASSERT_TRUE(idle());
    EXPECT_EQ(bytes(), saved);
    EXPECT_FALSE(session()->modified());

    // The export is what the CPU renderer draws.
    const QString picture = folder.filePath("edited.png");
    workspace().exportPicture({.path = picture, .scale = 2});
    ASSERT_TRUE(idle());
    const auto drawn = rasterize(mesh(), wholePicture(mesh(), {2, 2}), {.samples = kPictureSamples});
    ASSERT_TRUE(drawn.has_value());
    EXPECT_LT(difference(QImage(picture), toQImage(*drawn).convertToFormat(QImage::Format_RGB32)), .01);
}

TEST_F(Editing, KeysChooseToolsAndSelections) {
    key(Qt::Key_Q);
    EXPECT_EQ(window->tools().tool(), ToolId::Lasso);
    EXPECT_TRUE(action(ActionId::ToolLasso)->isChecked());
    key(Qt::Key_V);
    EXPECT_EQ(window->tools().tool(), ToolId::Select);
    key(Qt::Key_A, Qt::ControlModifier);
    EXPECT_EQ(session()->selection().patches().size(), mesh().patchCount());
    key(Qt::Key_A, Qt::ControlModifier | Qt::ShiftModifier);
    EXPECT_TRUE(session()->selection().patches().empty());
    drag(at(-5, -5), {at(60, 50), at(165, 125)});
    EXPECT_EQ(session()->selection().patches().size(), mesh().patchCount());
    key(Qt::Key_I, Qt::ControlModifier | Qt::ShiftModifier);
    EXPECT_TRUE(session()->selection().patches().empty());
}

TEST_F(Editing, AHiddenPatchIsNotDrawnUntilAllAreShown) {
    ASSERT_TRUE(settled());
    const QImage before = grab();
    click(at(80, 60));
    ASSERT_EQ(session()->selection().patches().size(), 1u);
    key(Qt::Key_3, Qt::ControlModifier);
    ASSERT_TRUE(settled());
    const QImage hidden = grab();
    EXPECT_GT(difference(hidden, before), 0);
    const CanvasColours colours = canvasColours(Settings().theme());
    const QColor there = hidden.pixelColor(at(80, 60) * hidden.devicePixelRatio());
    EXPECT_TRUE(there == colours.checkLight || there == colours.checkDark)
        << there.name().toStdString() << ": one sees through a hidden patch";
    EXPECT_TRUE(session()->selection().patches().empty());
    key(Qt::Key_3, Qt::ControlModifier | Qt::AltModifier);
    ASSERT_TRUE(settled());
    EXPECT_EQ(difference(grab(), before), 0);
}

TEST_F(Editing, TheEyedropperSeesWhatIsSeenThoughThePointerRests) {
    key(Qt::Key_A, Qt::ControlModifier);
    ASSERT_TRUE(recolourSelection(*session(), "Replace Colour", ReplaceColour{{.1, .6, .2}}, {}));
    key(Qt::Key_I);
    const QPoint disk = at(80, 60);
    QTest::mouseMove(&canvas(), disk);
    const auto swatch = [&] {
        const auto& found = window->tools().overlay().swatch;
        return found ? found->colour : glm::dvec3(-1);
    };
    const glm::dvec3 painted = swatch();
    ASSERT_GT(painted.g, painted.r);
    QTest::keyPress(&canvas(), Qt::Key_O);
    const glm::dvec3 photographed = swatch();
    EXPECT_GT(photographed.r, photographed.g) << "the disk is orange";
    QTest::keyRelease(&canvas(), Qt::Key_O);
    EXPECT_EQ(swatch(), painted);
    QTest::keyPress(&canvas(), Qt::Key_Alt);
    EXPECT_EQ(swatch(), photographed) << "Alt picks from the other one";
    QTest::keyRelease(&canvas(), Qt::Key_Alt);
    EXPECT_EQ(swatch(), painted);
}

TEST_F(Editing, ThePanelSaysWhenThePhotoIsMissing) {
    auto* find = window->panel().findChild<QPushButton*>("findPhoto");
    ASSERT_NE(find, nullptr);
    EXPECT_FALSE(find->isVisible());
    session()->relinkPhoto({}, session()->document().source);
    EXPECT_TRUE(find->isVisible());
    workspace().relinkPhoto(photo);
    ASSERT_TRUE(idle());
    EXPECT_FALSE(find->isVisible());
}

// New patches are in pages of memory that the mesh from before does not have: nobody may look for them there.
TEST_F(Editing, ASelectionThatIsSplitGoesOnWithItsParts) {
    constexpr size_t kPatchesOfAPage = 512;
    for (uint32_t i = 0; mesh().patchCount() < kPatchesOfAPage + 20; ++i) {
        ASSERT_LT(i, 4 * kPatchesOfAPage) << "too few could be split";
        const PatchId p(i);
        if (alive(mesh(), {p}).empty()) continue;
        const size_t before = mesh().patchCount();
        session()->selection().setPatches({p});
        action(ActionId::SplitPatches)->trigger();
        EXPECT_EQ(session()->selection().patches().size(), 1 + mesh().patchCount() - before);
    }
    ASSERT_TRUE(settled());
}

TEST_F(Editing, TheSelectionIsOutlinedAndFitsTheView) {
    ASSERT_TRUE(settled());
    const QImage before = grab();
    click(at(80, 60));
    EXPECT_GT(difference(grab(), before), 0);
    const double scale = canvas().view().scale();
    key(Qt::Key_3);
    EXPECT_GT(canvas().view().scale(), scale);
    key(Qt::Key_QuoteLeft);
    EXPECT_EQ(canvas().view().scale(), scale);
}

TEST_F(Editing, ASelectedPointFitsTheView) {
    key(Qt::Key_A);
    const glm::dvec2 from = toPixels(mesh().position(innerVertex()));
    click(at(from.x, from.y));
    ASSERT_EQ(session()->selection().points().size(), 1u);
    const double scale = canvas().view().scale();
    key(Qt::Key_3);
    EXPECT_GT(canvas().view().scale(), scale);
    EXPECT_TRUE(canvas().visiblePart().contains(QPointF(from.x, from.y)));
}

TEST_F(Editing, EachTabKeepsItsViewAndItsZoomBefore) {
    const QString second = folder.filePath("second.png");
    ASSERT_TRUE(disk(90, 70).save(second));
    window->open(second);
    ASSERT_TRUE(idle());
    ASSERT_TRUE(QTest::qWaitFor([&] { return window->tabs().isVisible(); }, kWaitMs));
    QTest::qWait(20);
    workspace().setCurrent(workspace().sessions().first());
    for (int i = 0; i < 5; ++i) wheel(QPointF(at(80, 60)), 1, Qt::ControlModifier);
    const ViewTransform first = canvas().view();
    workspace().setCurrent(workspace().sessions().last());
    const ViewTransform fitted = canvas().view();
    EXPECT_FALSE(fitted == first);
    key(Qt::Key_QuoteLeft);
    EXPECT_EQ(canvas().view(), fitted) << "no zoom before: that of the other tab is not this one's";
    workspace().setCurrent(workspace().sessions().first());
    EXPECT_EQ(canvas().view(), first);
    key(Qt::Key_QuoteLeft);
    EXPECT_LT(canvas().view().scale(), first.scale());
    key(Qt::Key_QuoteLeft);
    EXPECT_EQ(canvas().view(), first);
    workspace().setCurrent(workspace().sessions().last());
    // It still follows the window, which is no zoom of the user's.
    window->resize(800, 560);
    QTest::qWait(20);
    EXPECT_LE(canvas().view().scale(), fitted.scale());
    workspace().setCurrent(workspace().sessions().first());
    EXPECT_EQ(canvas().view().scale(), first.scale());
    EXPECT_FALSE(canvas().visiblePart().isEmpty());
    key(Qt::Key_0, Qt::ControlModifier);
    window->resize(1000, 700);
    QTest::qWait(20);
    key(Qt::Key_QuoteLeft);
    EXPECT_EQ(canvas().view().scale(), first.scale()) << "a resize is no zoom";
}

TEST_F(Editing, ADragOfTheNavigatorsSliderIsOneZoom) {
    auto* dock = window->findChild<QWidget*>("navigatorDock");
    auto* zoom = dock->findChild<GestureSlider*>("zoom");
    ASSERT_NE(zoom, nullptr);
    const ViewTransform before = canvas().view();
    const int y = zoom->height() / 2;
    const QPoint from(int(zoom->xOf(zoom->value())), y);
    QTest::mousePress(zoom, Qt::LeftButton, {}, from);
    for (int i = 1; i <= 6; ++i) QTest::mouseMove(zoom, from + QPoint(6 * i, 0));
    QTest::mouseRelease(zoom, Qt::LeftButton, {}, from + QPoint(36, 0));
    EXPECT_GT(canvas().view().scale(), before.scale());
    canvas().setFocus();
    key(Qt::Key_QuoteLeft);
    EXPECT_EQ(canvas().view(), before);
}

TEST_F(Editing, TheColourUnderTheCursorIsTheOneSeenThere) {
    key(Qt::Key_A, Qt::ControlModifier);
    ASSERT_TRUE(recolourSelection(*session(), "Replace Colour", ReplaceColour{{.1, .6, .2}}, {}));
    key(Qt::Key_A, Qt::ControlModifier | Qt::ShiftModifier);
    ASSERT_TRUE(settled());
    QColor colour;
    const QObject scope;
    QObject::connect(&canvas(), &CanvasWidget::cursorMoved, &scope,
                     [&](std::optional<QPointF>, QColor shown) { colour = shown; });
    key(Qt::Key_I);
    const auto swatch = [&] { return window->tools().overlay().swatch->colour; };
    const QPoint left = at(60, 60), right = at(100, 60);
    const QColor orange(240, 180, 60);
    std::optional<QPointF> cursor;
    QObject::connect(&canvas(), &CanvasWidget::cursorMoved, &scope,
                     [&](std::optional<QPointF> image) { cursor = image; });
    // The pointer moves by way of the X server.
    const auto moveTo = [&](QPoint position) {
        QTest::mouseMove(&canvas(), position);
        ASSERT_TRUE(QTest::qWaitFor(
            [&] { return cursor && canvas().toWidget(*cursor).toPoint() == position; }, kWaitMs));
    };
    moveTo(left);
    EXPECT_GT(colour.green(), colour.red());
    action(ActionId::Split)->trigger();
    EXPECT_EQ(colour, orange);
    EXPECT_GT(swatch().r, swatch().g);
    moveTo(right);
    EXPECT_GT(colour.green(), colour.red());
    EXPECT_GT(swatch().g, swatch().r);
    action(ActionId::Split)->trigger();
    action(ActionId::XRay)->trigger();
    EXPECT_EQ(colour, orange) << "the lens is there though the pointer rests";
    EXPECT_GT(swatch().r, swatch().g);
    action(ActionId::XRay)->trigger();
    EXPECT_GT(colour.green(), colour.red());
    EXPECT_GT(swatch().g, swatch().r);
}

TEST_F(Editing, SplitViewShowsThePhotoLeftOfItsLine) {
    ASSERT_TRUE(settled());
    const QImage vector = grab();
    key(Qt::Key_6, Qt::ControlModifier);
    const QImage split = grab();
    // Below the words that say which side is which.
    const int middle = canvas().width() / 2, top = canvas().height() / 2;
    const auto right = [&](const QImage& image) {
        return image.copy(middle + 4, top, image.width() - middle - 4, image.height() - top);
    };
    const auto left = [&](const QImage& image) {
        return image.copy(0, top, middle - 4, image.height() - top);
    };
    EXPECT_EQ(difference(right(split), right(vector)), 0);
    EXPECT_GT(difference(left(split), left(vector)), 0);
    drag({middle, 100}, {{middle - 60, 100}, {middle - 120, 100}});
    EXPECT_LT(difference(grab(), vector), difference(split, vector));
    EXPECT_TRUE(session()->selection().empty()) << "the line was dragged, not the tool";
}

TEST_F(Editing, DocumentsHaveTabs) {
    EXPECT_FALSE(window->tabs().isVisible());
    const QString second = folder.filePath("second.png");
    ASSERT_TRUE(disk(90, 70).save(second));
    window->open(second);
    ASSERT_TRUE(idle());
    ASSERT_EQ(workspace().sessions().size(), 2);
    EXPECT_EQ(session()->width(), 90);
    ASSERT_TRUE(QTest::qWaitFor([&] { return window->tabs().isVisible(); }, kWaitMs));
    QTest::mouseClick(&window->tabs(), Qt::LeftButton, {}, window->tabs().tabRect(0).center());
    EXPECT_EQ(session()->width(), 160);
    answer(QMessageBox::Discard);
    key(Qt::Key_W, Qt::ControlModifier);
    EXPECT_EQ(session()->width(), 90);
}

TEST_F(Editing, EscapeGivesBackWhatADragHasMoved) {
    key(Qt::Key_A);
    const std::vector<uint8_t> before = bytes();
    const VertexId vertex = innerVertex();
    const glm::dvec2 from = toPixels(mesh().position(vertex));
    const QPoint grip = at(from.x, from.y);
    QTest::mousePress(&canvas(), Qt::LeftButton, {}, grip);
    QTest::mouseMove(&canvas(), grip + QPoint(10, 4));
    QTest::mouseMove(&canvas(), grip + QPoint(20, 8));
    EXPECT_NE(toPixels(mesh().position(vertex)), from);
    QTest::keyClick(&canvas(), Qt::Key_Escape);
    QTest::mouseRelease(&canvas(), Qt::LeftButton, {}, grip + QPoint(20, 8));
    EXPECT_EQ(bytes(), before);
    EXPECT_FALSE(session()->editing());
}

}  // namespace
}  // namespace tessera

int main(int argc, char** argv) {
    return tessera::runWindowTests(argc, argv);
}
