// Gestures: what is shown on the way, what one step they become, and who waits for them.
#include "app/edit_session.h"

#include <gtest/gtest.h>

#include <QCoreApplication>

#include "tests/support/edits.h"
#include "tests/support/test_meshes.h"

namespace tessera {
namespace {

Document smallDocument() {
    Document document;
    document.mesh = testing::curvedMesh(64, 48, 4, 3, 1);
    document.difference = ImageDifference{};
    return document;
}

struct EditSessionTest : ::testing::Test {
    EditSessionTest() {
        QObject::connect(&session, &DocumentSession::changed,
                         [this](const Change& change) { changes.push_back(change); });
    }
    std::vector<uint8_t> bytes() const { return testing::bytesOf(session.document()); }
    static MeshEdit painting(uint32_t patch, float value) {
        return [=](PatchMesh& mesh) { return testing::paint(mesh, PatchId(patch), value); };
    }

    DocumentSession session{smallDocument(), {}, {}};
    std::vector<Change> changes;
};

TEST_F(EditSessionTest, AGestureIsOneStep) {
    const auto before = bytes();
    {
        EditSession edit(session, "Paint");
        for (int i = 0; i < 30; ++i) ASSERT_TRUE(edit.preview(painting(3, .01f * float(i))));
        EXPECT_EQ(session.history().count(), 0);
        EXPECT_FALSE(session.modified());
        edit.commit();
        EXPECT_FALSE(edit.open());
    }
    const auto after = bytes();
    EXPECT_NE(after, before);
    EXPECT_EQ(session.history().count(), 1);
    EXPECT_EQ(session.history().undoText(), "Paint");
    EXPECT_FALSE(session.document().difference.has_value()) << "what was measured holds no more";
    session.history().undo();
    EXPECT_EQ(bytes(), before);
    EXPECT_TRUE(session.document().difference.has_value());
    session.history().redo();
    EXPECT_EQ(bytes(), after);
}

TEST_F(EditSessionTest, EachPreviewStartsFromTheStart) {
    EditSession edit(session, "Paint");
    const PatchSpline spline = session.document().mesh.spline(PatchId(3));
    ASSERT_TRUE(edit.preview(painting(3, 1)));
    ASSERT_TRUE(edit.preview(painting(5, 1)));
    EXPECT_EQ(session.document().mesh.spline(PatchId(3)), spline);
    ASSERT_EQ(changes.size(), 2u);
    EXPECT_EQ(changes[0].touched.patches, std::vector{PatchId(3)});
    EXPECT_EQ(changes[1].touched.patches, (std::vector{PatchId(3), PatchId(5)}))
        << "what is back where it was must be drawn again too";
    EXPECT_TRUE(changes[1].preview);
    edit.commit();
    EXPECT_EQ(changes.back().touched.patches, std::vector{PatchId(5)});
    EXPECT_FALSE(changes.back().preview);
}

TEST_F(EditSessionTest, WhatIsNotCommittedIsGone) {
    const auto before = bytes();
    const uint64_t revision = session.revision();
    {
        EditSession edit(session, "Paint");
        ASSERT_TRUE(edit.preview(painting(3, 1)));
        EXPECT_NE(bytes(), before);
    }
    EXPECT_EQ(bytes(), before);
    EXPECT_EQ(session.revision(), revision);
    EXPECT_EQ(session.history().count(), 0);
    EXPECT_EQ(changes.back().touched.patches, std::vector{PatchId(3)});
    EXPECT_FALSE(session.editing());
}

TEST_F(EditSessionTest, NothingTouchedIsNoStep) {
    EditSession edit(session, "Paint");
    ASSERT_TRUE(edit.preview([](PatchMesh&) { return Touched{}; }));
    edit.commit();
    EXPECT_EQ(session.history().count(), 0);
    EXPECT_TRUE(changes.empty());
    EXPECT_TRUE(applyEdit(session, "Paint", [](PatchMesh&) { return Touched{}; }));
    EXPECT_EQ(session.history().count(), 0);
}

TEST_F(EditSessionTest, AFailedEditShowsTheStart) {
    const auto before = bytes();
    const MeshEdit failing = [](PatchMesh& mesh) -> Result<Touched> {
        testing::paint(mesh, PatchId(3), 1);
        return failure(ErrorCode::Usage, "no");
    };
    EditSession edit(session, "Paint");
    ASSERT_TRUE(edit.preview(painting(3, 1)));
    const Result<void> failed = edit.preview(failing);
    ASSERT_FALSE(failed.has_value());
    EXPECT_EQ(failed.error().message, "no");
    EXPECT_EQ(bytes(), before);
    edit.commit();
    EXPECT_EQ(session.history().count(), 0);
    EXPECT_FALSE(applyEdit(session, "Paint", failing).has_value());
    EXPECT_EQ(bytes(), before);
}

TEST_F(EditSessionTest, OthersWaitInOrder) {
    ASSERT_TRUE(applyEdit(session, "First", painting(1, 0)));
    const auto first = bytes();
    std::vector<int> ran;
    {
        EditSession edit(session, "Second");
        ASSERT_TRUE(edit.preview(painting(2, 0)));
        EXPECT_FALSE(applyEdit(session, "Refused", painting(3, 0)).has_value());
        session.history().undo();
        session.whenIdle([&] { ran.push_back(1); });
        session.whenIdle([&] { ran.push_back(2); });
        QCoreApplication::processEvents();
        EXPECT_TRUE(ran.empty());
        EXPECT_EQ(session.history().index(), 1);
        edit.commit();
        EXPECT_TRUE(ran.empty()) << "not in the middle of whoever commits";
    }
    session.whenIdle([&] { ran.push_back(3); });
    QCoreApplication::processEvents();
    EXPECT_EQ(ran, (std::vector{1, 2, 3}));
    EXPECT_EQ(session.history().index(), 1) << "the undo was of the step that was just made";
    EXPECT_EQ(bytes(), first);
}

TEST_F(EditSessionTest, ADocumentMayGoFirst) {
    auto closing = std::make_unique<DocumentSession>(smallDocument(), Photo{}, QString());
    EditSession edit(*closing, "Paint");
    ASSERT_TRUE(edit.preview(painting(3, 1)));
    closing.reset();
    EXPECT_FALSE(edit.open());
    EXPECT_TRUE(edit.preview(painting(4, 1)));
    edit.commit();
}

}  // namespace
}  // namespace tessera
