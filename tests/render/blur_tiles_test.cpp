// Tiles of a view: they cover it once, and where a feature is blurred the blurred ones do.
#include "render/blur_tiles.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "core/mesh/patch_query.h"
#include "tests/support/test_meshes.h"

namespace tessera::render {
namespace {

PatchMesh blurredMesh() {
    PatchMesh mesh = testing::curvedMesh(300, 220, 11, 8, 5);
    mesh.forEachEdge([&](EdgeId e) {
        EdgeCurve curve = mesh.curve(e);
        if (!curve.feature || e.index % 3 != 0) return;
        curve.blurSigma = {.4F, 1.2F};
        mesh.setCurve(e, curve);
    });
    return mesh;
}

// By pixel: 0 where no rectangle is, 1 where a plain one, 2 where a blurred one, 3 where several.
std::vector<int> coverage(const BlurTiles& tiles, const View& view) {
    std::vector<int> pixels(size_t(view.width) * size_t(view.height), 0);
    for (size_t i = 0; i < tiles.rects.size(); ++i) {
        const glm::ivec4 r = tiles.rects[i];
        for (int y = r.y; y < r.w; ++y)
            for (int x = r.x; x < r.z; ++x) {
                int& pixel = pixels[size_t(y) * size_t(view.width) + size_t(x)];
                pixel = pixel != 0 ? 3 : i < tiles.plain ? 1 : 2;
            }
    }
    return pixels;
}

TEST(BlurTiles, CoverTheViewAndAllThatIsBlurred) {
    const PatchMesh mesh = blurredMesh();
    const EdgeBlur blur(mesh);
    const PatchQuery query(mesh);
    for (const double scale : {.7, 1.0, 3.7}) {
        View view;
        view.width = 203;
        view.height = 149;
        view.scale = glm::dvec2(scale);
        view.origin = {13.3, -7.1};
        const std::vector<int> pixels = coverage(blurTiles(blur, view), view);
        size_t plain = 0, blurred = 0;
        for (int y = 0; y < view.height; ++y)
            for (int x = 0; x < view.width; ++x) {
                const int kind = pixels[size_t(y) * size_t(view.width) + size_t(x)];
                ASSERT_TRUE(kind == 1 || kind == 2) << x << ' ' << y;
                plain += kind == 1;
                const glm::dvec2 point = view.origin + (glm::dvec2(x, y) + .5) / scale;
                const auto hit = query.patchAt(point);
                std::array<BlurTerm, kMaxBlurTerms> terms;
                if (!hit || blur.terms(hit->patch, point, terms) == 0) continue;
                ++blurred;
                ASSERT_EQ(kind, 2) << x << ' ' << y << " at " << scale;
            }
        EXPECT_GT(blurred, 300U);
        EXPECT_GT(plain, 1000U) << "not all is called blurred";
    }
}

TEST(BlurTiles, AreAllPlainWhereNothingIsBlurred) {
    View view;
    view.width = 1001;
    view.height = 700;
    const BlurTiles tiles = blurTiles(EdgeBlur(blurredMesh(), 0), view);
    EXPECT_EQ(tiles.plain, tiles.rects.size());
    for (const int pixel : coverage(tiles, view)) ASSERT_EQ(pixel, 1);
}

}  // namespace
}  // namespace tessera::render
