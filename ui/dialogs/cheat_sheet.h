// All keys and mouse gestures on one sheet.
#pragma once

#include <QDialog>

#include "ui/dialogs/key_presets.h"

class QGridLayout;

namespace tessera {

// Any click, Escape and the key that opened it close it.
class CheatSheet : public QDialog {
    Q_OBJECT

  public:
    // Of the rows, those that have a key are listed. `toggle` is the sheet's own key.
    CheatSheet(const QList<KeyRow>& rows, const QKeySequence& toggle, QWidget* parent = nullptr);

  protected:
    void mousePressEvent(QMouseEvent* event) override;
};

}  // namespace tessera
