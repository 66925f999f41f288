// What the program can be set to: its look, its keys, and what it takes of the machine.
#pragma once

#include <QDialog>

#include "app/settings.h"
#include "ui/dialogs/key_presets.h"

class QComboBox;
class QDialogButtonBox;
class QSpinBox;

namespace tessera {

class KeyPage;

// Writes to the settings on OK and on Apply only, and while no two actions share a key.
class PreferencesDialog : public QDialog {
    Q_OBJECT

  public:
    PreferencesDialog(const QList<KeyRow>& rows, Settings& settings, QWidget* parent = nullptr);

    // The rows with the keys as they are in the dialog.
    const QList<KeyRow>& rows() const;

  signals:
    // The settings have been written; who goes by them should look again.
    void applied();

  private:
    QWidget* makeGeneralPage();
    void makeButtons();
    void apply();
    void storeKeys();

    Settings& mSettings;
    QComboBox* mTheme;
    QSpinBox* mAutosave;
    QSpinBox* mHistory;
    QSpinBox* mThreads;
    KeyPage* mKeys;
    QDialogButtonBox* mButtons;
};

}  // namespace tessera
