// What the panels are put together from, so that they look alike.
#pragma once

#include <QColor>
#include <QString>
#include <glm/vec3.hpp>

class QGridLayout;
class QPushButton;
class QVBoxLayout;
class QWidget;

namespace tessera {

// The column of a whole panel, with its margins.
QVBoxLayout* panelColumn(QWidget* panel);
// A button of a group in which none stands out. It leaves the keys to the canvas when clicked.
QPushButton* panelButton(const QString& text, const QString& tip, const char* objectName);
// Puts buttons into rows of the same width.
void fillGrid(QGridLayout* grid, std::initializer_list<QWidget*> widgets, int columns);

// "#rrggbb".
QString hexText(glm::dvec3 srgb);

// Text and lines that are legible on a colour.
QColor inkOn(const QColor& ground);

}  // namespace tessera
