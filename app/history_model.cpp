// See history_model.h.
#include "app/history_model.h"

namespace tessera {

void HistoryModel::setHistory(History* history) {
    if (mHistory) mHistory->disconnect(this);
    beginResetModel();
    mHistory = history;
    mRows = history ? history->count() + 1 : 0;
    endResetModel();
    if (!history) return;
    connect(history, &History::changed, this, &HistoryModel::update);
    connect(history, &QObject::destroyed, this, [this] { setHistory(nullptr); });
}

void HistoryModel::update() {
    // Which step has gone and which has come is not told: rows are few and quickly drawn. Views keep their
    // place where only the state has moved.
    if (mRows == mHistory->count() + 1) {
        emit dataChanged(index(0), index(mRows - 1));
        return;
    }
    beginResetModel();
    mRows = mHistory->count() + 1;
    endResetModel();
}

int HistoryModel::rowCount(const QModelIndex& parent) const {
    return parent.isValid() ? 0 : mRows;
}

QVariant HistoryModel::data(const QModelIndex& index, int role) const {
    const int row = index.row();
    if (!mHistory || !index.isValid() || row > mHistory->count()) return {};
    switch (role) {
        case Qt::DisplayRole:
            if (row > 0) return mHistory->text(row - 1);
            return mHistory->forgot() ? tr("Earlier Steps") : tr("Opened");
        case CurrentRole:
            return row == mHistory->index();
        case UndoneRole:
            return row > mHistory->index();
        case SavedRole:
            return row == mHistory->savedIndex();
        default:
            return {};
    }
}

}  // namespace tessera
