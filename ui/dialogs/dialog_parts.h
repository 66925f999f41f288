// Pieces that the dialogs have in common, in the look of the theme.
#pragma once

#include <QString>

class QDialog;
class QDialogButtonBox;
class QFormLayout;
class QLayout;
class QPushButton;
class QVBoxLayout;
class QWidget;

namespace tessera {

// The dialog's outermost layout.
QVBoxLayout* dialogColumn(QDialog* dialog);
QFormLayout* dialogForm();
// A row whose label names the field to a screen reader too.
void addField(QFormLayout* form, const QString& label, QWidget* field);
// The same for a row of several widgets, of which `field` is the one that the label is about.
void addField(QFormLayout* form, const QString& label, QLayout* row, QWidget* field);
// The accepting button, which the Enter key presses.
QPushButton* addPrimaryButton(QDialogButtonBox* box, const QString& text);

}  // namespace tessera
