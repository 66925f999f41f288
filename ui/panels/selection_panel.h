// What is selected, how to change it, and the selections that have names.
#pragma once

#include <QListWidget>
#include <QPointer>

#include "app/selection.h"
#include "core/base/result.h"
#include "ui/panels/lazy_panel.h"

class QLabel;
class QLineEdit;
class QPushButton;

namespace tessera {

class ActionTable;
class DocumentSession;
class ToolManager;

// The names of the stored selections. A click or Return recalls one, with Shift added to the selection, with
// Alt taken from it; F2 or a double click renames it in place; Delete removes it.
class StoredList : public QListWidget {
    Q_OBJECT

  public:
    explicit StoredList(QWidget* parent = nullptr);

    // As high as its names, within reason, so that none is out of sight below an empty half.
    QSize sizeHint() const override;
    QSize minimumSizeHint() const override { return sizeHint(); }

  signals:
    void recalled(const QString& name, tessera::SelectMode mode);
    void removed(const QString& name);

  protected:
    bool event(QEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
};

class SelectionPanel : public LazyPanel {
    Q_OBJECT

  public:
    explicit SelectionPanel(QWidget* parent = nullptr);

    // Null for none.
    void setSession(DocumentSession* session);
    // Whose wand says what is similar; outlives the panel.
    void setToolOptions(const ToolManager& tools) { mTools = &tools; }
    // The buttons say what the actions that do the same say, with their keys.
    void showTipsOf(const ActionTable& actions);

  signals:
    // One sentence for the person.
    void said(const QString& text);

  private:
    QWidget* makeButtons();
    QWidget* makeStoredPart();
    void refresh() override;
    void fillStored();
    void store();
    void sayFailure(const Result<void>& result);
    void rename(QListWidgetItem* item);
    // The first "Selection N" that is free.
    QString freeName() const;

    QPointer<DocumentSession> mSession;
    const ToolManager* mTools = nullptr;
    QLabel* mCounts;
    std::vector<QPushButton*> mNeedMesh;       // what can be used where there are patches
    std::vector<QPushButton*> mNeedSelection;  // and where some are selected
    QPushButton* mNone = nullptr;              // and where anything is
    StoredList* mStored = nullptr;
    QLabel* mStoredHint = nullptr;
};

}  // namespace tessera
