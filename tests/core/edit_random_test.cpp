// Hundreds of edits of all kinds in random order: every state on the way is valid, what an edit says that it
// touched is what it changed, and the states before are as they were.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "core/edit/brush.h"
#include "core/edit/drag_colour.h"
#include "core/edit/edge_edits.h"
#include "core/edit/recolour.h"
#include "core/edit/refit.h"
#include "core/edit/reshape.h"
#include "core/edit/select.h"
#include "core/edit/snap.h"
#include "core/edit/split_merge.h"
#include "tests/support/edit_meshes.h"

namespace tessera {
namespace {

using testing::changedPatches;
using testing::expectValid;
using testing::sameMesh;

class RandomEditor {
  public:
    RandomEditor(PatchMesh mesh, Image photo, unsigned seed)
        : mStart(mesh), mMesh(std::move(mesh)), mPhoto(std::move(photo)), mRandom(seed) {}

    const PatchMesh& mesh() const { return mMesh; }

    // The name of the edit, for messages.
    const char* step(Touched& touched) {
        switch (pick(14)) {
            case 0:
                touched =
                    recolour(mMesh, region(), ColourShift{real(-180, 180), real(.5, 1.5), real(-.1, .1)},
                             {pick(3) == 0 ? 8.0 : 0.0});
                return "hue";
            case 1:
                touched = recolour(mMesh, region(), Levels{real(-.1, .1), real(-.3, .3)});
                return "levels";
            case 2:
                touched = recolour(mMesh, region(), Tint{colour(), real(0, 1)});
                return "tint";
            case 3:
                touched = dragColour(mMesh, patch(), {.5, .3, .2}, colour());
                return "drag colour";
            case 4:
                touched = brush(mMesh, PatchQuery(mMesh), std::vector{point(), point()},
                                {real(3, 30), real(0, 1), colour(), real(0, 1), pick(2) == 0});
                return "brush";
            case 5:
            case 6:
                return dragPoint(touched);
            case 7:
                touched = ShapeDrag::bend(mMesh, edge(), real(0, 1)).drag(mMesh, offset(8)).touched;
                return "bend";
            case 8:
                take(splitEdge(mMesh, edge(), real(0, 1)), touched);
                return "split edge";
            case 9:
                take(splitPatch(mMesh, patch(), {.3, .5, .2}), touched);
                return "split patch";
            case 10:
                take(mergeEdge(mMesh, edge()), touched);
                return "merge";
            case 11:
                return changeEdge(touched);
            case 12:
                return reset(touched);
            default:
                return fromPhoto(touched);
        }
    }

  private:
    size_t pick(size_t count) { return mRandom() % count; }
    double real(double from, double to) { return std::uniform_real_distribution<double>(from, to)(mRandom); }
    glm::dvec3 colour() { return {real(0, 1), real(0, 1), real(0, 1)}; }
    glm::dvec2 point() { return {real(0, mMesh.width()), real(0, mMesh.height())}; }
    glm::dvec2 offset(double px) { return {real(-px, px), real(-px, px)}; }
    PatchId patch() {
        for (;;)
            if (const PatchId p(uint32_t(pick(mMesh.connectivity().faceCapacity())));
                mMesh.connectivity().alive(p))
                return p;
    }
    EdgeId edge() {
        for (;;)
            if (const EdgeId e(uint32_t(pick(mMesh.connectivity().edgeCapacity())));
                mMesh.connectivity().alive(e))
                return e;
    }
    PatchSet region() {
        PatchSet set{patch()};
        for (size_t i = pick(4); i > 0; --i) set = grown(mMesh, set);
        return set;
    }
    static void take(const Result<Touched>& result, Touched& touched) {
        if (result) touched = *result;
    }

    const char* dragPoint(Touched& touched) {
        const HalfedgeId h = HalfedgeMesh::halfedge(edge());
        const std::array refs{ControlPointRef::of(mMesh.connectivity().origin(h)), ControlPointRef::of(h),
                              ControlPointRef::of(patch())};
        touched = ShapeDrag(mMesh, {refs[pick(3)]}).drag(mMesh, offset(20), pick(4) == 0).touched;
        return "drag";
    }
    const char* changeEdge(Touched& touched) {
        const std::array one{edge()};
        switch (pick(3)) {
            case 0:
                take(setBlur(mMesh, one, real(0, 4), real(0, 4)), touched);
                return "blur";
            case 1:
                take(setFeature(mMesh, one, true), touched);
                return "mark";
            default:
                take(setFeature(mMesh, one, false), touched);
                return "unmark";
        }
    }
    const char* reset(Touched& touched) {
        if (pick(2) == 0) {
            touched = resetColours(mMesh, mStart, region());
            return "reset colours";
        }
        touched = resetShape(mMesh, mStart, region());
        return "reset shape";
    }
    const char* fromPhoto(Touched& touched) {
        if (pick(2) == 0) {
            touched = refitColours(mMesh, mPhoto, {patch()});
            return "refit";
        }
        take(snapToFeature(mMesh, mPhoto, std::array{edge()}), touched);
        return "snap";
    }

    PatchMesh mStart, mMesh;
    Image mPhoto;
    std::mt19937 mRandom;
};

class RandomEdits : public ::testing::TestWithParam<unsigned> {};

TEST_P(RandomEdits, EndValidAndLeaveTheStartAsItWas) {
    const unsigned seed = GetParam();
    SCOPED_TRACE("seed " + std::to_string(seed));
    const PatchMesh start = testing::sceneMesh(160, 120, 140);
    const PatchMesh untouched = testing::sceneMesh(160, 120, 140);
    RandomEditor editor(start, testing::editScene(160, 120), seed);
    constexpr int kEdits = 300;
    int changing = 0;
    for (int i = 0; i < kEdits; ++i) {
        const PatchMesh before = editor.mesh();
        Touched touched;
        const char* what = editor.step(touched);
        changing += !touched.empty();
        if (!touched.topology) {
            const auto changed = changedPatches(before, editor.mesh());
            EXPECT_TRUE(
                std::includes(touched.patches.begin(), touched.patches.end(), changed.begin(), changed.end()))
                << what << ", edit " << i;
        }
        const MeshValidation validation = validate(editor.mesh());
        ASSERT_TRUE(validation.valid()) << what << ", edit " << i << ": " << validation.violations.front();
    }
    EXPECT_GT(changing, kEdits / 2);
    EXPECT_TRUE(sameMesh(start, untouched));
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomEdits, ::testing::Values(1U, 2U, 3U, 4U));

}  // namespace
}  // namespace tessera
