// What the dialogs for files propose, and what is said when a file or a copy is done.
#include <gtest/gtest.h>

#include <QFileDialog>
#include <QStandardPaths>

#include "tests/ui/main_window_fixture.h"
#include "ui/dialogs/export_dialog.h"

namespace tessera {
namespace {

class Files : public MainWindowTest {
  protected:
    // What the file dialog proposes, once `act` has it opened.
    QString proposed(ActionId act) {
        QString path;
        if (act == ActionId::Export)
            whenAsked<ExportDialog>([&](ExportDialog& dialog) {
                readProposal(path);
                QTest::keyClick(&dialog, Qt::Key_Return);
            });
        else
            readProposal(path);
        action(act)->trigger();
        return path;
    }
    bool says(const QString& words) {
        return QTest::qWaitFor([&] { return window->messages().text().contains(words); }, 2000);
    }

  private:
    void readProposal(QString& path) {
        whenAsked<QFileDialog>([&](QFileDialog& dialog) {
            path = dialog.selectedFiles().value(0);
            QTest::keyClick(&dialog, Qt::Key_Escape);
        });
    }
};

TEST_F(Files, AnExportIsNotProposedOverThePhoto) {
    openPhoto();
    vectorize();
    EXPECT_EQ(proposed(ActionId::Export), folder.filePath("disk-vector.png"));
}

TEST_F(Files, DialogsForTheSampleStartWhereThePersonLooks) {
    const QString cache = QStandardPaths::writableLocation(QStandardPaths::CacheLocation);
    ASSERT_TRUE(QDir().mkpath(cache));
    const QDir last(folder.filePath("last"));
    ASSERT_TRUE(last.mkpath("."));
    Settings().setFolder(last.path());
    photo = cache + "/sample.png";
    ASSERT_TRUE(disk(160, 120).save(photo));
    openPhoto();
    vectorize();
    EXPECT_EQ(proposed(ActionId::SaveAs), last.filePath("sample.tessera"));
    EXPECT_EQ(QFileInfo(proposed(ActionId::Export)).path(), last.path());
    EXPECT_EQ(Settings().folder(), last.path()) << "opening the sample has moved it to the cache";
}

TEST_F(Files, WhatIsDoneIsSaid) {
    openPhoto();
    vectorize();
    const QString path = folder.filePath("large.png");
    workspace().exportPicture({.path = path, .scale = 10, .options = {}});
    ASSERT_TRUE(idle());
    EXPECT_TRUE(says("Exported “large.png”, 1,600 × 1,200.")) << window->messages().text().toStdString();
    window->messages().clear();
    action(ActionId::ExportAgain)->trigger();
    ASSERT_TRUE(idle());
    EXPECT_TRUE(says("1,600 × 1,200")) << window->messages().text().toStdString();
    window->messages().clear();
    QTest::keyClick(&canvas(), Qt::Key_C, Qt::ControlModifier);
    ASSERT_TRUE(idle());
    EXPECT_TRUE(says("clipboard")) << window->messages().text().toStdString();
}

TEST_F(Files, WhatWasCancelledIsSaid) {
    openPhoto();
    vectorize();
    workspace().exportPicture({.path = folder.filePath("huge.png"), .scale = 60, .options = {}});
    ASSERT_TRUE(workspace().running(JobKind::Export));
    action(ActionId::Cancel)->trigger();
    ASSERT_TRUE(idle());
    EXPECT_TRUE(says("Cancelled: Exporting huge.png.")) << window->messages().text().toStdString();
}

}  // namespace
}  // namespace tessera

int main(int argc, char** argv) {
    return tessera::runWindowTests(argc, argv);
}
