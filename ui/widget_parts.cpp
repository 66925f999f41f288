// See widget_parts.h.
#include "ui/widget_parts.h"

#include <QAction>
#include <QFrame>
#include <QGridLayout>
#include <QLabel>
#include <QVBoxLayout>

namespace tessera {

QLabel* headingLabel(const QString& text) {
    auto* label = new QLabel(text);
    label->setProperty("role", "heading");
    return label;
}

QLabel* dimLabel(const QString& text) {
    auto* label = new QLabel(text);
    label->setProperty("role", "dim");
    label->setWordWrap(true);
    return label;
}

QFrame* separatorLine() {
    auto* frame = new QFrame;
    frame->setProperty("role", "line");
    return frame;
}

void showTipOf(const QAction& action, QWidget& widget) {
    widget.setToolTip(action.toolTip());
    QObject::connect(&action, &QAction::changed, &widget,
                     [&action, &widget] { widget.setToolTip(action.toolTip()); });
}

QVBoxLayout* partColumn(QWidget* part) {
    auto* column = new QVBoxLayout(part);
    column->setContentsMargins(0, 0, 0, 0);
    column->setSpacing(8);
    return column;
}

QGridLayout* partGrid(QWidget* part) {
    auto* grid = new QGridLayout(part);
    grid->setContentsMargins(0, 0, 0, 0);
    grid->setSpacing(6);
    return grid;
}

}  // namespace tessera
