// See vectorize_panel.h.
#include "ui/vectorize_panel.h"

#include <QAction>
#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QGridLayout>
#include <QLabel>
#include <QLocale>
#include <QPushButton>
#include <QVBoxLayout>
#include <cmath>
#include <functional>

#include "app/document_session.h"
#include "app/workspace.h"
#include "core/vectorize/quality.h"
#include "ui/action_table.h"
#include "ui/amount_field.h"
#include "ui/panels/gesture_slider.h"
#include "ui/panels/panel_parts.h"
#include "ui/status_bar.h"
#include "ui/widget_parts.h"

namespace tessera {

namespace {

constexpr int kFieldHeightPx = 28;
// Among the presets, what stands for the paper's method.
const QString kPaper = "paper";

QHBoxLayout* labelled(const QString& text, QWidget* field) {
    auto* label = new QLabel(text);
    label->setBuddy(field);
    field->setAccessibleName(QString(text).remove('&'));
    auto* row = new QHBoxLayout;
    row->addWidget(label);
    row->addWidget(field, 1);
    return row;
}

// A check box that is the action's other face.
QCheckBox* boxFor(QAction* action) {
    auto* box = new QCheckBox(QString(action->text()).remove('&'));
    showTipOf(*action, *box);
    box->setChecked(action->isChecked());
    box->setFocusPolicy(Qt::TabFocus);
    box->setEnabled(action->isEnabled());
    QObject::connect(action, &QAction::enabledChanged, box, &QWidget::setEnabled);
    QObject::connect(box, &QCheckBox::clicked, action, &QAction::setChecked);
    QObject::connect(action, &QAction::toggled, box, &QCheckBox::setChecked);
    return box;
}

double secondsOf(const VectorizeReport& report) {
    double seconds = 0;
    for (const StageReport& stage : report.stages) seconds += stage.seconds;
    return seconds;
}

}  // namespace

VectorizePanel::VectorizePanel(Settings& settings, const ActionTable& actions, QWidget* parent)
    : QWidget(parent), mSettings(settings) {
    auto* column = panelColumn(this);
    column->setSpacing(16);
    column->addWidget(makeVectorizePart(actions));
    column->addWidget(separatorLine());
    column->addWidget(makeShowPart(actions));
    column->addWidget(mResult = makeResultPart());
    column->addStretch(1);
    showSession(nullptr, 0);
}

QWidget* VectorizePanel::makeVectorizePart(const ActionTable& actions) {
    auto* part = new QWidget;
    auto* column = partColumn(part);
    column->addWidget(mAmount = makeAmountField());
    column->addLayout(makeQualityRow());
    column->addWidget(mFeaturesPart = makeFeaturesPart());
    column->addWidget(mEdgeContrastPart = makeEdgeContrastPart());
    showFieldsOfMethod();
    column->addSpacing(4);
    column->addWidget(makeVectorizeButton(actions));
    column->addWidget(mPhotoMissing = makePhotoMissingPart(actions));
    column->addSpacing(4);
    auto* onOpen = makeOption(tr("Vectorize photos when opened"), mSettings.vectorizeOnOpen(),
                              &Settings::setVectorizeOnOpen);
    onOpen->setToolTip(tr("Start at once, with what is set here; it can be cancelled and done again"));
    column->addWidget(onOpen);
    auto* embed =
        makeOption(tr("Keep the photo in the saved file"), mSettings.embedPhoto(), &Settings::setEmbedPhoto);
    embed->setToolTip(
        tr("So that the original can be compared with wherever the file goes; the file is larger"));
    column->addWidget(embed);
    return part;
}

AmountField* VectorizePanel::makeAmountField() {
    auto* amount = new AmountField(mSettings);
    connect(amount, &AmountField::draftWanted, this, &VectorizePanel::draftWanted);
    connect(amount, &AmountField::draftDropped, this, &VectorizePanel::draftDropped);
    return amount;
}

QLayout* VectorizePanel::makeQualityRow() {
    mQuality = new QComboBox;
    mQuality->setObjectName("quality");
    mQuality->setMinimumHeight(kFieldHeightPx);
    mQuality->setFocusPolicy(Qt::TabFocus);
    mQuality->setPlaceholderText(tr("Custom"));
    mQuality->addItem(tr("Draft"), "draft");
    mQuality->addItem(tr("Standard"), "standard");
    mQuality->addItem(tr("Fine"), "fine");
    mQuality->addItem(tr("Max"), "max");
    mQuality->insertSeparator(mQuality->count());
    mQuality->addItem(tr("Paper of 2009"), kPaper);
    mQuality->setToolTip(tr(
        "A draft takes seconds, the best some minutes. “Paper of 2009” is an older method, for comparison"));
    mQuality->setItemData(
        mQuality->findData(kPaper),
        tr("How the research paper of 2009 that Tessera began with makes its patches, to compare with"),
        Qt::ToolTipRole);
    mQuality->setCurrentIndex(mQuality->findData(mSettings.quality()));
    connect(mQuality, &QComboBox::activated, this,
            [this] { mSettings.setQuality(mQuality->currentData().toString()); });
    connect(mQuality, &QComboBox::currentIndexChanged, this, &VectorizePanel::showFieldsOfMethod);
    return labelled(tr("&Quality"), mQuality);
}

QWidget* VectorizePanel::makeFeaturesPart() {
    mFeatures = new GestureSlider;
    mFeatures->setObjectName("features");
    mFeatures->setRange(0, 100);
    mFeatures->setPageStep(10);
    mFeatures->setValue(int(std::lround(100 * mSettings.features())));
    connect(mFeatures, &QSlider::valueChanged, this,
            [this](int percent) { mSettings.setFeatures(percent / 100.0); });
    connect(mFeatures, &GestureSlider::ended, this, [this] {
        if (mDraftShown) emit draftWanted();
    });
    mFeatures->setToolTip(tr("How many outlines stay sharp when enlarged; to the left, none"));
    auto* part = new QWidget;
    partColumn(part)->addLayout(labelled(tr("&Outlines"), mFeatures));
    return part;
}

QWidget* VectorizePanel::makeEdgeContrastPart() {
    mEdgeContrast = new QDoubleSpinBox;
    mEdgeContrast->setObjectName("edgeContrast");
    mEdgeContrast->setRange(1, 100);
    mEdgeContrast->setDecimals(1);
    mEdgeContrast->setSingleStep(2.5);
    mEdgeContrast->setSuffix(tr(" %"));
    mEdgeContrast->setAlignment(Qt::AlignRight);
    mEdgeContrast->setMinimumHeight(kFieldHeightPx);
    mEdgeContrast->setFocusPolicy(Qt::StrongFocus);
    mEdgeContrast->setValue(100 * mSettings.edgeContrast());
    connect(mEdgeContrast, &QDoubleSpinBox::valueChanged, this,
            [this](double percent) { mSettings.setEdgeContrast(percent / 100); });
    mEdgeContrast->setToolTip(
        tr("Edges above this share of the strongest become features. Raise it where they hold too many "
           "patches"));
    auto* part = new QWidget;
    partColumn(part)->addLayout(labelled(tr("&Edge contrast"), mEdgeContrast));
    return part;
}

QPushButton* VectorizePanel::makeVectorizeButton(const ActionTable& actions) {
    QAction* vectorize = actions[ActionId::Vectorize];
    auto* button = mApply = new QPushButton(tr("Vectorize"));
    button->setObjectName("vectorizeButton");
    button->setProperty("role", "primary");
    button->setMinimumHeight(34);
    button->setFocusPolicy(Qt::TabFocus);
    showTipOf(*vectorize, *button);
    button->setEnabled(vectorize->isEnabled());
    connect(button, &QPushButton::clicked, vectorize, &QAction::trigger);
    connect(vectorize, &QAction::enabledChanged, button, &QWidget::setEnabled);
    return button;
}

QWidget* VectorizePanel::makePhotoMissingPart(const ActionTable& actions) {
    QAction* find = actions[ActionId::Relink];
    auto* button = new QPushButton(tr("Find the Photo…"));
    button->setObjectName("findPhoto");
    button->setFocusPolicy(Qt::TabFocus);
    showTipOf(*find, *button);
    connect(button, &QPushButton::clicked, find, &QAction::trigger);
    auto* part = new QWidget;
    auto* column = partColumn(part);
    column->addWidget(
        dimLabel(tr("The photo is not where it was. Without it nothing can be vectorized "
                    "again, compared or refitted.")));
    column->addWidget(button);
    return part;
}

QCheckBox* VectorizePanel::makeOption(const QString& text, bool on, void (Settings::*set)(bool)) {
    auto* box = new QCheckBox(text);
    box->setChecked(on);
    box->setFocusPolicy(Qt::TabFocus);
    connect(box, &QCheckBox::toggled, this, [this, set](bool now) { std::invoke(set, mSettings, now); });
    return box;
}

bool VectorizePanel::paperChosen() const {
    return mQuality->currentData() == kPaper;
}

void VectorizePanel::showFieldsOfMethod() {
    mFeaturesPart->setVisible(!paperChosen());
    mEdgeContrastPart->setVisible(paperChosen());
    mAmount->setErrorPossible(!paperChosen());
}

QWidget* VectorizePanel::makeShowPart(const ActionTable& actions) {
    auto* part = new QWidget;
    auto* column = partColumn(part);
    column->addWidget(headingLabel(tr("Show")));
    auto* grid = new QGridLayout;
    grid->setVerticalSpacing(8);
    int at = 0;
    for (const ActionId id : {ActionId::ShowFeatures, ActionId::ShowEdges, ActionId::ShowControlPoints,
                              ActionId::ShowCentres, ActionId::ShowHeatMap, ActionId::ShowOriginal}) {
        grid->addWidget(boxFor(actions[id]), at / 2, at % 2);
        ++at;
    }
    column->addLayout(grid);
    return part;
}

QWidget* VectorizePanel::makeResultPart() {
    auto* part = new QWidget;
    auto* column = partColumn(part);
    column->addWidget(separatorLine());
    column->addSpacing(8);
    column->addWidget(headingLabel(tr("Result")));
    mFigures = new QFormLayout;
    mFigures->setHorizontalSpacing(16);
    mFigures->setVerticalSpacing(6);
    mFigures->setFieldGrowthPolicy(QFormLayout::AllNonFixedFieldsGrow);
    column->addLayout(mFigures);
    mShortfall = dimLabel({});
    column->addWidget(mShortfall);
    return part;
}

VectorizeSettings VectorizePanel::settings(const DocumentSession* session) const {
    VectorizeSettings settings = session ? session->document().settings : VectorizeSettings{};
    const QString method = paperChosen() ? "paper" : "default";
    if (settings.method != method.toStdString()) {
        // Variants of the other method's stages mean nothing in this one.
        settings.method = method.toStdString();
        settings.stageVariants.clear();
    }
    settings.patches = mAmount->patches();
    if (paperChosen()) {
        // The lower threshold follows in the paper's proportion.
        const VectorizeSettings usual;
        const double high = mEdgeContrast->value() / 100;
        settings.cannyLow = high * usual.cannyLow / usual.cannyHigh;
        settings.cannyHigh = high;
        return settings;
    }
    setFeatureShare(settings, mFeatures->value() / 100.0);
    // A document's own settings stay where they are no preset's and none has been chosen.
    if (mQuality->currentIndex() >= 0) {
        const auto applied = applyPreset(settings, mQuality->currentData().toString().toStdString());
        Q_ASSERT(applied);
    }
    return settings;
}

std::optional<double> VectorizePanel::meanError() const {
    return mAmount->meanError();
}

void VectorizePanel::setPatches(int patches) {
    mAmount->setPatches(patches);
}

void VectorizePanel::showDraft(std::optional<size_t> patches) {
    mDraftShown = patches.has_value();
    mAmount->showDraft(patches);
    mApply->setText(mDraftShown ? tr("Apply") : tr("Vectorize"));
}

void VectorizePanel::showSettings(const VectorizeSettings& settings) {
    mAmount->setPatches(settings.patches);
    if (settings.method == "paper") {
        mQuality->setCurrentIndex(mQuality->findData(kPaper));
        mEdgeContrast->setValue(100 * settings.cannyHigh);
        return;
    }
    mQuality->setCurrentIndex(mQuality->findData(QString::fromStdString(presetOf(settings))));
    mFeatures->setValue(int(std::lround(100 * featureShare(settings))));
}

void VectorizePanel::showSession(const DocumentSession* session, size_t features,
                                 std::optional<size_t> draft) {
    const bool hasMesh = session && session->hasMesh();
    mAmount->setPicture(session ? QSize(session->width(), session->height()) : QSize());
    mResult->setVisible(hasMesh || (session && draft));
    mPhotoMissing->setVisible(hasMesh && !session->photo().image);
    if (!mResult->isHidden()) showFigures(*session, features, draft);
}

void VectorizePanel::showFigures(const DocumentSession& session, size_t features,
                                 std::optional<size_t> draft) {
    while (mFigures->rowCount() > 0) mFigures->removeRow(0);
    const auto add = [&](const QString& name, const QString& value) {
        auto* label = new QLabel(value);
        label->setAlignment(Qt::AlignRight);
        label->setTextInteractionFlags(Qt::TextSelectableByMouse);
        mFigures->addRow(name, label);
    };
    const Document& document = session.document();
    const QLocale locale;
    add(tr("Picture"), tr("%1 × %2").arg(session.width()).arg(session.height()));
    mShortfall->setVisible(!draft && !document.report.shortfall.empty());
    // What is known of the document is not so of its draft.
    if (draft) return add(tr("Draft"), tr("%1 patches").arg(countText(*draft)));
    add(tr("Patches"), countText(document.mesh.patchCount()));
    add(tr("Feature curves"), countText(features));
    if (document.difference) {
        add(tr("Mean error"), tr("%1 of 255").arg(locale.toString(document.difference->mae, 'f', 2)));
        add(tr("PSNR"), tr("%1 dB").arg(locale.toString(document.difference->psnr, 'f', 1)));
    } else if (document.fitted) {
        add(tr("Mean error"), tr("edited since it was measured"));
    }
    if (!document.report.stages.empty())
        add(tr("Time"), tr("%1 s").arg(locale.toString(secondsOf(document.report), 'f', 1)));
    mShortfall->setText(asSentence(document.report.shortfall));
}

}  // namespace tessera
