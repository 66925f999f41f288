// See palette_panel.h.
#include "ui/panels/palette_panel.h"

#include <QAction>
#include <QFileDialog>
#include <QGridLayout>
#include <QLabel>
#include <QLocale>
#include <QPushButton>
#include <QSpinBox>
#include <QVBoxLayout>

#include "app/jobs/palette_job.h"
#include "app/message.h"
#include "app/settings.h"
#include "app/tools/tool_manager.h"
#include "ui/conversions.h"
#include "ui/dialogs/save_path.h"
#include "ui/panels/colour_popup.h"
#include "ui/panels/panel_parts.h"
#include "ui/panels/swatch_button.h"
#include "ui/widget_parts.h"

namespace tessera {

namespace {

constexpr int kRestMs = 150;
constexpr int kUsualColours = 8;
constexpr int kEntryColumns = 4, kSwatchColumns = 8;

void clear(QGridLayout* grid) {
    while (QLayoutItem* item = grid->takeAt(0)) {
        // Not at once: it may be the one whose click brought us here.
        if (QWidget* widget = item->widget()) {
            widget->hide();
            widget->setObjectName({});
            widget->deleteLater();
        }
        delete item;
    }
}

void addMenuEntry(QWidget* widget, const QString& text, const std::function<void()>& act) {
    auto* action = new QAction(text, widget);
    QObject::connect(action, &QAction::triggered, widget, act);
    widget->addAction(action);
    widget->setContextMenuPolicy(Qt::ActionsContextMenu);
}

}  // namespace

PalettePanel::PalettePanel(SwatchStore& store, QWidget* parent)
    : QWidget(parent), mStore(store), mPopup(new ColourPopup(this)) {
    setAccessibleName(tr("Palette"));
    mRest.setSingleShot(true);
    mRest.setInterval(kRestMs);
    connect(&mRest, &QTimer::timeout, this, &PalettePanel::find);
    auto* column = panelColumn(this);
    column->addWidget(makePalettePart());
    column->addWidget(separatorLine());
    column->addWidget(makeSwatchPart());
    column->addStretch(1);
    connect(mPopup, &ColourPopup::previewed, this, &PalettePanel::preview);
    connect(mPopup, &ColourPopup::chosen, this, [this](glm::dvec3 colour) { finishEdit(colour); });
    connect(mPopup, &ColourPopup::cancelled, this, [this] { finishEdit({}); });
    connect(&mStore, &SwatchStore::changed, this, &PalettePanel::showSwatches);
    showPalette();
    showSwatches();
}

PalettePanel::~PalettePanel() = default;

QWidget* PalettePanel::makePalettePart() {
    auto* part = new QWidget;
    auto* column = partColumn(part);
    mColours = new QSpinBox;
    mColours->setObjectName("colours");
    mColours->setAccessibleName(tr("How many dominant colours"));
    mColours->setToolTip(tr("How many colours to look for"));
    mColours->setRange(Palette::kLeast, Palette::kMost);
    mColours->setValue(kUsualColours);
    mColours->setFocusPolicy(Qt::StrongFocus);
    connect(mColours, &QSpinBox::valueChanged, this, &PalettePanel::findSoon);
    auto* head = new QHBoxLayout;
    head->addWidget(headingLabel(tr("Dominant colours")), 1);
    head->addWidget(mColours);
    column->addLayout(head);
    mEntries = new QGridLayout;
    mEntries->setSpacing(4);
    column->addLayout(mEntries);
    column->addWidget(mHint = dimLabel({}));
    mHint->setObjectName("hint");
    return part;
}

QWidget* PalettePanel::makeSwatchPart() {
    auto* part = new QWidget;
    auto* column = partColumn(part);
    column->addWidget(headingLabel(tr("Swatches")));
    mSwatches = new QGridLayout;
    mSwatches->setSpacing(2);
    mSwatches->setColumnStretch(kSwatchColumns, 1);
    column->addLayout(mSwatches);
    column->addWidget(
        mSwatchHint = dimLabel(tr("Colours that you keep, for all documents. Click one to work with it.")));
    auto* add = panelButton(tr("Keep"), tr("Keep the tools' colour as a swatch"), "keep");
    auto* import = panelButton(tr("Import…"), tr("Add the swatches of a .gpl file"), "import");
    auto* save = panelButton(tr("Export…"), tr("Write the swatches to a .gpl file"), "export");
    auto* row = new QGridLayout;
    row->setSpacing(6);
    fillGrid(row, {add, import, save}, 3);
    column->addLayout(row);
    connect(add, &QPushButton::clicked, this, [this] {
        if (mTools) mStore.add({{mTools->options().colour, {}}});
    });
    connect(import, &QPushButton::clicked, this, &PalettePanel::askImport);
    connect(save, &QPushButton::clicked, this, &PalettePanel::askExport);
    return part;
}

void PalettePanel::setSession(DocumentSession* session) {
    finishEdit({});
    if (mSession) mSession->disconnect(this);
    mSession = session;
    delete mJob;
    mRevision = 0;
    mPalette = {};
    if (session) {
        connect(session, &DocumentSession::changed, this, [this](const Change& change) {
            if (change.mesh() && !change.preview) findSoon();
        });
        connect(session, &DocumentSession::editingChanged, this, &PalettePanel::findSoon);
        connect(session, &QObject::destroyed, this, [this] { setSession(nullptr); });
    }
    showPalette();
    findSoon();
}

bool PalettePanel::current() const {
    return mSession && mRevision == mSession->revision() && mCount == mColours->value() &&
           !mSession->editing();
}

int PalettePanel::colourCount() const {
    return int(mPalette.entries.size());
}

void PalettePanel::showEvent(QShowEvent* event) {
    QWidget::showEvent(event);
    findSoon();
}

void PalettePanel::hideEvent(QHideEvent* event) {
    QWidget::hideEvent(event);
    if (std::exchange(mHighlighting, false)) emit highlighted({});
}

void PalettePanel::findSoon() {
    if (isVisible()) mRest.start();
}

void PalettePanel::find() {
    delete mJob;
    // An edit that is under way asks again at its end.
    if (!mSession || !isVisible() || mSession->editing() || current()) return;
    if (!mSession->hasMesh()) {
        mPalette = {};
        mRevision = 0;
        return showPalette();
    }
    const uint64_t revision = mSession->revision();
    const int count = mColours->value();
    std::vector<glm::dvec3> like;
    if (count == mCount)
        for (const PaletteEntry& entry : mPalette.entries) like.push_back(entry.colour);
    const auto show = [=, this](const Result<Palette>& found) {
        if (!found || !mSession || mSession->revision() != revision || mSession->editing()) return;
        mPalette = *found;
        mRevision = revision;
        mCount = count;
        showPalette();
    };
    mJob = startPaletteJob(this, mSession->document().mesh, count, std::move(like), show);
}

void PalettePanel::showPalette() {
    if (std::exchange(mHighlighting, false)) emit highlighted({});
    clear(mEntries);
    const int count = colourCount();
    for (int entry = 0; entry < count; ++entry)
        mEntries->addWidget(makeEntry(entry), entry / kEntryColumns, entry % kEntryColumns);
    for (int c = 0; c < kEntryColumns; ++c) mEntries->setColumnStretch(c, 1);
    mColours->setEnabled(mSession && mSession->hasMesh());
    mHint->setText(count > 0 ? tr("Click to select, double-click to change a colour everywhere.")
                             : tr("The main colours of a vectorized picture appear here."));
}

SwatchButton* PalettePanel::makeEntry(int entry) {
    const PaletteEntry& e = mPalette.entries[size_t(entry)];
    const QString hex = hexText(e.colour);
    const QLocale locale;
    const QString share = locale.toString(100 * e.weight, 'f', e.weight < .1 ? 1 : 0);
    auto* button = new SwatchButton;
    button->setObjectName(QString("entry%1").arg(entry));
    button->setColour(toQColor(e.colour));
    button->setCaption(locale.toString(qulonglong(e.patches)));
    button->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
    button->setAccessibleName(tr("Dominant colour %1, patches: %2").arg(hex).arg(e.patches));
    button->setToolTip(tr("%1, %2 % of the picture").arg(hex, share));
    connect(button, &SwatchButton::hovered, this, [this, entry](bool on) { highlight(on ? entry : -1); });
    connect(button, &SwatchButton::picked, this,
            [this, entry](Qt::KeyboardModifiers modifiers) { select(entry, modifiers); });
    connect(button, &SwatchButton::editRequested, this, [this, entry] { edit(entry); });
    const glm::dvec3 colour = e.colour;
    addMenuEntry(button, tr("Change Colour…"), [this, entry] { edit(entry); });
    addMenuEntry(button, tr("Select Patches"), [this, entry] { select(entry, {}); });
    addMenuEntry(button, tr("Use for Tools"), [this, colour] { useColour(colour); });
    addMenuEntry(button, tr("Keep as Swatch"), [this, colour] { mStore.add({{colour, {}}}); });
    return button;
}

void PalettePanel::highlight(int entry) {
    mHighlighting = entry >= 0 && mSession;
    emit highlighted(mHighlighting ? alive(mSession->document().mesh, patchesOf(mPalette, entry))
                                   : PatchSet());
}

void PalettePanel::select(int entry, Qt::KeyboardModifiers modifiers) {
    if (!mSession) return;
    const PatchMesh& mesh = mSession->document().mesh;
    PatchSet found = alive(mesh, patchesOf(mPalette, entry));
    std::erase_if(found, [&](PatchId p) { return !selectable(mesh, p); });
    const SelectMode mode = selectModeOf(
        {.shift = modifiers.testFlag(Qt::ShiftModifier), .alt = modifiers.testFlag(Qt::AltModifier)});
    mSession->selection().setPatches(combined(mSession->selection().patches(), found, mode));
}

void PalettePanel::edit(int entry) {
    if (!mSession) return;
    if (mSession->editing()) return emit said(asSentence(refusedMeanwhile().value().message));
    const auto* button = qobject_cast<SwatchButton*>(mEntries->itemAt(entry)->widget());
    mEntry = entry;
    highlight(-1);  // the colours shall be seen as they will be
    mPopup->setColour(mPalette.entries[size_t(entry)].colour);
    mPopup->open(button);
}

void PalettePanel::preview(glm::dvec3 colour) {
    if (!mSession) return;
    if (!mGesture) {
        if (mSession->editing()) return;
        PatchSet all;
        mSession->document().mesh.forEachPatch([&](PatchId p) { all.push_back(p); });
        mGesture.emplace(*mSession, tr("Change Palette Colour"), std::move(all));
    }
    mGesture->show(PaletteShift{mPalette, mEntry, colour});
}

void PalettePanel::finishEdit(std::optional<glm::dvec3> colour) {
    if (mGesture && colour) {
        mGesture->show(PaletteShift{mPalette, mEntry, *colour});
        mGesture->commit(mTools ? mTools->finish() : finishNow);
        mPalette.entries[size_t(mEntry)].colour = *colour;  // what is found next is like this
    }
    mGesture.reset();
}

void PalettePanel::useColour(glm::dvec3 colour) {
    if (!mTools) return;
    ToolOptions options = mTools->options();
    options.colour = colour;
    mTools->setOptions(options);
}

void PalettePanel::showSwatches() {
    clear(mSwatches);
    const std::vector<Swatch>& swatches = mStore.swatches();
    for (size_t i = 0; i < swatches.size(); ++i) {
        const Swatch& swatch = swatches[i];
        const QString hex = hexText(swatch.colour);
        const QString name = swatch.name.isEmpty() ? hex : tr("%1 (%2)").arg(swatch.name, hex);
        auto* button = new SwatchButton;
        button->setObjectName(QString("swatch%1").arg(i));
        button->setColour(toQColor(swatch.colour));
        button->setAccessibleName(tr("Swatch %1").arg(name));
        button->setToolTip(name);
        const glm::dvec3 colour = swatch.colour;
        connect(button, &SwatchButton::picked, this, [this, colour] { useColour(colour); });
        addMenuEntry(button, tr("Remove Swatch"), [this, i] { mStore.remove(i); });
        mSwatches->addWidget(button, int(i) / kSwatchColumns, int(i) % kSwatchColumns);
    }
    mSwatchHint->setVisible(swatches.empty());
    findChild<QPushButton*>("export")->setEnabled(!swatches.empty());
}

void PalettePanel::importFrom(const QString& path) {
    const Result<SwatchList> list = readGpl(path);
    if (!list) return emit said(asSentence(list.error().message));
    mStore.add(list->swatches);
}

void PalettePanel::exportTo(const QString& path) {
    const Result<void> written = writeGpl(path, {tr("Tessera"), mStore.swatches()});
    if (!written) emit said(asSentence(written.error().message));
}

void PalettePanel::askImport() {
    const QString path = QFileDialog::getOpenFileName(this, tr("Import Swatches"), Settings().folder(),
                                                      tr("GIMP palettes (*.gpl);;All files (*)"));
    if (!path.isEmpty()) importFrom(path);
}

void PalettePanel::askExport() {
    const QString path = askForSavePath(this, tr("Export Swatches"), Settings().folder() + "/swatches.gpl",
                                        tr("GIMP palettes (*.gpl)"));
    if (!path.isEmpty()) exportTo(path);
}

}  // namespace tessera
