// See history_panel.h.
#include "ui/panels/history_panel.h"

#include <QItemSelectionModel>
#include <QLabel>
#include <QListView>
#include <QLocale>
#include <QPainter>
#include <QScopedValueRollback>
#include <QStyledItemDelegate>
#include <QVBoxLayout>

#include "app/document_session.h"
#include "ui/panels/panel_parts.h"
#include "ui/widget_parts.h"

namespace tessera {

namespace {

// Undone steps dim, and a mark at what the file holds.
class StepDelegate : public QStyledItemDelegate {
  public:
    using QStyledItemDelegate::QStyledItemDelegate;

    QSize sizeHint(const QStyleOptionViewItem& option, const QModelIndex& index) const override {
        const QSize size = QStyledItemDelegate::sizeHint(option, index);
        return {size.width(), size.height() + 6};
    }

    void paint(QPainter* painter, const QStyleOptionViewItem& option,
               const QModelIndex& index) const override {
        const bool saved = index.data(HistoryModel::SavedRole).toBool();
        const QString mark = saved ? QObject::tr("saved") : QString();
        const int markWidth = saved ? option.fontMetrics.horizontalAdvance(mark) + 12 : 0;
        QStyledItemDelegate::paint(painter, option, index);
        if (!saved) return;
        const bool selected = option.state.testFlag(QStyle::State_Selected);
        painter->setPen(selected ? option.palette.color(QPalette::HighlightedText)
                                 : option.palette.color(QPalette::PlaceholderText));
        painter->drawText(option.rect.adjusted(option.rect.width() - markWidth, 0, -6, 0),
                          Qt::AlignRight | Qt::AlignVCenter, mark);
    }

  protected:
    void initStyleOption(QStyleOptionViewItem* option, const QModelIndex& index) const override {
        QStyledItemDelegate::initStyleOption(option, index);
        if (index.data(HistoryModel::UndoneRole).toBool())
            option->palette.setColor(QPalette::Text, option->palette.color(QPalette::PlaceholderText));
    }
};

}  // namespace

HistoryPanel::HistoryPanel(QWidget* parent) : QWidget(parent), mList(new QListView), mMemory(dimLabel({})) {
    setAccessibleName(tr("History"));
    mList->setObjectName("steps");
    mList->setAccessibleName(tr("Steps of the document"));
    mList->setToolTip(tr("Click to go to a state of the document"));
    mList->setModel(&mModel);
    mList->setItemDelegate(new StepDelegate(mList));
    mList->setUniformItemSizes(true);
    mList->setVerticalScrollMode(QAbstractItemView::ScrollPerPixel);
    mMemory->setObjectName("memory");
    mMemory->setToolTip(tr("What the steps take; the oldest are forgotten beyond the limit"));
    auto* column = panelColumn(this);
    column->addWidget(mList, 1);
    column->addWidget(mMemory);
    connect(mList->selectionModel(), &QItemSelectionModel::currentChanged, this, &HistoryPanel::goTo);
    connect(&mModel, &QAbstractItemModel::modelReset, this, &HistoryPanel::follow);
    connect(&mModel, &QAbstractItemModel::dataChanged, this, &HistoryPanel::follow);
    showMemory();
}

void HistoryPanel::setSession(DocumentSession* session) {
    if (mSession) mSession->disconnect(this);
    mSession = session;
    // Undo waits for the end of a gesture: then the list shows again where the document is.
    if (session) connect(session, &DocumentSession::editingChanged, this, &HistoryPanel::follow);
    mModel.setHistory(session ? &session->history() : nullptr);
    follow();
}

void HistoryPanel::showEvent(QShowEvent* event) {
    QWidget::showEvent(event);
    follow();
}

void HistoryPanel::goTo(const QModelIndex& row) {
    if (!mFollowing && mSession && row.isValid()) mSession->history().goTo(row.row());
}

void HistoryPanel::follow() {
    const QScopedValueRollback following(mFollowing, true);
    if (mSession) {
        const QModelIndex row = mModel.index(mSession->history().index());
        mList->setCurrentIndex(row);
        mList->scrollTo(row);
    }
    if (isVisible()) showMemory();
}

void HistoryPanel::showMemory() {
    if (!mSession) return mMemory->setText(tr("No document"));
    const History& history = mSession->history();
    const QLocale locale;
    const auto size = [&](size_t bytes, int decimals) {
        return locale.formattedDataSize(qint64(bytes), decimals, QLocale::DataSizeTraditionalFormat);
    };
    mMemory->setText(
        tr("Steps: %1, %2 of %3")
            .arg(locale.toString(history.count()), size(history.bytes(), 1), size(history.memoryLimit(), 0)));
}

}  // namespace tessera
