// See canvas_keys.h.
#include "ui/canvas_keys.h"

#include <QAbstractButton>
#include <QAbstractItemView>
#include <QAbstractSpinBox>
#include <QApplication>
#include <QComboBox>
#include <QDockWidget>
#include <QDoubleSpinBox>
#include <QKeyEvent>
#include <QLineEdit>
#include <QMainWindow>
#include <QTimer>
#include <algorithm>

namespace tessera {

namespace {

constexpr Qt::KeyboardModifiers kVarying = Qt::ShiftModifier | Qt::AltModifier;
constexpr Qt::KeyboardModifiers kCompared =
    Qt::ControlModifier | Qt::MetaModifier | Qt::ShiftModifier | Qt::AltModifier;

bool isModifier(int key) {
    return key == Qt::Key_Shift || key == Qt::Key_Control || key == Qt::Key_Alt || key == Qt::Key_AltGr ||
           key == Qt::Key_Meta;
}

bool isList(const QWidget& widget) {
    return qobject_cast<const QAbstractItemView*>(&widget) ||
           qobject_cast<const QAbstractItemView*>(widget.parentWidget());
}

// Of a combo box that is open.
bool isChoice(const QWidget& widget) {
    return qobject_cast<const QComboBox*>(widget.window()->parentWidget());
}

// Whether the event would change what a field for text says.
bool types(const QWidget& field, const QKeyEvent& event) {
    if (isModifier(event.key())) return false;
    const auto* number = qobject_cast<const QAbstractSpinBox*>(&field);
    const auto* line = number ? number->findChild<QLineEdit*>() : qobject_cast<const QLineEdit*>(&field);
    if (!line) return field.testAttribute(Qt::WA_InputMethodEnabled) && !isList(field);
    if (event.matches(QKeySequence::Undo)) return line->isUndoAvailable();
    if (event.matches(QKeySequence::Redo)) return line->isRedoAvailable();
    if (!number || event.text().isEmpty() || (event.modifiers() & ~(Qt::ShiftModifier | Qt::KeypadModifier)))
        return true;
    const QChar character = event.text()[0];
    return !character.isPrint() || character.isDigit() || QStringLiteral("+-−.,'%").contains(character);
}

// Whether a widget with the focus does something with a held key itself.
bool uses(const QWidget& widget, const QKeyEvent& event) {
    if (event.key() == Qt::Key_Space &&
        (qobject_cast<const QAbstractButton*>(&widget) || qobject_cast<const QComboBox*>(&widget)))
        return true;
    return types(widget, event);
}

// Whether the person is done with a field.
bool finishes(const QWidget& widget, const QKeyEvent& event) {
    if (event.key() == Qt::Key_Escape) return true;
    const bool enters = event.key() == Qt::Key_Return || event.key() == Qt::Key_Enter;
    return enters && !qobject_cast<const QAbstractButton*>(&widget);
}

// Forgets what has been typed into a field for numbers and is no value yet.
void takeBackTyping(QWidget& field) {
    if (auto* whole = qobject_cast<QSpinBox*>(&field)) whole->setValue(whole->value());
    if (auto* real = qobject_cast<QDoubleSpinBox*>(&field)) real->setValue(real->value());
}

}  // namespace

bool isKeyOf(const QKeyEvent& event, const QAction& action) {
    const QKeySequence keys = action.shortcut();
    if (keys.isEmpty()) return false;
    const Qt::KeyboardModifiers wanted = keys[0].keyboardModifiers() & kCompared;
    const Qt::KeyboardModifiers present = event.modifiers() & kCompared;
    return event.key() == keys[0].key() && (present & wanted) == wanted &&
           (present & ~kVarying) == (wanted & ~kVarying);
}

CanvasKeys::CanvasKeys(QMainWindow& window, QWidget& canvas, const ActionTable& actions)
    : mWindow(window), mCanvas(canvas), mActions(actions) {
    qApp->installEventFilter(this);
}

bool CanvasKeys::inWindow(const QWidget& widget) const {
    const QWidget* top = widget.window();
    return top == &mWindow || (qobject_cast<const QDockWidget*>(top) && top->parentWidget() == &mWindow);
}

bool CanvasKeys::eventFilter(QObject* watched, QEvent* event) {
    // Wherever they come: what is held must not stay so.
    if (event->type() == QEvent::KeyRelease && release(static_cast<QKeyEvent&>(*event))) return true;
    if (event->type() == QEvent::ApplicationDeactivate ||
        (event->type() == QEvent::WindowDeactivate && watched == &mWindow && !mWindow.isActiveWindow()))
        releaseAll();
    if (!watched->isWidgetType()) return false;
    auto& widget = static_cast<QWidget&>(*watched);
    switch (event->type()) {
        case QEvent::KeyPress: {
            const auto& key = static_cast<QKeyEvent&>(*event);
            if (!inWindow(widget)) {
                if (isChoice(widget) && finishes(widget, key)) handBackSoon();
                return false;
            }
            const QWidget* focus = QApplication::focusWidget();
            if (!uses(focus && inWindow(*focus) ? *focus : widget, key) && press(key)) return true;
            if (&widget != focus || !finishes(widget, key)) return false;
            if (key.key() == Qt::Key_Escape) takeBackTyping(widget);
            handBackSoon();
            return false;
        }
        case QEvent::ShortcutOverride: {
            const auto& key = static_cast<QKeyEvent&>(*event);
            const bool field =
                qobject_cast<const QAbstractSpinBox*>(&widget) || qobject_cast<const QLineEdit*>(&widget);
            if (!field || !inWindow(widget) || isModifier(key.key()) || types(widget, key)) return false;
            event->ignore();
            return true;
        }
        case QEvent::MouseButtonRelease: {
            const bool text = qobject_cast<const QLineEdit*>(&widget) || isList(widget);
            if (isChoice(widget) || (inWindow(widget) && !text)) handBackSoon();
            return false;
        }
        default:
            return false;
    }
}

bool CanvasKeys::press(const QKeyEvent& event) {
    for (const ActionId id : {ActionId::PeekOriginal, ActionId::Pan}) {
        if (!isKeyOf(event, *mActions[id])) continue;
        // A held key repeats as pairs of press and release on X11.
        if (std::any_of(mHeld.begin(), mHeld.end(), [&](const Held& held) { return held.id == id; }))
            return true;
        mHeld.push_back({id, event.key()});
        emit heldChanged(id, true);
        return true;
    }
    return false;
}

bool CanvasKeys::release(const QKeyEvent& event) {
    const auto found =
        std::find_if(mHeld.begin(), mHeld.end(), [&](const Held& held) { return held.key == event.key(); });
    if (found == mHeld.end()) return false;
    if (event.isAutoRepeat()) return true;
    const ActionId id = found->id;
    mHeld.erase(found);
    emit heldChanged(id, false);
    return true;
}

void CanvasKeys::releaseAll() {
    for (const Held& held : std::exchange(mHeld, {})) emit heldChanged(held.id, false);
}

void CanvasKeys::handBackSoon() {
    QTimer::singleShot(0, this, [this] {
        // What the event has opened has the keys now: a dialog, a popup, the editor of a list's row.
        const QWidget* focus = QApplication::focusWidget();
        if (QApplication::activeModalWidget() || QApplication::activePopupWidget()) return;
        if (!focus || focus == &mCanvas || !inWindow(*focus)) return;
        if (qobject_cast<const QLineEdit*>(focus) && isList(*focus->parentWidget())) return;
        if (focus->window() != &mWindow) mWindow.activateWindow();
        mCanvas.setFocus();
    });
}

}  // namespace tessera
