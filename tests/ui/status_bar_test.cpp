// What the status bar says: of every stage that a job can be in, and of documents that have been edited.
#include "ui/status_bar.h"

#include <gtest/gtest.h>

#include <QDirIterator>
#include <QFile>
#include <QLabel>
#include <QMenu>
#include <QRegularExpression>

#include "app/edit_actions.h"
#include "core/vectorize/vectorize.h"
#include "tests/ui/main_window_fixture.h"

namespace tessera {
namespace {

// All literals in calls of beginStage below a folder.
QStringList stagesNamedIn(const QString& folder) {
    static const QRegularExpression kCall("beginStage\\(([^;]*);"), kLiteral("\"([^\"]+)\"");
    QStringList found;
    QDirIterator files(QString(TESSERA_SOURCE_DIR) + '/' + folder, {"*.cpp"}, QDir::Files,
                       QDirIterator::Subdirectories);
    while (files.hasNext()) {
        QFile file(files.next());
        if (file.fileName().contains("/cli_") || !file.open(QIODevice::ReadOnly)) continue;
        const QString text = QString::fromUtf8(file.readAll());
        for (auto call = kCall.globalMatch(text); call.hasNext();)
            for (auto literal = kLiteral.globalMatch(call.next().captured(1)); literal.hasNext();)
                found += literal.next().captured(1);
    }
    return found;
}

TEST(StageText, ThereAreWordsForEveryStage) {
    QStringList stages = stagesNamedIn("app") + stagesNamedIn("core");
    EXPECT_TRUE(stages.contains("measuring")) << "the scan sees nothing";
    for (const std::string& method : methodNames())
        for (const StageVariants& stage : stageTable(method)) stages += QString::fromStdString(stage.stage);
    for (const QString& stage : stages) EXPECT_FALSE(stageText(stage).isEmpty()) << stage.toStdString();
    EXPECT_TRUE(stageText("no such stage").isEmpty());
}

TEST_F(MainWindowTest, AnEditedDocumentSaysSoInPlaceOfItsMeanError) {
    openPhoto();
    vectorize();
    const auto says = [&](const QString& words) {
        for (auto* label : window->status().findChildren<QLabel*>())
            if (label->text().contains(words)) return true;
        return false;
    };
    EXPECT_TRUE(says("mean error"));
    session()->selection().setPatches({PatchId(0), PatchId(1)});
    ASSERT_TRUE(recolourSelection(*session(), "Replace Colour", ReplaceColour{{.1, .6, .2}}, {}));
    EXPECT_FALSE(says("mean error"));
    EXPECT_TRUE(says("edited"));
    session()->history().undo();
    EXPECT_TRUE(says("mean error"));
    EXPECT_FALSE(says("edited"));
}

TEST_F(MainWindowTest, TheZoomOpensAMenuOfSizes) {
    openPhoto();
    const double fitting = canvas().view().scale();
    auto* zoom = window->status().findChild<QPushButton*>("zoom");
    ASSERT_NE(zoom, nullptr);
    EXPECT_FALSE(zoom->toolTip().isEmpty());
    // A click on the one of these entries that has this text.
    const auto choose = [&](const QString& text) {
        QTimer::singleShot(100, window.get(), [&] {
            auto* menu = qobject_cast<QMenu*>(QApplication::activePopupWidget());
            ASSERT_NE(menu, nullptr);
            for (QAction* entry : menu->actions())
                if (entry->text().remove('&') == text)
                    return QTest::mouseClick(menu, Qt::LeftButton, {}, menu->actionGeometry(entry).center());
            menu->close();
            ADD_FAILURE() << "no " << text.toStdString();
        });
        QTest::mouseClick(zoom, Qt::LeftButton);
    };
    for (const auto& [text, scale] :
         {std::pair("100 %", 1.), std::pair("800 %", 8.), std::pair("25 %", .25)}) {
        choose(text);
        EXPECT_EQ(canvas().view().scale(), scale) << text;
    }
    choose("Fit in Window");
    EXPECT_EQ(canvas().view().scale(), fitting);
}

}  // namespace
}  // namespace tessera

int main(int argc, char** argv) {
    return tessera::runWindowTests(argc, argv);
}
