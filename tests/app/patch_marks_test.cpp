// Which patches are hidden, locked and cut out, kept with the changes of a document.
#include "app/patch_marks.h"

#include <gtest/gtest.h>

#include <random>

#include "app/edit_session.h"
#include "core/edit/split_merge.h"
#include "tests/support/test_meshes.h"

namespace tessera {
namespace {

// What a look at all patches finds.
void expectRight(const DocumentSession& session) {
    const PatchMarks fresh(session.document().mesh);
    EXPECT_EQ(session.marks().hidden(), fresh.hidden());
    EXPECT_EQ(session.marks().locked(), fresh.locked());
    EXPECT_EQ(session.marks().cutOut(), fresh.cutOut());
}

Touched mark(PatchMesh& mesh, PatchId p, const PatchAttributes& attributes) {
    mesh.setAttributes(p, attributes);
    return touchedOf({}, {}, {p});
}

TEST(PatchMarks, FollowEditsPreviewsUndoAndSplits) {
    Document document;
    document.mesh = testing::gridMesh(64, 48, 4, 3);
    document.mesh.setAttributes(PatchId(5), {.hidden = true});
    DocumentSession session(std::move(document), {}, {});
    EXPECT_EQ(session.marks().hidden(), PatchSet{PatchId(5)}) << "of a document that is opened";
    std::mt19937 random(3);
    for (int i = 0; i < 120; ++i) {
        const auto alive = allSelectable(session.document().mesh);
        ASSERT_FALSE(alive.empty());
        const PatchId p = alive[random() % alive.size()];
        const PatchAttributes attributes{random() % 8 == 0, random() % 8 == 0, random() % 2 == 0};
        if (i % 4 == 0) {
            EditSession edit(session, "Mark");
            ASSERT_TRUE(edit.preview([&](PatchMesh& mesh) { return mark(mesh, p, attributes); }));
            expectRight(session);
            if (i % 8 == 0) edit.commit();
        } else if (i % 4 == 1) {
            ASSERT_TRUE(applyEdit(session, "Split",
                                  [&](PatchMesh& mesh) { return splitPatch(mesh, p, Barycentric(1. / 3)); }));
        } else if (i % 4 == 2 && session.history().canUndo()) {
            session.history().undo();
        } else {
            ASSERT_TRUE(
                applyEdit(session, "Mark", [&](PatchMesh& mesh) { return mark(mesh, p, attributes); }));
        }
        expectRight(session);
    }
    EXPECT_FALSE(session.marks().cutOut().empty());
    EXPECT_TRUE(session.marks().leavesHoles());
}

TEST(PatchMarks, KnowOnlyWhatTheyAreTold) {
    PatchMesh mesh = testing::gridMesh(64, 48, 4, 3);
    PatchMarks marks(mesh);
    mark(mesh, PatchId(2), {.locked = true});
    mark(mesh, PatchId(7), {.cutOut = true});
    marks.update(mesh, {PatchId(7)});
    EXPECT_TRUE(marks.locked().empty());
    EXPECT_EQ(marks.cutOut(), PatchSet{PatchId(7)});
    EXPECT_TRUE(marks.leavesHoles());
    mark(mesh, PatchId(7), {});
    marks.update(mesh, {PatchId(2), PatchId(7)});
    EXPECT_EQ(marks.locked(), PatchSet{PatchId(2)});
    EXPECT_FALSE(marks.leavesHoles());
}

}  // namespace
}  // namespace tessera
