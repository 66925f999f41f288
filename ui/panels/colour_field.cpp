// See colour_field.h.
#include "ui/panels/colour_field.h"

#include <QEvent>
#include <QHBoxLayout>
#include <QLineEdit>
#include <QRegularExpressionValidator>
#include <QToolButton>

#include "ui/conversions.h"
#include "ui/panels/colour_popup.h"
#include "ui/panels/panel_parts.h"
#include "ui/panels/swatch_button.h"

namespace tessera {

ColourField::ColourField(const QString& name, QWidget* parent)
    : QWidget(parent), mSwatch(new SwatchButton), mHex(new QLineEdit), mPopup(new ColourPopup(this)) {
    setAccessibleName(name);
    mSwatch->setObjectName("swatch");
    mSwatch->setAccessibleName(name);
    mSwatch->setToolTip(tr("%1: click to change it").arg(name));
    mHex->setObjectName("hex");
    mHex->setAccessibleName(tr("%1, hex digits").arg(name));
    mHex->setToolTip(tr("Red, green and blue as hex digits"));
    mHex->setMinimumWidth(mHex->fontMetrics().horizontalAdvance("#dddddd") + 14);
    static const QRegularExpression kDigits("#?[0-9a-fA-F]{0,6}");
    mHex->setValidator(new QRegularExpressionValidator(kDigits, mHex));
    auto* row = new QHBoxLayout(this);
    row->setContentsMargins(0, 0, 0, 0);
    row->setSpacing(6);
    row->addWidget(mSwatch);
    row->addWidget(mHex, 1);
    connect(mSwatch, &QToolButton::clicked, this, &ColourField::edit);
    connect(mHex, &QLineEdit::editingFinished, this, &ColourField::enterHex);
    connect(mPopup, &ColourPopup::previewed, this, [this](glm::dvec3 srgb) {
        show(srgb);
        emit previewed(srgb);
    });
    connect(mPopup, &ColourPopup::chosen, this, [this](glm::dvec3 srgb) {
        show(srgb);
        emit chosen(srgb);
    });
    connect(mPopup, &ColourPopup::cancelled, this, [this] {
        show(mPopup->colour());
        emit abandoned();
    });
    show(mColour);
}

void ColourField::setColour(glm::dvec3 srgb) {
    if (!editing()) show(srgb);
}

void ColourField::edit() {
    mPopup->setColour(mColour);
    mPopup->open(this);
}

bool ColourField::editing() const {
    return mPopup->isVisible();
}

void ColourField::show(glm::dvec3 srgb) {
    mColour = srgb;
    mSwatch->setColour(toQColor(srgb));
    mHex->setText(isEnabled() ? hexText(srgb) : QString());
}

void ColourField::changeEvent(QEvent* event) {
    if (event->type() == QEvent::EnabledChange) show(mColour);
    QWidget::changeEvent(event);
}

void ColourField::enterHex() {
    QString digits = mHex->text();
    if (!digits.startsWith('#')) digits.prepend('#');
    const QColor entered(digits);
    const bool valid = entered.isValid() && (digits.size() == 4 || digits.size() == 7);
    if (!valid || entered.name() == hexText(mColour)) return show(mColour);
    show(toSrgb(entered));
    emit chosen(mColour);
}

}  // namespace tessera
