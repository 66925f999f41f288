// The map of errors: clear where the vector image is the photo, red where it is far from it.
#include "app/heat_map.h"

#include <gtest/gtest.h>

#include "app/jobs/render_job.h"
#include "core/export/rasterize.h"
#include "tests/support/test_meshes.h"

namespace tessera {
namespace {

TEST(HeatMap, IsClearWhereThePhotoIsMetAndRedWhereItIsNot) {
    const PatchMesh mesh = testing::gridMesh(24, 16, 3, 2);
    auto photo = rasterize(mesh, wholePicture(mesh, {1, 1}), {.samples = kPictureSamples});
    ASSERT_TRUE(photo.has_value());
    photo->at(5, 7, 0) += 60.F / 255;
    photo->at(6, 7, 1) += 10.F / 255;
    photo->at(7, 7, 2) += 3.F / 255;
    Progress progress;
    progress.beginStage("measuring", 1);
    const auto map = heatMap(mesh, *photo, progress);
    ASSERT_TRUE(map.has_value());
    EXPECT_EQ(map->size(), QSize(24, 16));
    const auto at = [&](int x, int y) { return map->pixelColor(x, y); };
    EXPECT_EQ(at(0, 0).alpha(), 0);
    EXPECT_EQ(at(7, 7).alpha(), 0) << "nobody sees three levels";
    EXPECT_GT(at(6, 7).alpha(), 0);
    EXPECT_GT(at(6, 7).green(), 150) << "a small error is yellow";
    EXPECT_GT(at(5, 7).alpha(), 200);
    EXPECT_LT(at(5, 7).green(), 20) << "a large one is red";
}

}  // namespace
}  // namespace tessera
