// The steps of a document, to go back and forth among them.
#pragma once

#include <QPointer>
#include <QWidget>

#include "app/history_model.h"

class QLabel;
class QListView;

namespace tessera {

class DocumentSession;

// A click, or the arrow keys, go to a state.
class HistoryPanel : public QWidget {
    Q_OBJECT

  public:
    explicit HistoryPanel(QWidget* parent = nullptr);

    // Null for none.
    void setSession(DocumentSession* session);

  protected:
    void showEvent(QShowEvent* event) override;

  private:
    void goTo(const QModelIndex& row);
    void follow();
    void showMemory();

    QPointer<DocumentSession> mSession;
    HistoryModel mModel;
    QListView* mList;
    QLabel* mMemory;
    bool mFollowing = false;  // the current row is being set to where the document is
};

}  // namespace tessera
