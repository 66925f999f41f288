// Several documents, their jobs, and the pictures that come and go beside files.
#include "app/workspace.h"

#include <gtest/gtest.h>

#include <QSignalSpy>
#include <QTest>
#include <cmath>

#include "app/colour_adjustment.h"
#include "app/edit_session.h"
#include "app/element_edits.h"
#include "app/recolour_gesture.h"
#include "core/document/codec.h"
#include "core/image/image_io.h"
#include "tests/support/edits.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_meshes.h"

namespace tessera {
namespace {

constexpr int kWaitMs = 60'000;

QImage stripes(int width, int height) {
    QImage image(width, height, QImage::Format_RGB32);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            image.setPixel(x, y, x / 8 % 2 ? qRgb(200, 80, 40) : qRgb(20, 60, 90));
    return image;
}

class WorkspaceTest : public testing::TemporaryFolderTest {
  protected:
    WorkspaceTest() {
        QObject::connect(&workspace, &Workspace::said, [this](const Message& message) { said = message; });
    }
    QString path(const std::string& name) const { return QString::fromStdString(at(name)); }
    bool idle() {
        return QTest::qWaitFor([&] { return !workspace.currentJob(); }, kWaitMs);
    }
    // A document of a grid of one colour, in a file.
    QString documentFile(const std::string& name, int width = 40) {
        Document document;
        document.mesh = testing::gridMesh(width, 30, 4, 3);
        EXPECT_TRUE(saveDocument(document, at(name)).has_value());
        return path(name);
    }
    void open(const QString& file) {
        workspace.open(file);
        ASSERT_TRUE(idle());
    }
    void change() {
        const auto edit = [](PatchMesh& mesh) { return testing::paint(mesh, PatchId(3), .5f); };
        ASSERT_TRUE(applyEdit(*workspace.session(), "Paint", edit));
    }
    CloseQuestions answering(CloseAnswer answer, RunningAnswer aboutWork = RunningAnswer::Stop) {
        return {.unsaved =
                    [this, answer](DocumentSession&) {
                        ++asked;
                        return answer;
                    },
                .running =
                    [this, aboutWork](const QStringList& titles) {
                        askedAbout.append(titles);
                        return aboutWork;
                    }};
    }

    Workspace workspace;
    Message said;
    int asked = 0;           // about unsaved changes
    QStringList askedAbout;  // the work that would have been lost
};

TEST_F(WorkspaceTest, DocumentsAreOpenSideBySide) {
    const QString a = documentFile("a.tessera", 40), b = documentFile("b.tessera", 50);
    QSignalSpy added(&workspace, &Workspace::sessionAdded), current(&workspace, &Workspace::sessionChanged);
    open(a);
    open(b);
    ASSERT_EQ(workspace.sessions().size(), 2);
    EXPECT_EQ(workspace.session()->width(), 50);
    EXPECT_EQ(added.size(), 2);
    EXPECT_EQ(current.size(), 2);
    open(a);
    EXPECT_EQ(workspace.sessions().size(), 2) << "it was open already";
    EXPECT_EQ(workspace.session()->width(), 40);
    workspace.moveSession(0, 1);
    EXPECT_EQ(workspace.sessions()[1], workspace.session());
    workspace.open(path("c.tessera"));
    ASSERT_TRUE(idle());
    EXPECT_EQ(said.kind, Message::Kind::Error);
    EXPECT_EQ(workspace.sessions().size(), 2);
}

TEST_F(WorkspaceTest, TwoFilesOpenAtOnce) {
    workspace.open(documentFile("a.tessera"));
    workspace.open(documentFile("b.tessera"));
    workspace.open(path("b.tessera"));
    ASSERT_TRUE(idle());
    EXPECT_EQ(workspace.sessions().size(), 2);
}

TEST_F(WorkspaceTest, ClosingAsksWhereChangesWouldBeLost) {
    open(documentFile("a.tessera"));
    open(documentFile("b.tessera"));
    QPointer<DocumentSession> b = workspace.session();
    std::vector<bool> heard;
    const auto hear = [&](bool closed) { heard.push_back(closed); };
    change();
    workspace.close(b, answering({CloseAnswer::Kind::Cancel}), hear);
    EXPECT_EQ(workspace.sessions().size(), 2);
    workspace.close(b, answering({CloseAnswer::Kind::Save}), hear);
    EXPECT_EQ(workspace.sessions().size(), 2) << "not before it is written";
    ASSERT_TRUE(QTest::qWaitFor([&] { return heard.size() == 2; }, kWaitMs));
    EXPECT_EQ(heard, (std::vector{false, true}));
    EXPECT_EQ(asked, 2);
    ASSERT_TRUE(QTest::qWaitFor([&] { return !b; }, kWaitMs));
    EXPECT_EQ(workspace.session()->displayName(), "a.tessera");
    const auto written = loadDocument(at("b.tessera"));
    ASSERT_TRUE(written.has_value());
    EXPECT_NEAR(evaluateSpline(written->mesh.spline(PatchId(3)), 0, {.3, .3}), .5, .01);
    change();
    workspace.closeAll(answering({CloseAnswer::Kind::Discard}), hear);
    EXPECT_EQ(workspace.session(), nullptr);
    EXPECT_EQ(heard.back(), true);
}

TEST_F(WorkspaceTest, ClosingAllStopsAtTheFirstThatIsKept) {
    open(documentFile("a.tessera"));
    change();
    open(documentFile("b.tessera"));
    bool closed = true;
    workspace.closeAll(answering({CloseAnswer::Kind::Cancel}), [&](bool all) { closed = all; });
    EXPECT_FALSE(closed);
    EXPECT_EQ(workspace.sessions().size(), 1);
    EXPECT_EQ(workspace.session()->displayName(), "a.tessera");
}

TEST_F(WorkspaceTest, ClosingAllEndsWithASaveThatFails) {
    open(documentFile("a.tessera"));
    open(documentFile("b.tessera"));
    change();
    std::optional<bool> closed;
    const CloseAnswer elsewhere{.kind = CloseAnswer::Kind::Save, .path = path("no/such/folder/b.tessera")};
    workspace.closeAll(answering(elsewhere), [&](bool all) { closed = all; });
    ASSERT_TRUE(QTest::qWaitFor([&] { return closed.has_value(); }, kWaitMs)) << "nobody was told";
    EXPECT_FALSE(*closed);
    EXPECT_EQ(said.kind, Message::Kind::Error);
    EXPECT_EQ(workspace.sessions().size(), 2);
    EXPECT_TRUE(workspace.session()->modified());
    EXPECT_EQ(asked, 1);
}

TEST_F(WorkspaceTest, ClosingTwiceDuringASaveClosesOnce) {
    open(documentFile("a.tessera"));
    open(documentFile("b.tessera"));
    open(documentFile("c.tessera"));
    workspace.setCurrent(workspace.sessions()[1]);
    const QPointer<DocumentSession> b = workspace.session();
    change();
    workspace.save(path("b.tessera"), true);
    std::vector<int> heard;
    workspace.close(b, answering({}), [&](bool closed) { heard.push_back(closed ? 1 : -1); });
    EXPECT_EQ(heard, std::vector<int>());
    workspace.close(b, answering({}), [&](bool closed) { heard.push_back(closed ? 2 : -2); });
    ASSERT_TRUE(QTest::qWaitFor([&] { return !b; }, kWaitMs));
    EXPECT_EQ(heard, (std::vector{-1, 2}));
    EXPECT_EQ(asked, 0) << "it was saved";
    ASSERT_EQ(workspace.sessions().size(), 2);
    EXPECT_EQ(workspace.sessions()[0]->displayName(), "a.tessera");
    EXPECT_EQ(workspace.sessions()[1]->displayName(), "c.tessera");
}

TEST_F(WorkspaceTest, ClosingTwiceDuringASaveThatFailsAsksOnce) {
    open(documentFile("a.tessera"));
    change();
    workspace.save(path("no/such/folder/a.tessera"), true);
    std::vector<bool> heard;
    for (int i = 0; i < 2; ++i)
        workspace.closeAll(answering({CloseAnswer::Kind::Cancel}), [&](bool all) { heard.push_back(all); });
    ASSERT_TRUE(QTest::qWaitFor([&] { return heard.size() == 2; }, kWaitMs));
    EXPECT_EQ(asked, 1);
    EXPECT_EQ(heard, (std::vector{false, false}));
    EXPECT_EQ(workspace.sessions().size(), 1);
}

TEST_F(WorkspaceTest, EndingAsksAboutExportsThatRun) {
    open(documentFile("a.tessera"));
    const auto startExport = [&] {
        workspace.exportPicture({.path = path("a.png"), .scale = 60, .options = {}});
        ASSERT_TRUE(workspace.running(JobKind::Export));
    };
    startExport();
    std::optional<bool> closed;
    const auto hear = [&](bool all) { closed = all; };
    workspace.closeAll(answering({}, RunningAnswer::Cancel), hear);
    EXPECT_EQ(askedAbout, QStringList("Exporting a.png"));
    EXPECT_EQ(closed, false);
    EXPECT_EQ(workspace.sessions().size(), 1);
    ASSERT_TRUE(workspace.running(JobKind::Export));
    workspace.closeAll(answering({}, RunningAnswer::Stop), hear);
    EXPECT_EQ(closed, true);
    EXPECT_TRUE(workspace.sessions().isEmpty());
    ASSERT_TRUE(idle());
    EXPECT_FALSE(QFile::exists(path("a.png")));
    open(path("a.tessera"));
    startExport();
    closed.reset();
    workspace.closeAll(answering({}, RunningAnswer::Wait), hear);
    EXPECT_EQ(closed, std::nullopt);
    ASSERT_TRUE(QTest::qWaitFor([&] { return closed.has_value(); }, kWaitMs));
    EXPECT_TRUE(*closed);
    EXPECT_TRUE(QFile::exists(path("a.png"))) << said.text.toStdString();
    EXPECT_EQ(askedAbout.size(), 3);
}

TEST_F(WorkspaceTest, ClosingATabLeavesItsExportAlone) {
    open(documentFile("a.tessera"));
    workspace.exportPicture({.path = path("a.png"), .scale = 30, .options = {}});
    workspace.close(workspace.session(), answering({}));
    EXPECT_TRUE(workspace.sessions().isEmpty());
    EXPECT_EQ(askedAbout, QStringList());
    ASSERT_TRUE(idle());
    EXPECT_TRUE(QFile::exists(path("a.png")));
}

TEST_F(WorkspaceTest, ClosingAsksAboutAVectorizationThatRuns) {
    ASSERT_TRUE(stripes(160, 120).save(path("a.png")));
    open(path("a.png"));
    VectorizeSettings settings;
    settings.patches = 40;
    workspace.vectorize(settings);
    DocumentSession* const session = workspace.session();
    workspace.close(session, answering({}, RunningAnswer::Cancel));
    EXPECT_EQ(askedAbout, QStringList("Vectorizing a.png"));
    EXPECT_TRUE(workspace.running(JobKind::Vectorize));
    std::optional<bool> closed;
    workspace.close(session, answering({CloseAnswer::Kind::Cancel}, RunningAnswer::Wait),
                    [&](bool done) { closed = done; });
    ASSERT_TRUE(QTest::qWaitFor([&] { return closed.has_value(); }, kWaitMs));
    EXPECT_FALSE(*closed);
    EXPECT_TRUE(session->hasMesh());
    EXPECT_EQ(asked, 1) << "what was waited for is not saved";
}

TEST_F(WorkspaceTest, ASaveWaitsForTheEndOfAGesture) {
    open(documentFile("a.tessera"));
    const auto edit = [](PatchMesh& mesh) { return testing::paint(mesh, PatchId(3), .5f); };
    {
        EditSession gesture(*workspace.session(), "Paint");
        ASSERT_TRUE(gesture.preview(edit));
        workspace.save(path("other.tessera"), true);
        QTest::qWait(20);
        EXPECT_FALSE(workspace.running(JobKind::Save));
        gesture.commit();
    }
    ASSERT_TRUE(QTest::qWaitFor([&] { return !workspace.session()->modified(); }, kWaitMs));
    EXPECT_EQ(workspace.session()->displayName(), "other.tessera");
    ASSERT_TRUE(idle());
}

TEST_F(WorkspaceTest, AFileHoldsOneOfTheOpenDocuments) {
    const QString a = documentFile("a.tessera", 40);
    open(a);
    open(documentFile("b.tessera", 50));
    std::optional<bool> written;
    const auto hear = [&](bool done) { written = done; };
    ASSERT_TRUE(QFile::link(a, path("link.tessera")));
    for (const QString& file : {a, path("link.tessera"), path("./a.tessera")}) {
        written.reset();
        workspace.save(file, true, hear);
        EXPECT_EQ(written, false) << file.toStdString();
        EXPECT_TRUE(said.text.contains("another tab")) << said.text.toStdString();
    }
    ASSERT_TRUE(idle());
    EXPECT_EQ(loadDocument(at("a.tessera"))->mesh.width(), 40);
    // A file is taken from the moment when a save to it begins.
    workspace.save(path("c.tessera"), true);
    workspace.setCurrent(workspace.sessions()[0]);
    workspace.save(path("c.tessera"), true, hear);
    EXPECT_EQ(written, false);
    ASSERT_TRUE(idle());
    EXPECT_EQ(loadDocument(at("c.tessera"))->mesh.width(), 50);
}

TEST_F(WorkspaceTest, AnExportWithoutAFormatDoesNotBegin) {
    open(documentFile("a.tessera"));
    workspace.exportPicture({.path = path("photo.v2"), .options = {}});
    EXPECT_EQ(workspace.currentJob(), nullptr);
    EXPECT_EQ(said.kind, Message::Kind::Error);
    EXPECT_FALSE(workspace.canExportAgain());
}

TEST_F(WorkspaceTest, JobsBelongToTheirDocument) {
    ASSERT_TRUE(stripes(160, 120).save(path("a.png")));
    ASSERT_TRUE(stripes(600, 400).save(path("b.png")));
    open(path("a.png"));
    DocumentSession* const a = workspace.session();
    VectorizeSettings settings;
    settings.patches = 40;
    workspace.vectorize(settings);
    open(path("b.png"));
    DocumentSession* const b = workspace.session();
    ASSERT_TRUE(QTest::qWaitFor([&] { return a->hasMesh(); }, kWaitMs));
    EXPECT_FALSE(b->hasMesh());
    EXPECT_TRUE(workspace.canVectorize());
    workspace.vectorize(settings);
    EXPECT_TRUE(workspace.running(JobKind::Vectorize));
    workspace.setCurrent(a);
    EXPECT_FALSE(workspace.running(JobKind::Vectorize));
    EXPECT_TRUE(workspace.canVectorize());
    workspace.close(b, answering({CloseAnswer::Kind::Discard}));
    EXPECT_TRUE(idle()) << "it went with its document";
    EXPECT_TRUE(a->document().fitted == std::nullopt);
    EXPECT_TRUE(a->modified());
}

TEST_F(WorkspaceTest, APictureIsPastedAsADocument) {
    const QImage picture = stripes(64, 48);
    workspace.paste(picture);
    ASSERT_TRUE(idle());
    ASSERT_NE(workspace.session(), nullptr) << said.text.toStdString();
    EXPECT_EQ(workspace.session()->displayName(), "Pasted Picture.png");
    EXPECT_TRUE(workspace.canVectorize());
    EXPECT_EQ(toQImage(*workspace.session()->photo().image), picture);
    workspace.paste(QImage());
    ASSERT_TRUE(idle());
    EXPECT_EQ(said.kind, Message::Kind::Error);
    EXPECT_EQ(workspace.sessions().size(), 1);
}

TEST_F(WorkspaceTest, AMissingPhotoIsRelinked) {
    Document document;
    document.mesh = testing::gridMesh(64, 48, 4, 3);
    document.source.fileName = "gone.png";
    ASSERT_TRUE(stripes(64, 48).save(path("photo.png")));
    document.source.sha256 = readImage(at("photo.png")).value().source.sha256;
    ASSERT_TRUE(saveDocument(document, at("a.tessera")).has_value());
    open(path("a.tessera"));
    EXPECT_FALSE(workspace.canVectorize());
    ASSERT_TRUE(stripes(65, 48).save(path("wrong.png")));
    workspace.relinkPhoto(path("wrong.png"));
    ASSERT_TRUE(idle());
    EXPECT_EQ(said.kind, Message::Kind::Error);
    EXPECT_TRUE(said.text.contains("65 × 48")) << said.text.toStdString();
    workspace.relinkPhoto(path("a.tessera"));
    ASSERT_TRUE(idle());
    EXPECT_TRUE(said.text.contains("choose a picture"));
    QImage other = stripes(64, 48);
    other.setPixel(3, 3, qRgb(255, 255, 255));
    ASSERT_TRUE(other.save(path("other.png")));
    workspace.relinkPhoto(path("other.png"));
    ASSERT_TRUE(idle());
    EXPECT_FALSE(workspace.canVectorize());
    ASSERT_TRUE(said.action);
    said.action();
    EXPECT_TRUE(workspace.canVectorize());
    workspace.relinkPhoto(path("photo.png"));
    ASSERT_TRUE(idle());
    said.action();  // it is not the other one
    EXPECT_EQ(toQImage(*workspace.session()->photo().image), stripes(64, 48));
    DocumentSession& session = *workspace.session();
    EXPECT_TRUE(session.modified()) << "closed without a question, the document would not find it again";
    EXPECT_EQ(session.document().source.fileName, "photo.png");
    session.history().undo();
    EXPECT_EQ(session.document().source.fileName, "other.png");
    EXPECT_NE(toQImage(*session.photo().image), stripes(64, 48));
    session.history().undo();
    EXPECT_FALSE(workspace.canVectorize()) << "the photo was missing";
    EXPECT_FALSE(session.modified());
    session.history().redo();
    session.history().redo();
    EXPECT_EQ(toQImage(*session.photo().image), stripes(64, 48));
    workspace.save(path("a.tessera"), true);
    ASSERT_TRUE(idle());
    EXPECT_FALSE(session.modified());
    ASSERT_TRUE(loadDocument(at("a.tessera"))->embeddedSource) << "from now on it cannot get lost";
}

// Another picture than the one that was vectorized is the document's from then on.
TEST_F(WorkspaceTest, ARelinkedPhotoIsThereAfterTheNextOpening) {
    Document document;
    document.mesh = testing::gridMesh(64, 48, 4, 3);
    document.source.fileName = "gone.png";
    document.source.sha256 = std::string(64, '0');
    ASSERT_TRUE(saveDocument(document, at("a.tessera")).has_value());
    ASSERT_TRUE(stripes(64, 48).save(path("photo.png")));
    open(path("a.tessera"));
    workspace.relinkPhoto(path("photo.png"));
    ASSERT_TRUE(idle());
    ASSERT_TRUE(said.action);
    said.action();
    workspace.save(path("a.tessera"), false);
    ASSERT_TRUE(idle());
    EXPECT_FALSE(loadDocument(at("a.tessera"))->embeddedSource);
    workspace.close(workspace.session(), answering({}));
    EXPECT_EQ(asked, 0);
    open(path("a.tessera"));
    EXPECT_TRUE(workspace.canVectorize());
}

TEST_F(WorkspaceTest, APhotoThatIsNowhereElseStaysInTheDocument) {
    const QString file = path("a.tessera");
    const auto embeds = [&] { return loadDocument(at("a.tessera"))->embeddedSource != nullptr; };
    ASSERT_TRUE(stripes(64, 48).save(path("photo.png")));
    Document document;
    document.mesh = testing::gridMesh(64, 48, 4, 3);
    document.source = readImage(at("photo.png")).value().source;
    QFile photo(path("photo.png"));
    ASSERT_TRUE(photo.open(QIODevice::ReadOnly));
    const QByteArray bytes = photo.readAll();
    photo.close();
    document.embeddedSource = std::make_shared<const std::vector<uint8_t>>(bytes.begin(), bytes.end());
    ASSERT_TRUE(saveDocument(document, at("a.tessera")).has_value());
    const auto saveWithout = [&] {
        workspace.save(file, false);
        ASSERT_TRUE(idle());
    };
    ASSERT_TRUE(photo.remove());
    open(file);
    saveWithout();
    EXPECT_TRUE(embeds()) << "the file is gone";
    ASSERT_TRUE(stripes(65, 48).save(path("photo.png")));
    saveWithout();
    EXPECT_TRUE(embeds()) << "it is another picture";
    ASSERT_TRUE(photo.open(QIODevice::WriteOnly));
    photo.write(bytes);
    photo.close();
    saveWithout();
    EXPECT_FALSE(embeds());
}

TEST_F(WorkspaceTest, TheSelectionIsCopiedAsAPicture) {
    open(documentFile("a.tessera"));
    const auto copy = [&] {
        QImage copied;
        workspace.drawSelection([&](const QImage& picture) { copied = picture; });
        EXPECT_TRUE(copied.isNull()) << "the window does not wait for it";
        EXPECT_TRUE(idle());
        return copied;
    };
    const QImage whole = copy();
    EXPECT_EQ(whole.size(), QSize(40, 30));
    EXPECT_EQ(whole.pixel(3, 3), qRgb(0, 0, 0));
    change();
    // One triangle of the second cell.
    workspace.session()->selection().setPatches({PatchId(3)});
    const QImage picture = copy();
    EXPECT_EQ(picture.size(), QSize(10, 10));
    EXPECT_EQ(picture.pixelColor(1, 8).alpha(), 255);
    EXPECT_NEAR(picture.pixelColor(1, 8).red(), 128, 1);
    EXPECT_EQ(picture.pixelColor(8, 1).alpha(), 0);
    EXPECT_GT(picture.pixelColor(5, 5).alpha(), 0);
    EXPECT_LT(picture.pixelColor(5, 5).alpha(), 255) << "on the curve, in part";
}

// Where the slider stood when the drafts were built does not matter to what it shows.
TEST_F(WorkspaceTest, DraftsOfFewPatchesAreAsGoodAsThoseOnTheWayDownFromMany) {
    QImage picture(200, 150, QImage::Format_RGB32);
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x) {
            const bool inside = std::hypot(x % 50 - 25, y % 50 - 25) < 14 + x / 50;
            picture.setPixel(x, y, inside ? qRgb(220, 60 + y, 40) : qRgb(20, 60, 90 + x / 2));
        }
    ASSERT_TRUE(picture.save(path("disks.png")));
    open(path("disks.png"));
    std::vector<std::shared_ptr<const DraftLadder>> ladders;
    for (const int patches : {40, 1500}) {
        VectorizeSettings settings;
        settings.patches = patches;
        workspace.buildDrafts(settings, [&](auto ladder) { ladders.push_back(ladder); });
        ASSERT_TRUE(idle());
        ASSERT_NE(ladders.back(), nullptr) << said.text.toStdString();
    }
    EXPECT_EQ(ladders[0]->at(40).geometry(), ladders[1]->at(40).geometry());
    EXPECT_LE(ladders[0]->at(40).patchCount(), 40u);
}

class ManyElements : public WorkspaceTest {
  protected:
    void SetUp() override {
        WorkspaceTest::SetUp();
        Document document;
        document.mesh = testing::gridMesh(240, 160, 24, 16);
        ASSERT_TRUE(saveDocument(document, at("many.tessera")).has_value());
        open(path("many.tessera"));
        session = workspace.session();
        start = testing::bytesOf(session->document());
        session->selection().setPatches(allSelectable(session->document().mesh));
    }

    DocumentSession* session = nullptr;
    std::vector<uint8_t> start;
};

TEST_F(ManyElements, AreEditedByAJobAsOneStep) {
    const size_t patches = session->document().mesh.patchCount();
    workspace.edit(splitPatches(*session));
    ASSERT_NE(workspace.running(JobKind::Edit), nullptr);
    EXPECT_TRUE(session->editing()) << "nothing else may change the document meanwhile";
    EXPECT_EQ(session->document().mesh.patchCount(), patches);
    ASSERT_TRUE(idle());
    EXPECT_FALSE(session->editing());
    EXPECT_EQ(session->document().mesh.patchCount(), 3 * patches);
    EXPECT_EQ(session->selection().patches().size(), 3 * patches) << "the parts are selected";
    EXPECT_EQ(session->history().undoText(), "Split Patch");
    session->history().undo();
    EXPECT_EQ(testing::bytesOf(session->document()), start);
}

TEST_F(ManyElements, StayAsTheyWereWhereTheJobIsStopped) {
    workspace.edit(splitPatches(*session));
    workspace.cancel();
    ASSERT_TRUE(idle());
    EXPECT_FALSE(session->editing());
    EXPECT_EQ(session->history().count(), 0);
    EXPECT_EQ(testing::bytesOf(session->document()), start);
    EXPECT_TRUE(said.text.startsWith("Cancelled: ")) << said.text.toStdString();
}

TEST_F(ManyElements, DoNotKeepADocumentFromBeingClosed) {
    workspace.edit(splitPatches(*session));
    workspace.close(session, answering({.kind = CloseAnswer::Kind::Discard}, RunningAnswer::Stop));
    EXPECT_EQ(workspace.session(), nullptr);
    EXPECT_EQ(asked, 0) << "nothing has been changed";
    EXPECT_EQ(askedAbout, QStringList("Split Patch"));
    EXPECT_TRUE(idle());
}

TEST_F(ManyElements, GoOnWhereTheDocumentIsKept) {
    workspace.edit(splitPatches(*session));
    workspace.close(session, answering({}, RunningAnswer::Cancel));
    EXPECT_TRUE(workspace.running(JobKind::Edit));
    ASSERT_TRUE(idle());
    EXPECT_EQ(session->history().undoText(), "Split Patch");
}

TEST_F(ManyElements, AFewAreEditedAtOnceAndFailuresAreSaid) {
    session->selection().setPatches({PatchId(2)});
    workspace.edit(splitPatches(*session));
    EXPECT_EQ(workspace.currentJob(), nullptr);
    EXPECT_EQ(session->history().count(), 1);
    session->selection().clear();
    workspace.edit(splitPatches(*session));
    EXPECT_EQ(said.text, "Select patches first.");
}

// The last, exact frame of a gesture takes a second for tens of thousands of patches.
class ManyPatches : public WorkspaceTest {
  protected:
    void SetUp() override {
        WorkspaceTest::SetUp();
        Document document;
        document.mesh = testing::gridMesh(240, 160, 60, 40);
        document.mesh.forEachPatch(
            [&](PatchId p) { document.mesh.setSpline(p, constantSpline(std::array{.8f, .3f, .2f})); });
        ASSERT_TRUE(saveDocument(document, at("many.tessera")).has_value());
        open(path("many.tessera"));
        session = workspace.session();
        start = testing::bytesOf(session->document());
        session->selection().setPatches(allSelectable(session->document().mesh));
        exact = session->document().mesh;
        recolour(exact, session->selection().patches(), kGreen);
    }
    const FinishGesture finish = [this](std::shared_ptr<EditSession> gesture, ElementEdit edit,
                                        EditThen then) {
        workspace.finish(std::move(gesture), std::move(edit), std::move(then));
    };
    bool hasColoursOf(const PatchMesh& mesh) const {
        bool same = true;
        mesh.forEachPatch(
            [&](PatchId p) { same = same && mesh.spline(p) == session->document().mesh.spline(p); });
        return same;
    }

    const Recolouring kGreen = ReplaceColour{{.2, .8, .3}};
    const Recolouring kTurned = ColourShift{.hueDegrees = 120};
    DocumentSession* session = nullptr;
    std::vector<uint8_t> start;
    PatchMesh exact;
};

TEST_F(ManyPatches, AGestureIsEndedByAJobAndShowsWhatItShowedMeanwhile) {
    RecolourGesture gesture(*session, "Replace Colour");
    gesture.show(kGreen);
    const PatchMesh shown = session->document().mesh;
    gesture.commit(finish);
    ASSERT_NE(workspace.running(JobKind::Edit), nullptr);
    EXPECT_TRUE(session->editing());
    EXPECT_TRUE(hasColoursOf(shown));
    ASSERT_TRUE(idle());
    EXPECT_FALSE(session->editing());
    EXPECT_TRUE(hasColoursOf(exact));
    EXPECT_EQ(session->history().count(), 1);
    EXPECT_EQ(session->history().undoText(), "Replace Colour");
    session->history().undo();
    EXPECT_EQ(testing::bytesOf(session->document()), start);
    RecolourGesture other(*session, "Replace Colour");
    other.show(kGreen);
    other.commit(finish);
    workspace.cancel();
    ASSERT_TRUE(idle());
    EXPECT_FALSE(session->editing());
    EXPECT_EQ(testing::bytesOf(session->document()), start) << "it was stopped";
}

TEST_F(ManyPatches, SlidersStayWhereTheyAreUntilTheJobHasEnded) {
    ColourAdjustment adjustment(*session, session->selection().patches());
    ASSERT_TRUE(adjustment.begin("Hue", kTurned, {}));
    adjustment.show(kTurned);
    bool told = false;
    adjustment.commit(finish, [&] { told = true; });
    ASSERT_NE(workspace.running(JobKind::Edit), nullptr);
    EXPECT_FALSE(told);
    ASSERT_TRUE(adjustment.value());
    EXPECT_EQ(std::get<ColourShift>(*adjustment.value()).hueDegrees, 120);
    EXPECT_FALSE(adjustment.begin("Hue", kTurned, {})) << "one after the other";
    ASSERT_TRUE(idle());
    EXPECT_TRUE(told);
    EXPECT_EQ(std::get<ColourShift>(adjustment.value().value()).hueDegrees, 120);
    session->history().undo();
    EXPECT_EQ(std::get<ColourShift>(adjustment.value().value()).hueDegrees, 0);
}

TEST_F(ManyPatches, ASliderGoesBackWithTheJobThatWasToMakeItsStep) {
    ASSERT_TRUE(
        applyEdit(*session, "Paint", [](PatchMesh& m) { return testing::paint(m, PatchId(3), .5f); }));
    ColourAdjustment adjustment(*session, session->selection().patches());
    ASSERT_TRUE(adjustment.begin("Hue", kTurned, {}));
    adjustment.show(kTurned);
    adjustment.commit(finish);
    // Kept after all.
    workspace.close(session, answering({CloseAnswer::Kind::Cancel}, RunningAnswer::Stop));
    EXPECT_EQ(asked, 1);
    ASSERT_TRUE(idle());
    EXPECT_EQ(std::get<ColourShift>(adjustment.value().value()).hueDegrees, 0);
    // Its end does not wait for the job, nor the job for it.
    std::optional<ColourAdjustment> brief(std::in_place, *session, session->selection().patches());
    ASSERT_TRUE(brief->begin("Hue", kTurned, {}));
    brief->show(kTurned);
    brief->commit(finish);
    brief.reset();
    ASSERT_TRUE(idle());
    EXPECT_EQ(session->history().undoText(), "Hue");
}

}  // namespace
}  // namespace tessera
