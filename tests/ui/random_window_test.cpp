// The window under thousands of random events of mouse, wheel and keys: the mesh stays sound, and undoing all
// of them gives back the bytes of the start.
#include <gtest/gtest.h>

#include <QCheckBox>
#include <QDockWidget>
#include <QSpinBox>
#include <array>
#include <cstdio>
#include <random>

#include "core/mesh/mesh_validate.h"
#include "tests/support/edits.h"
#include "tests/ui/main_window_fixture.h"
#include "ui/panels/gesture_slider.h"
#include "ui/panels/swatch_button.h"

namespace tessera {
namespace {

struct KeyPress {
    int key;
    Qt::KeyboardModifiers modifiers = {};
};

// Without those that ask for a file or close something.
const std::array kKeys{KeyPress{Qt::Key_V},
                       KeyPress{Qt::Key_A},
                       KeyPress{Qt::Key_A},
                       KeyPress{Qt::Key_Q},
                       KeyPress{Qt::Key_Y},
                       KeyPress{Qt::Key_I},
                       KeyPress{Qt::Key_B},
                       KeyPress{Qt::Key_C},
                       KeyPress{Qt::Key_G},
                       KeyPress{Qt::Key_S},
                       KeyPress{Qt::Key_H},
                       KeyPress{Qt::Key_Z},
                       KeyPress{Qt::Key_Escape},
                       KeyPress{Qt::Key_Return},
                       KeyPress{Qt::Key_Left},
                       KeyPress{Qt::Key_Right, Qt::ShiftModifier},
                       KeyPress{Qt::Key_Up, Qt::AltModifier},
                       KeyPress{Qt::Key_Down},
                       KeyPress{Qt::Key_BracketLeft},
                       KeyPress{Qt::Key_BracketRight},
                       KeyPress{Qt::Key_3},
                       KeyPress{Qt::Key_QuoteLeft},
                       KeyPress{Qt::Key_Tab},
                       KeyPress{Qt::Key_0, Qt::ControlModifier},
                       KeyPress{Qt::Key_1, Qt::ControlModifier},
                       KeyPress{Qt::Key_2, Qt::ControlModifier},
                       KeyPress{Qt::Key_2, Qt::ControlModifier | Qt::AltModifier},
                       KeyPress{Qt::Key_3, Qt::ControlModifier},
                       KeyPress{Qt::Key_3, Qt::ControlModifier | Qt::AltModifier},
                       KeyPress{Qt::Key_5, Qt::ControlModifier},
                       KeyPress{Qt::Key_6, Qt::ControlModifier},
                       KeyPress{Qt::Key_6, Qt::AltModifier},
                       KeyPress{Qt::Key_7, Qt::AltModifier},
                       KeyPress{Qt::Key_8, Qt::AltModifier},
                       KeyPress{Qt::Key_A, Qt::ControlModifier},
                       KeyPress{Qt::Key_A, Qt::ControlModifier | Qt::ShiftModifier},
                       KeyPress{Qt::Key_I, Qt::ControlModifier | Qt::ShiftModifier},
                       KeyPress{Qt::Key_Equal, Qt::ControlModifier | Qt::AltModifier},
                       KeyPress{Qt::Key_Minus, Qt::ControlModifier | Qt::AltModifier},
                       KeyPress{Qt::Key_R, Qt::ControlModifier},
                       KeyPress{Qt::Key_Z, Qt::ControlModifier},
                       KeyPress{Qt::Key_Z, Qt::ControlModifier},
                       KeyPress{Qt::Key_Z, Qt::ControlModifier | Qt::ShiftModifier}};

// Entries of menus that have no keys. Splitting and merging are balanced by hand below.
const std::array kEntries{ActionId::SelectSimilar, ActionId::ResetColours,  ActionId::ResetShape,
                          ActionId::RefitColours,  ActionId::CutOut,        ActionId::FillIn,
                          ActionId::MarkFeature,   ActionId::UnmarkFeature, ActionId::SnapToFeature,
                          ActionId::MergeCurves,   ActionId::SplitCurves,   ActionId::SplitPatches};
constexpr size_t kMostSplit = 3;

class RandomWindow : public MainWindowTest {
  protected:
    void run(unsigned seed, int events) {
        std::printf("seed %u, %d events\n", seed, events);
        mRandom.seed(seed);
        openPhoto();
        vectorize();
        const auto start = testing::bytesOf(session()->document());
        const int first = session()->history().index();
        for (int i = 0; i < events; ++i) {
            event();
            QCoreApplication::processEvents();
            ASSERT_EQ(QApplication::activeModalWidget(), nullptr) << "event " << i;
            if (i % 500 != 0) continue;
            const MeshValidation validation = validate(session()->document().mesh);
            ASSERT_TRUE(validation.valid()) << "event " << i << ": " << validation.violations.front();
        }
        finish();
        const MeshValidation validation = validate(session()->document().mesh);
        EXPECT_TRUE(validation.valid()) << validation.violations.front();
        EXPECT_GT(session()->history().count(), first + events / 200) << "next to nothing was done";
        EXPECT_FALSE(session()->history().forgot());
        const auto end = testing::bytesOf(session()->document());
        const int last = session()->history().index();
        session()->history().goTo(first);
        EXPECT_EQ(testing::bytesOf(session()->document()), start);
        session()->history().goTo(last);
        EXPECT_EQ(testing::bytesOf(session()->document()), end);
    }

  private:
    int below(int count) { return int(mRandom() % unsigned(count)); }
    Qt::KeyboardModifiers modifiers() {
        Qt::KeyboardModifiers held;
        if (below(4) == 0) held |= Qt::ShiftModifier;
        if (below(4) == 0) held |= Qt::AltModifier;
        return held;
    }

    // Near where it was, mostly; on a vertex rather often.
    QPoint point() {
        const PatchMesh& mesh = session()->document().mesh;
        if (below(3) == 0) {
            mAt = {below(canvas().width()), below(canvas().height())};
        } else if (below(2) == 0) {
            const VertexId v(uint32_t(below(int(mesh.connectivity().vertexCapacity()))));
            if (!mesh.connectivity().alive(v)) return mAt;
            const glm::dvec2 p = toPixels(mesh.position(v));
            const QPoint at = canvas().toWidget({p.x, p.y}).toPoint();
            if (canvas().rect().contains(at)) mAt = at;
        } else {
            mAt += QPoint(below(41) - 20, below(41) - 20);
        }
        return mAt;
    }

    void event() {
        switch (below(20)) {
            case 0:
            case 1:
            case 2:
            case 3: {
                const KeyPress& press = kKeys[size_t(below(int(kKeys.size())))];
                return QTest::keyClick(&canvas(), Qt::Key(press.key), press.modifiers);
            }
            case 4:
                return wheel(point(), below(5) - 2, below(2) ? Qt::ControlModifier : Qt::NoModifier);
            case 5:
                return usePanel();
            case 6:
                return chooseEntry();
            case 7:
                return QTest::mouseDClick(&canvas(), Qt::LeftButton, modifiers(), point());
            case 8:
                return QTest::mousePress(&canvas(), Qt::LeftButton, modifiers(), point());
            case 9:
                return QTest::mouseRelease(&canvas(), Qt::LeftButton, modifiers(), point());
            case 10:
            case 11:
            case 12:
            case 13:
                QTest::mousePress(&canvas(), Qt::LeftButton, modifiers(), point());
                for (int i = below(4); i >= 0; --i) QTest::mouseMove(&canvas(), point());
                return QTest::mouseRelease(&canvas(), Qt::LeftButton, modifiers(), point());
            default:
                return QTest::mouseMove(&canvas(), point());
        }
    }

    void chooseEntry() {
        const ActionId id = kEntries[size_t(below(int(kEntries.size())))];
        const Selection& selection = session()->selection();
        // So that the mesh does not grow without end.
        if (id == ActionId::SplitPatches && selection.patches().size() > kMostSplit) return;
        if (id == ActionId::SplitCurves && selection.curves().size() > kMostSplit) return;
        action(id)->trigger();
    }

    void usePanel() {
        const auto docks = window->findChildren<QDockWidget*>();
        QDockWidget* dock = docks[below(int(docks.size()))];
        if (!dock->isVisible()) return;
        dock->raise();
        QList<QWidget*> widgets;
        for (QWidget* widget : dock->findChildren<QWidget*>()) {
            const QString name = widget->objectName();
            // Those that ask for files, vectorize, or remember something beyond the document.
            if (!widget->isVisible() || !widget->isEnabled() || name == "vectorizeButton" ||
                name == "import" || name == "export" || name == "amountSlider")
                continue;
            if (qobject_cast<QPushButton*>(widget) || qobject_cast<GestureSlider*>(widget) ||
                qobject_cast<SwatchButton*>(widget) || qobject_cast<QCheckBox*>(widget))
                widgets.append(widget);
        }
        if (widgets.isEmpty()) return;
        QWidget* widget = widgets[below(int(widgets.size()))];
        const QPoint from(below(widget->width()), widget->height() / 2);
        QTest::mousePress(widget, Qt::LeftButton, {}, from);
        if (qobject_cast<GestureSlider*>(widget))
            for (int i = below(4); i >= 0; --i)
                QTest::mouseMove(widget, QPoint(below(widget->width()), from.y()));
        QTest::mouseRelease(widget, Qt::LeftButton, {}, from);
        if (QWidget* popup = QApplication::activePopupWidget()) QTest::keyClick(popup, Qt::Key_Escape);
        if (below(2) == 0) canvas().setFocus();
    }

    // Nothing is held or under way any more.
    void finish() {
        QTest::mouseRelease(&canvas(), Qt::LeftButton, {}, mAt);
        canvas().setFocus();
        QTest::keyClick(&canvas(), Qt::Key_Escape);
        window->tools().cancel();
        QTest::qWait(400);  // sliders that wait for further steps
        ASSERT_TRUE(idle());
        EXPECT_FALSE(session()->editing());
    }

    std::mt19937 mRandom;
    QPoint mAt{200, 200};
};

TEST_F(RandomWindow, AFewHundredEvents) {
    run(1, 600);
}

TEST_F(RandomWindow, SlowTenThousandEvents) {
    run(2, 10'000);
}

}  // namespace
}  // namespace tessera

int main(int argc, char** argv) {
    return tessera::runWindowTests(argc, argv);
}
