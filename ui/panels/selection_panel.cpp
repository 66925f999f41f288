// See selection_panel.h.
#include "ui/panels/selection_panel.h"

#include <QGridLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QLocale>
#include <QMouseEvent>
#include <QPushButton>
#include <QSignalBlocker>
#include <QTimer>
#include <QVBoxLayout>
#include <algorithm>

#include "app/message.h"
#include "app/selection_actions.h"
#include "app/tools/tool_manager.h"
#include "ui/action_table.h"
#include "ui/panels/panel_parts.h"
#include "ui/widget_parts.h"

namespace tessera {

namespace {

// The name that the document knows, while the text may be one that is being typed.
constexpr int kNameRole = Qt::UserRole;

SelectMode modeOf(Qt::KeyboardModifiers modifiers) {
    return selectModeOf(
        {.shift = modifiers.testFlag(Qt::ShiftModifier), .alt = modifiers.testFlag(Qt::AltModifier)});
}

}  // namespace

StoredList::StoredList(QWidget* parent) : QListWidget(parent) {
    setEditTriggers(QAbstractItemView::DoubleClicked | QAbstractItemView::EditKeyPressed);
    setVerticalScrollMode(QAbstractItemView::ScrollPerPixel);
    setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    setToolTip(tr("Click to select; Shift adds, Alt subtracts. F2 renames, Delete removes"));
}

QSize StoredList::sizeHint() const {
    constexpr int kMostRows = 6;
    const int row = count() > 0 ? sizeHintForRow(0) : fontMetrics().height();
    return {QListWidget::sizeHint().width(), std::clamp(count(), 1, kMostRows) * row + 2 * frameWidth()};
}

bool StoredList::event(QEvent* event) {
    // The keys that it uses are not for the window's shortcuts.
    if (event->type() == QEvent::ShortcutOverride && currentItem()) {
        const int key = static_cast<QKeyEvent*>(event)->key();
        if (key == Qt::Key_Delete || key == Qt::Key_Backspace || key == Qt::Key_F2) {
            event->accept();
            return true;
        }
    }
    return QListWidget::event(event);
}

void StoredList::mousePressEvent(QMouseEvent* event) {
    const QListWidgetItem* item = itemAt(event->position().toPoint());
    const QString name = item ? item->data(kNameRole).toString() : QString();
    QListWidget::mousePressEvent(event);
    if (item && event->button() == Qt::LeftButton) emit recalled(name, modeOf(event->modifiers()));
}

void StoredList::keyPressEvent(QKeyEvent* event) {
    const QListWidgetItem* item = currentItem();
    if (!item || state() == QAbstractItemView::EditingState) return QListWidget::keyPressEvent(event);
    const QString name = item->data(kNameRole).toString();
    switch (event->key()) {
        case Qt::Key_Delete:
        case Qt::Key_Backspace:
            return emit removed(name);
        case Qt::Key_Return:
        case Qt::Key_Enter:
            return emit recalled(name, modeOf(event->modifiers()));
        default:
            QListWidget::keyPressEvent(event);
    }
}

namespace {

// How many patches cannot be selected, and why; empty for none.
QString outOfReach(const PatchMarks& marks) {
    QStringList parts;
    if (const size_t hidden = marks.hidden().size(); hidden > 0)
        parts += QObject::tr("%1 hidden").arg(QLocale().toString(qulonglong(hidden)));
    if (const size_t locked = marks.locked().size(); locked > 0)
        parts += QObject::tr("%1 locked").arg(QLocale().toString(qulonglong(locked)));
    return parts.join(QObject::tr(", "));
}

}  // namespace

SelectionPanel::SelectionPanel(QWidget* parent) : LazyPanel(parent), mCounts(new QLabel) {
    setAccessibleName(tr("Selection"));
    auto* column = panelColumn(this);
    mCounts->setObjectName("counts");
    mCounts->setWordWrap(true);
    column->addWidget(mCounts);
    column->addWidget(makeButtons());
    column->addWidget(separatorLine());
    column->addWidget(makeStoredPart(), 1);
    refreshNow();
}

QWidget* SelectionPanel::makeButtons() {
    auto* part = new QWidget;
    auto* grid = partGrid(part);
    const auto add = [&](const QString& text, const QString& tip, const char* name, bool needsSelection,
                         const std::function<void(DocumentSession&)>& act) {
        QPushButton* button = panelButton(text, tip, name);
        (needsSelection ? mNeedSelection : mNeedMesh).push_back(button);
        connect(button, &QPushButton::clicked, this, [this, act] {
            if (mSession) act(*mSession);
        });
        return button;
    };
    fillGrid(grid,
             {add(tr("All"), tr("Select all patches"), "all", false, &selectAll),
              mNone = add(tr("None"), tr("Select nothing"), "none", false, &selectNone),
              add(tr("Invert"), tr("Select what is not selected"), "invert", false, &invertSelection),
              add(tr("Grow"), tr("Add the patches around the selection"), "grow", true, &growSelection),
              add(tr("Shrink"), tr("Take the outermost patches away"), "shrink", true, &shrinkSelection),
              add(tr("Similar"), tr("Add patches of similar colour, as the wand is set"), "similar", true,
                  [this](DocumentSession& session) {
                      selectSimilar(session, mTools ? mTools->options().wand : WandOptions{});
                  })},
             3);
    return part;
}

void SelectionPanel::showTipsOf(const ActionTable& actions) {
    for (const auto& [name, id] :
         {std::pair{"all", ActionId::SelectAll}, std::pair{"none", ActionId::SelectNone},
          std::pair{"invert", ActionId::InvertSelection}, std::pair{"grow", ActionId::GrowSelection},
          std::pair{"shrink", ActionId::ShrinkSelection}, std::pair{"similar", ActionId::SelectSimilar}})
        showTipOf(*actions[id], *findChild<QPushButton*>(name));
}

QWidget* SelectionPanel::makeStoredPart() {
    auto* part = new QWidget;
    auto* column = partColumn(part);
    auto* head = new QHBoxLayout;
    head->addWidget(headingLabel(tr("Stored selections")), 1);
    QPushButton* storeButton =
        panelButton(tr("Store"), tr("Keep the selection in the document, under a name"), "store");
    mNeedSelection.push_back(storeButton);
    head->addWidget(storeButton);
    column->addLayout(head);
    mStored = new StoredList;
    mStored->setObjectName("stored");
    mStored->setAccessibleName(tr("Stored selections"));
    column->addWidget(mStored, 1);
    mStoredHint = dimLabel(tr("Kept with the document, to come back to."));
    column->addWidget(mStoredHint);
    connect(storeButton, &QPushButton::clicked, this, &SelectionPanel::store);
    connect(mStored, &QListWidget::itemChanged, this, &SelectionPanel::rename);
    connect(mStored, &StoredList::recalled, this, [this](const QString& name, SelectMode mode) {
        if (mSession) recallSelection(*mSession, name, mode);
    });
    connect(mStored, &StoredList::removed, this, [this](const QString& name) {
        if (mSession) sayFailure(removeStoredSelection(*mSession, name));
    });
    return part;
}

void SelectionPanel::setSession(DocumentSession* session) {
    if (mSession) {
        mSession->disconnect(this);
        mSession->selection().disconnect(this);
    }
    mSession = session;
    if (session) {
        connect(session, &DocumentSession::changed, this, [this](const Change& change) {
            if (change.selections || change.replaced) fillStored();
            if (change.mesh() && !change.preview) refreshSoon();
        });
        connect(&session->selection(), &Selection::changed, this, &SelectionPanel::refreshSoon);
        connect(session, &QObject::destroyed, this, [this] { setSession(nullptr); });
    }
    fillStored();
    refreshNow();
}

void SelectionPanel::refresh() {
    const bool hasMesh = mSession && mSession->hasMesh();
    const bool hasPatches = hasMesh && !mSession->selection().patches().empty();
    for (QPushButton* button : mNeedMesh) button->setEnabled(hasMesh);
    for (QPushButton* button : mNeedSelection) button->setEnabled(hasPatches);
    mNone->setEnabled(hasMesh && !mSession->selection().empty());
    if (!hasMesh) return mCounts->setText(mSession ? tr("No patches yet") : tr("No document"));
    const Selection& selection = mSession->selection();
    const QLocale locale;
    QStringList parts;
    if (!selection.patches().empty())
        parts += tr("%1 of %2 patches")
                     .arg(locale.toString(qulonglong(selection.patches().size())),
                          locale.toString(qulonglong(mSession->document().mesh.patchCount())));
    if (!selection.points().empty()) parts += tr("points: %1").arg(selection.points().size());
    if (!selection.curves().empty()) parts += tr("curves: %1").arg(selection.curves().size());
    QString text = parts.isEmpty() ? tr("Nothing selected") : parts.join(tr(", "));
    // Nothing on the canvas tells hidden patches from those cut out, and locked ones look like all others.
    if (const QString kept = outOfReach(mSession->marks()); !kept.isEmpty()) text += '\n' + kept;
    mCounts->setText(text);
}

void SelectionPanel::fillStored() {
    const QSignalBlocker quiet(mStored);
    const QString current = mStored->currentItem() ? mStored->currentItem()->text() : QString();
    mStored->clear();
    if (mSession)
        for (const NamedSelection& stored : mSession->document().selections) {
            const QString name = QString::fromStdString(stored.name);
            auto* item = new QListWidgetItem(name, mStored);
            item->setData(kNameRole, name);
            item->setFlags(item->flags() | Qt::ItemIsEditable);
            item->setToolTip(tr("Patches: %1").arg(stored.patches.size()));
            if (name == current) mStored->setCurrentItem(item);
        }
    mStored->updateGeometry();
    mStored->setVisible(mStored->count() > 0);
    mStoredHint->setVisible(mStored->count() == 0);
}

QString SelectionPanel::freeName() const {
    for (int i = 1;; ++i) {
        const QString name = tr("Selection %1").arg(i);
        if (mStored->findItems(name, Qt::MatchExactly).isEmpty()) return name;
    }
}

void SelectionPanel::sayFailure(const Result<void>& result) {
    if (!result) emit said(asSentence(result.error().message));
}

void SelectionPanel::store() {
    if (!mSession) return;
    const QString name = freeName();
    sayFailure(storeSelection(*mSession, name));
    const auto items = mStored->findItems(name, Qt::MatchExactly);
    if (items.isEmpty()) return;
    // The name can be typed at once.
    mStored->setCurrentItem(items.first());
    mStored->editItem(items.first());
}

void SelectionPanel::rename(QListWidgetItem* item) {
    if (!mSession) return;
    const QString from = item->data(kNameRole).toString();
    const QString to = item->text().trimmed();
    // The list is filled anew by the rename itself; not under the editor that is closing.
    QTimer::singleShot(0, this, [this, from, to] {
        if (!mSession || from == to) return fillStored();
        const Result<void> renamed = renameStoredSelection(*mSession, from, to);
        if (renamed) return;
        if (!to.isEmpty()) sayFailure(renamed);
        fillStored();
    });
}

}  // namespace tessera
