// See key_edit.h.
#include "ui/dialogs/key_edit.h"

#include <QKeyEvent>

namespace tessera {

namespace {

bool isModifier(int key) {
    switch (key) {
        case Qt::Key_Control:
        case Qt::Key_Shift:
        case Qt::Key_Alt:
        case Qt::Key_AltGr:
        case Qt::Key_Meta:
        case Qt::Key_CapsLock:
        case Qt::Key_unknown:
            return true;
        default:
            return false;
    }
}

bool leavesField(const QKeyEvent& event) {
    const int key = event.key();
    return key == Qt::Key_Tab || key == Qt::Key_Backtab || key == Qt::Key_Escape;
}

QKeySequence sequenceOf(const QKeyEvent& event) {
    constexpr Qt::KeyboardModifiers kKept =
        Qt::ControlModifier | Qt::ShiftModifier | Qt::AltModifier | Qt::MetaModifier;
    Qt::KeyboardModifiers modifiers = event.modifiers() & kKept;
    // "?" needs Shift on some keyboards and not on others: where Shift only makes the character, it is no
    // part of the key.
    const QString text = event.text();
    const bool makesCharacter =
        !text.isEmpty() && text[0].isPrint() && !text[0].isLetterOrNumber() && !text[0].isSpace();
    if (makesCharacter) modifiers &= ~Qt::ShiftModifier;
    return QKeySequence(QKeyCombination(modifiers, Qt::Key(event.key())));
}

}  // namespace

KeyEdit::KeyEdit(QWidget* parent) : QLineEdit(parent) {
    setReadOnly(true);
    setContextMenuPolicy(Qt::NoContextMenu);
    setPlaceholderText(tr("Press a key"));
    setAlignment(Qt::AlignCenter);
}

void KeyEdit::setKey(const QKeySequence& key) {
    setText(key.toString(QKeySequence::NativeText));
}

bool KeyEdit::event(QEvent* event) {
    // Otherwise the dialog's own keys would be taken for what they do.
    if (event->type() == QEvent::ShortcutOverride) {
        event->setAccepted(!leavesField(*static_cast<QKeyEvent*>(event)));
        return true;
    }
    return QLineEdit::event(event);
}

void KeyEdit::keyPressEvent(QKeyEvent* event) {
    if (leavesField(*event)) return event->ignore();
    event->accept();
    if (isModifier(event->key())) return;
    const QKeySequence key = sequenceOf(*event);
    setKey(key);
    emit keyChosen(key);
}

}  // namespace tessera
