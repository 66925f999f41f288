// Panels that are closed, floated, hidden and brought back, now and at the next start.
#include <gtest/gtest.h>

#include <QAbstractButton>
#include <QDockWidget>

#include "tests/ui/main_window_fixture.h"

namespace tessera {
namespace {

class Docks : public MainWindowTest {
  protected:
    QDockWidget* dock(const char* name) { return window->findChild<QDockWidget*>(name); }
    // A button of a panel's title, by Qt's name for it.
    void pressTitleButton(QDockWidget* panel, const char* name) {
        auto* button = panel->findChild<QAbstractButton*>(name);
        ASSERT_NE(button, nullptr);
        QTest::mouseClick(button, Qt::LeftButton);
    }
    void startAgain() {
        ASSERT_TRUE(window->close());
        MainWindowTest::SetUp();
    }
    void TearDown() override {
        Settings().setBlob("state", {});
        Settings().setBlob("geometry", {});
    }
};

TEST_F(Docks, AClosedPanelStaysClosedUntilTheMenuBringsItBack) {
    QAction* shown = action(ActionId::ShowSelectionPanel);
    EXPECT_TRUE(shown->isChecked());
    pressTitleButton(dock("selectionDock"), "qt_dockwidget_closebutton");
    EXPECT_TRUE(dock("selectionDock")->isHidden());
    EXPECT_FALSE(shown->isChecked());
    startAgain();
    shown = action(ActionId::ShowSelectionPanel);
    EXPECT_TRUE(dock("selectionDock")->isHidden());
    EXPECT_FALSE(shown->isChecked());
    EXPECT_FALSE(dock("historyDock")->isHidden());
    shown->trigger();
    QTest::qWait(20);
    EXPECT_TRUE(dock("selectionDock")->isVisible());
    EXPECT_FALSE(dock("selectionDock")->visibleRegion().isEmpty()) << "it is behind another tab";
    startAgain();
    EXPECT_FALSE(dock("selectionDock")->isHidden());
}

TEST_F(Docks, AFloatingPanelFloatsAtTheNextStartAndItsKeysAreTheWindows) {
    pressTitleButton(dock("recolourDock"), "qt_dockwidget_floatbutton");
    EXPECT_TRUE(dock("recolourDock")->isFloating());
    startAgain();
    QDockWidget* panel = dock("recolourDock");
    EXPECT_TRUE(panel->isFloating());
    EXPECT_TRUE(panel->isVisible());
    openPhoto();
    vectorize();
    panel->activateWindow();
    auto* colour = panel->findChild<QWidget*>("colour");
    colour->setFocus();
    QTest::keyPress(panel, Qt::Key_O);
    EXPECT_TRUE(canvas().showsPhoto());
    QTest::keyRelease(panel, Qt::Key_O);
    EXPECT_FALSE(canvas().showsPhoto());
    session()->history().undo();
}

TEST_F(Docks, TabHidesWhatIsOpenAndNoMore) {
    pressTitleButton(dock("navigatorDock"), "qt_dockwidget_closebutton");
    pressTitleButton(dock("paletteDock"), "qt_dockwidget_floatbutton");
    canvas().setFocus();
    QTest::keyClick(&canvas(), Qt::Key_Tab);
    for (QDockWidget* panel : window->findChildren<QDockWidget*>()) EXPECT_TRUE(panel->isHidden());
    QTest::keyClick(&canvas(), Qt::Key_Tab);
    EXPECT_TRUE(dock("navigatorDock")->isHidden());
    EXPECT_TRUE(dock("paletteDock")->isVisible());
    EXPECT_FALSE(dock("vectorizeDock")->isHidden());
    // Hidden is not closed.
    QTest::keyClick(&canvas(), Qt::Key_Tab);
    startAgain();
    EXPECT_TRUE(dock("navigatorDock")->isHidden());
    EXPECT_FALSE(dock("vectorizeDock")->isHidden());
    EXPECT_TRUE(dock("paletteDock")->isFloating());
}

TEST_F(Docks, PanelsComeBackWithTheSameOnesInFront) {
    action(ActionId::ShowRecolourPanel)->setChecked(false);
    action(ActionId::ShowRecolourPanel)->trigger();
    action(ActionId::ShowHistoryPanel)->setChecked(false);
    action(ActionId::ShowHistoryPanel)->trigger();
    const auto inFront = [&] {
        QStringList names;
        for (QDockWidget* panel : window->findChildren<QDockWidget*>())
            if (!panel->visibleRegion().isEmpty()) names.append(panel->objectName());
        names.sort();
        return names;
    };
    const QStringList wanted{"historyDock", "recolourDock"};
    ASSERT_TRUE(QTest::qWaitFor([&] { return inFront() == wanted; }, 2000))
        << inFront().join(' ').toStdString();
    canvas().setFocus();
    QTest::keyClick(&canvas(), Qt::Key_Tab);
    QTest::qWait(50);
    EXPECT_EQ(inFront(), QStringList());
    QTest::keyClick(&canvas(), Qt::Key_Tab);
    QTest::qWait(50);
    EXPECT_EQ(inFront(), wanted) << inFront().join(' ').toStdString();
    // The same once more, and over the end of the program.
    QTest::keyClick(&canvas(), Qt::Key_Tab);
    startAgain();
    QTest::qWait(50);
    EXPECT_EQ(inFront(), wanted) << inFront().join(' ').toStdString();
}

}  // namespace
}  // namespace tessera

int main(int argc, char** argv) {
    return tessera::runWindowTests(argc, argv);
}
