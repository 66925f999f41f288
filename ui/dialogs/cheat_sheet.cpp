// See cheat_sheet.h.
#include "ui/dialogs/cheat_sheet.h"

#include <QGridLayout>
#include <QLabel>
#include <QScreen>
#include <QScrollArea>
#include <QScrollBar>
#include <QShortcut>
#include <QVBoxLayout>
#include <algorithm>

#include "ui/widget_parts.h"

namespace tessera {

namespace {

constexpr int kMostColumns = 4;
constexpr int kHeadingRows = 2;  // a heading takes the room of so many lines

struct Entry {
    QString keys;
    QString text;
};

struct Group {
    QString title;
    QList<Entry> entries;

    int lines() const { return int(entries.size()) + kHeadingRows; }
};

QList<Group> keyGroups(const QList<KeyRow>& rows) {
    QList<Group> groups;
    for (int i = 0; i < rows.size(); ++i) {
        QStringList keys;
        for (const QKeySequence& key : keysInForce(rows, i)) keys << key.toString(QKeySequence::NativeText);
        if (keys.isEmpty()) continue;
        if (groups.isEmpty() || groups.last().title != rows[i].menu) groups.append({rows[i].menu, {}});
        groups.last().entries.append({keys.join(CheatSheet::tr(" or ")), rows[i].text});
    }
    return groups;
}

// What no action of the table does.
QList<Group> gestureGroups() {
    const auto tr = [](const char* text) { return CheatSheet::tr(text); };
    return {{tr("Look around"),
             {{tr("Ctrl + wheel, pinch"), tr("Zoom at the cursor")},
              {tr("Wheel"), tr("Scroll; with Shift, sideways")},
              {tr("Middle button"), tr("Move the picture")}}},
            {tr("Select"),
             {{tr("Click"), tr("Select a patch")},
              {tr("Drag"), tr("Select the patches whose middle is in a frame")},
              {tr("Shift"), tr("Add to the selection")},
              {tr("Alt"), tr("Take from the selection")},
              {tr("Double-click"), tr("Select up to the features around")}}},
            {tr("Shape"),
             {{tr("Drag a point"), tr("Move it; neighbours stay joined")},
              {tr("Drag a curve"), tr("Bend it")},
              {tr("Shift"), tr("Keep to the axes and diagonals")},
              {tr("Alt"), tr("Break a smooth join")},
              {tr("Nudge keys"), tr("Move by an image pixel")},
              {tr("Shift + nudge"), tr("Move by ten")},
              {tr("Alt + nudge"), tr("Move by a screen pixel")},
              {tr("Escape"), tr("Give a drag up")}}}};
}

// Into columns one after the other, so that the longest is as short as it can be.
QList<QList<Group>> inColumns(const QList<Group>& groups, int columns) {
    int height = 0, all = 0;
    for (const Group& group : groups) {
        height = std::max(height, group.lines());
        all += group.lines();
    }
    for (height = std::max(height, all / columns);; ++height) {
        QList<QList<Group>> result{{}};
        int used = 0;
        for (const Group& group : groups) {
            if (used + group.lines() > height && used > 0) {
                result.append(QList<Group>());
                used = 0;
            }
            result.last().append(group);
            used += group.lines();
        }
        if (result.size() <= columns) return result;
    }
}

QLabel* keyLabel(const QString& keys) {
    auto* label = new QLabel(keys);
    label->setProperty("role", "key");
    label->setAlignment(Qt::AlignCenter);
    return label;
}

QWidget* columnOf(const QList<Group>& groups) {
    auto* column = new QWidget;
    auto* grid = partGrid(column);
    grid->setHorizontalSpacing(12);
    grid->setColumnStretch(1, 1);
    int line = 0;
    for (const Group& group : groups) {
        if (line > 0) grid->setRowMinimumHeight(line++, 10);
        grid->addWidget(headingLabel(group.title), line++, 0, 1, 2);
        for (const Entry& entry : group.entries) {
            grid->addWidget(keyLabel(entry.keys), line, 0, Qt::AlignRight | Qt::AlignVCenter);
            grid->addWidget(new QLabel(entry.text), line++, 1);
        }
    }
    grid->setRowStretch(line, 1);
    return column;
}

QWidget* sheetOf(const QList<Group>& groups, int columns) {
    auto* sheet = new QWidget;
    auto* across = new QHBoxLayout(sheet);
    across->setContentsMargins(24, 20, 24, 20);
    across->setSpacing(32);
    for (const QList<Group>& column : inColumns(groups, columns)) across->addWidget(columnOf(column));
    return sheet;
}

}  // namespace

CheatSheet::CheatSheet(const QList<KeyRow>& rows, const QKeySequence& toggle, QWidget* parent)
    : QDialog(parent) {
    setWindowTitle(tr("Keys and Gestures"));
    setStyleSheet(
        "QLabel[role=\"key\"] { border: 1px solid palette(mid); border-radius: 4px; padding: 1px 6px;"
        " background: palette(base); }");
    auto* area = new QScrollArea;
    area->setFrameShape(QFrame::NoFrame);
    area->setWidgetResizable(true);
    area->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    auto* column = new QVBoxLayout(this);
    column->setContentsMargins(0, 0, 0, 0);
    column->addWidget(area);
    // As many columns as the screen is wide enough for; one may scroll down.
    const QList<Group> groups = keyGroups(rows) + gestureGroups();
    const QSize room = screen()->availableSize() * .98;
    const int scrollBar = area->verticalScrollBar()->sizeHint().width();
    for (int columns = kMostColumns; columns > 0; --columns) {
        area->setWidget(sheetOf(groups, columns));
        ensurePolished();
        if (area->widget()->sizeHint().width() + scrollBar <= room.width()) break;
    }
    const QSize sheet = area->widget()->sizeHint();
    resize(QSize(sheet.width() + scrollBar, sheet.height()).boundedTo(room));
    if (!toggle.isEmpty())
        connect(new QShortcut(toggle, this), &QShortcut::activated, this, &QDialog::reject);
}

void CheatSheet::mousePressEvent(QMouseEvent*) {
    reject();
}

}  // namespace tessera
