// See colour_popup.h.
#include "ui/panels/colour_popup.h"

#include <QDoubleSpinBox>
#include <QGridLayout>
#include <QGuiApplication>
#include <QKeyEvent>
#include <QLabel>
#include <QPainter>
#include <QScreen>
#include <QSignalBlocker>
#include <algorithm>
#include <cmath>

#include "core/image/oklab.h"
#include "ui/conversions.h"
#include "ui/panels/gesture_slider.h"
#include "ui/panels/hex_field.h"

namespace tessera {

namespace {

constexpr int kLightness = 0, kChroma = 1, kHue = 2;
// Beyond it no colour of sRGB has any more.
constexpr double kMostChroma = .33;
// Sliders count in these; fields show the coordinates themselves, lightness in percent.
constexpr int kTicks = 1000;
constexpr std::array<double, 3> kMost{1, kMostChroma, 360};
constexpr std::array<double, 3> kShown{100, 1, 1};

bool inGamut(glm::dvec3 srgb) {
    constexpr double kTolerance = 1e-4;
    for (int c = 0; c < 3; ++c)
        if (!(srgb[c] >= -kTolerance && srgb[c] <= 1 + kTolerance)) return false;
    return true;
}

}  // namespace

glm::dvec3 oklchInGamut(glm::dvec3 lch) {
    glm::dvec3 srgb = fromOklch(lch);
    if (!inGamut(srgb)) {
        double inside = 0, outside = lch.y;
        constexpr int kHalvings = 12;
        for (int i = 0; i < kHalvings; ++i) {
            const double middle = .5 * (inside + outside);
            (inGamut(fromOklch({lch.x, middle, lch.z})) ? inside : outside) = middle;
        }
        srgb = fromOklch({lch.x, inside, lch.z});
    }
    for (int c = 0; c < 3; ++c) srgb[c] = std::clamp(srgb[c], 0., 1.);
    return srgb;
}

ColourPopup::ColourPopup(QWidget* parent) : QFrame(parent, Qt::Popup) {
    setObjectName("colourPopup");
    setAccessibleName(tr("Colour"));
    auto* grid = new QGridLayout(this);
    grid->setContentsMargins(12, 12, 12, 12);
    grid->setHorizontalSpacing(8);
    grid->setVerticalSpacing(6);
    mComparison = new QWidget;
    mComparison->setMinimumHeight(2 * fontMetrics().height());
    mComparison->setToolTip(tr("Left: as it was; right: as it will be"));
    grid->addWidget(mComparison, 0, 0, 1, 3);
    addRow(1, kLightness, tr("L"), tr("Lightness"), 1);
    addRow(2, kChroma, tr("C"), tr("Chroma"), 3);
    addRow(3, kHue, tr("H"), tr("Hue"), 0);
    mHex = new HexField;
    mHex->setObjectName("hex");
    mHex->setAccessibleName(tr("Hex digits"));
    grid->addWidget(mHex, 4, 2);
    connect(mHex, &HexField::entered, this, [this](glm::dvec3 srgb) {
        setColour(srgb);
        emit previewed(mColour);
    });
    grid->setColumnStretch(1, 1);
}

void ColourPopup::addRow(int row, int coordinate, const QString& letter, const QString& name, int decimals) {
    auto* label = new QLabel(letter);
    label->setToolTip(name);
    auto* slider = mSliders[size_t(coordinate)] = new GestureSlider;
    slider->setRange(0, kTicks);
    slider->setSingleStep(kTicks / 100);
    slider->setPageStep(kTicks / 10);
    slider->setMinimumWidth(160);
    slider->setAccessibleName(name);
    slider->setGradient([this, coordinate](double share) {
        glm::dvec3 lch = mLch;
        lch[coordinate] = share * kMost[size_t(coordinate)];
        return toQColor(oklchInGamut(lch));
    });
    connect(slider, &GestureSlider::moved, this, [this, coordinate](int tick) {
        setCoordinate(coordinate, kMost[size_t(coordinate)] * tick / kTicks);
    });
    connect(slider, &GestureSlider::cancelled, this, [this, coordinate, slider] {
        setCoordinate(coordinate, kMost[size_t(coordinate)] * slider->value() / kTicks);
    });
    auto* field = mFields[size_t(coordinate)] = new QDoubleSpinBox;
    field->setDecimals(decimals);
    field->setRange(0, kMost[size_t(coordinate)] * kShown[size_t(coordinate)]);
    field->setSingleStep(field->maximum() / 100);
    if (coordinate == kHue) {
        field->setWrapping(true);
        field->setSuffix(tr("°"));
    }
    if (coordinate == kLightness) field->setSuffix(tr(" %"));
    field->setAccessibleName(name);
    connect(field, &QDoubleSpinBox::valueChanged, this, [this, coordinate](double value) {
        setCoordinate(coordinate, value / kShown[size_t(coordinate)]);
    });
    auto* grid = static_cast<QGridLayout*>(layout());
    grid->addWidget(label, row, 0);
    grid->addWidget(slider, row, 1);
    grid->addWidget(field, row, 2);
}

void ColourPopup::setColour(glm::dvec3 srgb) {
    const double hue = mLch.z;
    mColour = srgb;
    mLch = toOklch(srgb);
    constexpr double kGrey = 1e-3;
    if (mLch.y < kGrey) mLch.z = hue;  // greys have none: the slider stays
    showCoordinates();
}

void ColourPopup::setCoordinate(int coordinate, double value) {
    mLch[coordinate] = value;
    mColour = oklchInGamut(mLch);
    showCoordinates();
    emit previewed(mColour);
}

void ColourPopup::showCoordinates() {
    for (size_t i = 0; i < 3; ++i) {
        const QSignalBlocker quietSlider(mSliders[i]);
        const QSignalBlocker quietField(mFields[i]);
        mSliders[i]->setValue(int(std::lround(kTicks * mLch[int(i)] / kMost[i])));
        mSliders[i]->update();
        mFields[i]->setValue(mLch[int(i)] * kShown[i]);
    }
    mHex->setColour(mColour);
    update();
}

void ColourPopup::open(const QWidget* field) {
    mBefore = mColour;
    mOpen = true;
    adjustSize();
    QPoint at = field->mapToGlobal(QPoint(0, field->height() + 2));
    if (const QScreen* screen = field->screen()) {
        const QRect room = screen->availableGeometry();
        if (at.y() + height() > room.bottom()) at.setY(field->mapToGlobal(QPoint(0, 0)).y() - height() - 2);
        at.setX(std::clamp(at.x(), room.left(), std::max(room.left(), room.right() - width())));
    }
    move(at);
    show();
    mSliders[kLightness]->setFocus();
}

void ColourPopup::keyPressEvent(QKeyEvent* event) {
    if (event->key() == Qt::Key_Escape) {
        mColour = mBefore;
        close();
    } else if (event->key() == Qt::Key_Return || event->key() == Qt::Key_Enter) {
        close();
    } else {
        QFrame::keyPressEvent(event);
    }
}

void ColourPopup::hideEvent(QHideEvent* event) {
    QFrame::hideEvent(event);
    if (!std::exchange(mOpen, false)) return;
    if (mColour == mBefore)
        emit cancelled();
    else
        emit chosen(mColour);
}

void ColourPopup::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.setPen(palette().color(QPalette::Dark));
    painter.setBrush(palette().window());
    painter.drawRect(rect().adjusted(0, 0, -1, -1));
    const QRect whole = mComparison->geometry();
    painter.fillRect(whole, toQColor(mColour));
    painter.fillRect(QRect(whole.topLeft(), QSize(whole.width() / 2, whole.height())), toQColor(mBefore));
    painter.setBrush(Qt::NoBrush);
    painter.drawRect(whole.adjusted(0, 0, -1, -1));
}

}  // namespace tessera
