// The recolouring panel through real events: one gesture is one step, and sliders are taken up again.
#include "ui/panels/recolour_panel.h"

#include <gtest/gtest.h>

#include <QDoubleSpinBox>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QShortcut>
#include <QSignalSpy>
#include <QTest>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/image/oklab.h"
#include "tests/support/panel_hands.h"
#include "ui/panels/colour_field.h"
#include "ui/panels/colour_popup.h"
#include "ui/panels/swatch_button.h"

namespace tessera {
namespace {

using testing::column;
using testing::PanelsTest;
using testing::stripes;

// Longer than a slider waits for further steps.
constexpr int kRestMs = 700;

struct RecolourPanelTest : PanelsTest {
    RecolourPanelTest() {
        panel.setToolOptions(tools);
        panel.setSession(session.get());
        QObject::connect(&panel, &RecolourPanel::said, [this](const QString& text) { said = text; });
    }
    void SetUp() override { open(panel); }
    GestureSlider* slider(const char* name) { return child<GestureSlider>(panel, name); }
    void select(const PatchSet& set) {
        session->selection().setPatches(set);
        QTest::qWait(5);
    }

    RecolourPanel panel;
    QString said;
};

TEST_F(RecolourPanelTest, WantsASelection) {
    auto* hint = child<QLabel>(panel, "hint");
    EXPECT_TRUE(hint->isVisible());
    EXPECT_FALSE(slider("hue")->isEnabled());
    select(column(0));
    EXPECT_FALSE(hint->isVisible());
    EXPECT_TRUE(slider("hue")->isEnabled());
    EXPECT_LT(glm::distance(child<ColourField>(panel, "mean")->colour(), {.8, .3, .2}), 1e-3);
    panel.setSession(nullptr);
    EXPECT_TRUE(hint->isVisible());
    EXPECT_FALSE(slider("hue")->isEnabled());
}

TEST_F(RecolourPanelTest, ADragIsOneStepThatUndoTakesBack) {
    select(column(0));
    dragTo(slider("hue"), 90);
    EXPECT_TRUE(session->editing()) << "live";
    EXPECT_GT(glm::distance(colourOf(column(0)[0]), {.8, .3, .2}), .1);
    EXPECT_EQ(history().count(), 0);
    release(slider("hue"));
    EXPECT_FALSE(session->editing());
    ASSERT_EQ(history().count(), 1);
    EXPECT_LT(glm::distance(colourOf(column(1)[0]), {.2, .3, .8}), 1e-6) << "what is not selected stays";
    const double turned = toOklch(colourOf(column(0)[0])).z - toOklch({.8, .3, .2}).z;
    EXPECT_NEAR(turned, slider("hue")->value(), 1.5);
    EXPECT_NEAR(slider("hue")->value(), 90, 3);
    const auto after = bytes();
    history().undo();
    QTest::qWait(5);
    EXPECT_EQ(bytes(), start);
    EXPECT_EQ(slider("hue")->value(), 0) << "the slider shows what the document has";
    history().redo();
    QTest::qWait(5);
    EXPECT_EQ(bytes(), after);
    EXPECT_NEAR(slider("hue")->value(), 90, 3);
}

TEST_F(RecolourPanelTest, WithoutASelectionThereIsNoColourOfIt) {
    auto* hex = child<QWidget>(panel, "mean")->findChild<QLineEdit*>("hex");
    select(column(0));
    EXPECT_EQ(hex->text(), "#cc4d33");
    select({});
    EXPECT_EQ(hex->text(), "");
    EXPECT_EQ(child<QWidget>(panel, "colour")->findChild<QLineEdit*>("hex")->text().size(), 7)
        << "that of the tools is always there";
}

TEST_F(RecolourPanelTest, ASliderIsTakenUpAgain) {
    select(column(0));
    dragTo(slider("chroma"), -100);
    release(slider("chroma"));
    EXPECT_LT(toOklch(colourOf(column(0)[0])).y, .01) << "grey";
    dragTo(slider("chroma"), -50);
    release(slider("chroma"));
    EXPECT_EQ(history().count(), 2);
    EXPECT_NEAR(toOklch(colourOf(column(0)[0])).y, .5 * toOklch({.8, .3, .2}).y, .01)
        << "the grey remembers its colour";
    QTest::mouseDClick(slider("chroma"), Qt::LeftButton);
    EXPECT_EQ(slider("chroma")->value(), 0);
    EXPECT_EQ(history().count(), 3);
    EXPECT_EQ(colourOf(column(0)[0]), meanColour(stripes(), column(0)[0]).srgb) << "to the bit";
}

// The rest after a step is no reason to lose it.
TEST_F(RecolourPanelTest, AGestureThatWaitsForMoreIsKeptWhenTheSelectionChanges) {
    select(column(0));
    slider("hue")->setFocus();
    wheel(slider("hue"), 40);
    ASSERT_TRUE(session->editing());
    session->selection().setPatches(column(1));
    EXPECT_FALSE(session->editing());
    ASSERT_EQ(history().count(), 1);
    EXPECT_GT(glm::distance(colourOf(column(0)[0]), {.8, .3, .2}), .1);
    EXPECT_LT(glm::distance(colourOf(column(1)[0]), {.2, .3, .8}), 1e-6);
    QTest::qWait(5);
    EXPECT_EQ(slider("hue")->value(), 0) << "of the new selection";
}

TEST_F(RecolourPanelTest, AGestureThatWaitsForMoreIsKeptWhenAnotherDocumentIsShown) {
    select(column(0));
    slider("hue")->setFocus();
    wheel(slider("hue"), 40);
    ASSERT_TRUE(session->editing());
    panel.setSession(nullptr);
    EXPECT_FALSE(session->editing());
    EXPECT_EQ(history().count(), 1);
}

TEST_F(RecolourPanelTest, AnotherKindBeginsWithWhatIsThere) {
    select(column(0));
    dragTo(slider("lightness"), 20);
    release(slider("lightness"));
    const glm::dvec3 lighter = colourOf(column(0)[0]);
    dragTo(slider("brightness"), -10);
    EXPECT_EQ(slider("lightness")->value(), 0);
    release(slider("brightness"));
    const glm::dvec3 darker = colourOf(column(0)[0]);
    EXPECT_NEAR(lighter.x - darker.x, -slider("brightness")->value() / 100., .01);
    EXPECT_EQ(history().count(), 2);
}

TEST_F(RecolourPanelTest, AnotherSelectionBeginsAnew) {
    select(column(0));
    dragTo(slider("hue"), 60);
    release(slider("hue"));
    select(column(1));
    EXPECT_EQ(slider("hue")->value(), 0);
    const glm::dvec3 first = colourOf(column(0)[0]);
    dragTo(slider("hue"), 60);
    release(slider("hue"));
    EXPECT_EQ(colourOf(column(0)[0]), first);
}

TEST_F(RecolourPanelTest, AnotherChangeBeginsAnew) {
    select(column(0));
    dragTo(slider("hue"), 60);
    release(slider("hue"));
    const auto paint = [](PatchMesh& m) { return testing::paint(m, column(0)[0], .5f); };
    ASSERT_TRUE(applyEdit(*session, "Brush", paint));
    QTest::qWait(5);
    EXPECT_EQ(slider("hue")->value(), 0);
    dragTo(slider("lightness"), 20);
    release(slider("lightness"));
    EXPECT_NEAR(toOklch(colourOf(column(0)[0])).x - toOklch(glm::dvec3(.5)).x,
                slider("lightness")->value() / 100., .01)
        << "what was painted is what it begins with";
    history().undo();
    history().undo();
    QTest::qWait(5);
    EXPECT_EQ(history().index(), 1);
    EXPECT_EQ(slider("hue")->value(), 0) << "it has been taken up elsewhere since";
}

TEST_F(RecolourPanelTest, KeysOfASliderAreNoShortcuts) {
    select(column(0));
    QShortcut remove(Qt::Key_Delete, &panel);
    const QSignalSpy removed(&remove, &QShortcut::activated);
    dragTo(slider("hue"), 60);
    release(slider("hue"));
    QTest::keyClick(slider("hue"), Qt::Key_Delete);
    EXPECT_EQ(removed.count(), 0);
    EXPECT_EQ(slider("hue")->value(), 0);
    child<QPushButton>(panel, "hide")->setFocus();
    QTest::keyClick(child<QPushButton>(panel, "hide"), Qt::Key_Delete);
    EXPECT_EQ(removed.count(), 1) << "elsewhere it is the window's";
}

TEST_F(RecolourPanelTest, AClickAloneIsNoStepAndEscapeTakesBack) {
    select(column(0));
    click(slider("hue"));
    EXPECT_EQ(history().count(), 0);
    dragTo(slider("hue"), 90);
    QTest::keyClick(slider("hue"), Qt::Key_Escape);
    EXPECT_FALSE(session->editing());
    EXPECT_EQ(bytes(), start);
    release(slider("hue"));
    EXPECT_EQ(history().count(), 0);
    EXPECT_EQ(slider("hue")->value(), 0);
    dragTo(slider("hue"), 90);
    QTest::mouseMove(slider("hue"), QPoint(int(slider("hue")->xOf(0)), 5));
    release(slider("hue"));
    EXPECT_EQ(history().count(), 0) << "back where it began";
}

TEST_F(RecolourPanelTest, TurnsOfTheWheelAndKeysAreOneStep) {
    select(column(0));
    GestureSlider* const lightness = slider("lightness");
    wheel(lightness, 1);
    EXPECT_EQ(lightness->value(), 0) << "without the focus the panel scrolls";
    lightness->setFocus();
    for (int i = 0; i < 3; ++i) wheel(lightness, 1);
    EXPECT_EQ(lightness->value(), 3);
    EXPECT_TRUE(session->editing());
    QTest::qWait(kRestMs);
    EXPECT_FALSE(session->editing());
    EXPECT_EQ(history().count(), 1);
    for (int i = 0; i < 4; ++i) QTest::keyClick(lightness, Qt::Key_PageUp);
    QTest::qWait(kRestMs);
    EXPECT_EQ(lightness->value(), 43);
    EXPECT_EQ(history().count(), 2);
    QTest::keyClick(lightness, Qt::Key_Delete);
    QTest::qWait(kRestMs);
    EXPECT_EQ(lightness->value(), 0);
    EXPECT_EQ(history().count(), 3);
}

TEST_F(RecolourPanelTest, AColourIsReplacedByItsDigits) {
    select(column(0));
    auto* hex = child<QLineEdit>(*child<ColourField>(panel, "mean"), "hex");
    hex->setFocus();
    hex->selectAll();
    QTest::keyClicks(hex, "#3366cc");
    QTest::keyClick(hex, Qt::Key_Return);
    ASSERT_EQ(history().count(), 1);
    EXPECT_LT(glm::distance(colourOf(column(0)[0]), glm::dvec3(0x33, 0x66, 0xcc) / 255.), 2e-3);
    hex->selectAll();
    QTest::keyClicks(hex, "33");
    QTest::keyClick(hex, Qt::Key_Return);
    EXPECT_EQ(history().count(), 1) << "half a colour is none";
    EXPECT_EQ(hex->text(), "#3366cc");
}

TEST_F(RecolourPanelTest, APopupIsOneStepUntilItIsClosed) {
    select(column(0));
    auto* field = child<ColourField>(panel, "mean");
    click(child<SwatchButton>(*field, "swatch"));
    auto* popup = field->findChild<ColourPopup*>();
    ASSERT_TRUE(popup->isVisible());
    const auto sliders = popup->findChildren<GestureSlider*>();
    ASSERT_EQ(sliders.size(), 3);
    for (GestureSlider* part : sliders) {
        dragTo(part, 400);
        release(part);
    }
    EXPECT_TRUE(session->editing());
    EXPECT_EQ(history().count(), 0);
    QTest::keyClick(popup, Qt::Key_Return);
    EXPECT_FALSE(session->editing());
    EXPECT_EQ(history().count(), 1);
    EXPECT_NEAR(toOklch(colourOf(column(0)[0])).x, .4, .01);

    click(child<SwatchButton>(*field, "swatch"));
    dragTo(sliders[0], 900);
    release(sliders[0]);
    QTest::keyClick(popup, Qt::Key_Escape);
    EXPECT_FALSE(session->editing());
    EXPECT_EQ(history().count(), 1);
    EXPECT_NEAR(toOklch(colourOf(column(0)[0])).x, .4, .01);
}

TEST_F(RecolourPanelTest, SharesColoursAndFeatherWithTheTools) {
    ToolOptions options = tools.options();
    options.colour = {1, 0, 0};
    options.secondColour = {0, 0, 1};
    options.featherPx = 3;
    tools.setOptions(options);
    EXPECT_EQ(child<ColourField>(panel, "colour")->colour(), glm::dvec3(1, 0, 0));
    EXPECT_EQ(child<QDoubleSpinBox>(panel, "feather")->value(), 3);
    click(child<QWidget>(panel, "exchange"));
    EXPECT_EQ(tools.options().colour, glm::dvec3(0, 0, 1));
    EXPECT_EQ(tools.options().secondColour, glm::dvec3(1, 0, 0));
    select(column(0));
    auto* feather = child<QDoubleSpinBox>(panel, "feather");
    feather->setFocus();
    QTest::keyClick(feather, Qt::Key_Up);
    EXPECT_EQ(tools.options().featherPx, 4);
    feather->setValue(0);
    click(child<QPushButton>(panel, "use"));
    EXPECT_LT(glm::distance(colourOf(column(0)[0]), {0, 0, 1}), 2e-3);
    EXPECT_EQ(history().count(), 1);
    click(child<QPushButton>(panel, "reset"));
    EXPECT_EQ(colourOf(column(0)[0]), meanColour(stripes(), column(0)[0]).srgb);
}

TEST_F(RecolourPanelTest, HidesLocksAndCutsOut) {
    select(column(0));
    auto* cutOut = child<QPushButton>(panel, "cutOut");
    click(cutOut);
    QTest::qWait(5);
    EXPECT_TRUE(mesh().attributes(column(0)[0]).cutOut);
    EXPECT_EQ(cutOut->text(), "Fill in");
    click(cutOut);
    EXPECT_FALSE(mesh().attributes(column(0)[0]).cutOut);
    click(child<QPushButton>(panel, "lock"));
    EXPECT_TRUE(mesh().attributes(column(0)[0]).locked);
    EXPECT_TRUE(selected().empty());
    select(column(1));
    click(child<QPushButton>(panel, "hide"));
    EXPECT_TRUE(mesh().attributes(column(1)[0]).hidden);
    EXPECT_EQ(history().count(), 4);
}

TEST_F(RecolourPanelTest, SaysWhatFails) {
    select(column(0));
    click(child<QPushButton>(panel, "reset"));
    EXPECT_TRUE(said.contains("Nothing has been edited")) << said.toStdString();
    EditSession other(*session, "Other");
    dragTo(slider("hue"), 50);
    release(slider("hue"));
    EXPECT_TRUE(said.contains("under way")) << said.toStdString();
    EXPECT_EQ(slider("hue")->value(), 0);
    EXPECT_EQ(history().count(), 0);
}

TEST_F(RecolourPanelTest, OutlivesItsDocument) {
    select(column(0));
    dragTo(slider("hue"), 50);
    tools.setSession(nullptr);
    session.reset();
    release(slider("hue"));
    EXPECT_TRUE(child<QLabel>(panel, "hint")->isVisible());
}

TEST(ColourPopup, ColoursBeyondSrgbLoseChroma) {
    for (const double hue : {0., 90., 200., 300.}) {
        const glm::dvec3 asked(.6, .33, hue);
        const glm::dvec3 got = toOklch(oklchInGamut(asked));
        EXPECT_NEAR(got.x, asked.x, .01) << hue;
        EXPECT_LT(got.y, asked.y) << hue;
        EXPECT_NEAR(std::remainder(got.z - hue, 360), 0, 1.5) << hue;
    }
    EXPECT_LT(glm::distance(oklchInGamut(toOklch({.3, .6, .2})), {.3, .6, .2}), 1e-5) << "inside it stays";
}

}  // namespace
}  // namespace tessera

int main(int argc, char** argv) {
    return tessera::testing::runPanelTests(argc, argv);
}
