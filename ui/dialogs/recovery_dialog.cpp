// See recovery_dialog.h.
#include "ui/dialogs/recovery_dialog.h"

#include <QDir>
#include <QFileInfo>
#include <QLabel>
#include <QListWidget>
#include <QLocale>
#include <QPushButton>
#include <QVBoxLayout>

#include "ui/dialogs/dialog_parts.h"
#include "ui/icons.h"
#include "ui/widget_parts.h"

namespace tessera {

namespace {

QString nameOf(const RecoveryInfo& info) {
    if (!info.path.isEmpty()) return QFileInfo(info.path).fileName();
    if (!info.photoPath.isEmpty())
        return RecoveryDialog::tr("%1, not saved before").arg(QFileInfo(info.photoPath).completeBaseName());
    return RecoveryDialog::tr("A document not saved before");
}

QString placeOf(const RecoveryInfo& info) {
    const QString path = info.path.isEmpty() ? info.photoPath : info.path;
    return path.isEmpty() ? RecoveryDialog::tr("from the clipboard") : QDir::toNativeSeparators(path);
}

QString timeOf(const RecoveryInfo& info) {
    return QLocale().toString(info.time.toLocalTime(), QLocale::ShortFormat);
}

}  // namespace

RecoveryDialog::RecoveryDialog(const std::vector<RecoveryInfo>& found, QWidget* parent)
    : QDialog(parent), mList(new QListWidget), mWarning(new QLabel) {
    setWindowTitle(tr("Recover Documents"));
    mList->setObjectName("documents");
    mList->setAccessibleName(tr("Documents that can be recovered"));
    mList->setSpacing(2);
    mList->setIconSize({24, 24});
    // The outlines of check boxes cannot be seen on the dark theme's base.
    QPalette raised = palette();
    raised.setColor(QPalette::Base, raised.color(QPalette::Button));
    mList->setPalette(raised);
    for (const RecoveryInfo& info : found) {
        auto* item = new QListWidgetItem(icon("history", palette()),
                                         tr("%1\n%2 — %3").arg(nameOf(info), timeOf(info), placeOf(info)));
        item->setToolTip(placeOf(info));
        item->setFlags(Qt::ItemIsEnabled | Qt::ItemIsSelectable | Qt::ItemIsUserCheckable);
        item->setCheckState(Qt::Checked);
        mList->addItem(item);
    }
    mWarning->setObjectName("warning");
    mWarning->setWordWrap(true);

    QVBoxLayout* column = dialogColumn(this);
    column->addWidget(dimLabel(tr("Tessera ended before these changes were saved. They were autosaved:")));
    column->addWidget(mList, 1);
    column->addWidget(mWarning);
    makeButtons();
    connect(mList, &QListWidget::itemChanged, this, [this] {
        mAskedToDiscard = false;
        update();
    });
    update();
    resize(560, 340);
}

void RecoveryDialog::makeButtons() {
    mDiscard = new QPushButton(tr("Discard…"));
    mLater = new QPushButton(tr("Later"));
    mRecover = new QPushButton(tr("Recover"));
    mRecover->setProperty("role", "primary");
    mRecover->setDefault(true);
    mDiscard->setObjectName("discard");
    mLater->setObjectName("later");
    mRecover->setObjectName("recover");
    mDiscard->setAutoDefault(false);
    mLater->setAutoDefault(false);
    mLater->setToolTip(tr("Keep them, and ask again at the next start"));
    auto* row = new QHBoxLayout;
    row->addWidget(mDiscard);
    row->addStretch(1);
    row->addWidget(mLater);
    row->addWidget(mRecover);
    static_cast<QVBoxLayout*>(layout())->addLayout(row);
    connect(mRecover, &QPushButton::clicked, this, [this] { finish(Answer::Recover); });
    connect(mDiscard, &QPushButton::clicked, this, &RecoveryDialog::discardClicked);
    connect(mLater, &QPushButton::clicked, this, &QDialog::reject);
}

std::vector<size_t> RecoveryDialog::chosen() const {
    std::vector<size_t> indices;
    for (int i = 0; i < mList->count(); ++i)
        if (mList->item(i)->checkState() == Qt::Checked) indices.push_back(size_t(i));
    return indices;
}

void RecoveryDialog::finish(Answer answer) {
    mAnswer = answer;
    accept();
}

void RecoveryDialog::discardClicked() {
    if (mAskedToDiscard) return finish(Answer::Discard);
    mAskedToDiscard = true;
    update();
}

void RecoveryDialog::update() {
    const int count = int(chosen().size());
    mRecover->setEnabled(count > 0);
    mDiscard->setEnabled(count > 0);
    mDiscard->setText(mAskedToDiscard ? tr("Discard for Good") : tr("Discard…"));
    mWarning->setText(count == 1 ? tr("The changes in this document will be lost for good.")
                                 : tr("The changes in %1 documents will be lost for good.").arg(count));
    mWarning->setVisible(mAskedToDiscard);
}

}  // namespace tessera
