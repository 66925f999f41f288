// The keys that hands know from other programs, pressed in the window with each preset: they trigger what the
// preset says, and nothing else.
#include <gtest/gtest.h>

#include <QSignalSpy>
#include <set>

#include "tests/ui/main_window_fixture.h"

namespace tessera {
namespace {

struct Press {
    ActionId action;
    Qt::Key key;
    Qt::KeyboardModifiers modifiers;
};

constexpr Qt::KeyboardModifiers kCtrl = Qt::ControlModifier, kShift = Qt::ShiftModifier,
                                kAlt = Qt::AltModifier, kPlain = Qt::NoModifier;

// The window with a preset, and a vectorized picture of which something is selected and undone.
class KeyPresetsInTheWindow : public MainWindowTest {
  protected:
    void TearDown() override { Settings().setKeyPreset(KeyPreset::Tessera); }

    void openWith(KeyPreset preset) {
        Settings().setKeyPreset(preset);
        MainWindowTest::SetUp();
        openPhoto();
        vectorize();
        action(ActionId::SelectAll)->trigger();
        action(ActionId::CutOut)->trigger();
        action(ActionId::FillIn)->trigger();
        action(ActionId::Undo)->trigger();
        action(ActionId::SelectAll)->trigger();
    }
    void SetUp() override {}

    // What a key triggers. Dialogs are closed as they open.
    std::set<QString> triggeredBy(const Press& press) {
        std::set<QString> triggered;
        const QObject scope;
        for (QAction* candidate : window->findChildren<QAction*>())
            QObject::connect(candidate, &QAction::triggered, &scope,
                             [&triggered, candidate] { triggered.insert(candidate->objectName()); });
        QTimer closer;
        QObject::connect(&closer, &QTimer::timeout, &closer, [] {
            if (QWidget* dialog = QApplication::activeModalWidget()) dialog->close();
        });
        closer.start(20);
        // A dialog before has left no window active where nothing manages windows.
        window->activateWindow();
        EXPECT_TRUE(QTest::qWaitForWindowActive(window.get()));
        canvas().setFocus();
        QTest::keyClick(&canvas(), press.key, press.modifiers);
        // Not in the way of the next: a tool's change is another press's business.
        QTest::qWait(1);
        return triggered;
    }

    void expectEach(std::initializer_list<Press> presses) {
        for (const Press& press : presses) {
            const QString name = action(press.action)->objectName();
            ASSERT_TRUE(action(press.action)->isEnabled()) << name.toStdString();
            EXPECT_EQ(triggeredBy(press), std::set<QString>{name}) << name.toStdString();
        }
    }
};

TEST_F(KeyPresetsInTheWindow, IllustratorsKeys) {
    openWith(KeyPreset::Illustrator);
    expectEach({{ActionId::ToolSelect, Qt::Key_V, kPlain},       {ActionId::ToolDirect, Qt::Key_A, kPlain},
                {ActionId::ToolLasso, Qt::Key_Q, kPlain},        {ActionId::ToolWand, Qt::Key_Y, kPlain},
                {ActionId::ToolEyedropper, Qt::Key_I, kPlain},   {ActionId::ToolBrush, Qt::Key_B, kPlain},
                {ActionId::ToolGradient, Qt::Key_G, kPlain},     {ActionId::ToolHand, Qt::Key_H, kPlain},
                {ActionId::ToolZoom, Qt::Key_Z, kPlain},         {ActionId::ShowEdges, Qt::Key_Y, kCtrl},
                {ActionId::ShowControlPoints, Qt::Key_H, kCtrl}, {ActionId::ZoomFit, Qt::Key_0, kCtrl},
                {ActionId::Zoom100, Qt::Key_1, kCtrl},           {ActionId::ZoomIn, Qt::Key_Plus, kCtrl},
                {ActionId::ZoomOut, Qt::Key_Minus, kCtrl},       {ActionId::Rulers, Qt::Key_R, kCtrl},
                {ActionId::Preferences, Qt::Key_K, kCtrl},       {ActionId::Export, Qt::Key_E, kCtrl | kAlt},
                {ActionId::Redo, Qt::Key_Z, kCtrl | kShift},     {ActionId::Undo, Qt::Key_Z, kCtrl},
                {ActionId::SelectAll, Qt::Key_A, kCtrl},         {ActionId::Lock, Qt::Key_2, kCtrl},
                {ActionId::UnlockAll, Qt::Key_2, kCtrl | kAlt},  {ActionId::HidePanels, Qt::Key_Tab, kPlain},
                {ActionId::FullScreen, Qt::Key_F, kPlain}});
}

TEST_F(KeyPresetsInTheWindow, InkscapesKeys) {
    openWith(KeyPreset::Inkscape);
    expectEach({{ActionId::ToolSelect, Qt::Key_S, kPlain},
                {ActionId::ToolDirect, Qt::Key_N, kPlain},
                {ActionId::ToolEyedropper, Qt::Key_D, kPlain},
                {ActionId::ToolGradient, Qt::Key_G, kPlain},
                {ActionId::ToolBrush, Qt::Key_W, kPlain},
                {ActionId::ToolZoom, Qt::Key_Z, kPlain},
                {ActionId::ZoomIn, Qt::Key_Plus, kPlain},
                {ActionId::ZoomOut, Qt::Key_Minus, kPlain},
                {ActionId::Zoom100, Qt::Key_1, kPlain},
                {ActionId::FitSelection, Qt::Key_3, kPlain},
                {ActionId::ZoomFit, Qt::Key_4, kPlain},
                {ActionId::PreviousZoom, Qt::Key_QuoteLeft, kPlain},
                {ActionId::InvertSelection, Qt::Key_Exclam, kPlain},
                {ActionId::Export, Qt::Key_E, kCtrl | kShift},
                {ActionId::Preferences, Qt::Key_P, kCtrl | kShift},
                {ActionId::Redo, Qt::Key_Z, kCtrl | kShift},
                {ActionId::Undo, Qt::Key_Z, kCtrl},
                {ActionId::Redo, Qt::Key_Y, kCtrl},
                {ActionId::HidePanels, Qt::Key_F12, kPlain},
                {ActionId::FullScreen, Qt::Key_F11, kPlain}});
}

// What a preset takes away does nothing any more.
TEST_F(KeyPresetsInTheWindow, KeysThatAPresetUsesOtherwiseAreGone) {
    openWith(KeyPreset::Inkscape);
    for (const Press& press :
         {Press{ActionId::ToolSelect, Qt::Key_V, kPlain}, Press{ActionId::ZoomFit, Qt::Key_0, kCtrl},
          Press{ActionId::Export, Qt::Key_E, kCtrl}})
        EXPECT_EQ(triggeredBy(press).count(action(press.action)->objectName()), 0u)
            << action(press.action)->objectName().toStdString();
}

}  // namespace
}  // namespace tessera

int main(int argc, char** argv) {
    return tessera::runWindowTests(argc, argv);
}
