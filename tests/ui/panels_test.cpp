// The panels through real events: what they show of a document, and what one gesture makes of it.
#include <gtest/gtest.h>

#include <QAbstractSpinBox>
#include <QApplication>
#include <QLabel>
#include <QLineEdit>
#include <QListView>
#include <QPushButton>
#include <QSpinBox>
#include <QTemporaryDir>
#include <QTest>
#include <QWheelEvent>
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "app/selection_actions.h"
#include "core/image/oklab.h"
#include "tests/support/panel_hands.h"
#include "ui/panels/colour_popup.h"
#include "ui/panels/history_panel.h"
#include "ui/panels/navigator.h"
#include "ui/panels/palette_panel.h"
#include "ui/panels/recolour_panel.h"
#include "ui/panels/selection_panel.h"
#include "ui/panels/swatch_button.h"

namespace tessera {
namespace {

using testing::column;
using testing::kColumns;
using testing::kRows;
using testing::PanelsTest;

constexpr int kWaitMs = 10'000;

struct PalettePanelTest : PanelsTest {
    PalettePanelTest() : store(folder.filePath("data/own.gpl")), panel(store) {
        QObject::connect(&panel, &PalettePanel::highlighted,
                         [this](const PatchSet& set) { highlighted = set; });
        QObject::connect(&panel, &PalettePanel::said, [this](const QString& text) { said = text; });
        panel.setToolOptions(tools);
        panel.setSession(session.get());
    }
    void SetUp() override {
        open(panel);
        ASSERT_TRUE(found());
    }
    bool found() {
        return QTest::qWaitFor([&] { return panel.current(); }, kWaitMs);
    }
    // The button of the entry that a patch belongs to.
    SwatchButton* entryOf(PatchId p) {
        const QColor colour =
            QColor::fromRgbF(float(colourOf(p).x), float(colourOf(p).y), float(colourOf(p).z));
        for (int i = 0; i < panel.colourCount(); ++i) {
            auto* button = panel.findChild<SwatchButton*>(QString("entry%1").arg(i));
            const QColor c = button->colour();
            if (std::abs(c.red() - colour.red()) + std::abs(c.green() - colour.green()) +
                    std::abs(c.blue() - colour.blue()) <
                6)
                return button;
        }
        return nullptr;
    }
    SwatchButton* swatch(int i) { return panel.findChild<SwatchButton*>(QString("swatch%1").arg(i)); }

    QTemporaryDir folder;
    SwatchStore store;
    PalettePanel panel;
    std::optional<PatchSet> highlighted;
    QString said;
};

TEST_F(PalettePanelTest, HoveringHighlightsAndAClickSelects) {
    ASSERT_EQ(panel.colourCount(), kColumns);
    SwatchButton* const red = entryOf(column(0)[0]);
    ASSERT_NE(red, nullptr);
    QTest::mouseMove(&panel, QPoint(2, 2));
    QTest::mouseMove(red);
    ASSERT_TRUE(QTest::qWaitFor([&] { return highlighted.has_value(); }, 1000));
    EXPECT_EQ(*highlighted, column(0));
    QTest::mouseMove(&panel, QPoint(2, 2));
    ASSERT_TRUE(QTest::qWaitFor([&] { return highlighted->empty(); }, 1000));
    click(red);
    EXPECT_EQ(selected(), column(0));
    click(entryOf(column(3)[0]), Qt::ShiftModifier);
    EXPECT_EQ(selected(), united(column(0), column(3)));
    click(red, Qt::AltModifier);
    EXPECT_EQ(selected(), column(3));
}

TEST_F(PalettePanelTest, LooksAgainWhenTheDocumentRests) {
    auto* colours = child<QSpinBox>(panel, "colours");
    colours->setValue(Palette::kLeast);
    EXPECT_FALSE(panel.current());
    ASSERT_TRUE(found());
    EXPECT_EQ(panel.colourCount(), Palette::kLeast);
    ASSERT_TRUE(applyEdit(*session, "Paint", [](PatchMesh& m) { return testing::paint(m, PatchId(0), 1); }));
    EXPECT_FALSE(panel.current());
    ASSERT_TRUE(found());
    panel.setSession(nullptr);
    EXPECT_EQ(panel.colourCount(), 0);
}

TEST_F(PalettePanelTest, AColourIsChangedEverywhereInOneStep) {
    QTest::mouseDClick(entryOf(column(0)[0]), Qt::LeftButton);
    auto* popup = panel.findChild<ColourPopup*>();
    ASSERT_TRUE(popup->isVisible());
    GestureSlider* const lightness = popup->findChildren<GestureSlider*>().first();
    dragTo(lightness, 900);
    EXPECT_TRUE(session->editing());
    EXPECT_GT(toOklch(colourOf(column(0)[0])).x, .8) << "live";
    release(lightness);
    QTest::keyClick(popup, Qt::Key_Return);
    EXPECT_FALSE(session->editing());
    ASSERT_EQ(history().count(), 1);
    EXPECT_GT(toOklch(colourOf(column(0)[0])).x, .8);
    EXPECT_LT(glm::distance(colourOf(column(1)[0]), {.2, .3, .8}), .06) << "another entry's";
    ASSERT_TRUE(found());
    EXPECT_NE(entryOf(column(0)[0]), nullptr) << "the palette has the new colour";
    history().undo();
    EXPECT_EQ(bytes(), start);
}

TEST_F(PalettePanelTest, SwatchesAreKeptAndSetTheToolsColour) {
    ToolOptions options = tools.options();
    options.colour = {1, .2, 0};
    tools.setOptions(options);
    click(child<QPushButton>(panel, "keep"));
    options.colour = {0, .4, 1};
    tools.setOptions(options);
    click(child<QPushButton>(panel, "keep"));
    click(child<QPushButton>(panel, "keep"));
    EXPECT_EQ(store.swatches().size(), 2u) << "the same once";
    click(swatch(1));
    EXPECT_EQ(tools.options().colour, glm::dvec3(1, .2, 0));
    const SwatchStore again(folder.filePath("data/own.gpl"));
    EXPECT_EQ(again.swatches(), store.swatches());

    const QString file = folder.filePath("out.gpl");
    panel.exportTo(file);
    store.remove(0);
    store.remove(0);
    EXPECT_EQ(swatch(0), nullptr);
    panel.importFrom(file);
    EXPECT_EQ(store.swatches(), again.swatches());
    EXPECT_EQ(said, QString());
    panel.importFrom(folder.filePath("none.gpl"));
    EXPECT_TRUE(said.contains("none.gpl")) << said.toStdString();
    panel.exportTo(folder.filePath("no/such/folder.gpl"));
    EXPECT_TRUE(said.contains("folder.gpl")) << said.toStdString();
}

struct SelectionPanelTest : PanelsTest {
    SelectionPanelTest() {
        panel.setToolOptions(tools);
        panel.setSession(session.get());
        QObject::connect(&panel, &SelectionPanel::said, [this](const QString& text) { said = text; });
    }
    void SetUp() override { open(panel); }
    void press(const char* name) { click(child<QPushButton>(panel, name)); }
    StoredList* list() { return child<StoredList>(panel, "stored"); }
    void clickRow(int row, Qt::KeyboardModifiers modifiers = {}) {
        QTest::mouseClick(list()->viewport(), Qt::LeftButton, modifiers,
                          list()->visualItemRect(list()->item(row)).center());
    }
    // Types into the name that is being edited.
    void type(const QString& name) {
        auto* editor = list()->findChild<QLineEdit*>();
        ASSERT_NE(editor, nullptr);
        editor->selectAll();
        QTest::keyClicks(editor, name);
        QTest::keyClick(editor, Qt::Key_Return);
        // The editor closes, and the list is filled anew, in later turns of the event loop.
        ASSERT_TRUE(QTest::qWaitFor([&] { return !list()->findChild<QLineEdit*>(); }, kWaitMs));
        QTest::qWait(100);
    }

    SelectionPanel panel;
    QString said;
};

TEST_F(SelectionPanelTest, ButtonsAndCounts) {
    auto* counts = child<QLabel>(panel, "counts");
    EXPECT_EQ(counts->text(), "Nothing selected");
    EXPECT_FALSE(child<QPushButton>(panel, "grow")->isEnabled());
    press("all");
    EXPECT_EQ(selected().size(), size_t(2 * kColumns * kRows));
    EXPECT_EQ(counts->text(), "48 of 48 patches");
    press("none");
    EXPECT_TRUE(selected().empty());
    session->selection().setPatches(column(2));
    QTest::qWait(5);
    press("invert");
    EXPECT_EQ(selected().size(), 40u);
    press("invert");
    press("grow");
    EXPECT_EQ(selected(), grown(mesh(), column(2)));
    press("shrink");
    EXPECT_EQ(selected(), column(2));
    session->selection().setPatches({column(2)[0]});
    QTest::qWait(5);
    press("similar");
    EXPECT_EQ(selected(), column(2));
    EXPECT_EQ(history().count(), 0) << "a selection is no step";
    panel.setSession(nullptr);
    EXPECT_FALSE(child<QPushButton>(panel, "all")->isEnabled());
}

TEST_F(SelectionPanelTest, PointsAndCurvesCanBeDeselectedToo) {
    session->selection().setShape({}, {EdgeId(3)});
    QTest::qWait(5);
    EXPECT_FALSE(child<QPushButton>(panel, "grow")->isEnabled());
    press("none");
    EXPECT_TRUE(session->selection().empty());
    QTest::qWait(5);
    EXPECT_FALSE(child<QPushButton>(panel, "none")->isEnabled());
}

TEST_F(SelectionPanelTest, TellsOfPatchesOutOfReach) {
    auto* counts = child<QLabel>(panel, "counts");
    session->selection().setPatches(column(1));
    ASSERT_TRUE(setFlag(*session, PatchFlag::Locked, true));
    session->selection().setPatches({column(2)[0]});
    ASSERT_TRUE(setFlag(*session, PatchFlag::Hidden, true));
    QTest::qWait(5);
    EXPECT_EQ(counts->text(), "Nothing selected\n1 hidden, 8 locked");
    ASSERT_TRUE(clearFlag(*session, PatchFlag::Locked));
    ASSERT_TRUE(clearFlag(*session, PatchFlag::Hidden));
    QTest::qWait(5);
    EXPECT_EQ(counts->text(), "Nothing selected");
}

TEST_F(SelectionPanelTest, StoresRecallsRenamesAndRemoves) {
    session->selection().setPatches(column(0));
    QTest::qWait(5);
    press("store");
    ASSERT_NO_FATAL_FAILURE(type("Sky"));
    session->selection().setPatches(column(1));
    QTest::qWait(5);
    press("store");
    ASSERT_NO_FATAL_FAILURE(type("Sea"));
    ASSERT_EQ(list()->count(), 2);
    EXPECT_EQ(list()->item(0)->text(), "Sky");
    EXPECT_EQ(session->document().selections[1].name, "Sea");

    clickRow(0);
    EXPECT_EQ(selected(), column(0));
    clickRow(1, Qt::ShiftModifier);
    EXPECT_EQ(selected(), united(column(0), column(1)));
    clickRow(0, Qt::AltModifier);
    EXPECT_EQ(selected(), column(1));

    list()->setCurrentRow(0);
    QTest::keyClick(list(), Qt::Key_F2);
    ASSERT_NO_FATAL_FAILURE(type("Sea"));
    EXPECT_TRUE(said.contains("Sea")) << said.toStdString();
    EXPECT_EQ(list()->item(0)->text(), "Sky") << "names are all different";
    list()->setCurrentRow(0);
    QTest::keyClick(list(), Qt::Key_F2);
    ASSERT_NO_FATAL_FAILURE(type("Heaven"));
    EXPECT_EQ(session->document().selections[0].name, "Heaven");

    const auto before = bytes();
    list()->setCurrentRow(0);
    QTest::keyClick(list(), Qt::Key_Delete);
    ASSERT_EQ(list()->count(), 1);
    EXPECT_EQ(list()->item(0)->text(), "Sea");
    history().undo();
    EXPECT_EQ(list()->count(), 2);
    EXPECT_EQ(bytes(), before);
    while (history().canUndo()) history().undo();
    EXPECT_EQ(bytes(), start);
}

struct HistoryPanelTest : PanelsTest {
    void SetUp() override {
        for (uint32_t i = 0; i < 3; ++i)
            ASSERT_TRUE(applyEdit(*session, QString("Step %1").arg(i),
                                  [&](PatchMesh& m) { return testing::paint(m, PatchId(i), 1); }));
        panel.setSession(session.get());
        open(panel);
    }
    QListView* list() { return child<QListView>(panel, "steps"); }

    HistoryPanel panel;
};

TEST_F(HistoryPanelTest, AClickGoesToAState) {
    EXPECT_EQ(list()->currentIndex().row(), 3);
    const auto end = bytes();
    const QModelIndex first = list()->model()->index(1, 0);
    QTest::mouseClick(list()->viewport(), Qt::LeftButton, {}, list()->visualRect(first).center());
    EXPECT_EQ(history().index(), 1);
    EXPECT_TRUE(list()->model()->index(2, 0).data(HistoryModel::UndoneRole).toBool());
    QTest::keyClick(list(), Qt::Key_Up);
    EXPECT_EQ(history().index(), 0);
    EXPECT_EQ(bytes(), start);
    QTest::keyClick(list(), Qt::Key_End);
    EXPECT_EQ(bytes(), end);
}

TEST_F(HistoryPanelTest, FollowsTheDocument) {
    auto* memory = child<QLabel>(panel, "memory");
    EXPECT_TRUE(memory->text().startsWith("Steps: 3, ")) << memory->text().toStdString();
    history().undo();
    EXPECT_EQ(list()->currentIndex().row(), 2);
    ASSERT_TRUE(applyEdit(*session, "New", [](PatchMesh& m) { return testing::paint(m, PatchId(9), 0); }));
    EXPECT_EQ(list()->model()->rowCount(), 4);
    EXPECT_EQ(list()->currentIndex().row(), 3);
    {
        EditSession gesture(*session, "Gesture");
        list()->setCurrentIndex(list()->model()->index(0, 0));
        EXPECT_EQ(history().index(), 3) << "waits for the end of a gesture";
    }
    QTest::qWait(10);
    EXPECT_EQ(history().index(), 0);
    EXPECT_EQ(list()->currentIndex().row(), 0);
    panel.setSession(nullptr);
    EXPECT_EQ(list()->model()->rowCount(), 0);
}

// What rows look like: undone ones are dimmer, and the one in the file has a mark.
TEST_F(HistoryPanelTest, UndoneStepsAreDimAndTheSavedOneIsMarked) {
    const auto ink = [&](int row) {
        const QRect rect = list()->visualRect(list()->model()->index(row, 0));
        const QImage image = list()->viewport()->grab(rect).toImage();
        const QColor ground = list()->palette().color(QPalette::Base);
        double most = 0;
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x)
                most =
                    std::max(most, std::abs(image.pixelColor(x, y).lightnessF() - ground.lightnessF()) * 1.);
        return most;
    };
    history().goTo(1);
    EXPECT_GT(ink(0), 1.3 * ink(2));
    const auto row = [&](int i) {
        return list()->viewport()->grab(list()->visualRect(list()->model()->index(i, 0))).toImage();
    };
    const QImage before = row(2);
    session->markSaved(history().revision(2), "x.tessera", {});
    EXPECT_NE(row(2), before);
}

struct NavigatorTest : ::testing::Test {
    void SetUp() override {
        navigator.resize(260, 220);
        navigator.show();
        ASSERT_TRUE(QTest::qWaitForWindowExposed(&navigator));
        QImage picture(80, 60, QImage::Format_RGB32);
        picture.fill(Qt::darkGreen);
        navigator.setPicture(picture);
        navigator.setVisibleRect(QRectF(200, 150, 200, 150), kSize);
        QObject::connect(&navigator, &Navigator::moveRequested, [this](QPointF to) { moved = to; });
        QObject::connect(&navigator, &Navigator::zoomRequested, [this](double to) { scale = to; });
    }
    NavigatorView* view() { return navigator.findChild<NavigatorView*>("view"); }
    QPoint at(QPointF image) {
        const QRectF rect = view()->pictureRect();
        return (rect.topLeft() +
                QPointF(image.x() * rect.width() / kSize.width(), image.y() * rect.height() / kSize.height()))
            .toPoint();
    }
    double pixel() { return kSize.width() / view()->pictureRect().width(); }

    static constexpr QSizeF kSize{800, 600};
    Navigator navigator;
    std::optional<QPointF> moved;
    std::optional<double> scale;
};

TEST_F(NavigatorTest, TheFrameIsDraggedWithoutAJump) {
    QTest::mousePress(view(), Qt::LeftButton, {}, at({250, 200}));
    EXPECT_FALSE(moved.has_value());
    QTest::mouseMove(view(), at({350, 300}));
    ASSERT_TRUE(moved.has_value());
    EXPECT_NEAR(moved->x(), 400, 2 * pixel());
    EXPECT_NEAR(moved->y(), 325, 2 * pixel());
    QTest::mouseRelease(view(), Qt::LeftButton, {}, at({350, 300}));
    moved.reset();
    QTest::mouseMove(view(), at({100, 100}));
    EXPECT_FALSE(moved.has_value());
}

TEST_F(NavigatorTest, APressBesideTheFrameGoesThere) {
    QTest::mouseClick(view(), Qt::LeftButton, {}, at({700, 500}));
    ASSERT_TRUE(moved.has_value());
    EXPECT_NEAR(moved->x(), 700, pixel());
    EXPECT_NEAR(moved->y(), 500, pixel());
}

TEST_F(NavigatorTest, ZoomsBySliderAndWheel) {
    navigator.setScale(2);
    EXPECT_FALSE(scale.has_value()) << "being told is no request";
    auto* zoom = navigator.findChild<QSlider*>("zoom");
    zoom->setFocus();
    QTest::keyClick(zoom, Qt::Key_PageUp);
    ASSERT_TRUE(scale.has_value());
    EXPECT_NEAR(*scale, 4, 1e-9);
    QTest::keyClick(zoom, Qt::Key_End);
    EXPECT_EQ(*scale, 1000);
    QTest::keyClick(zoom, Qt::Key_Home);
    EXPECT_EQ(*scale, .01);
    navigator.setScale(1);
    QWheelEvent event({50, 50}, view()->mapToGlobal(QPointF(50, 50)), {}, {0, 120}, Qt::NoButton, {},
                      Qt::NoScrollPhase, false);
    QApplication::sendEvent(view(), &event);
    EXPECT_NEAR(*scale, std::exp2(.25), 1e-9);
}

// Every control says what it is.
TEST_F(PanelsTest, ControlsHaveNames) {
    QTemporaryDir folder;
    SwatchStore store(folder.filePath("own.gpl"));
    RecolourPanel recolour;
    PalettePanel palette(store);
    SelectionPanel selection;
    HistoryPanel history;
    Navigator navigator;
    for (QWidget* panel : {static_cast<QWidget*>(&recolour), static_cast<QWidget*>(&palette),
                           static_cast<QWidget*>(&selection), static_cast<QWidget*>(&history),
                           static_cast<QWidget*>(&navigator)})
        for (QWidget* control : panel->findChildren<QWidget*>()) {
            const bool isInner = control->objectName().startsWith("qt_") ||
                                 qobject_cast<QAbstractSpinBox*>(control->parentWidget());
            if (control->focusPolicy() == Qt::NoFocus || isInner) continue;
            EXPECT_FALSE(control->accessibleName().isEmpty())
                << panel->accessibleName().toStdString() << ": " << control->metaObject()->className() << " "
                << control->objectName().toStdString();
        }
}

}  // namespace
}  // namespace tessera

int main(int argc, char** argv) {
    return tessera::testing::runPanelTests(argc, argv);
}
