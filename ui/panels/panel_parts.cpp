// See panel_parts.h.
#include "ui/panels/panel_parts.h"

#include <QFrame>
#include <QGridLayout>
#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>
#include <algorithm>

#include "core/image/oklab.h"

namespace tessera {

QLabel* panelHeading(const QString& text) {
    auto* label = new QLabel(text);
    label->setProperty("role", "heading");
    return label;
}

QLabel* panelHint(const QString& text) {
    auto* label = new QLabel(text);
    label->setProperty("role", "dim");
    label->setWordWrap(true);
    return label;
}

QFrame* panelLine() {
    auto* frame = new QFrame;
    frame->setProperty("role", "line");
    return frame;
}

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

QColor toQColor(glm::dvec3 srgb) {
    const auto channel = [](double value) { return float(std::clamp(value, 0., 1.)); };
    return QColor::fromRgbF(channel(srgb.x), channel(srgb.y), channel(srgb.z));
}

glm::dvec3 toSrgb(const QColor& colour) {
    return glm::dvec3(colour.red(), colour.green(), colour.blue()) / 255.;
}

QString hexText(glm::dvec3 srgb) {
    return toQColor(srgb).name();
}

QColor inkOn(const QColor& ground) {
    return toOklab(toSrgb(ground)).x > .65 ? QColor(0, 0, 0) : QColor(255, 255, 255);
}

}  // namespace tessera
