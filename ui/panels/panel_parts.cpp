// See panel_parts.h.
#include "ui/panels/panel_parts.h"

#include <QGridLayout>
#include <QPushButton>
#include <QVBoxLayout>

#include "core/image/oklab.h"
#include "ui/conversions.h"

namespace tessera {

QVBoxLayout* panelColumn(QWidget* panel) {
    auto* column = new QVBoxLayout(panel);
    column->setContentsMargins(14, 10, 14, 12);
    column->setSpacing(8);
    return column;
}

QPushButton* panelButton(const QString& text, const QString& tip, const char* objectName) {
    auto* button = new QPushButton(text);
    button->setProperty("role", "quiet");
    button->setObjectName(objectName);
    button->setToolTip(tip);
    button->setAccessibleName(text);
    button->setFocusPolicy(Qt::TabFocus);
    return button;
}

void fillGrid(QGridLayout* grid, std::initializer_list<QWidget*> widgets, int columns) {
    int at = 0;
    for (QWidget* widget : widgets) {
        grid->addWidget(widget, at / columns, at % columns);
        ++at;
    }
    for (int c = 0; c < columns; ++c) grid->setColumnStretch(c, 1);
}

QString hexText(glm::dvec3 srgb) {
    return toQColor(srgb).name();
}

QColor inkOn(const QColor& ground) {
    return toOklab(toSrgb(ground)).x > .65 ? QColor(0, 0, 0) : QColor(255, 255, 255);
}

}  // namespace tessera
