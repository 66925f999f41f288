// What panels, bars, dialogs and pages are put together from, in the look of the theme.
#pragma once

#include <QString>

class QAction;
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

// Gives the widget the action's tip, and whatever that becomes when the keys are others.
void showTipOf(const QAction& action, QWidget& widget);

}  // namespace tessera
