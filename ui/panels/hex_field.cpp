// See hex_field.h.
#include "ui/panels/hex_field.h"

#include <QKeyEvent>
#include <QRegularExpressionValidator>

#include "ui/conversions.h"
#include "ui/panels/panel_parts.h"

namespace tessera {

HexField::HexField(QWidget* parent) : QLineEdit(parent) {
    setToolTip(tr("Red, green and blue as hex digits"));
    setMinimumWidth(fontMetrics().horizontalAdvance("#dddddd") + 14);
    static const QRegularExpression kDigits("#?[0-9a-fA-F]{0,6}");
    setValidator(new QRegularExpressionValidator(kDigits, this));
    connect(this, &QLineEdit::editingFinished, this, &HexField::enter);
    setColour(mColour);
}

void HexField::setColour(glm::dvec3 srgb) {
    mColour = srgb;
    setText(isEnabled() ? hexText(srgb) : QString());
}

void HexField::enter() {
    QString digits = text();
    if (!digits.startsWith('#')) digits.prepend('#');
    const QColor typed(digits);
    const bool valid = typed.isValid() && (digits.size() == 4 || digits.size() == 7);
    const bool another = valid && typed.name() != hexText(mColour);
    setColour(another ? toSrgb(typed) : mColour);
    if (another) emit entered(mColour);
}

void HexField::keyPressEvent(QKeyEvent* event) {
    if (event->key() == Qt::Key_Escape) setColour(mColour);
    QLineEdit::keyPressEvent(event);
}

void HexField::changeEvent(QEvent* event) {
    if (event->type() == QEvent::EnabledChange) setColour(mColour);
    QLineEdit::changeEvent(event);
}

}  // namespace tessera
