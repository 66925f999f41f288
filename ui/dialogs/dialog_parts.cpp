// See dialog_parts.h.
#include "ui/dialogs/dialog_parts.h"

#include <QDialog>
#include <QDialogButtonBox>
#include <QFormLayout>
#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>

namespace tessera {

QVBoxLayout* dialogColumn(QDialog* dialog) {
    auto* column = new QVBoxLayout(dialog);
    column->setContentsMargins(20, 20, 20, 16);
    column->setSpacing(16);
    return column;
}

QFormLayout* dialogForm() {
    auto* form = new QFormLayout;
    form->setHorizontalSpacing(16);
    form->setVerticalSpacing(10);
    form->setFieldGrowthPolicy(QFormLayout::AllNonFixedFieldsGrow);
    return form;
}

void addField(QFormLayout* form, const QString& label, QWidget* field) {
    field->setAccessibleName(QString(label).remove('&'));
    form->addRow(label, field);
}

void addField(QFormLayout* form, const QString& label, QLayout* row, QWidget* field) {
    auto* name = new QLabel(label);
    name->setBuddy(field);
    field->setAccessibleName(QString(label).remove('&'));
    form->addRow(name, row);
}

QPushButton* addPrimaryButton(QDialogButtonBox* box, const QString& text) {
    QPushButton* button = box->addButton(text, QDialogButtonBox::AcceptRole);
    button->setProperty("role", "primary");
    button->setDefault(true);
    return button;
}

}  // namespace tessera
