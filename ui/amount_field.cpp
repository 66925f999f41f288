// See amount_field.h.
#include "ui/amount_field.h"

#include <QComboBox>
#include <QDoubleSpinBox>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QSignalBlocker>
#include <QSpinBox>
#include <QStackedWidget>
#include <QStandardItemModel>
#include <array>
#include <cmath>

#include "core/vectorize/quality.h"
#include "ui/panels/gesture_slider.h"
#include "ui/status_bar.h"
#include "ui/widget_parts.h"

namespace tessera {

namespace {

constexpr int kMinPatches = 2, kMaxPatches = 1'000'000;
// Where the slider begins, and where it ends while no picture says better.
constexpr int kFewPatches = 20, kManyPatches = 20'000;
constexpr int kTicks = 1000;
constexpr double kMinError = .1, kMaxError = 50;
constexpr int kFieldHeightPx = 28;
// What the settings call the choices, in their order.
const std::array<const char*, 3> kNames{"patches", "detail", "error"};

}  // namespace

AmountField::AmountField(Settings& settings, QWidget* parent)
    : QWidget(parent),
      mSettings(settings),
      mKind(new QComboBox),
      mStack(new QStackedWidget),
      mPatches(new QSpinBox),
      mDetail(new QSpinBox),
      mError(new QDoubleSpinBox),
      mSlider(new GestureSlider),
      mHint(dimLabel({})) {
    makeFields();
    makeSlider();
    auto* row = new QHBoxLayout;
    row->addWidget(mKind);
    row->addWidget(mStack, 1);
    auto* column = partColumn(this);
    column->addLayout(row);
    column->addWidget(mSlider);
    column->addWidget(mHint);
    const auto known = std::find(kNames.begin(), kNames.end(), mSettings.amount());
    mKind->setCurrentIndex(known == kNames.end() ? Patches : int(known - kNames.begin()));
    choose(kind());
    connect(mKind, &QComboBox::currentIndexChanged, this, &AmountField::choose);
}

void AmountField::makeFields() {
    mKind->addItems({tr("Patches"), tr("Detail"), tr("Mean error")});
    mKind->setObjectName("amount");
    mKind->setAccessibleName(tr("Amount by"));
    mKind->setToolTip(
        tr("What says how many patches there shall be: their number, the detail that they hold "
           "whatever the picture's size, or how far they may be from the photo"));
    mKind->setFocusPolicy(Qt::TabFocus);
    mKind->setMinimumHeight(kFieldHeightPx);
    mPatches->setObjectName("patches");
    mPatches->setRange(kMinPatches, kMaxPatches);
    mPatches->setStepType(QAbstractSpinBox::AdaptiveDecimalStepType);
    mPatches->setValue(mSettings.patches());
    mDetail->setObjectName("detail");
    mDetail->setRange(0, 100);
    mDetail->setSuffix(tr(" %"));
    mDetail->setValue(int(std::lround(100 * mSettings.detail())));
    mError->setObjectName("meanError");
    mError->setRange(kMinError, kMaxError);
    mError->setSingleStep(.25);
    mError->setSuffix(tr(" of 255"));
    mError->setValue(mSettings.meanError());
    mPatches->setToolTip(tr("How many patches to aim at"));
    mDetail->setToolTip(tr("From a few large patches to one for every texture"));
    mError->setToolTip(tr("The mean difference from the photo, in levels of a channel"));
    for (QAbstractSpinBox* field : std::initializer_list<QAbstractSpinBox*>{mPatches, mDetail, mError}) {
        field->setAlignment(Qt::AlignRight);
        field->setGroupSeparatorShown(true);
        field->setMinimumHeight(kFieldHeightPx);
        field->setFocusPolicy(Qt::StrongFocus);  // not by the wheel: it shall not change while one scrolls
        field->setAccessibleName(mKind->itemText(mStack->addWidget(field)));
    }
    connect(mPatches, &QSpinBox::valueChanged, this, [this](int patches) {
        mSettings.setPatches(patches);
        changed();
    });
    connect(mDetail, &QSpinBox::valueChanged, this, [this](int percent) {
        mSettings.setDetail(percent / 100.);
        changed();
    });
    connect(mError, &QDoubleSpinBox::valueChanged, this,
            [this](double levels) { mSettings.setMeanError(levels); });
}

void AmountField::makeSlider() {
    mSlider->setObjectName("amountSlider");
    mSlider->setRange(0, kTicks);
    mSlider->setSingleStep(kTicks / 50);
    mSlider->setPageStep(kTicks / 10);
    mSlider->setAccessibleName(tr("Amount"));
    mSlider->setToolTip(tr("Drag to see drafts; they change nothing until they are applied"));
    connect(mSlider, &GestureSlider::moved, this, &AmountField::follow);
    connect(mSlider, &GestureSlider::cancelled, this, [this] {
        follow(mSlider->value());
        emit draftDropped();
    });
}

AmountField::Kind AmountField::kind() const {
    return Kind(mKind->currentIndex());
}

void AmountField::choose(int kind) {
    mSettings.setAmount(kNames[size_t(kind)]);
    mStack->setCurrentIndex(kind);
    mSlider->setVisible(kind != Error);
    showSlider();
    showHint();
}

int AmountField::mostPatches() const {
    if (mPicture.isEmpty()) return kManyPatches;
    return std::max(2 * kFewPatches, patchesForDetail(1, mPicture.width(), mPicture.height()));
}

int AmountField::patchesAt(int tick) const {
    // On a logarithmic scale, to two digits.
    const double patches = kFewPatches * std::pow(double(mostPatches()) / kFewPatches, double(tick) / kTicks);
    const double step = std::pow(10, std::floor(std::log10(patches)) - 1);
    return int(std::lround(std::round(patches / step) * step));
}

int AmountField::tickOf(int patches) const {
    const double share =
        std::log(double(patches) / kFewPatches) / std::log(double(mostPatches()) / kFewPatches);
    return int(std::lround(kTicks * std::clamp(share, 0., 1.)));
}

void AmountField::follow(int tick) {
    {
        // The slider is where it is, between the values that fields can show.
        const QSignalBlocker quiet(mSlider);
        kind() == Detail ? mDetail->setValue(int(std::lround(100. * tick / kTicks)))
                         : mPatches->setValue(patchesAt(tick));
        mSlider->setValue(tick);
    }
    mSlider->update();
    if (!mDraft) emit draftWanted();
}

void AmountField::changed() {
    showSlider();
    showHint();
    if (mDraft) emit draftWanted();
}

void AmountField::showSlider() {
    const QSignalBlocker quiet(mSlider);
    mSlider->setValue(kind() == Detail ? kTicks / 100 * mDetail->value() : tickOf(mPatches->value()));
    mSlider->update();
}

void AmountField::showHint() {
    if (mDraft)
        mHint->setText(tr("A draft with %1 patches. Apply makes the full one, Escape goes back.")
                           .arg(countText(*mDraft)));
    else if (kind() == Patches)
        mHint->setText(tr("More keep detail; fewer are easier to edit."));
    else if (kind() == Error)
        mHint->setText(tr("As many patches as it takes: one to four runs."));
    else if (mPicture.isEmpty())
        mHint->setText(tr("The same detail takes more patches in a larger picture."));
    else
        mHint->setText(tr("About %1 patches for this picture.").arg(countText(size_t(patches()))));
}

int AmountField::patches() const {
    if (kind() != Detail || mPicture.isEmpty()) return mPatches->value();
    return patchesForDetail(mDetail->value() / 100., mPicture.width(), mPicture.height());
}

std::optional<double> AmountField::meanError() const {
    return kind() == Error ? std::optional(mError->value()) : std::nullopt;
}

void AmountField::setPatches(int patches) {
    mKind->setCurrentIndex(Patches);
    mPatches->setValue(patches);
}

void AmountField::setPicture(QSize picture) {
    if (picture == mPicture) return;
    mPicture = picture;
    showSlider();
    showHint();
}

void AmountField::setErrorPossible(bool possible) {
    if (!possible && kind() == Error) mKind->setCurrentIndex(Patches);
    static_cast<QStandardItemModel*>(mKind->model())->item(Error)->setEnabled(possible);
}

void AmountField::showDraft(std::optional<size_t> patches) {
    mDraft = patches;
    showHint();
}

void AmountField::keyPressEvent(QKeyEvent* event) {
    if (event->key() != Qt::Key_Escape || !mDraft) return QWidget::keyPressEvent(event);
    emit draftDropped();
}

}  // namespace tessera
