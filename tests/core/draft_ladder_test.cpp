// The ladder of drafts: every rung is valid, counts fall, the same count gives the same mesh.
#include "core/vectorize/draft_ladder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/parallel.h"
#include "core/export/rasterize.h"
#include "core/image/image_compare.h"
#include "core/mesh/mesh_validate.h"
#include "core/vectorize/vectorize.h"
#include "tests/support/painted_image.h"

namespace tessera {
namespace {

using tessera::testing::paint;
using ::testing::IsEmpty;

class Ladder : public ::testing::Test {
  protected:
    static void SetUpTestSuite() {
        picture = paint(128, 96, 3, [](double x, double y, int c) {
            if (std::hypot(x - 60, y - 50) < 24) return .8 - .2 * c;
            return .4 + .2 * std::sin(.08 * x + c) * std::cos(.06 * y);
        });
        ladder = build(2);
    }
    static std::shared_ptr<const DraftLadder> build(int threads) {
        std::shared_ptr<const DraftLadder> built;
        VectorizeSettings settings;
        settings.patches = 300;
        settings.threads = threads;
        StageObserver observe;
        observe.ladder = [&](std::shared_ptr<const DraftLadder> made) { built = std::move(made); };
        Progress progress;
        EXPECT_TRUE(vectorize(picture, settings, progress, observe));
        return built;
    }
    static double error(const PatchMesh& mesh) {
        return compareImages(picture, *rasterize(mesh, wholePicture(mesh, {1, 1})))->mae;
    }

    static inline Image picture;
    static inline std::shared_ptr<const DraftLadder> ladder;
};

TEST_F(Ladder, EveryRungIsValidAndFewerPatchesAreFewer) {
    ASSERT_TRUE(ladder);
    EXPECT_GE(ladder->mostPatches(), 400u);
    EXPECT_LE(ladder->leastPatches(), 20u);
    size_t last = ladder->mostPatches() + 1;
    for (size_t wanted = ladder->mostPatches() + 5; wanted + 4 > ladder->leastPatches();
         wanted -= wanted > 60 ? 17 : 5) {
        const PatchMesh mesh = ladder->at(wanted);
        EXPECT_THAT(validate(mesh).violations, IsEmpty()) << wanted;
        EXPECT_LE(mesh.patchCount(), last);
        last = mesh.patchCount();
        if (wanted < ladder->leastPatches()) {
            EXPECT_EQ(last, ladder->leastPatches());
        } else {
            EXPECT_LE(last, wanted);
            EXPECT_GE(last + 2, std::min(wanted, ladder->mostPatches()));
        }
    }
}

TEST_F(Ladder, MorePatchesAreCloser) {
    const double fine = error(ladder->at(400)), coarse = error(ladder->at(ladder->leastPatches()));
    EXPECT_LT(fine, 2);
    EXPECT_GT(coarse, 1.5 * fine);
    EXPECT_LT(coarse, 30);
}

TEST_F(Ladder, TheSameMeshForTheSameCount) {
    const auto other = build(1);
    EXPECT_EQ(other->leastPatches(), ladder->leastPatches());
    for (const size_t wanted : {350, 200, 120}) {
        const PatchMesh a = ladder->at(wanted);
        PatchMesh b;
        withThreads(1, [&] { b = other->at(wanted); });
        ASSERT_EQ(a.patchCount(), b.patchCount());
        a.forEachPatch([&](PatchId p) {
            EXPECT_EQ(a.controlPoints(p).p, b.controlPoints(p).p);
            EXPECT_EQ(a.spline(p), b.spline(p));
        });
    }
}

TEST_F(Ladder, IsBuiltOnlyWhereItIsAskedFor) {
    // Asking changes nothing but that there is one.
    VectorizeSettings settings;
    settings.patches = 60;
    Progress progress;
    size_t made = 0;
    StageObserver observe;
    observe.ladder = [&](const std::shared_ptr<const DraftLadder>&) { ++made; };
    const auto with = vectorize(picture, settings, progress, observe);
    const auto without = vectorize(picture, settings, progress);
    ASSERT_TRUE(with && without);
    EXPECT_EQ(made, 1u);
    EXPECT_EQ(error(with->mesh), error(without->mesh));
}

}  // namespace
}  // namespace tessera
