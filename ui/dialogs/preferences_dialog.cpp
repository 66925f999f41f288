// See preferences_dialog.h.
#include "ui/dialogs/preferences_dialog.h"

#include <QComboBox>
#include <QDialogButtonBox>
#include <QFormLayout>
#include <QLabel>
#include <QPushButton>
#include <QSpinBox>
#include <QTabWidget>
#include <QThread>
#include <QVBoxLayout>

#include "ui/dialogs/dialog_parts.h"
#include "ui/dialogs/key_page.h"
#include "ui/widget_parts.h"

namespace tessera {

namespace {

constexpr int kAutosaveStepSeconds = 30;
constexpr int kHistoryStepMegabytes = 128;
constexpr int kFieldWidthPx = 220;
constexpr int kAboveHeadingPx = 10;

// Short enough for one line; what wraps takes more room in a form than it shows.
QLabel* remark(const QString& text) {
    QLabel* label = dimLabel(text);
    label->setWordWrap(false);
    return label;
}

void addHeading(QFormLayout* form, const QString& text) {
    QLabel* label = headingLabel(text);
    label->setContentsMargins(0, kAboveHeadingPx, 0, 0);
    form->addRow(label);
}

QSpinBox* numberField(const QString& name, int least, int most, int step, int value) {
    auto* field = new QSpinBox;
    field->setObjectName(name);
    field->setRange(least, most);
    field->setSingleStep(step);
    field->setValue(value);
    field->setMinimumWidth(kFieldWidthPx);
    return field;
}

}  // namespace

PreferencesDialog::PreferencesDialog(const QList<KeyRow>& rows, Settings& settings, QWidget* parent)
    : QDialog(parent), mSettings(settings), mKeys(new KeyPage(rows, settings.keyPreset())) {
    setWindowTitle(tr("Preferences"));
    auto* pages = new QTabWidget;
    pages->setDocumentMode(true);
    pages->addTab(makeGeneralPage(), tr("&General"));
    pages->addTab(mKeys, tr("&Keys"));
    makeButtons();
    QVBoxLayout* column = dialogColumn(this);
    column->addWidget(pages, 1);
    column->addWidget(mButtons);
    resize(640, 600);
}

const QList<KeyRow>& PreferencesDialog::rows() const {
    return mKeys->rows();
}

QWidget* PreferencesDialog::makeGeneralPage() {
    mTheme = new QComboBox;
    mTheme->setObjectName("theme");
    mTheme->addItem(tr("Dark"), int(Theme::Dark));
    mTheme->addItem(tr("Light"), int(Theme::Light));
    mTheme->addItem(tr("As the system"), int(Theme::System));
    mTheme->setCurrentIndex(mTheme->findData(int(mSettings.theme())));
    mAutosave = numberField("autosave", 0, Settings::kMaxAutosaveSeconds, kAutosaveStepSeconds,
                            mSettings.autosaveSeconds());
    mAutosave->setSuffix(tr(" s"));
    mAutosave->setSpecialValueText(tr("Never"));
    mHistory = numberField("history", Settings::kMinHistoryMegabytes, Settings::kMaxHistoryMegabytes,
                           kHistoryStepMegabytes, mSettings.historyMegabytes());
    mHistory->setSuffix(tr(" MB"));
    mThreads = numberField("threads", 0, Settings::kMaxThreads, 1, mSettings.threads());
    mThreads->setSpecialValueText(tr("One for each core (%1)").arg(QThread::idealThreadCount()));

    QFormLayout* form = dialogForm();
    addField(form, tr("&Theme"), mTheme);
    addHeading(form, tr("Safety"));
    addField(form, tr("&Autosave every"), mAutosave);
    form->addRow({}, remark(tr("After a crash, what was autosaved is offered when Tessera starts.")));
    addHeading(form, tr("Machine"));
    addField(form, tr("&Undo memory"), mHistory);
    form->addRow({}, remark(tr("For each document. The oldest steps are forgotten beyond it.")));
    addField(form, tr("T&hreads"), mThreads);
    form->addRow({}, remark(tr("For vectorizing and exporting. The result is the same with any number.")));
    auto* page = new QWidget;
    auto* column = new QVBoxLayout(page);
    column->setContentsMargins(16, 16, 16, 16);
    column->addLayout(form);
    column->addStretch(1);
    return page;
}

void PreferencesDialog::makeButtons() {
    mButtons = new QDialogButtonBox(QDialogButtonBox::Cancel | QDialogButtonBox::Apply);
    QPushButton* ok = addPrimaryButton(mButtons, tr("OK"));
    QPushButton* applyButton = mButtons->button(QDialogButtonBox::Apply);
    connect(ok, &QPushButton::clicked, this, [this] {
        apply();
        accept();
    });
    connect(applyButton, &QPushButton::clicked, this, &PreferencesDialog::apply);
    connect(mButtons, &QDialogButtonBox::rejected, this, &QDialog::reject);
    connect(mKeys, &KeyPage::changed, this, [this, ok, applyButton] {
        for (QPushButton* button : {ok, applyButton}) button->setEnabled(!mKeys->hasConflicts());
    });
}

void PreferencesDialog::apply() {
    mSettings.setTheme(Theme(mTheme->currentData().toInt()));
    mSettings.setAutosaveSeconds(mAutosave->value());
    mSettings.setHistoryMegabytes(mHistory->value());
    mSettings.setThreads(mThreads->value());
    storeKeys();
    emit applied();
}

void PreferencesDialog::storeKeys() {
    mSettings.setKeyPreset(mKeys->preset());
    for (int i = 0; i < rows().size(); ++i) {
        const QKeySequence& key = rows()[i].current;
        const bool own = key != mKeys->presetKeyOf(i);
        mSettings.setKey(rows()[i].name, own ? std::optional(key) : std::nullopt);
    }
}

}  // namespace tessera
