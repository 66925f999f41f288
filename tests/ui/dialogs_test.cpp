// The icons, the dialogs and the start page, through real events.
#include <gtest/gtest.h>

#include <QApplication>
#include <QBuffer>
#include <QComboBox>
#include <QDir>
#include <QDoubleSpinBox>
#include <QDropEvent>
#include <QFile>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QMimeData>
#include <QPainter>
#include <QPushButton>
#include <QRegularExpression>
#include <QSignalSpy>
#include <QSpinBox>
#include <QTabWidget>
#include <QTemporaryDir>
#include <QTest>
#include <QToolButton>
#include <QTreeWidget>
#include <map>

#include "core/document/codec.h"
#include "tests/support/random_documents.h"
#include "ui/action_table.h"
#include "ui/application.h"
#include "ui/dialogs/cheat_sheet.h"
#include "ui/dialogs/export_dialog.h"
#include "ui/dialogs/key_edit.h"
#include "ui/dialogs/preferences_dialog.h"
#include "ui/dialogs/recovery_dialog.h"
#include "ui/icons.h"
#include "ui/start_page.h"
#include "ui/thumbnail.h"

namespace tessera {
namespace {

constexpr int kWaitMs = 20'000;

template <class Widget>
Widget* child(const QWidget& parent, const char* name) {
    auto* widget = parent.findChild<Widget*>(name);
    EXPECT_NE(widget, nullptr) << name;
    return widget;
}

void show(QWidget& widget) {
    widget.show();
    widget.activateWindow();
    ASSERT_TRUE(QTest::qWaitForWindowActive(&widget));
}

void click(QWidget* widget) {
    QTest::mouseClick(widget, Qt::LeftButton);
}

// Types a number into a spin box as a person would.
void type(QWidget* field, const QString& text) {
    field->setFocus();
    QTest::keyClick(field, Qt::Key_A, Qt::ControlModifier);
    QTest::keyClicks(field, text);
    QTest::keyClick(field, Qt::Key_Tab);
}

// Pixels that are not fully transparent, and the sum of their opacity.
double ink(const QImage& image) {
    double sum = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) sum += image.pixelColor(x, y).alphaF();
    return sum;
}

QPalette testPalette() {
    QPalette palette;
    palette.setColor(QPalette::ButtonText, QColor(10, 200, 30));
    palette.setColor(QPalette::Disabled, QPalette::ButtonText, QColor(90, 90, 90));
    palette.setColor(QPalette::Highlight, QColor(30, 60, 250));
    palette.setColor(QPalette::HighlightedText, QColor(250, 250, 10));
    return palette;
}

QColor strongest(const QImage& image) {
    QColor best(0, 0, 0, 0);
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            if (image.pixelColor(x, y).alpha() > best.alpha()) best = image.pixelColor(x, y);
    best.setAlpha(255);
    return best;
}

// Icons.

TEST(IconsTest, AllDrawSomethingOfTheirOwnWithinTheGrid) {
    const QStringList names = iconNames();
    EXPECT_GE(names.size(), 50);
    std::map<QByteArray, QString> seen;
    for (const QString& name : names) {
        // With a margin of a pixel, in which nothing may be drawn.
        QPixmap pixmap(26, 26);
        pixmap.fill(Qt::transparent);
        QPainter painter(&pixmap);
        icon(name, testPalette()).paint(&painter, QRect(1, 1, 24, 24));
        painter.end();
        const QImage image = pixmap.toImage().convertToFormat(QImage::Format_ARGB32);
        EXPECT_GT(ink(image), 15) << name.toStdString();
        EXPECT_LT(ink(image), 400) << name.toStdString();
        EXPECT_DOUBLE_EQ(ink(image), ink(image.copy(1, 1, 24, 24))) << name.toStdString();
        const QByteArray bytes(reinterpret_cast<const char*>(image.constBits()), image.sizeInBytes());
        const auto [at, isNew] = seen.emplace(bytes, name);
        EXPECT_TRUE(isNew) << name.toStdString() << " looks like " << at->second.toStdString();
    }
}

TEST(IconsTest, FollowThePaletteAndTheState) {
    const QPalette palette = testPalette();
    const QIcon save = icon("save", palette);
    const auto colour = [&](QIcon::Mode mode, QIcon::State state) {
        return strongest(save.pixmap(QSize(96, 96), 1, mode, state).toImage());
    };
    EXPECT_EQ(colour(QIcon::Normal, QIcon::Off), palette.color(QPalette::ButtonText));
    EXPECT_EQ(colour(QIcon::Normal, QIcon::On), palette.color(QPalette::Highlight));
    EXPECT_EQ(colour(QIcon::Disabled, QIcon::Off), palette.color(QPalette::Disabled, QPalette::ButtonText));
    EXPECT_EQ(colour(QIcon::Selected, QIcon::On), palette.color(QPalette::HighlightedText));
}

TEST(IconsTest, AreAsSharpAtTwiceTheSize) {
    const QIcon save = icon("save", testPalette());
    const QPixmap large = save.pixmap(QSize(24, 24), 2);
    EXPECT_EQ(large.size(), QSize(48, 48));
    EXPECT_EQ(large.devicePixelRatio(), 2);
    // Drawn at 48 pixels, not enlarged from 24.
    EXPECT_EQ(large.toImage(), [&] {
        QImage image = save.pixmap(QSize(48, 48), 1).toImage();
        image.setDevicePixelRatio(2);
        return image;
    }());
}

// Names are strings: one that is misspelt shall be found here, not by whoever opens that menu.
TEST(IconsTest, EveryNameInTheSourcesExists) {
    const QRegularExpression call("\\bicon\\(\"([^\"]+)\"");
    const QStringList names = iconNames();
    int uses = 0;
    for (const char* folder : {"ui", "ui/dialogs", "ui/panels"}) {
        const QDir dir(QString(TESSERA_SOURCE_DIR) + '/' + folder);
        for (const QString& fileName : dir.entryList({"*.cpp"}, QDir::Files)) {
            QFile file(dir.filePath(fileName));
            ASSERT_TRUE(file.open(QIODevice::ReadOnly));
            auto matches = call.globalMatch(QString::fromUtf8(file.readAll()));
            while (matches.hasNext()) {
                const QString name = matches.next().captured(1);
                EXPECT_TRUE(names.contains(name)) << fileName.toStdString() << ": " << name.toStdString();
                ++uses;
            }
        }
    }
    EXPECT_GT(uses, 3);
}

TEST(IconsDeathTest, AnUnknownNameIsABug) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_DEATH(icon("no such icon", {}), "");
}

// Export.

constexpr QSize kPicture(300, 200);

TEST(ExportDialogTest, ScaleAndPixelsFollowEachOther) {
    Settings settings;
    settings.setBlob("export", {});
    ExportDialog dialog(kPicture, {}, settings);
    show(dialog);
    EXPECT_EQ(dialog.request().size, kPicture);
    type(child<QDoubleSpinBox>(dialog, "scale"), "250");
    EXPECT_EQ(dialog.request().size, QSize(750, 500));
    type(child<QSpinBox>(dialog, "width"), "600");
    EXPECT_EQ(dialog.request().size, QSize(600, 400));
    EXPECT_DOUBLE_EQ(dialog.request().scale, 2);
    type(child<QSpinBox>(dialog, "height"), "100");
    EXPECT_EQ(dialog.request().size, QSize(150, 100));
    EXPECT_DOUBLE_EQ(dialog.request().scale, .5);
    click(child<QToolButton>(dialog, "linked"));
    type(child<QSpinBox>(dialog, "height"), "333");
    EXPECT_EQ(dialog.request().size, QSize(150, 333));
    click(child<QToolButton>(dialog, "linked"));
    EXPECT_EQ(dialog.request().size, QSize(150, 100));
}

TEST(ExportDialogTest, FormatsOfferWhatTheyCanHold) {
    Settings settings;
    settings.setBlob("export", {});
    ExportDialog dialog(kPicture, {1, 2, 3}, settings);
    show(dialog);
    auto* format = child<QComboBox>(dialog, "format");
    auto* depth = child<QComboBox>(dialog, "depth");
    auto* background = child<QComboBox>(dialog, "background");
    auto* profile = child<QComboBox>(dialog, "profile");
    depth->setFocus();
    QTest::keyClick(depth, Qt::Key_Down);
    EXPECT_EQ(dialog.suffix(), "png");
    EXPECT_EQ(dialog.request().options.bitsPerChannel, 16);
    EXPECT_FALSE(dialog.request().options.background) << "transparency is kept";
    profile->setFocus();
    QTest::keyClick(profile, Qt::Key_Down);
    EXPECT_EQ(dialog.request().options.iccProfile, (std::vector<uint8_t>{1, 2, 3}));
    QTest::keyClick(profile, Qt::Key_Down);
    EXPECT_FALSE(dialog.request().options.embedProfile);
    EXPECT_TRUE(dialog.request().options.iccProfile.empty());
    background->setFocus();
    QTest::keyClick(background, Qt::Key_Down);
    EXPECT_EQ(dialog.request().options.background, (std::array<float, 3>{1, 1, 1}));
    QTest::keyClick(background, Qt::Key_Up);

    format->setFocus();
    QTest::keyClick(format, Qt::Key_Down);
    EXPECT_EQ(dialog.suffix(), "jpg");
    EXPECT_FALSE(depth->isEnabled());
    EXPECT_FALSE(background->isEnabled());
    EXPECT_TRUE(child<QSpinBox>(dialog, "quality")->isEnabled());
    EXPECT_EQ(dialog.request().options.bitsPerChannel, 8);
    EXPECT_TRUE(dialog.request().options.background) << "a JPEG has no transparency";
    QTest::keyClick(format, Qt::Key_End);
    EXPECT_EQ(dialog.suffix(), "exr");
    EXPECT_FALSE(profile->isEnabled());
    EXPECT_TRUE(background->isEnabled());
}

TEST(ExportDialogTest, SaysWhatIsHugeAndRefusesWhatIsTooLarge) {
    Settings settings;
    settings.setBlob("export", {});
    ExportDialog dialog(kPicture, {}, settings);
    show(dialog);
    auto* ok = dialog.findChild<QPushButton*>();
    for (QPushButton* button : dialog.findChildren<QPushButton*>())
        if (button->isDefault()) ok = button;
    const auto text = [&] { return child<QLabel>(dialog, "size")->text(); };
    EXPECT_TRUE(text().contains("300")) << text().toStdString();
    EXPECT_FALSE(text().contains("huge"));
    type(child<QSpinBox>(dialog, "width"), "12000");
    EXPECT_TRUE(text().contains("huge")) << text().toStdString();
    EXPECT_TRUE(ok->isEnabled());
    type(child<QSpinBox>(dialog, "width"), "40000");
    EXPECT_TRUE(text().contains("Too large")) << text().toStdString();
    EXPECT_FALSE(ok->isEnabled());
}

TEST(ExportDialogTest, BeginsWithWhatWasChosenLast) {
    Settings settings;
    settings.setBlob("export", {});
    {
        ExportDialog dialog(kPicture, {}, settings);
        show(dialog);
        auto* format = child<QComboBox>(dialog, "format");
        format->setFocus();
        QTest::keyClick(format, Qt::Key_Down);
        QTest::keyClick(format, Qt::Key_Down);
        type(child<QDoubleSpinBox>(dialog, "scale"), "320");
        auto* samples = child<QComboBox>(dialog, "samples");
        samples->setFocus();
        QTest::keyClick(samples, Qt::Key_End);
        QTest::keyClick(&dialog, Qt::Key_Return);
        ASSERT_EQ(dialog.result(), QDialog::Accepted);
    }
    EXPECT_EQ(ExportDialog(kPicture, {}, settings).suffix(), "tif");
    {
        ExportDialog dialog(kPicture, {}, settings);
        EXPECT_EQ(dialog.request().size, QSize(960, 640));
        EXPECT_EQ(dialog.request().samples, 16);
        dialog.reject();
    }
    settings.setBlob("export", "{\"format\": 12, \"scale\": \"x\", \"samples\": 7");
    ExportDialog dialog(kPicture, {}, settings);
    EXPECT_EQ(dialog.suffix(), "png");
    EXPECT_EQ(dialog.request().size, kPicture);
}

// Keys.

QList<KeyRow> keyRows() {
    const auto row = [](const char* name, const char* text, const char* menu, const char* key) {
        return KeyRow{name, text, menu, QKeySequence(key), QKeySequence(key), {}};
    };
    return {row("open", "Open…", "File", "Ctrl+O"),
            row("export", "Export Picture…", "File", "Ctrl+E"),
            row("exportAgain", "Export Again", "File", ""),
            row("undo", "Undo", "Edit", "Ctrl+Z"),
            row("toolSelect", "Select", "Tools", "V"),
            row("toolBlur", "Soften", "Tools", "S"),
            row("cheatSheet", "Keys and Gestures", "Help", "?")};
}

QKeySequence currentKey(const QList<KeyRow>& rows, const char* name) {
    for (const KeyRow& row : rows)
        if (row.name == name) return row.current;
    ADD_FAILURE() << name;
    return {};
}

QList<KeyRow> withPreset(QList<KeyRow> rows, KeyPreset preset) {
    const QList<QKeySequence> keys = presetKeys(preset, rows);
    for (int i = 0; i < rows.size(); ++i) rows[i].current = keys[i];
    return rows;
}

TEST(KeyPresets, APresetsKeyIsTakenFromWhoHasItByDefault) {
    const QList<KeyRow> rows = withPreset(keyRows(), KeyPreset::Inkscape);
    EXPECT_EQ(currentKey(rows, "toolSelect"), QKeySequence("S"));
    EXPECT_EQ(currentKey(rows, "toolBlur"), QKeySequence());
    EXPECT_EQ(currentKey(rows, "undo"), QKeySequence("Ctrl+Z"));
}

TEST(KeyPresets, AreFreeOfConflictsForTheWindowsActions) {
    QWidget window;
    const QList<KeyRow> rows = ActionTable(&window, Settings()).keyRows();
    for (const KeyPreset preset : {KeyPreset::Tessera, KeyPreset::Illustrator, KeyPreset::Inkscape}) {
        const QList<KeyRow> preset_rows = withPreset(rows, preset);
        for (const int i : conflictingRows(preset_rows))
            ADD_FAILURE() << presetName(preset).toStdString() << ": " << preset_rows[i].name.toStdString()
                          << " " << preset_rows[i].current.toString().toStdString();
    }
}

TEST(KeyPresets, AFurtherKeyGivesWay) {
    QList<KeyRow> rows = keyRows();
    rows[3].further = {QKeySequence("Alt+Backspace"), QKeySequence("Ctrl+Y")};
    EXPECT_EQ(
        keysInForce(rows, 3),
        (QList<QKeySequence>{QKeySequence("Ctrl+Z"), QKeySequence("Alt+Backspace"), QKeySequence("Ctrl+Y")}));
    rows[0].current = QKeySequence("Ctrl+Y");
    EXPECT_EQ(keysInForce(rows, 3),
              (QList<QKeySequence>{QKeySequence("Ctrl+Z"), QKeySequence("Alt+Backspace")}));
    rows[3].current = QKeySequence("U");
    EXPECT_EQ(keysInForce(rows, 3), QList<QKeySequence>{QKeySequence("U")});
    rows[3].current = {};
    EXPECT_TRUE(keysInForce(rows, 3).isEmpty());
}

TEST(KeyPresets, ConflictsAreFound) {
    QList<KeyRow> rows = keyRows();
    EXPECT_TRUE(conflictingRows(rows).isEmpty());
    rows[3].current = rows[0].current;
    EXPECT_EQ(conflictingRows(rows), (QSet<int>{0, 3}));
    rows[3].current = rows[0].current = {};
    EXPECT_TRUE(conflictingRows(rows).isEmpty());
}

class PreferencesTest : public ::testing::Test {
  protected:
    void SetUp() override {
        for (const KeyRow& row : keyRows()) settings.setKey(row.name, {});
        settings.setKeyPreset(KeyPreset::Tessera);
        settings.setTheme(Theme::Dark);
        dialog = std::make_unique<PreferencesDialog>(keyRows(), settings);
        dialog->findChild<QTabWidget*>()->setCurrentIndex(1);
        show(*dialog);
        tree = child<QTreeWidget>(*dialog, "keys");
        key = dialog->findChild<KeyEdit*>();
    }
    void TearDown() override {
        for (const KeyRow& row : keyRows()) settings.setKey(row.name, {});
        settings.setKeyPreset(KeyPreset::Tessera);
        settings.setTheme(Theme::Dark);
    }

    QTreeWidgetItem* item(const QString& text) {
        const auto found = tree->findItems(text, Qt::MatchExactly | Qt::MatchRecursive);
        EXPECT_EQ(found.size(), 1) << text.toStdString();
        return found.value(0);
    }
    void choose(const QString& text) {
        tree->scrollToItem(item(text));
        QTest::mouseClick(tree->viewport(), Qt::LeftButton, {}, tree->visualItemRect(item(text)).center());
    }
    QPushButton* ok() {
        for (QPushButton* button : dialog->findChildren<QPushButton*>())
            if (button->text() == "OK") return button;
        return nullptr;
    }

    Settings settings;
    std::unique_ptr<PreferencesDialog> dialog;
    QTreeWidget* tree = nullptr;
    KeyEdit* key = nullptr;
};

TEST_F(PreferencesTest, AKeyIsChangedByPressingIt) {
    choose("Undo");
    EXPECT_EQ(key->text(), "Ctrl+Z");
    key->setFocus();
    QTest::keyClick(key, Qt::Key_Backspace, Qt::AltModifier);
    EXPECT_EQ(currentKey(dialog->rows(), "undo"), QKeySequence("Alt+Backspace"));
    EXPECT_TRUE(ok()->isEnabled());
    EXPECT_FALSE(settings.key("undo")) << "nothing is written before OK";
    QSignalSpy applied(dialog.get(), &PreferencesDialog::applied);
    click(ok());
    EXPECT_EQ(applied.size(), 1);
    EXPECT_EQ(settings.key("undo"), QKeySequence("Alt+Backspace"));
    EXPECT_FALSE(settings.key("open")) << "only what was chosen is stored";
}

TEST_F(PreferencesTest, ShiftedCharactersAreTheCharacter) {
    choose("Undo");
    key->setFocus();
    QTest::keyPress(key, Qt::Key_Shift);
    QTest::sendKeyEvent(QTest::Click, key, Qt::Key_Exclam, QString("!"), Qt::ShiftModifier);
    EXPECT_EQ(currentKey(dialog->rows(), "undo"), QKeySequence("!"));
    QTest::sendKeyEvent(QTest::Click, key, Qt::Key_K, QString("K"), Qt::ShiftModifier | Qt::ControlModifier);
    EXPECT_EQ(currentKey(dialog->rows(), "undo"), QKeySequence("Ctrl+Shift+K"));
}

TEST_F(PreferencesTest, AConflictMustBeSettled) {
    choose("Undo");
    key->setFocus();
    QTest::keyClick(key, Qt::Key_E, Qt::ControlModifier);
    EXPECT_FALSE(ok()->isEnabled());
    EXPECT_TRUE(child<QLabel>(*dialog, "conflict")->text().contains("Export Picture…"));
    EXPECT_FALSE(item("Export Picture…")->icon(1).isNull());
    click(child<QPushButton>(*dialog, "take"));
    EXPECT_TRUE(ok()->isEnabled());
    EXPECT_TRUE(child<QLabel>(*dialog, "conflict")->text().isEmpty());
    EXPECT_EQ(currentKey(dialog->rows(), "undo"), QKeySequence("Ctrl+E"));
    EXPECT_TRUE(currentKey(dialog->rows(), "export").isEmpty());
    click(ok());
    ASSERT_TRUE(settings.key("export"));
    EXPECT_TRUE(settings.key("export")->isEmpty()) << "no key is a choice too";
}

TEST_F(PreferencesTest, OneKeyIsResetWithoutTheOthers) {
    for (const char* text : {"Undo", "Open…"}) {
        choose(text);
        click(child<QPushButton>(*dialog, "clear"));
    }
    EXPECT_TRUE(currentKey(dialog->rows(), "open").isEmpty());
    choose("Undo");
    click(child<QPushButton>(*dialog, "reset"));
    EXPECT_EQ(currentKey(dialog->rows(), "undo"), QKeySequence("Ctrl+Z"));
    EXPECT_TRUE(currentKey(dialog->rows(), "open").isEmpty());
}

TEST_F(PreferencesTest, SearchFindsActionsAndKeys) {
    QTest::keyClicks(child<QLineEdit>(*dialog, "search"), "export");
    EXPECT_FALSE(item("Export Picture…")->isHidden());
    EXPECT_TRUE(item("Open…")->isHidden());
    EXPECT_TRUE(item("Edit")->isHidden()) << "a menu without matches goes";
    child<QLineEdit>(*dialog, "search")->clear();
    QTest::keyClicks(child<QLineEdit>(*dialog, "search"), "ctrl+z");
    EXPECT_FALSE(item("Undo")->isHidden());
    EXPECT_TRUE(item("Export Picture…")->isHidden());
}

TEST_F(PreferencesTest, APresetChangesAllKeysAndIsRemembered) {
    auto* preset = child<QComboBox>(*dialog, "preset");
    preset->setFocus();
    QTest::keyClick(preset, Qt::Key_End);
    EXPECT_EQ(currentKey(dialog->rows(), "toolSelect"), QKeySequence("S"));
    EXPECT_TRUE(currentKey(dialog->rows(), "toolBlur").isEmpty());
    click(ok());
    EXPECT_EQ(settings.keyPreset(), KeyPreset::Inkscape);
    EXPECT_FALSE(settings.key("toolSelect")) << "the preset's own key is no choice of one's own";
}

TEST_F(PreferencesTest, TheRestIsWrittenOnOkAndNotOnCancel) {
    dialog->findChild<QTabWidget*>()->setCurrentIndex(0);
    settings.setAutosaveSeconds(120);
    settings.setThreads(0);
    type(child<QSpinBox>(*dialog, "autosave"), "0");
    EXPECT_EQ(child<QSpinBox>(*dialog, "autosave")->text(), "Never");
    type(child<QSpinBox>(*dialog, "threads"), "3");
    type(child<QSpinBox>(*dialog, "history"), "256");
    auto* theme = child<QComboBox>(*dialog, "theme");
    theme->setFocus();
    QTest::keyClick(theme, Qt::Key_Down);
    QTest::keyClick(dialog.get(), Qt::Key_Escape);
    EXPECT_EQ(settings.autosaveSeconds(), 120);
    EXPECT_EQ(settings.theme(), Theme::Dark);
    show(*dialog);
    click(ok());
    EXPECT_EQ(settings.autosaveSeconds(), 0);
    EXPECT_EQ(settings.threads(), 3);
    EXPECT_EQ(settings.historyMegabytes(), 256);
    EXPECT_EQ(settings.theme(), Theme::Light);
    settings.setAutosaveSeconds(120);
    settings.setThreads(0);
    settings.setHistoryMegabytes(512);
}

TEST(CheatSheetTest, ListsWhatHasAKeyAndClosesByItsOwn) {
    CheatSheet sheet(keyRows(), QKeySequence("?"));
    show(sheet);
    QStringList texts;
    for (const QLabel* label : sheet.findChildren<QLabel*>()) texts << label->text();
    EXPECT_TRUE(texts.contains("Undo"));
    EXPECT_TRUE(texts.contains("Ctrl+Z"));
    EXPECT_FALSE(texts.contains("Export Again")) << "it has no key";
    EXPECT_TRUE(texts.contains("Zoom at the cursor"));
    QTest::keyClick(&sheet, Qt::Key_Question);
    EXPECT_FALSE(sheet.isVisible());
    show(sheet);
    QTest::keyClick(&sheet, Qt::Key_Escape);
    EXPECT_FALSE(sheet.isVisible());
    show(sheet);
    QTest::mouseClick(&sheet, Qt::LeftButton, {}, {5, 5});
    EXPECT_FALSE(sheet.isVisible());
}

// Recovery.

std::vector<RecoveryInfo> lostDocuments() {
    const QDateTime time(QDate(2026, 3, 4), QTime(15, 6), Qt::UTC);
    return {{"/pictures/harbour.tessera", "/pictures/harbour.jpg", time},
            {"", "/pictures/still life.png", time.addSecs(-900)},
            {"", "", time.addDays(-1)}};
}

TEST(RecoveryDialogTest, RecoversWhatIsChosen) {
    RecoveryDialog dialog(lostDocuments());
    show(dialog);
    auto* list = child<QListWidget>(dialog, "documents");
    ASSERT_EQ(list->count(), 3);
    EXPECT_TRUE(list->item(0)->text().contains("harbour.tessera"));
    EXPECT_TRUE(list->item(1)->text().contains("still life"));
    EXPECT_EQ(dialog.chosen(), (std::vector<size_t>{0, 1, 2}));
    list->setFocus();
    list->setCurrentRow(1);
    QTest::keyClick(list, Qt::Key_Space);
    EXPECT_EQ(dialog.chosen(), (std::vector<size_t>{0, 2}));
    click(child<QPushButton>(dialog, "recover"));
    EXPECT_EQ(dialog.answer(), RecoveryDialog::Answer::Recover);
    EXPECT_FALSE(dialog.isVisible());
}

TEST(RecoveryDialogTest, DiscardsAtTheSecondClickOnly) {
    RecoveryDialog dialog(lostDocuments());
    show(dialog);
    auto* discard = child<QPushButton>(dialog, "discard");
    auto* list = child<QListWidget>(dialog, "documents");
    click(discard);
    EXPECT_TRUE(dialog.isVisible());
    EXPECT_TRUE(child<QLabel>(dialog, "warning")->isVisible());
    // Who then chooses others is asked once more.
    list->setFocus();
    list->setCurrentRow(0);
    QTest::keyClick(list, Qt::Key_Space);
    EXPECT_FALSE(child<QLabel>(dialog, "warning")->isVisible());
    click(discard);
    EXPECT_TRUE(dialog.isVisible());
    click(discard);
    EXPECT_FALSE(dialog.isVisible());
    EXPECT_EQ(dialog.answer(), RecoveryDialog::Answer::Discard);
    EXPECT_EQ(dialog.chosen(), (std::vector<size_t>{1, 2}));
}

TEST(RecoveryDialogTest, EscapeIsLater) {
    RecoveryDialog dialog(lostDocuments());
    show(dialog);
    click(child<QPushButton>(dialog, "discard"));
    QTest::keyClick(&dialog, Qt::Key_Escape);
    EXPECT_EQ(dialog.answer(), RecoveryDialog::Answer::Later);
}

// Thumbnails and the start page.

QImage painted(QSize size, QColor colour) {
    QImage image(size, QImage::Format_RGB32);
    image.fill(colour);
    return image;
}

class StartPageTest : public ::testing::Test {
  protected:
    QString path(const char* name) const { return folder.filePath(name); }
    QString photo(const char* name, QSize size, QColor colour) {
        EXPECT_TRUE(painted(size, colour).save(path(name)));
        return path(name);
    }
    // A document with a preview of one colour; none for an invalid one.
    QString document(const char* name, QColor preview) {
        Document document;
        document.mesh = testing::curvedMesh(100, 80, 6, 5, 3);
        if (preview.isValid()) {
            QByteArray png;
            QBuffer buffer(&png);
            EXPECT_TRUE(painted({200, 100}, preview).save(&buffer, "PNG"));
            document.previewPng = std::make_shared<const std::vector<uint8_t>>(png.begin(), png.end());
        }
        EXPECT_TRUE(saveDocument(document, path(name).toStdString()));
        return path(name);
    }

    QTemporaryDir folder;
};

TEST_F(StartPageTest, ThumbnailsOfPhotosAndDocuments) {
    const QSize bounds(60, 40);
    const QImage wide = thumbnailOf(photo("wide.png", {400, 100}, Qt::red), bounds);
    EXPECT_EQ(wide.size(), QSize(60, 15));
    EXPECT_EQ(wide.pixelColor(30, 7), QColor(Qt::red));
    EXPECT_EQ(thumbnailOf(photo("small.png", {20, 10}, Qt::red), bounds).size(), QSize(20, 10));
    const QImage preview = thumbnailOf(document("a.tessera", Qt::blue), bounds);
    EXPECT_EQ(preview.size(), QSize(60, 30));
    EXPECT_EQ(preview.pixelColor(30, 15), QColor(Qt::blue));
    EXPECT_TRUE(thumbnailOf(document("b.tessera", {}), bounds).isNull());
    EXPECT_TRUE(thumbnailOf(path("missing.png"), bounds).isNull());
    QFile damaged(path("a.tessera"));
    ASSERT_TRUE(damaged.open(QIODevice::ReadWrite));
    ASSERT_TRUE(damaged.resize(damaged.size() / 2));
    damaged.close();
    EXPECT_TRUE(thumbnailOf(path("a.tessera"), bounds).isNull());
}

TEST_F(StartPageTest, ButtonsAndCardsAsk) {
    StartPage page;
    page.resize(900, 640);
    page.setRecentFiles({photo("one.png", {300, 200}, Qt::green), document("two.tessera", Qt::blue)});
    show(page);
    ASSERT_TRUE(QTest::qWaitFor([&] { return page.settled(); }, kWaitMs));
    QSignalSpy open(&page, &StartPage::openRequested), dialog(&page, &StartPage::openDialogRequested),
        sample(&page, &StartPage::sampleRequested), paste(&page, &StartPage::pasteRequested),
        clear(&page, &StartPage::clearRecentRequested);
    click(child<QPushButton>(page, "open"));
    click(child<QPushButton>(page, "sample"));
    click(child<QPushButton>(page, "paste"));
    click(child<QPushButton>(page, "clearRecent"));
    EXPECT_EQ(dialog.size() + sample.size() + paste.size() + clear.size(), 4);
    EXPECT_TRUE(open.isEmpty());
    QAbstractButton* second = nullptr;
    for (auto* button : page.findChildren<QAbstractButton*>())
        if (button->accessibleName() == "two.tessera") second = button;
    ASSERT_NE(second, nullptr);
    EXPECT_EQ(second->grab().toImage().pixelColor(second->width() / 2, 50), QColor(Qt::blue));
    click(second);
    ASSERT_EQ(open.size(), 1);
    EXPECT_EQ(open.takeFirst()[0].toString(), path("two.tessera"));
    second->setFocus();
    QTest::keyClick(second, Qt::Key_Space);
    EXPECT_EQ(open.size(), 1);
    page.setRecentFiles({});
    EXPECT_FALSE(child<QPushButton>(page, "clearRecent")->isVisible());
}

TEST_F(StartPageTest, DroppedFilesAreOpened) {
    StartPage page;
    show(page);
    QSignalSpy open(&page, &StartPage::openRequested);
    QMimeData data;
    data.setUrls({QUrl::fromLocalFile(path("a.png")), QUrl::fromLocalFile(path("b.png"))});
    QDragEnterEvent enter({100, 100}, Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
    QApplication::sendEvent(&page, &enter);
    EXPECT_TRUE(enter.isAccepted());
    const QImage dragging = page.grab().toImage();
    QDropEvent drop({100, 100}, Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
    QApplication::sendEvent(&page, &drop);
    EXPECT_EQ(open.size(), 2);
    EXPECT_NE(page.grab().toImage(), dragging) << "it shows that it would take the file";
    QMimeData text;
    text.setText("no file");
    QDragEnterEvent other({100, 100}, Qt::CopyAction, &text, Qt::LeftButton, Qt::NoModifier);
    other.ignore();
    QApplication::sendEvent(&page, &other);
    EXPECT_FALSE(other.isAccepted());
}

// Files that are replaced while their thumbnails are being made change nothing and hold nothing up.
TEST_F(StartPageTest, ALaterListReplacesOneThatIsStillLoading) {
    QStringList files;
    for (int i = 0; i < 8; ++i)
        files << photo(qPrintable(QString("%1.png").arg(i)), {1500, 1000}, QColor::fromHsv(i * 40, 255, 200));
    StartPage page;
    show(page);
    for (int round = 0; round < 5; ++round) page.setRecentFiles(files.mid(round));
    page.setRecentFiles(files.mid(0, 2));
    ASSERT_TRUE(QTest::qWaitFor([&] { return page.settled(); }, kWaitMs));
    page.setRecentFiles(files);
    EXPECT_FALSE(page.settled());
}

TEST(SampleTest, IsAPictureThatCanBeOpened) {
    const QString sample = StartPage::sampleFile();
    ASSERT_FALSE(sample.isEmpty());
    EXPECT_EQ(QImage(sample).size(), QSize(1200, 900));
    EXPECT_EQ(StartPage::sampleFile(), sample);
}

}  // namespace
}  // namespace tessera

int main(int argc, char** argv) {
    ::testing::InitGoogleTest(&argc, argv);
    // The user's own settings and files are neither read nor changed.
    const QTemporaryDir home;
    qputenv("XDG_CONFIG_HOME", home.filePath("config").toUtf8());
    qputenv("XDG_CACHE_HOME", home.filePath("cache").toUtf8());
    QApplication application(argc, argv);
    tessera::setUpApplication(application);
    return RUN_ALL_TESTS();
}
