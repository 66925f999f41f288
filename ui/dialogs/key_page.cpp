// See key_page.h.
#include "ui/dialogs/key_page.h"

#include <QComboBox>
#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QTreeWidget>
#include <QVBoxLayout>

#include "ui/dialogs/key_edit.h"
#include "ui/icons.h"

namespace tessera {

namespace {

enum Column { ActionColumn, KeyColumn, PresetColumn, ColumnCount };
constexpr int kRowHeightPx = 22;
constexpr int kRowRole = Qt::UserRole;

QString native(const QKeySequence& key) {
    return key.toString(QKeySequence::NativeText);
}

QPushButton* smallButton(const QString& text, const QString& name, const QString& tip) {
    auto* button = new QPushButton(text);
    button->setObjectName(name);
    button->setToolTip(tip);
    button->setAutoDefault(false);
    return button;
}

}  // namespace

KeyPage::KeyPage(QList<KeyRow> rows, KeyPreset preset, QWidget* parent)
    : QWidget(parent), mRows(std::move(rows)), mPresetKeys(presetKeys(preset, mRows)) {
    makeLayout();
    mPreset->setCurrentIndex(mPreset->findData(int(preset)));
    fillTree();
    connect(mPreset, &QComboBox::currentIndexChanged, this, &KeyPage::choosePreset);
    connect(mSearch, &QLineEdit::textChanged, this, &KeyPage::filter);
    connect(mTree, &QTreeWidget::currentItemChanged, this, &KeyPage::showChosen);
    connect(mTree, &QTreeWidget::itemActivated, mKey, [this] { mKey->setFocus(); });
    connect(mKey, &KeyEdit::keyChosen, this, [this](const QKeySequence& key) { setKey(chosenRow(), key); });
    connect(mClear, &QPushButton::clicked, this, [this] { setKey(chosenRow(), {}); });
    connect(mReset, &QPushButton::clicked, this, [this] { setKey(chosenRow(), mPresetKeys[chosenRow()]); });
    connect(mTake, &QPushButton::clicked, this, &KeyPage::takeKey);
    showKeys();
}

KeyPreset KeyPage::preset() const {
    return KeyPreset(mPreset->currentData().toInt());
}

void KeyPage::makeLayout() {
    mTree = new QTreeWidget;
    mTree->setObjectName("keys");
    mTree->setAccessibleName(tr("Keys of actions"));
    mTree->setColumnCount(ColumnCount);
    mTree->setHeaderLabels({tr("Action"), tr("Key"), tr("Preset")});
    mTree->setAlternatingRowColors(true);
    mTree->setUniformRowHeights(true);
    mTree->setMinimumHeight(300);
    auto* column = new QVBoxLayout(this);
    column->setContentsMargins(16, 16, 16, 16);
    column->setSpacing(10);
    column->addLayout(makeTopRow());
    column->addWidget(mTree, 1);
    column->addLayout(makeEditRow());
    mConflict = new QLabel;
    mConflict->setObjectName("conflict");
    mConflict->setWordWrap(true);
    mTake = smallButton(tr("Take It"), "take", tr("Take the key from the other action"));
    auto* warning = new QHBoxLayout;
    warning->addWidget(mConflict, 1);
    warning->addWidget(mTake);
    column->addLayout(warning);
}

QLayout* KeyPage::makeTopRow() {
    mSearch = new QLineEdit;
    mSearch->setObjectName("search");
    mSearch->setPlaceholderText(tr("Search actions and keys"));
    mSearch->setAccessibleName(tr("Search"));
    mSearch->setClearButtonEnabled(true);
    mSearch->addAction(icon("search", palette()), QLineEdit::LeadingPosition);
    mPreset = new QComboBox;
    mPreset->setObjectName("preset");
    for (const KeyPreset preset : {KeyPreset::Tessera, KeyPreset::Illustrator, KeyPreset::Inkscape})
        mPreset->addItem(presetName(preset), int(preset));
    mPreset->setAccessibleName(tr("Preset"));
    mPreset->setToolTip(tr("Start from the keys of this program; all keys of your own are given up"));
    auto* label = new QLabel(tr("&Preset"));
    label->setBuddy(mPreset);
    auto* row = new QHBoxLayout;
    row->addWidget(mSearch, 1);
    row->addSpacing(8);
    row->addWidget(label);
    row->addWidget(mPreset);
    return row;
}

QLayout* KeyPage::makeEditRow() {
    mKey = new KeyEdit;
    mKey->setObjectName("key");
    mKey->setAccessibleName(tr("Key of the chosen action"));
    mClear = smallButton(tr("No Key"), "clear", tr("Leave the action without a key"));
    mReset = smallButton(tr("Reset"), "reset", tr("Go back to the preset's key"));
    auto* label = new QLabel(tr("&Key"));
    label->setBuddy(mKey);
    auto* row = new QHBoxLayout;
    row->addWidget(label);
    row->addWidget(mKey, 1);
    row->addWidget(mClear);
    row->addWidget(mReset);
    return row;
}

void KeyPage::fillTree() {
    QTreeWidgetItem* menu = nullptr;
    for (int i = 0; i < mRows.size(); ++i) {
        if (!menu || menu->text(ActionColumn) != mRows[i].menu) {
            menu = new QTreeWidgetItem(mTree, {mRows[i].menu});
            menu->setFlags(Qt::ItemIsEnabled);
            menu->setExpanded(true);
            menu->setSizeHint(ActionColumn, {0, kRowHeightPx});
        }
        auto* item = new QTreeWidgetItem(menu, {mRows[i].text});
        item->setData(ActionColumn, kRowRole, i);
        item->setSizeHint(ActionColumn, {0, kRowHeightPx});
        mItems.append(item);
    }
    mTree->header()->setSectionResizeMode(ActionColumn, QHeaderView::Stretch);
    mTree->header()->setStretchLastSection(false);
    for (const int column : {KeyColumn, PresetColumn}) {
        mTree->header()->setSectionResizeMode(column, QHeaderView::Fixed);
        mTree->header()->resizeSection(column, 140);
    }
    if (!mItems.isEmpty()) mTree->setCurrentItem(mItems.first());
}

int KeyPage::chosenRow() const {
    const QTreeWidgetItem* item = mTree->currentItem();
    const QVariant row = item ? item->data(ActionColumn, kRowRole) : QVariant();
    return row.isValid() ? row.toInt() : -1;
}

void KeyPage::setKey(int row, const QKeySequence& key) {
    mRows[row].current = key;
    showKeys();
    emit changed();
}

void KeyPage::choosePreset() {
    mPresetKeys = presetKeys(preset(), mRows);
    for (int i = 0; i < mRows.size(); ++i) mRows[i].current = mPresetKeys[i];
    showKeys();
    emit changed();
}

void KeyPage::takeKey() {
    const int chosen = chosenRow();
    for (int i = 0; i < mRows.size(); ++i)
        if (i != chosen && mRows[i].current == mRows[chosen].current) mRows[i].current = {};
    showKeys();
    emit changed();
}

void KeyPage::filter(const QString& text) {
    const QString wanted = text.trimmed();
    for (int i = 0; i < mRows.size(); ++i) {
        const bool matches = mRows[i].text.contains(wanted, Qt::CaseInsensitive) ||
                             mRows[i].menu.contains(wanted, Qt::CaseInsensitive) ||
                             native(mRows[i].current).contains(wanted, Qt::CaseInsensitive);
        mItems[i]->setHidden(!matches);
    }
    for (int m = 0; m < mTree->topLevelItemCount(); ++m) {
        QTreeWidgetItem* menu = mTree->topLevelItem(m);
        bool any = false;
        for (int i = 0; i < menu->childCount(); ++i) any |= !menu->child(i)->isHidden();
        menu->setHidden(!any);
    }
}

void KeyPage::showKeys() {
    const QSet<int> conflicting = conflictingRows(mRows);
    for (int i = 0; i < mRows.size(); ++i) {
        QTreeWidgetItem* item = mItems[i];
        item->setText(KeyColumn, native(mRows[i].current));
        item->setText(PresetColumn, native(mPresetKeys[i]));
        item->setForeground(PresetColumn, palette().placeholderText());
        QFont font = mTree->font();
        font.setBold(mRows[i].current != mPresetKeys[i]);
        item->setFont(KeyColumn, font);
        item->setIcon(KeyColumn, conflicting.contains(i) ? icon("warning", palette()) : QIcon());
    }
    showChosen();
}

void KeyPage::showChosen() {
    const int row = chosenRow();
    for (QWidget* widget : std::initializer_list<QWidget*>{mKey, mClear, mReset})
        widget->setEnabled(row >= 0);
    mKey->setKey(row >= 0 ? mRows[row].current : QKeySequence());
    if (row >= 0) {
        mClear->setEnabled(!mRows[row].current.isEmpty());
        mReset->setEnabled(mRows[row].current != mPresetKeys[row]);
    }
    mConflict->setText(conflictText());
    mTake->setVisible(row >= 0 && !othersWith(mRows[row].current, row).isEmpty());
}

QStringList KeyPage::othersWith(const QKeySequence& key, int except) const {
    QStringList texts;
    for (int i = 0; i < mRows.size(); ++i)
        if (i != except && !key.isEmpty() && mRows[i].current == key) texts << mRows[i].text;
    return texts;
}

QString KeyPage::conflictText() const {
    const int row = chosenRow();
    const QStringList others = row >= 0 ? othersWith(mRows[row].current, row) : QStringList();
    if (!others.isEmpty())
        return tr("%1 is the key of “%2” already.")
            .arg(native(mRows[row].current), others.join(tr("” and “", "between names")));
    return hasConflicts() ? tr("Some actions share a key; they are marked.") : QString();
}

}  // namespace tessera
