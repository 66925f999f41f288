// See vectorize_panel.h.
#include "ui/vectorize_panel.h"

#include <QAction>
#include <QCheckBox>
#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QLabel>
#include <QLocale>
#include <QPushButton>
#include <QSignalBlocker>
#include <QSpinBox>
#include <QVBoxLayout>

#include "app/document_session.h"
#include "app/workspace.h"
#include "ui/action_table.h"
#include "ui/status_bar.h"

namespace tessera {

namespace {

constexpr int kMinPatches = 2;
constexpr int kMaxPatches = 1'000'000;
constexpr int kPanelWidthPx = 280;

QLabel* heading(const QString& text) {
    auto* label = new QLabel(text);
    label->setProperty("role", "heading");
    return label;
}

QLabel* dimLabel(const QString& text) {
    auto* label = new QLabel(text);
    label->setProperty("role", "dim");
    label->setWordWrap(true);
    return label;
}

QFrame* line() {
    auto* frame = new QFrame;
    frame->setProperty("role", "line");
    return frame;
}

QVBoxLayout* makeColumn(QWidget* part) {
    auto* column = new QVBoxLayout(part);
    column->setContentsMargins(0, 0, 0, 0);
    column->setSpacing(8);
    return column;
}

// A check box that is the action's other face.
QCheckBox* boxFor(QAction* action) {
    auto* box = new QCheckBox(QString(action->text()).remove('&'));
    box->setToolTip(action->toolTip());
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
    auto* column = new QVBoxLayout(this);
    column->setContentsMargins(16, 12, 16, 16);
    column->setSpacing(16);
    column->addWidget(makeVectorizePart(actions));
    column->addWidget(line());
    column->addWidget(makeShowPart(actions));
    column->addWidget(mResult = makeResultPart());
    column->addStretch(1);
    setMinimumWidth(kPanelWidthPx);
    showSession(nullptr, 0);
}

QWidget* VectorizePanel::makeVectorizePart(const ActionTable& actions) {
    auto* part = new QWidget;
    auto* column = makeColumn(part);
    auto* row = new QHBoxLayout;
    mPatches = new QSpinBox;
    mPatches->setObjectName("patches");
    mPatches->setRange(kMinPatches, kMaxPatches);
    mPatches->setGroupSeparatorShown(true);
    mPatches->setStepType(QAbstractSpinBox::AdaptiveDecimalStepType);
    mPatches->setAlignment(Qt::AlignRight);
    mPatches->setMinimumHeight(28);
    mPatches->setFocusPolicy(
        Qt::StrongFocus);  // not by the wheel: it shall not change while one scrolls past
    mPatches->setValue(mSettings.patches());
    connect(mPatches, &QSpinBox::valueChanged, this, [this](int patches) { mSettings.setPatches(patches); });
    connect(mPatches, &QSpinBox::editingFinished, this, &VectorizePanel::editingDone);
    auto* label = new QLabel(tr("&Patches"));
    label->setBuddy(mPatches);
    row->addWidget(label);
    row->addWidget(mPatches, 1);
    column->addLayout(row);
    column->addWidget(dimLabel(tr("More patches keep more detail; fewer are easier to edit.")));
    column->addLayout(makeEdgeContrastRow());
    column->addWidget(
        dimLabel(tr("Edges above this share of the strongest become features. Raise it where they hold too "
                    "many patches.")));

    QAction* vectorize = actions[ActionId::Vectorize];
    auto* button = new QPushButton(tr("Vectorize"));
    button->setObjectName("vectorizeButton");
    button->setProperty("role", "primary");
    button->setMinimumHeight(34);
    button->setFocusPolicy(Qt::TabFocus);
    button->setToolTip(vectorize->toolTip());
    button->setEnabled(vectorize->isEnabled());
    connect(button, &QPushButton::clicked, vectorize, &QAction::trigger);
    connect(vectorize, &QAction::enabledChanged, button, &QWidget::setEnabled);
    column->addSpacing(4);
    column->addWidget(button);
    column->addSpacing(4);

    auto* onOpen = new QCheckBox(tr("Vectorize photos when opened"));
    onOpen->setChecked(mSettings.vectorizeOnOpen());
    onOpen->setFocusPolicy(Qt::TabFocus);
    connect(onOpen, &QCheckBox::toggled, this, [this](bool on) { mSettings.setVectorizeOnOpen(on); });
    column->addWidget(onOpen);
    auto* embed = new QCheckBox(tr("Keep the photo in the saved file"));
    embed->setChecked(mSettings.embedPhoto());
    embed->setFocusPolicy(Qt::TabFocus);
    embed->setToolTip(
        tr("So that the original can be compared with wherever the file goes; the file is larger"));
    connect(embed, &QCheckBox::toggled, this, [this](bool on) { mSettings.setEmbedPhoto(on); });
    column->addWidget(embed);
    return part;
}

QHBoxLayout* VectorizePanel::makeEdgeContrastRow() {
    mEdgeContrast = new QDoubleSpinBox;
    mEdgeContrast->setObjectName("edgeContrast");
    mEdgeContrast->setRange(1, 100);
    mEdgeContrast->setDecimals(1);
    mEdgeContrast->setSingleStep(2.5);
    mEdgeContrast->setSuffix(tr(" %"));
    mEdgeContrast->setAlignment(Qt::AlignRight);
    mEdgeContrast->setMinimumHeight(28);
    mEdgeContrast->setFocusPolicy(Qt::StrongFocus);
    setEdgeContrast(mSettings.edgeContrast());
    connect(mEdgeContrast, &QDoubleSpinBox::valueChanged, this,
            [this](double percent) { mSettings.setEdgeContrast(percent / 100); });
    connect(mEdgeContrast, &QDoubleSpinBox::editingFinished, this, &VectorizePanel::editingDone);
    auto* label = new QLabel(tr("&Edge contrast"));
    label->setBuddy(mEdgeContrast);
    auto* row = new QHBoxLayout;
    row->addWidget(label);
    row->addWidget(mEdgeContrast, 1);
    return row;
}

QWidget* VectorizePanel::makeShowPart(const ActionTable& actions) {
    auto* part = new QWidget;
    auto* column = makeColumn(part);
    column->addWidget(heading(tr("Show")));
    for (const ActionId id :
         {ActionId::ShowFeatures, ActionId::ShowEdges, ActionId::ShowControlPoints, ActionId::ShowOriginal})
        column->addWidget(boxFor(actions[id]));
    column->addWidget(dimLabel(tr("Hold O to peek at the original.")));
    return part;
}

QWidget* VectorizePanel::makeResultPart() {
    auto* part = new QWidget;
    auto* column = makeColumn(part);
    column->addWidget(line());
    column->addSpacing(8);
    column->addWidget(heading(tr("Result")));
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
    settings.patches = mPatches->value();
    // The lower threshold follows in the paper's proportion.
    const VectorizeSettings usual;
    const double high = mEdgeContrast->value() / 100;
    settings.cannyLow = high * usual.cannyLow / usual.cannyHigh;
    settings.cannyHigh = high;
    return settings;
}

void VectorizePanel::setPatches(int patches) {
    mPatches->setValue(patches);
}

void VectorizePanel::setEdgeContrast(double share) {
    mEdgeContrast->setValue(100 * share);
}

void VectorizePanel::showSession(const DocumentSession* session, size_t features) {
    const bool hasMesh = session && session->hasMesh();
    mResult->setVisible(hasMesh);
    if (!hasMesh) return;
    while (mFigures->rowCount() > 0) mFigures->removeRow(0);
    const auto add = [&](const QString& name, const QString& value) {
        auto* label = new QLabel(value);
        label->setAlignment(Qt::AlignRight);
        label->setTextInteractionFlags(Qt::TextSelectableByMouse);
        mFigures->addRow(name, label);
    };
    const Document& document = session->document();
    const QLocale locale;
    add(tr("Picture"), tr("%1 × %2").arg(session->width()).arg(session->height()));
    add(tr("Patches"), countText(document.mesh.patchCount()));
    add(tr("Feature curves"), countText(features));
    if (document.difference) {
        add(tr("Mean error"), tr("%1 of 255").arg(locale.toString(document.difference->mae, 'f', 2)));
        add(tr("PSNR"), tr("%1 dB").arg(locale.toString(document.difference->psnr, 'f', 1)));
    }
    if (!document.report.stages.empty())
        add(tr("Time"), tr("%1 s").arg(locale.toString(secondsOf(document.report), 'f', 1)));
    mShortfall->setText(asSentence(document.report.shortfall));
    mShortfall->setVisible(!document.report.shortfall.empty());
}

}  // namespace tessera
