// The page of the preferences where keys are looked up and changed.
#pragma once

#include <QWidget>

#include "ui/dialogs/key_presets.h"

class QComboBox;
class QLabel;
class QLineEdit;
class QPushButton;
class QTreeWidget;
class QTreeWidgetItem;

namespace tessera {

class KeyEdit;

// Edits copies: nothing holds before somebody takes rows() and preset().
class KeyPage : public QWidget {
    Q_OBJECT

  public:
    KeyPage(QList<KeyRow> rows, KeyPreset preset, QWidget* parent = nullptr);

    const QList<KeyRow>& rows() const { return mRows; }
    KeyPreset preset() const;
    // A row's key under preset().
    QKeySequence presetKeyOf(int row) const { return mPresetKeys[row]; }
    bool hasConflicts() const { return !conflictingRows(mRows).isEmpty(); }

  signals:
    void changed();

  private:
    void makeLayout();
    QLayout* makeTopRow();
    QLayout* makeEditRow();
    void fillTree();

    // The chosen row, or -1.
    int chosenRow() const;
    void setKey(int row, const QKeySequence& key);
    void choosePreset();
    // Leaves the key to the chosen row alone.
    void takeKey();
    void filter(const QString& text);
    void showKeys();
    void showChosen();
    // Sentences about the chosen row's conflict, or else about any.
    QString conflictText() const;
    QStringList othersWith(const QKeySequence& key, int except) const;

    QList<KeyRow> mRows;
    QList<QKeySequence> mPresetKeys;
    QList<QTreeWidgetItem*> mItems;  // by row
    QComboBox* mPreset;
    QLineEdit* mSearch;
    QTreeWidget* mTree;
    KeyEdit* mKey;
    QPushButton* mClear;
    QPushButton* mReset;
    QLabel* mConflict;
    QPushButton* mTake;
};

}  // namespace tessera
