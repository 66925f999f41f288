// What panels, bars, dialogs and pages are put together from, in the look of the theme.
#pragma once

#include <QString>

class QFrame;
class QGridLayout;
class QLabel;
class QVBoxLayout;
class QWidget;

namespace tessera {

QLabel* headingLabel(const QString& text);
// Quiet text that wraps.
QLabel* dimLabel(const QString& text);
// Across its column.
QFrame* separatorLine();
// The layouts of a part that lies in another layout: without margins.
QVBoxLayout* partColumn(QWidget* part);
QGridLayout* partGrid(QWidget* part);

}  // namespace tessera
