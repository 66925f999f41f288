// Who gets the keys: the canvas, whatever else was clicked, unless something is being typed.
#pragma once

#include <QObject>
#include <vector>

#include "ui/action_table.h"

class QKeyEvent;
class QMainWindow;

namespace tessera {

// Whether an event is the key of an action that is held or repeated, not triggered. Shift and Alt may be down
// too: they vary what such a key does.
bool isKeyOf(const QKeyEvent& event, const QAction& action);

// Watches a window with its floating panels.
//
// Panels and bars hand the keys back: after a click that types nothing, and at Return or Escape in a field,
// which takes back what was being typed.
// Lists keep them, as they have keys of their own, and so does what was reached with Tab. The keys that are
// held act wherever the focus is, except where they would type or press a button. In a field for numbers what
// is no part of a number is a shortcut, and undo is the document's unless there is typing to take back.
class CanvasKeys : public QObject {
    Q_OBJECT

  public:
    // All outlive it. `canvas` is what gets the keys.
    CanvasKeys(QMainWindow& window, QWidget& canvas, const ActionTable& actions);

  signals:
    // PeekOriginal or Pan.
    void heldChanged(tessera::ActionId id, bool down);

  protected:
    bool eventFilter(QObject* watched, QEvent* event) override;

  private:
    struct Held {
        ActionId id;
        int key;
    };

    // In the window or in a panel that floats above it; dialogs and popups are not.
    bool inWindow(const QWidget& widget) const;
    bool press(const QKeyEvent& event);
    bool release(const QKeyEvent& event);
    void releaseAll();
    // After the event that is under way.
    void handBackSoon();

    QMainWindow& mWindow;
    QWidget& mCanvas;
    const ActionTable& mActions;
    std::vector<Held> mHeld;
};

}  // namespace tessera
