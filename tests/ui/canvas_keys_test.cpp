// What panels and bars do to the keys: they hand them back, and the keys that are held act everywhere.
#include <gtest/gtest.h>

#include <QCheckBox>
#include <QComboBox>
#include <QDockWidget>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QLineEdit>
#include <QSpinBox>

#include "app/edit_session.h"
#include "tests/ui/main_window_fixture.h"
#include "ui/panels/gesture_slider.h"

namespace tessera {
namespace {

class CanvasKeysTest : public MainWindowTest {
  protected:
    void SetUp() override {
        MainWindowTest::SetUp();
        openPhoto();
        vectorize();
    }
    template <class T>
    T* shown(const char* dock, const char* name) {
        auto* panel = window->findChild<QDockWidget*>(dock);
        panel->show();
        panel->raise();
        QTest::qWait(20);
        auto* found = panel->findChild<T*>(name);
        EXPECT_NE(found, nullptr) << name;
        return found;
    }
    // To whoever has the focus, as a keyboard does.
    void press(Qt::Key key, Qt::KeyboardModifiers modifiers = {}) {
        QTest::keyPress(QApplication::focusWidget(), key, modifiers);
    }
    void release(Qt::Key key) { QTest::keyRelease(QApplication::focusWidget(), key); }
    void click(Qt::Key key, Qt::KeyboardModifiers modifiers = {}) {
        press(key, modifiers);
        release(key);
    }
    bool canvasHasKeys() {
        return QTest::qWaitFor([&] { return canvas().hasFocus(); }, 500);
    }
    // The panel is refreshed when there is time.
    GestureSlider* hueOfEverything() {
        click(Qt::Key_A, Qt::ControlModifier);
        auto* hue = shown<GestureSlider>("recolourDock", "hue");
        EXPECT_TRUE(QTest::qWaitFor([&] { return hue->isEnabled() && hue->isVisible(); }, kWaitMs));
        return hue;
    }
    // Drags a slider to a share of its length.
    void drag(GestureSlider* slider, double share) {
        const int y = slider->height() / 2;
        QTest::mousePress(slider, Qt::LeftButton, {}, QPoint(int(slider->xOf(slider->value())), y));
        QTest::mouseMove(slider, QPoint(int(share * slider->width()), y));
        QTest::mouseRelease(slider, Qt::LeftButton, {}, QPoint(int(share * slider->width()), y));
    }
};

TEST_F(CanvasKeysTest, ASliderHandsTheKeysBack) {
    auto* hue = hueOfEverything();
    drag(hue, .8);
    EXPECT_EQ(session()->history().undoText(), "Hue");
    ASSERT_TRUE(canvasHasKeys());
    press(Qt::Key_O);
    EXPECT_TRUE(canvas().showsPhoto());
    release(Qt::Key_O);
    EXPECT_FALSE(canvas().showsPhoto());
    click(Qt::Key_Escape);
    EXPECT_TRUE(session()->selection().empty());
}

TEST_F(CanvasKeysTest, HeldKeysActWhereverTheFocusIs) {
    auto* slider = shown<GestureSlider>("vectorizeDock", "amountSlider");
    slider->setFocus();
    press(Qt::Key_O);
    EXPECT_TRUE(canvas().showsPhoto());
    // The release goes to another one.
    shown<QSpinBox>("vectorizeDock", "patches")->setFocus();
    release(Qt::Key_O);
    EXPECT_FALSE(canvas().showsPhoto());

    window->tools().setTool(ToolId::Brush);
    slider->setFocus();
    const QPointF origin = canvas().view().origin();
    const int steps = session()->history().count();
    press(Qt::Key_Space);
    QTest::mousePress(&canvas(), Qt::LeftButton, {}, {300, 300});
    QTest::mouseMove(&canvas(), {290, 280});
    QTest::mouseRelease(&canvas(), Qt::LeftButton, {}, {290, 280});
    release(Qt::Key_Space);
    EXPECT_NE(canvas().view().origin(), origin);
    EXPECT_EQ(session()->history().count(), steps) << "the brush has painted";
}

TEST_F(CanvasKeysTest, WhatIsTypedIsNoCommand) {
    auto* hex = shown<QWidget>("recolourDock", "colour")->findChild<QLineEdit*>("hex");
    hex->setFocus();
    hex->selectAll();
    for (const auto key : {Qt::Key_F, Qt::Key_A, Qt::Key_B}) click(key);
    EXPECT_EQ(hex->text(), "fab");
    EXPECT_EQ(window->tools().tool(), ToolId::Select);
    click(Qt::Key_Return);
    EXPECT_EQ(hex->text(), "#ffaabb");
    EXPECT_TRUE(canvasHasKeys());
}

TEST_F(CanvasKeysTest, EscapeTakesBackWhatWasBeingTyped) {
    hueOfEverything();
    const int steps = session()->history().count();
    auto* hex = shown<QWidget>("recolourDock", "mean")->findChild<QLineEdit*>("hex");
    const QString before = hex->text();
    hex->setFocus();
    ASSERT_TRUE(hex->hasFocus());
    hex->selectAll();
    for (const auto key : {Qt::Key_F, Qt::Key_A, Qt::Key_B}) click(key);
    click(Qt::Key_Escape);
    EXPECT_TRUE(canvasHasKeys());
    EXPECT_EQ(hex->text(), before);
    auto* feather = shown<QDoubleSpinBox>("recolourDock", "feather");
    feather->setFocus();
    feather->selectAll();
    click(Qt::Key_9);
    click(Qt::Key_Escape);
    EXPECT_TRUE(canvasHasKeys());
    EXPECT_EQ(feather->value(), 0);
    EXPECT_EQ(session()->history().count(), steps);
}

TEST_F(CanvasKeysTest, AFieldForNumbersTakesNumbersAlone) {
    auto* patches = shown<QSpinBox>("vectorizeDock", "patches");
    patches->setFocus();
    patches->selectAll();
    click(Qt::Key_7);
    click(Qt::Key_7);
    click(Qt::Key_Return);
    EXPECT_EQ(patches->value(), 77);
    EXPECT_TRUE(canvasHasKeys());
    patches->setFocus();
    press(Qt::Key_O);
    EXPECT_TRUE(canvas().showsPhoto());
    release(Qt::Key_O);
    EXPECT_EQ(patches->text(), "77");
    // Nothing has been typed: undo is the document's.
    click(Qt::Key_Z, Qt::ControlModifier);
    EXPECT_FALSE(session()->hasMesh());
    click(Qt::Key_Z, Qt::ControlModifier | Qt::ShiftModifier);
    EXPECT_TRUE(session()->hasMesh());
    click(Qt::Key_B);
    EXPECT_EQ(window->tools().tool(), ToolId::Brush);
    EXPECT_TRUE(canvasHasKeys());
}

TEST_F(CanvasKeysTest, ChoicesAndSwitchesHandTheKeysBackToo) {
    window->tools().setTool(ToolId::Wand);
    QCheckBox* contiguous = nullptr;
    for (auto* box : window->findChildren<QCheckBox*>())
        if (box->text() == "Contiguous") contiguous = box;
    ASSERT_NE(contiguous, nullptr);
    const bool before = window->tools().options().wand.contiguous;
    contiguous->setFocus();
    click(Qt::Key_Space);
    EXPECT_NE(window->tools().options().wand.contiguous, before) << "who came with Tab switches with Space";
    QTest::mouseClick(contiguous, Qt::LeftButton, {}, {6, contiguous->height() / 2});
    EXPECT_EQ(window->tools().options().wand.contiguous, before);
    EXPECT_TRUE(canvasHasKeys());
    auto* quality = shown<QComboBox>("vectorizeDock", "quality");
    quality->setFocus();
    quality->showPopup();
    QTest::qWait(50);
    QTest::keyClick(QApplication::activePopupWidget()->focusWidget(), Qt::Key_Return);
    EXPECT_TRUE(canvasHasKeys());
}

TEST_F(CanvasKeysTest, HeldKeysCanBeOthers) {
    Settings settings;
    settings.setKey("peekOriginal", QKeySequence("P"));
    settings.setKey("nudgeLeft", QKeySequence("J"));
    const_cast<ActionTable&>(window->actions()).applyKeys(settings);
    press(Qt::Key_O);
    EXPECT_FALSE(canvas().showsPhoto());
    release(Qt::Key_O);
    press(Qt::Key_P);
    EXPECT_TRUE(canvas().showsPhoto());
    release(Qt::Key_P);
    window->tools().setTool(ToolId::Eyedropper);
    bool said = false;
    for (auto* label : window->findChildren<QLabel*>())
        said |= label->isVisible() && label->text().contains("P held picks from the photo");
    EXPECT_TRUE(said);

    window->tools().setTool(ToolId::Direct);
    const PatchMesh& mesh = session()->document().mesh;
    VertexId inner;
    mesh.forEachVertex([&](VertexId v) {
        const glm::dvec2 p = toPixels(mesh.position(v));
        if (p.x > 20 && p.y > 20 && p.x < 140 && p.y < 100) inner = v;
    });
    const glm::dvec2 from = toPixels(mesh.position(inner));
    QTest::mouseClick(&canvas(), Qt::LeftButton, {}, canvas().toWidget({from.x, from.y}).toPoint());
    click(Qt::Key_Left);
    EXPECT_EQ(toPixels(session()->document().mesh.position(inner)), from);
    click(Qt::Key_J);
    EXPECT_LT(toPixels(session()->document().mesh.position(inner)).x, from.x);
    for (const char* id : {"peekOriginal", "nudgeLeft"}) settings.setKey(id, std::nullopt);
}

TEST_F(CanvasKeysTest, HeldKeysTakePartInConflicts) {
    QList<KeyRow> rows = window->actions().keyRows();
    const auto rowOf = [&](const char* name) {
        for (int i = 0; i < rows.size(); ++i)
            if (rows[i].name == name) return i;
        return -1;
    };
    ASSERT_GE(rowOf("peekOriginal"), 0);
    EXPECT_TRUE(conflictingRows(rows).isEmpty());
    rows[rowOf("open")].current = QKeySequence("O");
    EXPECT_TRUE(conflictingRows(rows).contains(rowOf("peekOriginal")));
}

TEST_F(CanvasKeysTest, TipsOfButtonsSayTheKeysOfNow) {
    auto* all = shown<QPushButton>("selectionDock", "all");
    EXPECT_TRUE(all->toolTip().contains("(Ctrl+A)")) << all->toolTip().toStdString();
    Settings settings;
    settings.setKey("selectAll", QKeySequence("Ctrl+L"));
    const_cast<ActionTable&>(window->actions()).applyKeys(settings);
    EXPECT_TRUE(all->toolTip().contains("(Ctrl+L)")) << all->toolTip().toStdString();
    settings.setKey("selectAll", std::nullopt);
}

TEST_F(CanvasKeysTest, AGestureThatWaitsForMoreIsUndoneByUndo) {
    auto* hue = hueOfEverything();
    const int steps = session()->history().count();
    hue->setFocus();
    ASSERT_TRUE(hue->hasFocus());
    click(Qt::Key_Right);
    ASSERT_TRUE(session()->editing()) << "it waits for the next step";
    click(Qt::Key_Z, Qt::ControlModifier);
    EXPECT_FALSE(session()->editing());
    EXPECT_EQ(session()->history().count(), steps + 1);
    EXPECT_EQ(session()->history().redoText(), "Hue");
}

TEST_F(CanvasKeysTest, AGestureThatWaitsForMoreIsAskedAboutWhenTheWindowCloses) {
    window->saveTo(folder.filePath("disk.tessera"));
    ASSERT_TRUE(idle());
    ASSERT_FALSE(session()->modified());
    auto* hue = hueOfEverything();
    hue->setFocus();
    ASSERT_TRUE(hue->hasFocus());
    click(Qt::Key_Right);
    ASSERT_TRUE(session()->editing());
    answer(QMessageBox::Cancel);
    EXPECT_FALSE(window->close());
    EXPECT_TRUE(session()->modified());
    EXPECT_TRUE(window->isVisible());
}

TEST_F(CanvasKeysTest, FullScreenGoesBackToMaximized) {
    window->showMaximized();
    QTest::qWait(20);
    ASSERT_TRUE(window->isMaximized());
    action(ActionId::FullScreen)->trigger();
    QTest::qWait(20);
    EXPECT_TRUE(window->isFullScreen());
    action(ActionId::FullScreen)->trigger();
    QTest::qWait(20);
    EXPECT_FALSE(window->isFullScreen());
    EXPECT_TRUE(window->isMaximized());
}

TEST_F(CanvasKeysTest, ToolsAreChosenWhileTheFirstPatchesAreBeingMade) {
    openPhoto();
    window->panel().setPatches(kPatches);
    QTest::keyClick(&canvas(), Qt::Key_Return, Qt::ControlModifier);
    ASSERT_TRUE(workspace().running(JobKind::Vectorize));
    QTest::keyClick(&canvas(), Qt::Key_Y);
    EXPECT_EQ(window->tools().tool(), ToolId::Wand);
    QTest::keyClick(&canvas(), Qt::Key_V);
    EXPECT_EQ(window->tools().tool(), ToolId::Select);
    QTest::mouseClick(&canvas(), Qt::LeftButton, {}, canvas().rect().center());
    ASSERT_TRUE(idle());
    EXPECT_TRUE(session()->hasMesh());
}

}  // namespace
}  // namespace tessera

int main(int argc, char** argv) {
    return tessera::runWindowTests(argc, argv);
}
