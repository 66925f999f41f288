// See recolour_panel.h.
#include "ui/panels/recolour_panel.h"

#include <QDoubleSpinBox>
#include <QGridLayout>
#include <QLabel>
#include <QPushButton>
#include <QSignalBlocker>
#include <QTimer>
#include <QToolButton>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>

#include "app/message.h"
#include "app/tools/tool_manager.h"
#include "ui/panels/colour_field.h"
#include "ui/panels/gesture_slider.h"
#include "ui/panels/panel_parts.h"
#include "ui/widget_parts.h"

namespace tessera {

namespace {

constexpr double kMostFeatherPx = 200;

// By area and opacity, as the session has them at hand.
glm::dvec3 meanOf(const PatchColours& colours, const PatchSet& set) {
    glm::dvec3 sum(0);
    double weight = 0;
    for (const PatchId p : set) {
        const double w = colours[p].area * colours[p].alpha;
        sum += w * colours[p].srgb;
        weight += w;
    }
    return weight > 0 ? sum / weight : glm::dvec3(0);
}

}  // namespace

RecolourPanel::RecolourPanel(QWidget* parent) : LazyPanel(parent) {
    setAccessibleName(tr("Recolour"));
    auto* column = panelColumn(this);
    column->addWidget(makeToolColours());
    column->addWidget(separatorLine());
    column->addWidget(mHint = dimLabel({}));
    mHint->setObjectName("hint");
    mEdits = new QWidget;
    auto* edits = partColumn(mEdits);
    edits->addWidget(makeReplacePart());
    edits->addWidget(makeSliders());
    edits->addWidget(makeButtons());
    column->addWidget(mEdits);
    column->addStretch(1);
    connectReplace();
    refreshNow();
}

RecolourPanel::~RecolourPanel() = default;

QWidget* RecolourPanel::makeToolColours() {
    auto* part = new QWidget;
    auto* grid = partGrid(part);
    mColour = new ColourField(tr("Colour"));
    mColour->setObjectName("colour");
    mSecondColour = new ColourField(tr("Second colour"));
    mSecondColour->setObjectName("secondColour");
    auto* exchange = new QToolButton;
    exchange->setObjectName("exchange");
    exchange->setText("⇄");
    exchange->setAutoRaise(true);
    exchange->setToolTip(tr("Exchange the two colours"));
    exchange->setAccessibleName(tr("Exchange the two colours"));
    exchange->setFocusPolicy(Qt::TabFocus);
    grid->addWidget(dimLabel(tr("Colour")), 0, 0);
    grid->addWidget(dimLabel(tr("Second")), 0, 2);
    grid->addWidget(mColour, 1, 0);
    grid->addWidget(exchange, 1, 1);
    grid->addWidget(mSecondColour, 1, 2);
    grid->setColumnStretch(0, 1);
    grid->setColumnStretch(2, 1);
    const auto set = [this] { setColours(mColour->colour(), mSecondColour->colour()); };
    for (ColourField* field : {mColour, mSecondColour}) {
        connect(field, &ColourField::previewed, this, set);
        connect(field, &ColourField::chosen, this, set);
        connect(field, &ColourField::abandoned, this, set);
    }
    connect(exchange, &QToolButton::clicked, this,
            [this] { setColours(mSecondColour->colour(), mColour->colour()); });
    return part;
}

QWidget* RecolourPanel::makeReplacePart() {
    auto* part = new QWidget;
    auto* grid = partGrid(part);
    grid->setColumnStretch(0, 1);
    mMean = new ColourField(tr("Colour of the selection"));
    mMean->setObjectName("mean");
    auto* use =
        panelButton(tr("Use colour"), tr("Give the selection the colour above; shading stays"), "use");
    connect(use, &QPushButton::clicked, this, [this] { replaceBy(mColour->colour()); });
    grid->addWidget(dimLabel(tr("Colour of the selection; its shading stays")), 0, 0, 1, 2);
    grid->addWidget(mMean, 1, 0);
    grid->addWidget(use, 1, 1);
    return part;
}

QWidget* RecolourPanel::makeSliders() {
    auto* part = new QWidget;
    auto* grid = partGrid(part);
    grid->setHorizontalSpacing(8);
    grid->setVerticalSpacing(4);
    grid->setColumnStretch(1, 1);
    addSlider(grid, Hue, tr("Hue"), tr("Turns all hues; a double click goes back"), -180, 180, tr("°"));
    addSlider(grid, Chroma, tr("Chroma"), tr("From grey to twice as colourful; a double click goes back"),
              -100, 100, tr(" %"));
    addSlider(grid, Lightness, tr("Lightness"), tr("By how it looks; a double click goes back"), -100, 100,
              tr(" %"));
    addSlider(grid, Brightness, tr("Brightness"), tr("Adds the same to all; a double click goes back"), -100,
              100, tr(" %"));
    addSlider(grid, Contrast, tr("Contrast"), tr("Around mid grey; a double click goes back"), -100, 100,
              tr(" %"));
    addSlider(grid, TintStrength, tr("Tint"),
              tr("Toward the hue of the colour above, as light as before; a double click goes back"), 0, 100,
              tr(" %"));
    mFeather = new QDoubleSpinBox;
    mFeather->setObjectName("feather");
    mFeather->setAccessibleName(tr("Feather"));
    mFeather->setToolTip(tr(
        "How far to either side of the selection's border recolourings fade; at features they stay sharp"));
    mFeather->setRange(0, kMostFeatherPx);
    mFeather->setDecimals(1);
    mFeather->setSuffix(tr(" px"));
    mFeather->setKeyboardTracking(false);
    mFeather->setFocusPolicy(Qt::StrongFocus);
    connect(mFeather, &QDoubleSpinBox::valueChanged, this, [this](double px) {
        if (!mTools) return;
        ToolOptions options = mTools->options();
        options.featherPx = px;
        mTools->setOptions(options);
    });
    auto* label = new QLabel(tr("Feather"));
    label->setBuddy(mFeather);
    grid->addWidget(label, RowCount, 0);
    grid->addWidget(mFeather, RowCount, 1, 1, 2, Qt::AlignRight);
    return part;
}

void RecolourPanel::addSlider(QGridLayout* grid, Row row, const QString& name, const QString& tip, int least,
                              int most, const QString& unit) {
    auto* slider = new GestureSlider;
    auto* field = new QSpinBox;
    slider->setObjectName(name.toLower());
    slider->setRange(least, most);
    slider->setPageStep(10);
    slider->setNeutral(0);
    slider->setAccessibleName(name);
    slider->setToolTip(tip);
    field->setRange(least, most);
    field->setSuffix(unit);
    field->setAlignment(Qt::AlignRight);
    field->setAccessibleName(name);
    field->setToolTip(tip);
    field->setKeyboardTracking(false);
    field->setFocusPolicy(Qt::StrongFocus);
    field->setButtonSymbols(QAbstractSpinBox::NoButtons);
    auto* label = new QLabel(name);
    label->setBuddy(field);
    grid->addWidget(label, row, 0);
    grid->addWidget(slider, row, 1);
    grid->addWidget(field, row, 2);
    mSliders[row] = {slider, field};

    connect(field, &QSpinBox::valueChanged, slider, &GestureSlider::step);
    connect(field, &QSpinBox::editingFinished, slider, &GestureSlider::finish);
    connect(slider, &QSlider::valueChanged, field, [field](int value) {
        const QSignalBlocker quiet(field);
        field->setValue(value);
    });
    connect(slider, &GestureSlider::begun, this, [this, row, name] { beginRow(row, name); });
    connect(slider, &GestureSlider::moved, this, [this, row] {
        if (mAdjustment) mAdjustment->show(recolouring(row));
    });
    connect(slider, &GestureSlider::ended, this, [this] {
        if (mAdjustment) mAdjustment->commit(finish(), [this] { showValues(); });
        showValues();
    });
    connect(slider, &GestureSlider::cancelled, this, [this] {
        if (mAdjustment) mAdjustment->cancel();
        showValues();
    });
}

QWidget* RecolourPanel::makeButtons() {
    auto* part = new QWidget;
    auto* grid = partGrid(part);
    auto* hide =
        panelButton(tr("Hide"), tr("Take the selected patches out of sight; exports keep them"), "hide");
    auto* lock = panelButton(tr("Lock"), tr("Keep tools off the selected patches"), "lock");
    mCutOut = panelButton({}, tr("Make the selected patches transparent, in exports too"), "cutOut");
    auto* reset = panelButton(tr("Reset to fitted colours"),
                              tr("Bring back the colours that the selection was vectorized with"), "reset");
    fillGrid(grid, {hide, lock, mCutOut}, 3);
    grid->addWidget(reset, 1, 0, 1, 3);
    connect(hide, &QPushButton::clicked, this, [this] {
        if (mSession) say(setFlag(*mSession, PatchFlag::Hidden, true));
    });
    connect(lock, &QPushButton::clicked, this, [this] {
        if (mSession) say(setFlag(*mSession, PatchFlag::Locked, true));
    });
    connect(mCutOut, &QPushButton::clicked, this, [this] {
        if (mSession) say(setFlag(*mSession, PatchFlag::CutOut, !mAllCutOut));
    });
    connect(reset, &QPushButton::clicked, this, [this] {
        if (mSession) say(resetColours(*mSession));
    });
    return part;
}

void RecolourPanel::connectReplace() {
    connect(mMean, &ColourField::previewed, this, [this](glm::dvec3 colour) {
        if (mReplace || beginReplace()) mReplace->show(ReplaceColour{colour});
    });
    connect(mMean, &ColourField::chosen, this, [this](glm::dvec3 colour) {
        if (!mReplace) return replaceBy(colour);
        mReplace->show(ReplaceColour{colour});
        mReplace->commit(finish());
        mReplace.reset();
    });
    connect(mMean, &ColourField::abandoned, this, [this] { mReplace.reset(); });
}

void RecolourPanel::setSession(DocumentSession* session) {
    mReplace.reset();
    finishAdjustment();
    if (mSession) {
        mSession->disconnect(this);
        mSession->selection().disconnect(this);
    }
    mSession = session;
    if (session) {
        connect(session, &DocumentSession::changed, this, [this](const Change& change) {
            if (change.mesh() && !change.preview) refreshSoon();
        });
        // What a job was to end may have been stopped.
        connect(session, &DocumentSession::editingChanged, this, [this] { refreshSoon(); });
        connect(&session->selection(), &Selection::changed, this, [this] {
            finishAdjustment();
            refreshSoon();
        });
        connect(session, &QObject::destroyed, this, [this] { setSession(nullptr); });
    }
    refreshNow();
}

void RecolourPanel::setToolOptions(ToolManager& tools) {
    mTools = &tools;
    connect(&tools, &ToolManager::optionsChanged, this, &RecolourPanel::showOptions);
    showOptions();
}

FinishGesture RecolourPanel::finish() const {
    return mTools ? mTools->finish() : finishNow;
}

void RecolourPanel::setColours(glm::dvec3 colour, glm::dvec3 second) {
    if (!mTools) return;
    ToolOptions options = mTools->options();
    options.colour = colour;
    options.secondColour = second;
    mTools->setOptions(options);
}

void RecolourPanel::showOptions() {
    const ToolOptions& options = mTools->options();
    mColour->setColour(options.colour);
    mSecondColour->setColour(options.secondColour);
    const QSignalBlocker quiet(mFeather);
    mFeather->setValue(options.featherPx);
}

RecolourOptions RecolourPanel::recolourOptions() const {
    return {.featherPx = mTools ? mTools->options().featherPx : 0};
}

Recolouring RecolourPanel::recolouring(Row row) const {
    const auto value = [&](Row of) { return double(mSliders[of].slider->value()); };
    switch (row) {
        case Hue:
        case Chroma:
        case Lightness:
            return ColourShift{.hueDegrees = value(Hue),
                               .chromaFactor = 1 + value(Chroma) / 100,
                               .lightnessShift = value(Lightness) / 100};
        case Brightness:
        case Contrast:
            return Levels{.brightness = value(Brightness) / 100, .contrast = value(Contrast) / 100};
        case TintStrength:
        case RowCount:
            break;
    }
    return Tint{.colour = mColour->colour(), .strength = value(TintStrength) / 100};
}

void RecolourPanel::beginRow(Row row, const QString& text) {
    if (!mSession) return;
    if (!mAdjustment) mAdjustment.emplace(*mSession, mSession->selection().patches());
    const Recolouring kind = recolouring(row);
    if (!mAdjustment->begin(text, kind, recolourOptions())) {
        return say(refusedMeanwhile());
    }
    // Those of other kinds are neutral again: what they did is what this begins with.
    for (int other = 0; other < RowCount; ++other)
        if (recolouring(Row(other)).index() != kind.index()) setRow(Row(other), 0);
}

void RecolourPanel::finishAdjustment() {
    // A gesture that waits for further steps is what the person wants, of the selection that it began with.
    for (const Slider& row : mSliders) row.slider->finish();
    mAdjustment.reset();
}

void RecolourPanel::setRow(Row row, double value) {
    mSliders[row].slider->setValue(int(std::lround(value)));
}

void RecolourPanel::showValues() {
    const auto value = mAdjustment ? mAdjustment->value() : std::nullopt;
    const auto* shift = value ? std::get_if<ColourShift>(&*value) : nullptr;
    const auto* levels = value ? std::get_if<Levels>(&*value) : nullptr;
    const auto* tint = value ? std::get_if<Tint>(&*value) : nullptr;
    setRow(Hue, shift ? shift->hueDegrees : 0);
    setRow(Chroma, shift ? 100 * (shift->chromaFactor - 1) : 0);
    setRow(Lightness, shift ? 100 * shift->lightnessShift : 0);
    setRow(Brightness, levels ? 100 * levels->brightness : 0);
    setRow(Contrast, levels ? 100 * levels->contrast : 0);
    setRow(TintStrength, tint ? 100 * tint->strength : 0);
}

bool RecolourPanel::beginReplace() {
    if (!mSession || mSession->editing() || mSession->selection().patches().empty()) return false;
    mReplace.emplace(*mSession, tr("Replace Colour"), recolourOptions());
    return true;
}

void RecolourPanel::replaceBy(glm::dvec3 colour) {
    if (mSession)
        say(recolourSelection(*mSession, tr("Replace Colour"), ReplaceColour{colour}, recolourOptions()));
}

void RecolourPanel::say(const Result<void>& result) {
    if (!result) emit said(asSentence(result.error().message));
}

void RecolourPanel::refresh() {
    const bool hasPatches = mSession && !mSession->selection().patches().empty();
    mEdits->setEnabled(hasPatches);
    mHint->setVisible(!hasPatches);
    mHint->setText(!mSession              ? tr("Open a picture to recolour it.")
                   : !mSession->hasMesh() ? tr("Vectorize the photo; then its patches can be recoloured.")
                                          : tr("Select patches to recolour them."));
    mAllCutOut = false;
    if (hasPatches) {
        const PatchSet& set = mSession->selection().patches();
        const PatchMesh& mesh = mSession->document().mesh;
        mAllCutOut =
            std::all_of(set.begin(), set.end(), [&](PatchId p) { return mesh.attributes(p).cutOut; });
        if (!mSession->editing()) mMean->setColour(meanOf(mSession->colours(), set));
    }
    mCutOut->setText(mAllCutOut ? tr("Fill in") : tr("Cut out"));
    mCutOut->setAccessibleName(mCutOut->text());
    if (!mAdjustment || !mAdjustment->active()) showValues();
}

}  // namespace tessera
