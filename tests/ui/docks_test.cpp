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

TEST_F(Docks, APanelThatIsFloatedMovesTowardsTheCanvas) {
    QDockWidget* panel = dock("vectorizeDock");
    const QPoint docked = panel->mapToGlobal(QPoint(0, 0));
    pressTitleButton(panel, "qt_dockwidget_floatbutton");
    ASSERT_TRUE(panel->isFloating());
    EXPECT_TRUE(QTest::qWaitFor([&] { return panel->pos().x() < docked.x() - 30; }, 2000))
        << panel->pos().x() << " of " << docked.x();
    // Qt docks it behind the others and lets it float over its place again the next time.
    pressTitleButton(panel, "qt_dockwidget_floatbutton");
    ASSERT_FALSE(panel->isFloating());
    QTest::qWait(500);
    panel->raise();
    QTest::qWait(100);
    pressTitleButton(panel, "qt_dockwidget_floatbutton");
    EXPECT_TRUE(QTest::qWaitFor([&] { return std::abs(panel->pos().x() - (docked.x() - 40)) < 8; }, 2000))
        << panel->pos().x() << " of " << docked.x();
    // Over the canvas it is left where it is.
    const QPoint over = panel->pos();
    QTest::qWait(400);
    EXPECT_EQ(panel->pos(), over);
}

TEST_F(Docks, ResetPanelsBringsAllBackToTheirPlaces) {
    const auto places = [&] {
        QList<QRect> rects;
        for (QDockWidget* panel : window->findChildren<QDockWidget*>())
            if (!panel->visibleRegion().isEmpty()) rects.append(panel->geometry());
        return rects;
    };
    QTest::qWait(50);
    const QList<QRect> atFirst = places();
    ASSERT_EQ(atFirst.size(), 2);
    pressTitleButton(dock("vectorizeDock"), "qt_dockwidget_floatbutton");
    pressTitleButton(dock("navigatorDock"), "qt_dockwidget_closebutton");
    window->addDockWidget(Qt::LeftDockWidgetArea, dock("selectionDock"));
    canvas().setFocus();
    QTest::keyClick(&canvas(), Qt::Key_Tab);
    action(ActionId::ResetPanels)->trigger();
    // Qt rounds how the groups share the height, and moves them there as one can see.
    const auto near = [](const QRect& a, const QRect& b) {
        return a.x() == b.x() && a.width() == b.width() && std::abs(a.y() - b.y()) < 16;
    };
    EXPECT_TRUE(QTest::qWaitFor(
        [&] {
            const QList<QRect> now = places();
            return now.size() == 2 && near(now[0], atFirst[0]) && near(now[1], atFirst[1]);
        },
        2000));
    EXPECT_FALSE(action(ActionId::HidePanels)->isChecked());
    for (QDockWidget* panel : window->findChildren<QDockWidget*>()) {
        EXPECT_FALSE(panel->isFloating());
        EXPECT_FALSE(panel->isHidden());
        EXPECT_EQ(window->dockWidgetArea(panel), Qt::RightDockWidgetArea);
    }
    EXPECT_TRUE(action(ActionId::ShowNavigatorPanel)->isChecked());
}

}  // namespace
}  // namespace tessera

int main(int argc, char** argv) {
    return tessera::runWindowTests(argc, argv);
}
