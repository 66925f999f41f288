// The panels through real events: what they show of a document, and what one gesture makes of it.
#include <gtest/gtest.h>

#include <QApplication>
#include <QDoubleSpinBox>
#include <QFile>
#include <QLabel>
#include <QLineEdit>
#include <QListView>
#include <QPushButton>
#include <QShortcut>
#include <QSignalSpy>
#include <QSpinBox>
#include <QTemporaryDir>
#include <QTest>
#include <QWheelEvent>
#include <glm/geometric.hpp>

#include "app/selection_actions.h"
#include "app/tools/tool_manager.h"
#include "core/image/oklab.h"
#include "tests/support/edits.h"
#include "tests/support/test_meshes.h"
#include "ui/application.h"
#include "ui/panels/colour_field.h"
#include "ui/panels/colour_popup.h"
#include "ui/panels/gesture_slider.h"
#include "ui/panels/history_panel.h"
#include "ui/panels/navigator.h"
#include "ui/panels/palette_panel.h"
#include "ui/panels/recolour_panel.h"
#include "ui/panels/selection_panel.h"
#include "ui/panels/swatch_button.h"

namespace tessera {
namespace {

constexpr int kColumns = 6, kRows = 4;
constexpr int kWaitMs = 10'000;
// Longer than a slider waits for further steps.
constexpr int kRestMs = 700;

// Straight cells of two patches each, every column of one colour.
PatchMesh stripes() {
    static constexpr std::array<std::array<float, 3>, kColumns> kColours{{{.8f, .3f, .2f},
                                                                          {.2f, .3f, .8f},
                                                                          {.2f, .7f, .3f},
                                                                          {.9f, .8f, .2f},
                                                                          {.5f, .5f, .5f},
                                                                          {.1f, .1f, .15f}}};
    PatchMesh mesh = testing::gridMesh(120, 80, kColumns, kRows);
    mesh.forEachPatch(
        [&](PatchId p) { mesh.setSpline(p, constantSpline(kColours[p.index / 2 % kColumns])); });
    return mesh;
}

PatchSet column(int index) {
    PatchSet set;
    for (uint32_t p = 0; p < 2 * kColumns * kRows; ++p)
        if (int(p / 2 % kColumns) == index) set.push_back(PatchId(p));
    return set;
}

struct PanelsTest : ::testing::Test {
    PanelsTest() {
        Document document;
        document.mesh = stripes();
        session = std::make_unique<DocumentSession>(document, Photo{}, QString(), QString());
        tools.setSession(session.get());
        start = bytes();
    }
    ~PanelsTest() override { tools.setSession(nullptr); }

    // Shows the panel as a window of its own, active.
    void open(QWidget& panel) {
        panel.resize(300, 560);
        panel.show();
        panel.activateWindow();
        ASSERT_TRUE(QTest::qWaitForWindowExposed(&panel));
        QTest::qWait(10);
    }
    template <class T>
    static T* child(QWidget& panel, const char* name) {
        T* found = panel.findChild<T*>(name);
        EXPECT_NE(found, nullptr) << name;
        return found;
    }
    static void click(QWidget* widget, Qt::KeyboardModifiers modifiers = {}) {
        QTest::mouseClick(widget, Qt::LeftButton, modifiers);
        QTest::qWait(1);
    }
    static void wheel(QWidget* widget, int notches) {
        const QPointF at(widget->rect().center());
        QWheelEvent event(at, widget->mapToGlobal(at), {}, {0, 120 * notches}, Qt::NoButton, {},
                          Qt::NoScrollPhase, false);
        QApplication::sendEvent(widget, &event);
    }
    // Presses where the slider stands and drags to a value in steps; the release is left to the caller.
    static void dragTo(GestureSlider* slider, int value) {
        const int y = slider->height() / 2;
        const double from = slider->xOf(slider->value()), to = slider->xOf(value);
        QTest::mousePress(slider, Qt::LeftButton, {}, QPoint(int(from), y));
        constexpr int kMoves = 5;
        for (int i = 1; i <= kMoves; ++i)
            QTest::mouseMove(slider, QPoint(int(from + (to - from) * i / kMoves), y));
    }
    static void release(GestureSlider* slider) {
        QTest::mouseRelease(slider, Qt::LeftButton, {}, QPoint(int(slider->xOf(slider->value())), 5));
        QTest::qWait(1);
    }

    const PatchMesh& mesh() const { return session->document().mesh; }
    const PatchSet& selected() const { return session->selection().patches(); }
    History& history() { return session->history(); }
    // Without what undo does not bring back: the mesh that the reset goes to.
    std::vector<uint8_t> bytes() const { return testing::bytesOf(session->document()); }
    glm::dvec3 colourOf(PatchId p) const { return meanColour(mesh(), p).srgb; }

    std::unique_ptr<DocumentSession> session;
    ToolManager tools;
    std::vector<uint8_t> start;
};

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

TEST(Gpl, ComesBackAsItWas) {
    const SwatchList list{"Été",
                          {{{0, 0, 0}, "Black"}, {{1, 1, 1}, ""}, {glm::dvec3(51, 102, 204) / 255., "a b"}}};
    const auto read = parseGpl(gplText(list), "list");
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(*read, list);
    const auto lines = parseGpl(gplText({"two\nlines", {{{0, 0, 0}, "x\n255 0 0"}}}), "list");
    ASSERT_TRUE(lines);
    EXPECT_EQ(lines->swatches.size(), 1u) << "a line break in a name is no further swatch";
}

TEST(Gpl, ReadsWhatOthersWrite) {
    const auto list = parseGpl(
        "GIMP Palette\r\nName: Tango\r\nColumns: 3\r\n# made by hand\r\n252 233  79\tButter 1\r\n"
        "  0   0   0\r\n\r\n255\t255\t255\tWhite: bright\r\n",
        "tango.gpl");
    ASSERT_TRUE(list) << list.error().message;
    EXPECT_EQ(list->name, "Tango");
    ASSERT_EQ(list->swatches.size(), 3u);
    EXPECT_EQ(list->swatches[0].name, "Butter 1");
    EXPECT_EQ(list->swatches[0].colour, glm::dvec3(252, 233, 79) / 255.);
    EXPECT_EQ(list->swatches[2].name, "White: bright");
    EXPECT_TRUE(parseGpl("GIMP Palette\n", "old.gpl")) << "the first version had no name";
}

TEST(Gpl, SaysWhatIsDamaged) {
    const std::pair<QByteArray, const char*> damaged[] = {
        {"", "GIMP Palette"},
        {"RIFF....PAL data", "GIMP Palette"},
        {"GIMP Palette\nName: x\n0 0\n", "line 3"},
        {"GIMP Palette\n#\n\n1 2 three\n", "line 4"},
        {"GIMP Palette\n0 256 0\n", "256"},
        {"GIMP Palette\n0 -1 0\n", "-1"},
        {"GIMP Palette\n0 99999999999999999999 0\n", "line 2"},
        {"GIMP Palette\n0 0 0 black\nName: late\n", "line 3"},
        {QByteArray("GIMP Palette\n").append(kMaxGplBytes, '\n'), "too large"}};
    for (const auto& [text, why] : damaged) {
        const auto list = parseGpl(text, "x.gpl");
        ASSERT_FALSE(list) << text.left(60).toStdString();
        EXPECT_EQ(list.error().code, ErrorCode::CannotRead);
        EXPECT_NE(list.error().message.find(why), std::string::npos) << list.error().message;
        EXPECT_NE(list.error().message.find("x.gpl"), std::string::npos) << list.error().message;
    }
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
        QTest::qWait(20);
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
    ::testing::InitGoogleTest(&argc, argv);
    // The user's own settings and swatches are neither read nor changed.
    const QTemporaryDir home;
    qputenv("XDG_CONFIG_HOME", home.filePath("config").toUtf8());
    qputenv("XDG_DATA_HOME", home.filePath("data").toUtf8());
    QApplication application(argc, argv);
    tessera::setUpApplication(application);
    return RUN_ALL_TESTS();
}
