// See colour_field.h.
#include "ui/panels/colour_field.h"

#include <QHBoxLayout>
#include <QToolButton>

#include "ui/conversions.h"
#include "ui/panels/colour_popup.h"
#include "ui/panels/hex_field.h"
#include "ui/panels/swatch_button.h"

namespace tessera {

ColourField::ColourField(const QString& name, QWidget* parent)
    : QWidget(parent), mSwatch(new SwatchButton), mHex(new HexField), mPopup(new ColourPopup(this)) {
    setAccessibleName(name);
    mSwatch->setObjectName("swatch");
    mSwatch->setAccessibleName(name);
    mSwatch->setToolTip(tr("%1: click to change it").arg(name));
    mHex->setObjectName("hex");
    mHex->setAccessibleName(tr("%1, hex digits").arg(name));
    auto* row = new QHBoxLayout(this);
    row->setContentsMargins(0, 0, 0, 0);
    row->setSpacing(6);
    row->addWidget(mSwatch);
    row->addWidget(mHex, 1);
    connect(mSwatch, &QToolButton::clicked, this, &ColourField::edit);
    connect(mHex, &HexField::entered, this, [this](glm::dvec3 srgb) {
        show(srgb);
        emit chosen(srgb);
    });
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
    mHex->setColour(srgb);
}

}  // namespace tessera
