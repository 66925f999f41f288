// What tests of panels share: a small document, and the ways of a hand.
#pragma once

#include <gtest/gtest.h>

#include <QApplication>
#include <QTemporaryDir>
#include <QTest>
#include <QWheelEvent>

#include "app/tools/tool_manager.h"
#include "tests/support/edits.h"
#include "tests/support/test_meshes.h"
#include "ui/application.h"
#include "ui/panels/gesture_slider.h"

namespace tessera::testing {

constexpr int kColumns = 6, kRows = 4;

// Straight cells of two patches each, every column of one colour.
inline PatchMesh stripes() {
    static constexpr std::array<std::array<float, 3>, kColumns> kColours{{{.8f, .3f, .2f},
                                                                          {.2f, .3f, .8f},
                                                                          {.2f, .7f, .3f},
                                                                          {.9f, .8f, .2f},
                                                                          {.5f, .5f, .5f},
                                                                          {.1f, .1f, .15f}}};
    PatchMesh mesh = gridMesh(120, 80, kColumns, kRows);
    mesh.forEachPatch(
        [&](PatchId p) { mesh.setSpline(p, constantSpline(kColours[p.index / 2 % kColumns])); });
    return mesh;
}

inline PatchSet column(int index) {
    PatchSet set;
    for (uint32_t p = 0; p < 2 * kColumns * kRows; ++p)
        if (int(p / 2 % kColumns) == index) set.push_back(PatchId(p));
    return set;
}

struct PanelsTest : ::testing::Test {
    PanelsTest() {
        Document document;
        document.mesh = stripes();
        session = std::make_unique<DocumentSession>(document, Photo{}, QString());
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
    std::vector<uint8_t> bytes() const { return bytesOf(session->document()); }
    glm::dvec3 colourOf(PatchId p) const { return meanColour(mesh(), p).srgb; }

    std::unique_ptr<DocumentSession> session;
    ToolManager tools;
    std::vector<uint8_t> start;
};

// Runs the program's tests under the window's own looks, without the settings and swatches of whoever runs
// them.
inline int runPanelTests(int argc, char** argv) {
    ::testing::InitGoogleTest(&argc, argv);
    const QTemporaryDir home;
    qputenv("XDG_CONFIG_HOME", home.filePath("config").toUtf8());
    qputenv("XDG_DATA_HOME", home.filePath("data").toUtf8());
    QApplication application(argc, argv);
    setUpApplication(application);
    return RUN_ALL_TESTS();
}

}  // namespace tessera::testing
