// What survives a crash, and what does not come back.
#include "app/recovery_store.h"

#include <gtest/gtest.h>

#include <QDir>
#include <QSignalSpy>
#include <QTest>
#include <atomic>
#include <thread>

#include "app/autosave.h"
#include "app/edit_session.h"
#include "core/document/codec.h"
#include "tests/support/edits.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_meshes.h"

namespace tessera {
namespace {

constexpr int kWaitMs = 60'000;

Document painted(float value) {
    Document document;
    document.mesh = testing::gridMesh(40, 30, 4, 3);
    testing::paint(document.mesh, PatchId(3), value);
    return document;
}

class RecoveryStoreTest : public testing::TemporaryFolderTest {
  protected:
    QString root() const { return QString::fromStdString(at("recovery")); }
    qsizetype folders() const { return QDir(root()).entryList(QDir::Dirs | QDir::NoDotAndDotDot).size(); }
    static std::vector<uint8_t> bytesIn(const RecoverySlot& slot) {
        return testing::bytesOf(loadDocument(slot.dataPath().toStdString()).value());
    }

    const RecoveryInfo info{"/a/b.tessera", "/a/b.png", QDateTime(QDate(2026, 1, 2), QTime(3, 4), Qt::UTC)};
};

TEST_F(RecoveryStoreTest, TheNextInstanceFindsWhatWasLeft) {
    {
        RecoveryStore store(root());
        ASSERT_TRUE(store.usable());
        EXPECT_TRUE(store.leftBehind().empty());
        const auto slot = store.newSlot();
        EXPECT_FALSE(slot->info().has_value());
        for (const float value : {.1f, .2f, .3f}) ASSERT_TRUE(slot->write(painted(value), info));
        EXPECT_EQ(slot->info(), info);
        EXPECT_TRUE(RecoveryStore(root()).leftBehind().empty()) << "this one still runs";
    }
    RecoveryStore next(root());
    const auto left = next.leftBehind();
    ASSERT_EQ(left.size(), 1u);
    EXPECT_EQ(left[0]->info(), info);
    EXPECT_EQ(bytesIn(*left[0]), testing::bytesOf(painted(.3f)));
    EXPECT_TRUE(RecoveryStore(root()).leftBehind().empty()) << "it is the other's now";
    ASSERT_TRUE(left[0]->write(painted(.4f), info)) << "its new owner goes on with it";
    EXPECT_EQ(bytesIn(*left[0]), testing::bytesOf(painted(.4f)));
}

TEST_F(RecoveryStoreTest, WhatIsForgottenIsGone) {
    {
        RecoveryStore store(root());
        const auto slot = store.newSlot();
        ASSERT_TRUE(slot->write(painted(.1f), info));
        slot->forget();
        EXPECT_FALSE(slot->info().has_value());
        ASSERT_TRUE(slot->write(painted(.2f), info)) << "a worker that comes too late";
        EXPECT_FALSE(slot->info().has_value());
    }
    EXPECT_EQ(folders(), 0);
}

// The window forgets; it must not wait for a disk.
TEST_F(RecoveryStoreTest, ForgettingDoesNotWaitForAWriteUnderWay) {
    RecoveryStore store(root());
    Document large = painted(.1f);
    large.embeddedSource = std::make_shared<const std::vector<uint8_t>>(size_t{100} << 20, uint8_t{7});
    const QString folder = QDir(root()).entryInfoList(QDir::Dirs | QDir::NoDotAndDotDot).at(0).filePath();
    const auto files = [&] { return QDir(folder).entryList(QDir::Files | QDir::Hidden).size(); };
    bool early = false;
    // The writer may be faster than we once, and not always.
    for (int attempt = 0; attempt < 5 && !early; ++attempt) {
        const auto slot = store.newSlot();
        std::atomic<bool> done = false;
        std::thread writer([&] {
            EXPECT_TRUE(slot->write(large, info));
            done = true;
        });
        while (files() < 2 && !done) std::this_thread::yield();
        slot->forget();
        early = !done;
        writer.join();
        EXPECT_FALSE(slot->info().has_value());
        EXPECT_EQ(files(), 1) << "the lock alone";
    }
    EXPECT_TRUE(early);
}

TEST_F(RecoveryStoreTest, RubbishIsClearedAway) {
    QString folder;
    {
        RecoveryStore store(root());
        const auto slot = store.newSlot();
        ASSERT_TRUE(slot->write(painted(.1f), info));
        folder = QFileInfo(slot->dataPath()).path();
    }
    for (const char* name : {"x.json", "y-a.tessera", ".tessera-123.tmp", "evil.json"}) {
        QFile file(folder + '/' + name);
        ASSERT_TRUE(file.open(QIODevice::WriteOnly));
        if (QString(name) == "evil.json") file.write(R"({"data": "../../../etc/passwd"})");
    }
    {
        RecoveryStore store(root());
        EXPECT_EQ(store.leftBehind().size(), 1u);
        EXPECT_EQ(QDir(folder).entryList(QDir::Files | QDir::Hidden).size(), 3) << "lock, manifest, data";
        for (const auto& slot : RecoveryStore(root()).leftBehind()) ADD_FAILURE() << slot->id().toStdString();
    }
    RecoveryStore store(root());
    const auto left = store.leftBehind();
    ASSERT_EQ(left.size(), 1u);
    left[0]->forget();
}

TEST_F(RecoveryStoreTest, WithoutAFolderItDoesNothing) {
    QFile file(root());
    ASSERT_TRUE(file.open(QIODevice::WriteOnly)) << "a file where the folder should be";
    RecoveryStore store(root());
    EXPECT_FALSE(store.usable());
    EXPECT_EQ(store.newSlot(), nullptr);
    Workspace workspace;
    Autosave autosave(workspace, store);
    autosave.saveNow();
}

class AutosaveTest : public RecoveryStoreTest {
  protected:
    void SetUp() override {
        RecoveryStoreTest::SetUp();
        Document document = painted(.1f);
        ASSERT_TRUE(saveDocument(document, at("a.tessera")).has_value());
        workspace = std::make_unique<Workspace>();
        store = std::make_unique<RecoveryStore>(root());
        autosave = std::make_unique<Autosave>(*workspace, *store);
    }
    void TearDown() override {
        autosave.reset();
        workspace.reset();
        store.reset();
        RecoveryStoreTest::TearDown();
    }
    bool idle() {
        return QTest::qWaitFor([&] { return !workspace->currentJob() && !autosave->writing(); }, kWaitMs);
    }
    QString file() const { return QString::fromStdString(at("a.tessera")); }
    void openAndPaint(float value) {
        workspace->open(file());
        ASSERT_TRUE(idle());
        paint(value);
    }
    void paint(float value) {
        const auto edit = [value](PatchMesh& mesh) { return testing::paint(mesh, PatchId(3), value); };
        ASSERT_TRUE(applyEdit(*workspace->session(), "Paint", edit));
    }
    static CloseQuestions discarding() {
        return {[](auto&) { return CloseAnswer{CloseAnswer::Kind::Discard}; },
                [](auto&) { return RunningAnswer::Stop; }};
    }
    // Ends this instance as a crash would, as far as the folder is concerned, and begins another.
    std::vector<std::shared_ptr<RecoverySlot>> crash() {
        autosave.reset();
        workspace = std::make_unique<Workspace>();
        store = std::make_unique<RecoveryStore>(root());
        autosave = std::make_unique<Autosave>(*workspace, *store);
        return store->leftBehind();
    }

    std::unique_ptr<Workspace> workspace;
    std::unique_ptr<RecoveryStore> store;
    std::unique_ptr<Autosave> autosave;
};

TEST_F(AutosaveTest, AModifiedDocumentIsRecovered) {
    openAndPaint(.5f);
    autosave->saveNow();
    ASSERT_TRUE(idle());
    paint(.6f);
    const auto bytes = testing::bytesOf(workspace->session()->document());
    autosave->saveNow();
    ASSERT_TRUE(idle());
    const auto left = crash();
    ASSERT_EQ(left.size(), 1u);
    EXPECT_EQ(left[0]->info()->path, file());
    autosave->recover(left[0]);
    ASSERT_TRUE(idle());
    ASSERT_NE(workspace->session(), nullptr);
    EXPECT_TRUE(workspace->session()->modified());
    EXPECT_EQ(workspace->session()->path(), file());
    EXPECT_EQ(testing::bytesOf(workspace->session()->document()), bytes);
    // A second crash before anything else happens loses nothing.
    ASSERT_EQ(crash().size(), 1u);
}

TEST_F(AutosaveTest, SavedAndClosedDocumentsAreForgotten) {
    openAndPaint(.5f);
    autosave->saveNow();
    ASSERT_TRUE(idle());
    workspace->save(file(), true);
    ASSERT_TRUE(idle());
    EXPECT_TRUE(crash().empty());
    openAndPaint(.7f);
    autosave->saveNow();
    ASSERT_TRUE(idle());
    workspace->close(workspace->session(), discarding());
    EXPECT_TRUE(crash().empty());
    openAndPaint(.8f);
    autosave->saveNow();
    ASSERT_TRUE(idle());
    workspace->session()->history().undo();
    autosave->saveNow();
    EXPECT_TRUE(crash().empty()) << "it is what the file holds";
}

TEST_F(AutosaveTest, WaitsForTheEndOfAGestureAndWritesOnlyChanges) {
    openAndPaint(.5f);
    autosave->saveNow();
    EXPECT_TRUE(autosave->writing());
    ASSERT_TRUE(idle());
    autosave->saveNow();
    EXPECT_FALSE(autosave->writing()) << "nothing has changed since";
    {
        EditSession gesture(*workspace->session(), "Paint");
        ASSERT_TRUE(gesture.preview([](PatchMesh& m) { return testing::paint(m, PatchId(3), .9f); }));
        autosave->saveNow();
        QTest::qWait(10);
        EXPECT_FALSE(autosave->writing());
        gesture.commit();
    }
    QSignalSpy rounds(autosave.get(), &Autosave::idle);
    ASSERT_TRUE(rounds.wait(kWaitMs));
    const auto bytes = testing::bytesOf(workspace->session()->document());
    const auto left = crash();
    ASSERT_EQ(left.size(), 1u);
    EXPECT_EQ(bytesIn(*left[0]), bytes);
}

// The autosave waits behind the closing for the end of the same gesture.
TEST_F(AutosaveTest, ADocumentThatIsClosedBeforeItsTurnIsNotWritten) {
    openAndPaint(.5f);
    QPointer<DocumentSession> session = workspace->session();
    {
        EditSession gesture(*session, "Paint");
        workspace->close(session, discarding());
        autosave->saveNow();
    }
    ASSERT_TRUE(QTest::qWaitFor([&] { return !session; }, kWaitMs));
    ASSERT_TRUE(idle());
    EXPECT_TRUE(crash().empty());
}

TEST_F(AutosaveTest, TheTimerDoesIt) {
    openAndPaint(.5f);
    autosave->setInterval(1);
    QSignalSpy rounds(autosave.get(), &Autosave::idle);
    ASSERT_TRUE(rounds.wait(kWaitMs));
    autosave->setInterval(0);
    EXPECT_EQ(crash().size(), 1u);
}

}  // namespace
}  // namespace tessera
