// The history of a document as rows for a panel.
#pragma once

#include <QAbstractListModel>
#include <QPointer>

#include "app/history.h"

namespace tessera {

// Row i is state i of the history: the first what was opened (or the oldest state that is kept), each further
// one what its step did. To go to a row's state, call History::goTo(row).
class HistoryModel : public QAbstractListModel {
    Q_OBJECT

  public:
    enum Role {
        CurrentRole = Qt::UserRole,  // bool: the document is in this state
        UndoneRole,                  // bool: redo would lead there
        SavedRole                    // bool: it is what the file holds
    };

    explicit HistoryModel(QObject* parent = nullptr) : QAbstractListModel(parent) {}

    // Null shows none.
    void setHistory(History* history);

    int rowCount(const QModelIndex& parent = {}) const override;
    QVariant data(const QModelIndex& index, int role) const override;

  private:
    void update();

    QPointer<History> mHistory;
    int mRows = 0;  // as the views know them
};

}  // namespace tessera
