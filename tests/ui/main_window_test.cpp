// The window through real events: what a person does with mouse, wheel and keys, and what they then see.
#include <gtest/gtest.h>

#include <QComboBox>
#include <QDialogButtonBox>
#include <QDir>
#include <QDoubleSpinBox>
#include <QFile>
#include <QFileDialog>
#include <QLabel>
#include <QLineEdit>
#include <QSlider>
#include <QSpinBox>
#include <QTabBar>
#include <QToolButton>

#include "app/recovery_store.h"
#include "core/export/rasterize.h"
#include "core/vectorize/quality.h"
#include "tests/support/test_meshes.h"
#include "tests/ui/main_window_fixture.h"
#include "ui/opening_card.h"
#include "ui/panels/gesture_slider.h"
#include "ui/start_page.h"
#include "ui/status_bar.h"
#include "ui/theme.h"

namespace tessera {
namespace {

TEST_F(MainWindowTest, QualityChoosesThePresetAndTheMethodWithItsFields) {
    openPhoto();
    auto* quality = window->panel().findChild<QComboBox*>("quality");
    auto* features = window->panel().findChild<QSlider*>("features");
    auto* contrast = window->panel().findChild<QDoubleSpinBox*>("edgeContrast");
    ASSERT_TRUE(quality && features && contrast);
    EXPECT_TRUE(features->isVisible());
    EXPECT_FALSE(contrast->isVisible());
    const auto asked = [&] { return window->panel().settings(session()); };
    EXPECT_EQ(asked().method, "default");
    EXPECT_EQ(presetOf(asked()), "standard");
    EXPECT_EQ(featureShare(asked()), .5);
    quality->setFocus();
    QTest::keyClick(quality, Qt::Key_Up);
    EXPECT_EQ(presetOf(asked()), "draft");
    features->setFocus();
    QTest::keyClick(features, Qt::Key_Home);
    EXPECT_EQ(asked().featureBudget, 0);
    vectorize();
    EXPECT_EQ(presetOf(session()->document().settings), "draft");
    EXPECT_EQ(session()->document().settings.featureBudget, 0);
    QTest::keyClick(quality, Qt::Key_End);
    EXPECT_EQ(asked().method, "paper");
    EXPECT_TRUE(asked().stageVariants.empty());
    EXPECT_FALSE(features->isVisible());
    EXPECT_TRUE(contrast->isVisible());
    // What the next window begins with.
    QTest::keyClick(quality, Qt::Key_Home);
    EXPECT_EQ(Settings().quality(), "draft");
    EXPECT_EQ(Settings().features(), 0);
    QTest::keyClick(quality, Qt::Key_Down);
    features->setValue(50);
}

TEST_F(MainWindowTest, AFileThatIsBeingOpenedTakesThePlaceOfTheStartPage) {
    auto* start = window->findChild<StartPage*>();
    auto* card = window->findChild<OpeningCard*>();
    ASSERT_TRUE(start && card);
    EXPECT_TRUE(start->isVisible());
    EXPECT_FALSE(card->isVisible());
    const QString other = folder.filePath("other.png");
    ASSERT_TRUE(disk(60, 40).save(other));
    window->open(photo);
    EXPECT_FALSE(start->isVisible());
    ASSERT_TRUE(card->isVisible());
    EXPECT_EQ(card->findChild<QLabel*>()->text(), "Opening disk.png…");
    window->open(other);
    EXPECT_EQ(card->findChild<QLabel*>()->text(), "Opening other.png…") << "the one that Cancel stops";
    ASSERT_TRUE(idle());
    EXPECT_FALSE(card->isVisible());
    EXPECT_FALSE(start->isVisible());
    EXPECT_EQ(workspace().sessions().size(), 2);
}

TEST_F(MainWindowTest, OpeningThatIsStoppedOrFailsLeadsBackToTheStartPage) {
    auto* start = window->findChild<StartPage*>();
    auto* card = window->findChild<OpeningCard*>();
    const QString large = folder.filePath("large.png");
    ASSERT_TRUE(disk(4000, 3000).save(large));
    window->open(large);
    QTest::mouseClick(card->findChild<QPushButton*>("cancelOpening"), Qt::LeftButton);
    ASSERT_TRUE(idle());
    EXPECT_FALSE(card->isVisible());
    EXPECT_TRUE(start->isVisible());
    EXPECT_EQ(session(), nullptr);
    window->open(folder.filePath("missing.png"));
    EXPECT_TRUE(card->isVisible());
    ASSERT_TRUE(idle());
    EXPECT_FALSE(card->isVisible());
    EXPECT_TRUE(start->isVisible());
    EXPECT_FALSE(window->messages().text().isEmpty());
}

// A document that was made with numbers of its own keeps them until a preset is chosen.
TEST_F(MainWindowTest, ADocumentsOwnSettingsStay) {
    openPhoto();
    VectorizeSettings own;
    own.refineRounds = 2;
    own.patches = kPatches;
    auto* quality = window->panel().findChild<QComboBox*>("quality");
    window->panel().showSettings(own);
    EXPECT_EQ(quality->currentIndex(), -1);
    workspace().vectorize(own);
    ASSERT_TRUE(idle());
    EXPECT_EQ(window->panel().settings(session()), own);
    quality->setFocus();
    QTest::keyClick(quality, Qt::Key_End);
    EXPECT_EQ(window->panel().settings(session()).method, "paper");
    QTest::keyClick(quality, Qt::Key_Home);
    EXPECT_EQ(presetOf(window->panel().settings(session())), "draft");
    quality->setCurrentIndex(1);
    Settings().setQuality("standard");
}

// What the canvas shows while the slider goes through the drafts is no part of the document.
TEST_F(MainWindowTest, DraftsFollowTheSliderUntilOneIsApplied) {
    openPhoto();
    vectorize();
    auto* slider = window->panel().findChild<GestureSlider*>("amountSlider");
    auto* button = window->panel().findChild<QPushButton*>("vectorizeButton");
    ASSERT_TRUE(slider && button);
    QTest::qWait(100);
    ASSERT_TRUE(settled());
    const QImage document = grab();
    const uint64_t revision = session()->revision();
    const auto drag = [&](double share) {
        const QImage before = grab();
        const QPoint to(int(slider->xOf(int(share * slider->maximum()))), slider->height() / 2);
        QTest::mousePress(slider, Qt::LeftButton, {}, QPoint(int(slider->xOf(slider->value())), to.y()));
        QTest::mouseMove(slider, to);
        QTest::mouseRelease(slider, Qt::LeftButton, {}, to);
        ASSERT_TRUE(QTest::qWaitFor([&] { return canvas().settled() && grab() != before; }, kWaitMs / 10));
        EXPECT_EQ(button->text(), "Apply");
    };
    const auto says = [&](const QString& words) {
        for (auto* label : window->findChildren<QLabel*>())
            if (label->text().contains(words)) return true;
        return false;
    };
    EXPECT_TRUE(says("mean error"));
    EXPECT_TRUE(says("of 255"));
    drag(.9);
    EXPECT_TRUE(says("Draft: "));
    EXPECT_FALSE(says("mean error")) << "a figure of what is not on the canvas";
    EXPECT_FALSE(says("of 255"));
    const QImage fine = grab();
    EXPECT_GT(difference(fine, document), 0);
    drag(0);
    const QImage coarse = grab();
    EXPECT_GT(difference(coarse, fine), 0);
    EXPECT_LT(difference(coarse, document), 30) << "no picture of the disk";
    EXPECT_EQ(session()->revision(), revision);
    EXPECT_EQ(window->width(), 1000) << "the name of a job has widened the window";
    // Tools have nothing to work on, and say so.
    QTest::mouseClick(&canvas(), Qt::LeftButton, {}, canvas().rect().center());
    EXPECT_TRUE(session()->selection().empty());
    EXPECT_TRUE(window->messages().text().contains("draft"));
    QTest::keyClick(&canvas(), Qt::Key_Escape);
    EXPECT_TRUE(window->messages().text().isEmpty());
    QTest::qWait(50);
    ASSERT_TRUE(settled());
    EXPECT_EQ(button->text(), "Vectorize");
    EXPECT_FALSE(says("Draft: "));
    EXPECT_TRUE(says("mean error"));
    EXPECT_TRUE(says("of 255"));
    EXPECT_EQ(difference(grab(), document), 0);
    EXPECT_EQ(window->panel().settings(session()).patches, kPatches);
    drag(.5);
    QTest::mouseClick(button, Qt::LeftButton);
    ASSERT_TRUE(idle());
    EXPECT_EQ(button->text(), "Vectorize");
    EXPECT_NE(session()->revision(), revision);
    QTest::keyClick(&canvas(), Qt::Key_Z, Qt::ControlModifier);
    EXPECT_EQ(session()->revision(), revision);
}

// The ladder takes as long as a draft: once for a photo, however often one looks at others.
TEST_F(MainWindowTest, DraftsOutliveALookAtAnotherTab) {
    openPhoto();
    vectorize();
    auto* slider = window->panel().findChild<GestureSlider*>("amountSlider");
    auto* button = window->panel().findChild<QPushButton*>("vectorizeButton");
    int ladders = 0;
    const Job* last = nullptr;
    QObject::connect(&workspace(), &Workspace::jobChanged, window.get(), [&] {
        const Job* job = workspace().currentJob();
        if (job && job != last && job->kind() == JobKind::Drafts) ++ladders;
        last = job;
    });
    const auto drafting = [&] { return button->text() == "Apply"; };
    const auto drag = [&](double share) {
        const QPoint to(int(slider->xOf(int(share * slider->maximum()))), slider->height() / 2);
        QTest::mousePress(slider, Qt::LeftButton, {}, QPoint(int(slider->xOf(slider->value())), to.y()));
        QTest::mouseMove(slider, to);
        QTest::mouseRelease(slider, Qt::LeftButton, {}, to);
        return QTest::qWaitFor([&] { return drafting() && !workspace().currentJob(); }, kWaitMs);
    };
    ASSERT_TRUE(drag(.4));
    EXPECT_EQ(ladders, 1);
    const QString second = folder.filePath("second.png");
    ASSERT_TRUE(disk(90, 70).save(second));
    window->open(second);
    ASSERT_TRUE(idle());
    EXPECT_FALSE(drafting());
    ASSERT_TRUE(drag(.3));
    EXPECT_EQ(ladders, 2) << "another photo, other drafts";
    QTest::mouseClick(&window->tabs(), Qt::LeftButton, {}, window->tabs().tabRect(0).center());
    EXPECT_FALSE(drafting());
    ASSERT_TRUE(drag(.2));
    EXPECT_EQ(ladders, 2);
}

TEST_F(MainWindowTest, TheAmountCanBeADetailOrAnError) {
    openPhoto();
    auto* amount = window->panel().findChild<QComboBox*>("amount");
    auto* slider = window->panel().findChild<GestureSlider*>("amountSlider");
    auto* quality = window->panel().findChild<QComboBox*>("quality");
    ASSERT_TRUE(amount && slider && quality);
    amount->setFocus();
    QTest::keyClick(amount, Qt::Key_Down);
    window->panel().findChild<QSpinBox*>("detail")->setValue(100);
    EXPECT_EQ(window->panel().settings(session()).patches, patchesForDetail(1, 160, 120));
    EXPECT_EQ(slider->value(), slider->maximum());
    QTest::keyClick(amount, Qt::Key_Down);
    EXPECT_FALSE(slider->isVisible());
    window->panel().findChild<QDoubleSpinBox*>("meanError")->setValue(2);
    QTest::keyClick(&canvas(), Qt::Key_Return, Qt::ControlModifier);
    ASSERT_TRUE(idle());
    ASSERT_TRUE(session()->hasMesh()) << window->messages().text().toStdString();
    const Document& document = session()->document();
    EXPECT_EQ(document.report.stages.front().stage, "search");
    EXPECT_TRUE(std::abs(document.difference->mae - 2) < .2 || !document.report.shortfall.empty());
    // The paper's method can search for no error.
    quality->setFocus();
    QTest::keyClick(quality, Qt::Key_End);
    EXPECT_EQ(amount->currentIndex(), 0);
    EXPECT_FALSE(window->panel().meanError().has_value());
    Settings().setQuality("standard");
    Settings().setAmount("patches");
}

TEST_F(MainWindowTest, ShowsThePhotoPixelForPixelAt100Percent) {
    openPhoto();
    EXPECT_FALSE(session()->hasMesh());
    EXPECT_FALSE(session()->modified());
    QTest::keyClick(&canvas(), Qt::Key_1, Qt::ControlModifier);
    EXPECT_EQ(canvas().view().scale(), 1);
    const QImage shown = grab().copy(QRect(canvas().view().origin().toPoint(), QSize(160, 120)));
    EXPECT_EQ(difference(shown, QImage(photo)), 0);
}

TEST_F(MainWindowTest, PicturesAreInTheColoursOfTheScreen) {
    openPhoto();
    QTest::keyClick(&canvas(), Qt::Key_1, Qt::ControlModifier);
    const QRect area(canvas().view().origin().toPoint(), QSize(160, 120));
    const QImage plain = grab();
    canvas().setScreenColours(QColorSpace::DisplayP3);
    const QImage wide = grab();
    QImage expected = plain.copy(area);
    expected.applyColorTransform(
        QColorSpace(QColorSpace::SRgb).transformationToColorSpace(QColorSpace::DisplayP3));
    EXPECT_LT(difference(wide.copy(area), expected), .5);
    EXPECT_GT(difference(wide.copy(area), plain.copy(area)), 2);
    EXPECT_EQ(wide.pixelColor(2, 2), plain.pixelColor(2, 2)) << "the ground is no picture";
    canvas().setScreenColours(QColorSpace::SRgb);
    EXPECT_EQ(difference(grab(), plain), 0);
}

TEST_F(MainWindowTest, VectorizesInTheBackgroundAndUndoes) {
    openPhoto();
    window->panel().setPatches(kPatches);
    QTest::keyClick(&canvas(), Qt::Key_Return, Qt::ControlModifier);
    EXPECT_FALSE(session()->hasMesh()) << "vectorize() must return before the work is done";
    EXPECT_FALSE(window->status().jobText().isEmpty());
    ASSERT_TRUE(idle());
    EXPECT_TRUE(window->status().jobText().isEmpty());
    ASSERT_TRUE(session()->hasMesh());
    EXPECT_TRUE(session()->modified());
    EXPECT_TRUE(window->isWindowModified());
    EXPECT_TRUE(session()->document().difference.has_value());
    const size_t patches = session()->document().mesh.patchCount();
    QTest::keyClick(&canvas(), Qt::Key_Z, Qt::ControlModifier);
    EXPECT_FALSE(session()->hasMesh());
    EXPECT_FALSE(window->isWindowModified());
    QTest::keyClick(&canvas(), Qt::Key_Z, Qt::ControlModifier | Qt::ShiftModifier);
    EXPECT_EQ(session()->document().mesh.patchCount(), patches);
}

TEST_F(MainWindowTest, ShowsTheVectorImageAsTheRendererDrawsIt) {
    openPhoto();
    vectorize();
    QTest::keyClick(&canvas(), Qt::Key_1, Qt::ControlModifier);
    ASSERT_TRUE(settled());
    const PatchMesh& mesh = session()->document().mesh;
    const auto expected = rasterize(mesh, wholePicture(mesh, {1, 1}), {.samples = kPictureSamples});
    ASSERT_TRUE(expected.has_value());
    const QImage shown = grab().copy(QRect(canvas().view().origin().toPoint(), QSize(160, 120)));
    EXPECT_EQ(difference(shown, toQImage(*expected).convertToFormat(QImage::Format_RGB32)), 0);
    EXPECT_LT(difference(shown, QImage(photo)), 12) << "it does not look like the photo";
}

TEST_F(MainWindowTest, CtrlWheelZoomsAtTheCursor) {
    openPhoto();
    vectorize();
    const QPointF cursor(413, 287);
    const QPointF before = canvas().toImage(cursor);
    const double scale = canvas().view().scale();
    for (int i = 0; i < 9; ++i) wheel(cursor, 1, Qt::ControlModifier);
    EXPECT_GT(canvas().view().scale(), 4 * scale);
    const QPointF after = canvas().toImage(cursor);
    EXPECT_NEAR(after.x(), before.x(), 1e-6);
    EXPECT_NEAR(after.y(), before.y(), 1e-6);
    ASSERT_TRUE(settled());
    for (int i = 0; i < 80; ++i) wheel(cursor, 1, Qt::ControlModifier);
    EXPECT_EQ(canvas().view().scale(), 1000);
    ASSERT_TRUE(settled());
    for (int i = 0; i < 160; ++i) wheel(cursor, -1, Qt::ControlModifier);
    EXPECT_EQ(canvas().view().scale(), .01);
    QTest::keyClick(&canvas(), Qt::Key_0, Qt::ControlModifier);
    EXPECT_EQ(canvas().view().scale(), scale);
}

TEST_F(MainWindowTest, WheelScrollsAndDragsPan) {
    openPhoto();
    for (int i = 0; i < 12; ++i) wheel({400, 300}, 1, Qt::ControlModifier);
    QPointF origin = canvas().view().origin();
    wheel({400, 300}, -1, Qt::NoModifier);
    EXPECT_EQ(canvas().view().origin().x(), origin.x());
    EXPECT_LT(canvas().view().origin().y(), origin.y());
    origin = canvas().view().origin();
    QTest::mousePress(&canvas(), Qt::MiddleButton, {}, {300, 300});
    QTest::mouseMove(&canvas(), {330, 310});
    QTest::mouseRelease(&canvas(), Qt::MiddleButton, {}, {330, 310});
    EXPECT_EQ(canvas().view().origin(), origin + QPointF(30, 10));
    QTest::keyPress(&canvas(), Qt::Key_Space);
    QTest::mousePress(&canvas(), Qt::LeftButton, {}, {300, 300});
    QTest::mouseMove(&canvas(), {290, 280});
    QTest::mouseRelease(&canvas(), Qt::LeftButton, {}, {290, 280});
    QTest::keyRelease(&canvas(), Qt::Key_Space);
    EXPECT_EQ(canvas().view().origin(), origin + QPointF(20, -10));
}

TEST_F(MainWindowTest, HoldingOShowsTheOriginal) {
    openPhoto();
    QTest::keyClick(&canvas(), Qt::Key_1, Qt::ControlModifier);
    const QImage original = grab();
    vectorize();
    const QImage vector = grab();
    EXPECT_GT(difference(vector, original), 0);
    QTest::keyPress(&canvas(), Qt::Key_O);
    EXPECT_EQ(difference(grab(), original), 0);
    QTest::keyRelease(&canvas(), Qt::Key_O);
    EXPECT_EQ(difference(grab(), vector), 0);
}

TEST_F(MainWindowTest, OverlaysCanBeSeenAndHidden) {
    openPhoto();
    vectorize();
    for (int i = 0; i < 8; ++i) wheel({400, 300}, 1, Qt::ControlModifier);
    ASSERT_TRUE(settled());
    const QImage plain = grab();
    for (const auto& [key, id] :
         {std::pair{Qt::Key_1, ActionId::ShowFeatures}, std::pair{Qt::Key_2, ActionId::ShowEdges},
          std::pair{Qt::Key_3, ActionId::ShowControlPoints}}) {
        action(id)->setChecked(false);
        const QImage without = grab();
        EXPECT_EQ(difference(without, plain), 0);
        QTest::keyClick(&canvas(), key, Qt::AltModifier);
        EXPECT_TRUE(action(id)->isChecked());
        EXPECT_GT(difference(grab(), without), 0) << action(id)->objectName().toStdString();
        QTest::keyClick(&canvas(), key, Qt::AltModifier);
        EXPECT_FALSE(action(id)->isChecked());
    }
    EXPECT_EQ(difference(grab(), plain), 0);
}

TEST_F(MainWindowTest, SavesAndOpensAgain) {
    openPhoto();
    vectorize();
    const size_t patches = session()->document().mesh.patchCount();
    const QString path = folder.filePath("disk.tessera");
    window->saveTo(path);
    ASSERT_TRUE(idle());
    ASSERT_TRUE(QFile::exists(path)) << window->messages().text().toStdString();
    EXPECT_FALSE(session()->modified());
    EXPECT_TRUE(window->windowTitle().startsWith("disk.tessera"));
    const QImage before = grab();
    QTest::keyClick(&canvas(), Qt::Key_W, Qt::ControlModifier);
    EXPECT_EQ(session(), nullptr);
    window->open(path);
    ASSERT_TRUE(idle());
    EXPECT_EQ(session()->path(), path);
    EXPECT_FALSE(session()->modified());
    EXPECT_EQ(session()->document().mesh.patchCount(), patches);
    EXPECT_TRUE(session()->photo().image) << "the photo is kept in the file";
    ASSERT_TRUE(settled());
    EXPECT_LT(difference(grab(), before), .3) << "the file holds colours to a tenth of a level";
}

// Types a name into a file dialog.
void choose(QFileDialog& dialog, const QString& path) {
    auto* name = dialog.findChild<QLineEdit*>("fileNameEdit");
    ASSERT_NE(name, nullptr);
    name->setText(path);  // typing would open the list of completions
    QTest::mouseClick(dialog.findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Save), Qt::LeftButton);
}

// A file that only the name with its suffix leads to is asked about like any other.
TEST_F(MainWindowTest, NamesWithoutTheirSuffixReplaceNothingUnasked) {
    openPhoto();
    vectorize();
    const QString taken = folder.filePath("taken.tessera");
    {
        QFile file(taken);
        ASSERT_TRUE(file.open(QIODevice::WriteOnly));
        file.write("precious");
    }
    bool asked = false;
    whenAsked<QFileDialog>([&](QFileDialog& dialog) {
        whenAsked<QMessageBox>([&](QMessageBox& box) {
            asked = true;
            EXPECT_TRUE(box.text().contains("taken.tessera")) << box.text().toStdString();
            whenAsked<QFileDialog>([&](QFileDialog& again) { QTest::keyClick(&again, Qt::Key_Escape); });
            QTest::mouseClick(box.button(QMessageBox::No), Qt::LeftButton);
        });
        choose(dialog, folder.filePath("taken"));
    });
    action(ActionId::SaveAs)->trigger();
    EXPECT_TRUE(asked);
    ASSERT_TRUE(idle());
    EXPECT_EQ(QFileInfo(taken).size(), 8);
    EXPECT_TRUE(session()->modified());
    whenAsked<QFileDialog>([&](QFileDialog& dialog) { choose(dialog, folder.filePath("disk.v2")); });
    action(ActionId::SaveAs)->trigger();
    ASSERT_TRUE(idle());
    EXPECT_TRUE(QFile::exists(folder.filePath("disk.v2.tessera"))) << "v2 is no suffix of ours";
}

TEST_F(MainWindowTest, ExportAgainIsAboutTheDocumentInFront) {
    const QString second = folder.filePath("second.png"), out = folder.filePath("out.png");
    ASSERT_TRUE(disk(90, 70).save(second));
    openPhoto();
    vectorize();
    EXPECT_FALSE(action(ActionId::ExportAgain)->isEnabled());
    workspace().exportPicture({.path = out, .options = {}});
    ASSERT_TRUE(idle());
    EXPECT_TRUE(action(ActionId::ExportAgain)->isEnabled());
    const QImage first(out);
    window->open(second);
    ASSERT_TRUE(idle());
    vectorize();
    EXPECT_FALSE(action(ActionId::ExportAgain)->isEnabled()) << "it has never been exported";
    action(ActionId::ExportAgain)->trigger();
    ASSERT_TRUE(idle());
    EXPECT_EQ(QImage(out), first);
    QTest::mouseClick(&window->tabs(), Qt::LeftButton, {}, window->tabs().tabRect(0).center());
    ASSERT_TRUE(QFile::remove(out));
    action(ActionId::ExportAgain)->trigger();
    ASSERT_TRUE(idle());
    EXPECT_EQ(QImage(out), first);
}

TEST_F(MainWindowTest, AFailedSaveSaysSoAndKeepsTheChanges) {
    openPhoto();
    vectorize();
    window->saveTo(folder.filePath("no/such/folder/disk.tessera"));
    ASSERT_TRUE(idle());
    EXPECT_FALSE(window->messages().text().isEmpty());
    EXPECT_TRUE(window->messages().showsError());
    EXPECT_TRUE(session()->modified());
}

TEST_F(MainWindowTest, CancelLeavesTheDocumentUntouched) {
    // Large enough that the work cannot be over before the button is pressed.
    ASSERT_TRUE(disk(1200, 900).save(photo));
    openPhoto();
    const uint64_t revision = session()->revision();
    QTest::keyClick(&canvas(), Qt::Key_Return, Qt::ControlModifier);
    ASSERT_TRUE(workspace().running(JobKind::Vectorize));
    auto* cancel = window->findChild<QPushButton*>("cancelJob");
    ASSERT_TRUE(QTest::qWaitFor([&] { return cancel->isVisible(); }, kWaitMs));
    QTest::mouseClick(cancel, Qt::LeftButton);
    ASSERT_TRUE(idle());
    EXPECT_FALSE(session()->hasMesh());
    EXPECT_EQ(session()->revision(), revision);
    EXPECT_FALSE(session()->modified());
    EXPECT_EQ(session()->history().count(), 0);
    EXPECT_FALSE(window->messages().showsError()) << "what one asked for is no error";
    EXPECT_EQ(window->messages().text(), "Cancelled: Vectorizing disk.png.");
}

TEST_F(MainWindowTest, AMessageLeavesThePictureWhereItIs) {
    openPhoto();
    const QRect before = canvas().geometry();
    const QPointF origin = canvas().view().origin();
    window->messages().show({.kind = Message::Kind::Error, .text = "Something has failed."});
    QTest::qWait(50);
    EXPECT_TRUE(window->messages().isVisible());
    EXPECT_EQ(canvas().geometry(), before);
    EXPECT_EQ(canvas().view().origin(), origin);
    EXPECT_TRUE(window->messages().geometry().intersects(before));
}

// What a vectorization has found is thrown away by the person only.
TEST_F(MainWindowTest, AQuestionWaitsUntilItIsAnswered) {
    ASSERT_TRUE(disk(600, 450).save(photo));
    openPhoto();
    vectorize();
    const uint64_t first = session()->revision();
    QTest::keyClick(&canvas(), Qt::Key_Return, Qt::ControlModifier);
    ASSERT_TRUE(workspace().running(JobKind::Vectorize));
    QTest::keyClick(&canvas(), Qt::Key_Z, Qt::ControlModifier);
    ASSERT_NE(session()->revision(), first);
    ASSERT_TRUE(idle());
    ASSERT_FALSE(session()->hasMesh());
    MessageBar& bar = window->messages();
    const QString question = bar.text();
    EXPECT_TRUE(question.contains("disk.png")) << question.toStdString();
    bar.show({.text = "Something else."});
    EXPECT_EQ(bar.text(), "Something else.");
    auto* close = bar.findChild<QToolButton*>();
    QTest::mouseClick(close, Qt::LeftButton);
    EXPECT_EQ(bar.text(), question);
    const QString second = folder.filePath("second.png");
    ASSERT_TRUE(disk(90, 70).save(second));
    window->open(second);
    ASSERT_TRUE(idle());
    EXPECT_EQ(bar.text(), "") << "it is about the other one";
    vectorize();
    QTest::mouseClick(&window->tabs(), Qt::LeftButton, {}, window->tabs().tabRect(0).center());
    EXPECT_EQ(bar.text(), question);
    QTest::mouseClick(bar.findChild<QPushButton*>(), Qt::LeftButton);
    EXPECT_TRUE(session()->hasMesh());
    EXPECT_EQ(bar.text(), "");
}

TEST_F(MainWindowTest, QuestionsEndWithTheirDocument) {
    openPhoto();
    MessageBar& bar = window->messages();
    bar.show({.text = "First?", .actionText = "Yes", .action = [] {}, .keep = true, .about = session()});
    bar.show({.text = "Second?", .actionText = "Yes", .action = [] {}, .keep = true});
    EXPECT_EQ(bar.text(), "First?");
    QTest::keyClick(&canvas(), Qt::Key_W, Qt::ControlModifier);
    EXPECT_EQ(session(), nullptr);
    EXPECT_EQ(bar.text(), "Second?");
}

TEST_F(MainWindowTest, NewShowsTheStartPageInATabOfItsOwn) {
    auto* start = window->findChild<StartPage*>();
    openPhoto();
    DocumentSession* const first = session();
    QTest::keyClick(&canvas(), Qt::Key_N, Qt::ControlModifier);
    EXPECT_EQ(session(), nullptr);
    EXPECT_TRUE(start->isVisible());
    QTabBar& tabs = window->tabs();
    ASSERT_EQ(tabs.count(), 2);
    EXPECT_EQ(tabs.currentIndex(), 1);
    QTest::mouseClick(&tabs, Qt::LeftButton, {}, tabs.tabRect(0).center());
    EXPECT_EQ(session(), first);
    EXPECT_FALSE(start->isVisible());
    EXPECT_EQ(tabs.count(), 1);
    action(ActionId::New)->trigger();
    action(ActionId::Close)->trigger();
    EXPECT_EQ(session(), first) << "there was nothing else to close";
    action(ActionId::New)->trigger();
    const QString second = folder.filePath("second.png");
    ASSERT_TRUE(disk(90, 70).save(second));
    window->open(second);
    ASSERT_TRUE(idle());
    EXPECT_EQ(session()->width(), 90);
    ASSERT_EQ(tabs.count(), 2);
    EXPECT_EQ(tabs.tabText(1), "second.png");
    EXPECT_FALSE(start->isVisible());
}

TEST_F(MainWindowTest, OpensWhatIsDropped) {
    drop(photo);
    ASSERT_TRUE(idle());
    ASSERT_NE(session(), nullptr);
    EXPECT_EQ(session()->width(), 160);
    EXPECT_TRUE(window->messages().text().isEmpty());
}

TEST_F(MainWindowTest, DroppedGarbageIsAMessageAndNoMore) {
    openPhoto();
    DocumentSession* const before = session();
    const QString path = folder.filePath("garbage.png");
    QFile file(path);
    ASSERT_TRUE(file.open(QIODevice::WriteOnly));
    file.write(QByteArray(5000, '\x5a'));
    file.close();
    drop(path);
    ASSERT_TRUE(idle());
    EXPECT_TRUE(window->messages().text().contains("garbage.png")) << window->messages().text().toStdString();
    EXPECT_TRUE(window->messages().showsError());
    EXPECT_EQ(session(), before);
    EXPECT_EQ(QApplication::activeModalWidget(), nullptr);
}

TEST_F(MainWindowTest, AsksBeforeChangesAreLost) {
    openPhoto();
    vectorize();
    answer(QMessageBox::Cancel);
    EXPECT_FALSE(window->close());
    EXPECT_TRUE(window->isVisible());
    answer(QMessageBox::Discard);
    window->close();
    EXPECT_TRUE(QTest::qWaitFor([&] { return !window->isVisible(); }, kWaitMs));
}

TEST_F(MainWindowTest, AsksBeforeAVectorizationIsLost) {
    ASSERT_TRUE(disk(1200, 900).save(photo));
    openPhoto();
    QTest::keyClick(&canvas(), Qt::Key_Return, Qt::ControlModifier);
    answer(QMessageBox::Cancel);
    EXPECT_FALSE(window->close());
    EXPECT_TRUE(workspace().running(JobKind::Vectorize));
    QTimer::singleShot(100, window.get(), [] {
        auto* box = qobject_cast<QMessageBox*>(QApplication::activeModalWidget());
        ASSERT_NE(box, nullptr);
        EXPECT_TRUE(box->text().contains("Vectorizing disk.png")) << box->text().toStdString();
        QTest::mouseClick(box->findChild<QPushButton*>("stop"), Qt::LeftButton);
    });
    window->close();
    EXPECT_TRUE(QTest::qWaitFor([&] { return !window->isVisible(); }, kWaitMs));
}

TEST_F(MainWindowTest, StaysOpenWhereASaveAtTheEndFails) {
    openPhoto();
    vectorize();
    const QString path = folder.filePath("gone/disk.tessera");
    ASSERT_TRUE(QDir(folder.path()).mkdir("gone"));
    window->saveTo(path);
    ASSERT_TRUE(idle());
    vectorize();
    ASSERT_TRUE(QDir(folder.filePath("gone")).removeRecursively());
    answer(QMessageBox::Save);
    EXPECT_FALSE(window->close());
    ASSERT_TRUE(idle());
    EXPECT_TRUE(window->isVisible());
    EXPECT_TRUE(window->messages().showsError());
    EXPECT_TRUE(session()->modified());
    answer(QMessageBox::Discard);
    window->close();
    EXPECT_TRUE(QTest::qWaitFor([&] { return !window->isVisible(); }, kWaitMs));
}

TEST_F(MainWindowTest, VectorizesPhotosAsTheyAreOpenedAndNotAsTheyAreLookedAt) {
    openPhoto();
    const QString second = folder.filePath("second.png");
    ASSERT_TRUE(disk(90, 70).save(second));
    window->open(second);
    ASSERT_TRUE(idle());
    Settings().setVectorizeOnOpen(true);
    workspace().setCurrent(workspace().sessions().first());
    EXPECT_FALSE(workspace().running(JobKind::Vectorize));
    const QString third = folder.filePath("third.png");
    ASSERT_TRUE(disk(80, 60).save(third));
    window->open(third);
    ASSERT_TRUE(idle());
    Settings().setVectorizeOnOpen(false);
    ASSERT_EQ(workspace().sessions().size(), 3);
    EXPECT_TRUE(session()->hasMesh());
    EXPECT_FALSE(workspace().sessions().first()->hasMesh());
}

TEST_F(MainWindowTest, MakingAWindowSetsNoThemeAgain) {
    struct Counter : QObject {
        bool eventFilter(QObject* object, QEvent* event) override {
            changes += object == qApp && event->type() == QEvent::ApplicationPaletteChange ? 1 : 0;
            return false;
        }
        int changes = 0;
    } counter;
    qApp->installEventFilter(&counter);
    const MainWindow another;
    EXPECT_EQ(counter.changes, 0);
    applyTheme(*qApp, Settings().theme());
    EXPECT_GT(counter.changes, 0) << "the counter sees nothing";
}

TEST_F(MainWindowTest, ExportsAtTheChosenScale) {
    openPhoto();
    vectorize();
    const QString path = folder.filePath("large.png");
    workspace().exportPicture({.path = path, .scale = 2.5, .options = {}});
    ASSERT_TRUE(idle());
    EXPECT_EQ(QImage(path).size(), QSize(400, 300)) << window->messages().text().toStdString();
    EXPECT_TRUE(session()->modified()) << "an export is not a save";
}

TEST_F(MainWindowTest, ReadsTheColourUnderTheCursor) {
    openPhoto();
    std::optional<QPointF> at;
    QColor colour;
    const QObject scope;  // the window still moves after the variables are gone
    QObject::connect(&canvas(), &CanvasWidget::cursorMoved, &scope,
                     [&](std::optional<QPointF> image, QColor shown) {
                         at = image;
                         colour = shown;
                     });
    QTest::mouseMove(&canvas(), canvas().toWidget({80.5, 60.5}).toPoint());
    ASSERT_TRUE(at.has_value());
    EXPECT_EQ(colour, QColor(240, 180, 60));
}

TEST_F(MainWindowTest, TheProcessorDrawsOnWhereTheGraphicsCardFails) {
    struct Lost : FrameDrawer {
        void setMesh(const PatchMesh&) override {}
        void update(const PatchMesh&, std::span<const PatchId>) override {}
        Result<QImage> draw(const View&) override {
            return failure(ErrorCode::Internal, "the graphics card was reset");
        }
    };
    openPhoto();
    vectorize();
    const QImage before = grab();
    canvas().setDrawer(std::make_unique<Lost>());
    ASSERT_TRUE(settled());
    EXPECT_FALSE(canvas().drawnWithOpenGl());
    EXPECT_EQ(difference(grab(), before), 0);
    bool said = false;
    for (auto* label : window->status().findChildren<QLabel*>())
        said |= label->text() == "CPU" && label->toolTip().contains("the graphics card was reset");
    EXPECT_TRUE(said);
}

TEST_F(MainWindowTest, VectorizesAPhotograph) {
    const QString path = QString(TESSERA_TEST_IMAGES) + "/kodak/kodim23.png";
    if (!QFile::exists(path)) GTEST_SKIP() << "no photographs: " << path.toStdString() << " does not exist";
    window->open(path);
    window->vectorizeWhenOpen();
    ASSERT_TRUE(QTest::qWaitFor(
        [&] { return session() && session()->hasMesh() && !workspace().currentJob(); }, kWaitMs));
    ASSERT_TRUE(settled());
    EXPECT_GT(session()->document().mesh.patchCount(), 10);
    ASSERT_TRUE(session()->document().difference.has_value());
    EXPECT_LT(session()->document().difference->mae, 20);
}

TEST_F(MainWindowTest, AFileOpensAtOnceThoughThereIsSomethingToRecover) {
    {
        RecoveryStore crashed;
        Document document;
        document.mesh = testing::gridMesh(40, 30, 4, 3);
        ASSERT_TRUE(crashed.newSlot()->write(document, {"", photo, QDateTime::currentDateTimeUtc()}));
    }
    window->open(photo);
    window->mentionRecovery();
    EXPECT_EQ(window->messages().text(), "") << "not before the file is there";
    ASSERT_TRUE(idle());
    ASSERT_NE(session(), nullptr);
    EXPECT_TRUE(window->messages().text().contains("autosaved")) << window->messages().text().toStdString();
    QTimer::singleShot(300, window.get(), [] {
        auto* dialog = qobject_cast<QDialog*>(QApplication::activeModalWidget());
        ASSERT_NE(dialog, nullptr);
        QTest::mouseClick(dialog->findChild<QPushButton*>("recover"), Qt::LeftButton);
    });
    const auto buttons = window->messages().findChildren<QPushButton*>();
    ASSERT_EQ(buttons.size(), 1);
    QTest::mouseClick(buttons[0], Qt::LeftButton);
    ASSERT_TRUE(QTest::qWaitFor([&] { return workspace().sessions().size() == 2; }, kWaitMs));
    EXPECT_TRUE(session()->hasMesh());
}

}  // namespace
}  // namespace tessera

int main(int argc, char** argv) {
    return tessera::runWindowTests(argc, argv);
}
