// Steps, their memory, and the rows of the history panel.
#include "app/history.h"

#include <gtest/gtest.h>

#include "app/edit_session.h"
#include "app/history_model.h"
#include "tests/support/edits.h"
#include "tests/support/test_meshes.h"

namespace tessera {
namespace {

// 800 patches: splines fill 13 pages.
Document largeDocument() {
    Document document;
    document.mesh = testing::curvedMesh(400, 400, 20, 20, 1);
    return document;
}

struct HistoryTest : ::testing::Test {
    void paint(uint32_t patch, float value) {
        const auto edit = [&](PatchMesh& mesh) { return testing::paint(mesh, PatchId(patch), value); };
        ASSERT_TRUE(applyEdit(session, QString("Paint %1").arg(patch), edit).has_value());
    }
    std::vector<uint8_t> bytes() const { return testing::bytesOf(session.document()); }

    DocumentSession session{largeDocument(), {}, {}};
    History& history = session.history();
};

TEST_F(HistoryTest, UndoAndRedoGiveTheSameBytes) {
    std::vector<std::vector<uint8_t>> states{bytes()};
    for (uint32_t i = 0; i < 6; ++i) {
        paint(100 * i, .1f * float(i));
        states.push_back(bytes());
    }
    for (const int state : {5, 0, 3, 6, 1, 6, 0}) {
        history.goTo(state);
        EXPECT_EQ(history.index(), state);
        EXPECT_EQ(bytes(), states[size_t(state)]) << state;
    }
    history.undo();
    EXPECT_EQ(history.index(), 0) << "there is nothing before the first state";
    history.redo();
    EXPECT_EQ(bytes(), states[1]);
}

TEST_F(HistoryTest, APushDropsWhatWasUndone) {
    paint(1, 0);
    paint(2, 0);
    history.undo();
    paint(3, 0);
    EXPECT_EQ(history.count(), 2);
    EXPECT_EQ(history.undoText(), "Paint 3");
    EXPECT_FALSE(history.canRedo());
}

TEST_F(HistoryTest, AStepCostsThePagesThatItTouched) {
    const size_t whole = session.document().mesh.bytesBeyond(PatchMesh());
    const size_t none = session.document().mesh.bytesBeyond(PatchMesh(session.document().mesh));
    paint(0, 0);
    const size_t one = history.bytes();
    EXPECT_LT(none, whole / 20);
    EXPECT_GT(one, none);
    EXPECT_LT(one, whole / 4);
    paint(1, 0);  // of the same page as the step before, but another copy of it
    EXPECT_GT(history.bytes(), one + one / 2);
    EXPECT_LT(history.bytes(), 5 * one / 2);
    // The pages of both sides of a step differ alike.
    const size_t undoable = history.bytes();
    history.goTo(0);
    EXPECT_NEAR(double(history.bytes()), double(undoable), .5 * double(undoable));
}

TEST_F(HistoryTest, ForgetsTheOldestStepsBeyondItsLimit) {
    paint(0, 0);
    const size_t one = history.bytes();
    history.setMemoryLimit(5 * one + one / 2);
    for (uint32_t i = 1; i < 12; ++i) {
        paint(64 * i, 0);
        EXPECT_LE(history.bytes(), history.memoryLimit());
    }
    EXPECT_TRUE(history.forgot());
    EXPECT_GE(history.count(), 4);
    EXPECT_LE(history.count(), 6);
    EXPECT_EQ(history.index(), history.count());
    EXPECT_EQ(history.undoText(), "Paint 704");
    const int kept = history.count();
    history.goTo(0);
    EXPECT_EQ(session.document().mesh.spline(PatchId(64 * (11 - uint32_t(kept)))),
              constantSpline(std::array{0.f, 0.f, 0.f}))
        << "what was forgotten stays done";
    history.goTo(kept);
    history.setMemoryLimit(0);
    EXPECT_EQ(history.count(), 1) << "the last step can always be undone";
}

TEST_F(HistoryTest, KnowsWhichStateIsInTheFile) {
    EXPECT_EQ(history.savedIndex(), -1) << "it was never saved";
    paint(0, 0);
    paint(1, 0);
    session.markSaved(session.revision(), "/x.tessera", {});
    EXPECT_EQ(history.savedIndex(), 2);
    history.goTo(0);
    EXPECT_EQ(history.savedIndex(), 2);
    paint(2, 0);
    EXPECT_EQ(history.savedIndex(), -1);
}

TEST_F(HistoryTest, RowsForAPanel) {
    HistoryModel model;
    EXPECT_EQ(model.rowCount(), 0);
    model.setHistory(&history);
    ASSERT_EQ(model.rowCount(), 1);
    const auto at = [&](int row, int role) { return model.data(model.index(row), role); };
    EXPECT_EQ(at(0, Qt::DisplayRole), "Opened");
    EXPECT_EQ(at(0, HistoryModel::CurrentRole), true);
    paint(0, 0);
    paint(1, 0);
    ASSERT_EQ(model.rowCount(), 3);
    EXPECT_EQ(at(2, Qt::DisplayRole), "Paint 1");
    history.goTo(1);
    EXPECT_EQ(at(0, HistoryModel::SavedRole), false);
    EXPECT_EQ(at(1, HistoryModel::CurrentRole), true);
    EXPECT_EQ(at(1, HistoryModel::UndoneRole), false);
    EXPECT_EQ(at(2, HistoryModel::UndoneRole), true);
    history.setMemoryLimit(0);
    EXPECT_EQ(at(0, Qt::DisplayRole), history.forgot() ? "Earlier Steps" : "Opened");
    {
        DocumentSession other(largeDocument(), {}, {}, {});
        model.setHistory(&other.history());
    }
    EXPECT_EQ(model.rowCount(), 0) << "the document has gone";
}

}  // namespace
}  // namespace tessera
