// What is remembered comes back, and a file that somebody has edited does no harm.
#include "app/settings.h"

#include <gtest/gtest.h>

#include <QSettings>
#include <QStandardPaths>
#include <QTemporaryDir>

namespace tessera {
namespace {

QSettings file() {
    return QSettings(QSettings::IniFormat, QSettings::UserScope, "tessera", "tessera");
}

struct SettingsTest : ::testing::Test {
    void SetUp() override { file().clear(); }
};

TEST_F(SettingsTest, DefaultsAndWhatWasSet) {
    EXPECT_EQ(Settings().theme(), Theme::Dark);
    EXPECT_EQ(Settings().keyPreset(), KeyPreset::Tessera);
    EXPECT_EQ(Settings().autosaveSeconds(), 120);
    EXPECT_EQ(Settings().threads(), 0);
    EXPECT_EQ(Settings().historyBytes(), size_t{512} << 20);
    for (const Theme theme : {Theme::System, Theme::Light, Theme::Dark}) {
        Settings().setTheme(theme);
        EXPECT_EQ(Settings().theme(), theme);
    }
    for (const KeyPreset preset : {KeyPreset::Inkscape, KeyPreset::Illustrator, KeyPreset::Tessera}) {
        Settings().setKeyPreset(preset);
        EXPECT_EQ(Settings().keyPreset(), preset);
    }
    Settings().setAutosaveSeconds(0);
    Settings().setThreads(3);
    Settings().setHistoryMegabytes(64);
    EXPECT_EQ(Settings().autosaveSeconds(), 0);
    EXPECT_EQ(Settings().threads(), 3);
    EXPECT_EQ(Settings().historyBytes(), size_t{64} << 20);
}

TEST_F(SettingsTest, DialogsNeverStartInTheCache) {
    const QTemporaryDir home;
    Settings().setFolder(home.path());
    EXPECT_EQ(Settings().folder(), home.path());
    const QString cache = QStandardPaths::writableLocation(QStandardPaths::CacheLocation);
    Settings().setFolder(cache);
    EXPECT_EQ(Settings().folder(), home.path());
    EXPECT_EQ(Settings().outsideCache(cache + "/sample.tessera"), home.filePath("sample.tessera"));
    EXPECT_EQ(Settings().outsideCache("/photos/cat.png"), "/photos/cat.png");
    EXPECT_EQ(Settings().outsideCache(cache + "s/cat.png"), cache + "s/cat.png");
}

TEST_F(SettingsTest, NonsenseIsIgnored) {
    QSettings settings = file();
    settings.setValue("window/theme", "pink");
    settings.setValue("window/keyPreset", 7);
    settings.setValue("files/autosaveSeconds", -5);
    settings.setValue("system/threads", "many");
    settings.setValue("system/historyMegabytes", 1e30);
    settings.setValue("tools/brushRadiusPx", "nan");
    settings.setValue("tools/colour", QStringList{"1", "x"});
    settings.sync();
    EXPECT_EQ(Settings().theme(), Theme::Dark);
    EXPECT_EQ(Settings().keyPreset(), KeyPreset::Tessera);
    EXPECT_EQ(Settings().autosaveSeconds(), 120);
    EXPECT_EQ(Settings().threads(), 0);
    EXPECT_EQ(Settings().historyMegabytes(), 512);
    EXPECT_EQ(Settings().toolOptions().brushRadiusPx, ToolOptions().brushRadiusPx);
    EXPECT_EQ(Settings().toolOptions().colour, ToolOptions().colour);
}

TEST_F(SettingsTest, KeysAreRemapped) {
    EXPECT_FALSE(Settings().key("save").has_value());
    Settings().setKey("save", QKeySequence("Ctrl+Alt+S"));
    Settings().setKey("undo", QKeySequence());
    EXPECT_EQ(Settings().key("save"), QKeySequence("Ctrl+Alt+S"));
    EXPECT_EQ(Settings().key("undo"), QKeySequence()) << "no key at all";
    Settings().setKey("save", {});
    EXPECT_FALSE(Settings().key("save").has_value());
    Settings().setKey("undo", {});
    EXPECT_FALSE(Settings().key("undo").has_value());
}

TEST_F(SettingsTest, ToolOptionsComeBackExactly) {
    ToolOptions options;
    options.colour = {.1, 1. / 3, 1};
    options.secondColour = {0, .25, .7};
    options.wand = {.tolerance = .123, .contiguous = false, .stopAtFeatures = true};
    options.gapPx = 12.5;
    options.allHandles = true;
    options.eyedropper = ColourSource::Original;
    options.brushRadiusPx = 7.5;
    options.brushHardness = .9;
    options.brushStrength = .4;
    options.brushKeepsShading = false;
    options.gradientStrength = .6;
    options.featherPx = 3;
    options.refitAfterReshape = false;
    options.wholeFeatures = false;
    Settings().setToolOptions(options);
    const ToolOptions read = Settings().toolOptions();
    EXPECT_EQ(read.colour, options.colour);
    EXPECT_EQ(read.secondColour, options.secondColour);
    EXPECT_EQ(read.wand.tolerance, options.wand.tolerance);
    EXPECT_EQ(read.wand.contiguous, options.wand.contiguous);
    EXPECT_EQ(read.wand.stopAtFeatures, options.wand.stopAtFeatures);
    EXPECT_EQ(read.gapPx, options.gapPx);
    EXPECT_EQ(read.allHandles, options.allHandles);
    EXPECT_EQ(read.eyedropper, options.eyedropper);
    EXPECT_EQ(read.brushRadiusPx, options.brushRadiusPx);
    EXPECT_EQ(read.brushHardness, options.brushHardness);
    EXPECT_EQ(read.brushStrength, options.brushStrength);
    EXPECT_EQ(read.brushKeepsShading, options.brushKeepsShading);
    EXPECT_EQ(read.gradientStrength, options.gradientStrength);
    EXPECT_EQ(read.featherPx, options.featherPx);
    EXPECT_EQ(read.refitAfterReshape, options.refitAfterReshape);
    EXPECT_EQ(read.wholeFeatures, options.wholeFeatures);
}

}  // namespace
}  // namespace tessera
