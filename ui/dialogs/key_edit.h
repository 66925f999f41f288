// A field that takes the next key pressed in it as its value.
#pragma once

#include <QKeySequence>
#include <QLineEdit>

namespace tessera {

// One key with its modifiers. Tab, Shift+Tab and Escape keep their meaning in dialogs, so that one gets out
// of the field without a mouse.
class KeyEdit : public QLineEdit {
    Q_OBJECT

  public:
    explicit KeyEdit(QWidget* parent = nullptr);

    void setKey(const QKeySequence& key);

  signals:
    // By the person, not by setKey().
    void keyChosen(const QKeySequence& key);

  protected:
    bool event(QEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
};

}  // namespace tessera
