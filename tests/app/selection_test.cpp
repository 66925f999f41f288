// The selection, how it follows edits, and the selections that a document keeps.
#include "app/selection.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "app/edit_actions.h"
#include "app/element_edits.h"
#include "app/selection_actions.h"
#include "core/edit/split_merge.h"
#include "core/mesh/mesh_validate.h"
#include "tests/support/edits.h"
#include "tests/support/test_meshes.h"

namespace tessera {
namespace {

Document smallDocument() {
    Document document;
    document.mesh = testing::curvedMesh(120, 90, 5, 4, 3);
    return document;
}

struct SelectionTest : ::testing::Test {
    PatchSet ids(std::initializer_list<uint32_t> indices) const {
        PatchSet set;
        for (const uint32_t i : indices) set.push_back(PatchId(i));
        return set;
    }
    const PatchMesh& mesh() const { return session.document().mesh; }

    DocumentSession session{smallDocument(), {}, {}};
    Selection& selection = session.selection();
};

TEST_F(SelectionTest, ModesCombineSets) {
    const PatchSet a = ids({1, 2, 3}), b = ids({3, 4});
    EXPECT_EQ(combined(a, b, SelectMode::Replace), b);
    EXPECT_EQ(combined(a, b, SelectMode::Add), ids({1, 2, 3, 4}));
    EXPECT_EQ(combined(a, b, SelectMode::Subtract), ids({1, 2}));
    EXPECT_EQ(combined(a, b, SelectMode::Intersect), ids({3}));
}

TEST_F(SelectionTest, SignalsOnceAndOnlyChanges) {
    int signalled = 0;
    QObject::connect(&selection, &Selection::changed, [&] { ++signalled; });
    selection.setPatches(ids({4, 2, 4}));
    EXPECT_EQ(selection.patches(), ids({2, 4}));
    EXPECT_EQ(signalled, 1);
    selection.setPatches(ids({2, 4}));
    EXPECT_EQ(signalled, 1);
    selection.setShape({ControlPointRef::of(VertexId(1))}, {EdgeId(3)});
    selection.clear();
    EXPECT_TRUE(selection.empty());
    EXPECT_EQ(signalled, 3);
    EXPECT_EQ(session.history().count(), 0) << "selecting is no edit";
}

TEST_F(SelectionTest, PointsAndCurvesHavePatches) {
    const HalfedgeMesh& connectivity = mesh().connectivity();
    const PatchId patch(7);
    const HalfedgeId side = connectivity.sides(patch)[0];
    const VertexId corner = connectivity.origin(side);
    selection.setShape({ControlPointRef::of(patch)}, {});
    EXPECT_EQ(selectionsPatches(session), PatchSet{patch});
    selection.setShape({ControlPointRef::of(side)}, {});
    const PatchSet beside = selectionsPatches(session);
    EXPECT_TRUE(std::binary_search(beside.begin(), beside.end(), patch));
    selection.setShape({}, {HalfedgeMesh::edge(side)});
    EXPECT_EQ(selectionsPatches(session), beside);
    selection.setShape({ControlPointRef::of(corner)}, {});
    const PatchSet around = selectionsPatches(session);
    EXPECT_EQ(subtracted(beside, around), PatchSet());
    EXPECT_GT(around.size(), beside.size());
}

TEST_F(SelectionTest, PartsOfWhatWasSplitAreSelected) {
    selection.setPatches(ids({6, 11}));
    const size_t before = mesh().patchCount();
    constexpr Barycentric kCentre(1. / 3, 1. / 3, 1. / 3);
    const auto split = [&](PatchMesh& m) { return splitPatch(m, PatchId(6), kCentre); };
    ASSERT_TRUE(applyEdit(session, "Split", split).has_value());
    ASSERT_EQ(mesh().patchCount(), before + 2);
    EXPECT_EQ(selection.patches().size(), 4u) << "three parts and the other one";
    EXPECT_TRUE(contains(selection.patches(), PatchId(11)));
    session.history().undo();
    EXPECT_EQ(selection.patches(), ids({6, 11}));
    session.history().redo();
    EXPECT_EQ(selection.patches().size(), 4u);
}

TEST_F(SelectionTest, WhatHasGoneIsNotSelected) {
    std::optional<EdgeId> merged;
    mesh().forEachEdge([&](EdgeId e) {
        PatchMesh trial = mesh();
        if (!merged && !mesh().connectivity().onBorder(e) && mergeEdge(trial, e)) merged = e;
    });
    ASSERT_TRUE(merged.has_value());
    selectAll(session);
    selection.setShape(controlPointsOf(mesh(), *merged), {*merged});
    ASSERT_TRUE(applyEdit(session, "Merge", [&](PatchMesh& m) { return mergeEdge(m, *merged); }));
    EXPECT_EQ(selection.patches(), allSelectable(mesh()));
    EXPECT_TRUE(selection.curves().empty());
    EXPECT_EQ(selection.points().size(), 1u) << "of the two ends one is left";
}

TEST_F(SelectionTest, AnotherMeshHasNoSelection) {
    selection.setPatches(ids({1, 2}));
    Document other;
    other.mesh = testing::curvedMesh(120, 90, 6, 3, 5);
    session.history().push(EditCommand(session, "Vectorize", other, {.replaced = true}));
    EXPECT_TRUE(selection.empty());
}

TEST_F(SelectionTest, HiddenAndLockedPatchesLeaveIt) {
    selection.setPatches(ids({1, 2}));
    ASSERT_TRUE(setFlag(session, PatchFlag::Locked, true));
    EXPECT_TRUE(selection.empty());
    EXPECT_TRUE(mesh().attributes(PatchId(2)).locked);
    selectAll(session);
    EXPECT_FALSE(contains(selection.patches(), PatchId(2)));
    invertSelection(session);
    EXPECT_TRUE(selection.empty());
    ASSERT_TRUE(clearFlag(session, PatchFlag::Locked));
    EXPECT_FALSE(mesh().attributes(PatchId(2)).locked);
    EXPECT_FALSE(setFlag(session, PatchFlag::Hidden, true).has_value()) << "nothing is selected";
}

TEST_F(SelectionTest, StoredSelectionsArePartsOfTheDocument) {
    selection.setPatches(ids({1, 6}));
    storeSelection(session, "sky");
    ASSERT_EQ(session.document().selections.size(), 1u);
    EXPECT_TRUE(session.modified());
    selection.setPatches(ids({9}));
    recallSelection(session, "sky", SelectMode::Add);
    EXPECT_EQ(selection.patches(), ids({1, 6, 9}));
    recallSelection(session, "sky");
    EXPECT_EQ(selection.patches(), ids({1, 6}));
    storeSelection(session, "sea");
    EXPECT_FALSE(renameStoredSelection(session, "sea", "sky"));
    EXPECT_TRUE(renameStoredSelection(session, "sea", "lake"));
    constexpr Barycentric kCentre(1. / 3, 1. / 3, 1. / 3);
    ASSERT_TRUE(
        applyEdit(session, "Split", [&](PatchMesh& m) { return splitPatch(m, PatchId(6), kCentre); }));
    EXPECT_EQ(session.document().selections[0].patches.size(), 4u) << "remapped with the edit";
    session.history().undo();
    EXPECT_EQ(session.document().selections[0].patches, ids({1, 6}));
    removeStoredSelection(session, "sky");
    ASSERT_EQ(session.document().selections.size(), 1u);
    EXPECT_EQ(session.document().selections[0].name, "lake");
    session.history().goTo(0);
    EXPECT_TRUE(session.document().selections.empty());
}

TEST_F(SelectionTest, StoredSelectionsDoNotChangeDuringAnotherChange) {
    selection.setPatches(ids({1, 6}));
    ASSERT_TRUE(storeSelection(session, "sky"));
    const EditSession other(session, "Other");
    const auto expectRefused = [](const Result<void>& result) {
        ASSERT_FALSE(result);
        EXPECT_NE(result.error().message.find("under way"), std::string::npos) << result.error().message;
    };
    expectRefused(storeSelection(session, "sea"));
    expectRefused(renameStoredSelection(session, "sky", "lake"));
    expectRefused(removeStoredSelection(session, "sky"));
    EXPECT_EQ(session.document().selections.size(), 1u);
}

TEST_F(SelectionTest, BothHalvesOfACurveThatIsSplitAreSelected) {
    std::vector<EdgeId> inner;
    mesh().forEachEdge([&](EdgeId e) {
        if (!mesh().connectivity().onBorder(e) && inner.size() < 3) inner.push_back(e);
    });
    selection.setShape({}, inner);
    ASSERT_TRUE(makeNow(session, splitCurves(session)));
    EXPECT_EQ(selection.curves().size(), 2 * inner.size());
    for (const EdgeId e : selection.curves()) EXPECT_TRUE(mesh().connectivity().alive(e));
    session.history().undo();
    EXPECT_EQ(selection.curves(), inner);
}

TEST_F(SelectionTest, SimilarIsWhatTheWandFinds) {
    selection.setPatches(ids({3}));
    const WandOptions options{.tolerance = .1, .contiguous = false};
    const PatchSet found = wand(mesh(), PatchId(3), options);
    selectSimilar(session, options);
    EXPECT_EQ(selection.patches(), found);
}

TEST_F(SelectionTest, EditsOfTheSelectionAndTheWayBack) {
    EXPECT_FALSE(recolourSelection(session, "Tint", Tint{{1, 0, 0}, 1}).has_value());
    EXPECT_FALSE(resetColours(session).has_value()) << "nothing has been edited";
    selection.setPatches(ids({4, 5}));
    const auto start = testing::bytesOf(session.document());
    const PatchSpline spline = mesh().spline(PatchId(4));
    ASSERT_TRUE(recolourSelection(session, "Tint", Tint{{1, 0, 0}, 1}));
    EXPECT_NE(mesh().spline(PatchId(4)), spline);
    ASSERT_TRUE(session.document().fitted.has_value());
    ASSERT_TRUE(resetColours(session));
    EXPECT_EQ(mesh().spline(PatchId(4)), spline);
    EXPECT_EQ(session.history().count(), 2);
    session.history().goTo(0);
    EXPECT_EQ(testing::bytesOf(session.document()), start);
}

TEST_F(SelectionTest, WhatCannotBeSplitStaysAndIsToldOf) {
    constexpr Barycentric kCentre(1. / 3, 1. / 3, 1. / 3);
    // A part of a part of a part, until there is no room for another vertex.
    PatchId tiny(6);
    while (applyEdit(session, "Split", [&](PatchMesh& m) { return splitPatch(m, tiny, kCentre); }))
        tiny = PatchId(uint32_t(mesh().connectivity().faceCapacity() - 1));
    selection.setPatches({tiny});
    EXPECT_FALSE(makeNow(session, splitPatches(session)).has_value()) << "there was nothing else to split";

    const size_t patches = mesh().patchCount();
    const int steps = session.history().count();
    selection.setPatches({PatchId(1), PatchId(12), tiny});
    const Result<QString> remark = makeNow(session, splitPatches(session));
    ASSERT_TRUE(remark) << remark.error().message;
    EXPECT_TRUE(remark->startsWith("1 of 3 were left")) << remark->toStdString();
    EXPECT_EQ(mesh().patchCount(), patches + 4);
    EXPECT_EQ(session.history().count(), steps + 1);
    EXPECT_EQ(selection.patches().size(), 7u) << "the parts, and the one that has none";
    session.history().undo();
    EXPECT_EQ(mesh().patchCount(), patches);

    selection.setPatches({PatchId(1), PatchId(12)});
    EXPECT_EQ(makeNow(session, splitPatches(session)).value(), QString());
}

TEST_F(SelectionTest, CurvesThatCannotBeEditedHoldUpNoOthers) {
    std::vector<EdgeId> all;
    mesh().forEachEdge([&](EdgeId e) { all.push_back(e); });
    const auto border = size_t(
        std::count_if(all.begin(), all.end(), [&](EdgeId e) { return mesh().connectivity().onBorder(e); }));
    selection.setShape({}, all);
    const Result<QString> marked = makeNow(session, setFeature(session, true));
    ASSERT_TRUE(marked);
    EXPECT_TRUE(marked->startsWith(QString("%1 of %2 ").arg(border).arg(all.size())))
        << marked->toStdString();
    EXPECT_EQ(session.history().undoText(), "Mark Feature");

    selection.setPatches({PatchId(0)});
    ASSERT_TRUE(setFlag(session, PatchFlag::Locked, true));
    selection.setShape({}, all);
    const size_t patches = mesh().patchCount();
    const Result<QString> split = makeNow(session, splitCurves(session));
    ASSERT_TRUE(split);
    EXPECT_TRUE(split->startsWith(QString("3 of %1 ").arg(all.size()))) << split->toStdString();
    EXPECT_GT(mesh().patchCount(), 3 * patches);
    session.history().undo();

    const Result<QString> merged = makeNow(session, mergeCurves(session));
    ASSERT_TRUE(merged);
    EXPECT_FALSE(merged->isEmpty());
    EXPECT_LT(mesh().patchCount(), patches);
    EXPECT_TRUE(validate(mesh()).valid());
    session.history().undo();
    EXPECT_EQ(mesh().patchCount(), patches);
}

}  // namespace
}  // namespace tessera
