// What tests of the OpenGL renderer share: a context, frames, and the comparison with the CPU renderer.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/export/rasterize.h"
#include "render/gl_objects.h"
#include "render/offscreen_gl.h"
#include "render/renderer.h"

namespace tessera::testing {

// A test of a machine that may have no OpenGL 4.5: then it skips.
class GlTest : public ::testing::Test {
  protected:
    void SetUp() override {
        auto made = render::OffscreenGl::create();
        if (!made) GTEST_SKIP() << made.error().message;
        mContext.emplace(std::move(*made));
    }

  private:
    std::optional<render::OffscreenGl> mContext;
};

inline Image drawOffscreen(render::Renderer& renderer, const PatchMesh& mesh, const View& view,
                           const render::DrawOptions& options) {
    const render::OffscreenTarget target(view.width, view.height);
    target.bind();
    const auto drawn = renderer.draw(view, options);
    EXPECT_TRUE(drawn) << drawn.error().message;
    return target.read(mesh.channels());
}

inline Image drawOffscreen(const PatchMesh& mesh, const View& view, const render::DrawOptions& options) {
    auto renderer = render::Renderer::create();
    EXPECT_TRUE(renderer) << renderer.error().message;
    renderer->setMesh(mesh);
    return drawOffscreen(*renderer, mesh, view, options);
}

// How a frame differs from the CPU renderer's, in 1/255 of a channel: beyond kTolerance is bad.
struct FrameDifference {
    static constexpr double kTolerance = 2;

    double badShare = 0;         // of the pixels
    double worst = 0;            // anywhere
    double worstInside = 0;      // farther than a pixel from every patch's edge
    std::vector<double> inside;  // each of those
};

// For each pixel whether the patch that owns its centre owns all points within a pixel of it, as far as a
// grid of quarter pixels tells.
inline std::vector<bool> farFromEdges(const PatchMesh& mesh, const View& view) {
    constexpr int kFine = 4, kReach = kFine;
    View fine = view;
    fine.origin -= glm::dvec2(1) / view.scale;
    fine.scale *= kFine;
    fine.width = (view.width + 2) * kFine;
    fine.height = (view.height + 2) * kFine;
    const auto owners = locatePixels(mesh, fine);
    const auto owner = [&](int x, int y) { return owners[size_t(y) * size_t(fine.width) + size_t(x)].patch; };
    std::vector<bool> far;
    for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x) {
            const int cx = (x + 1) * kFine + kFine / 2, cy = (y + 1) * kFine + kFine / 2;
            bool alone = true;
            for (int j = -kReach - 1; j <= kReach; ++j)
                for (int i = -kReach - 1; i <= kReach; ++i)
                    alone = alone && owner(cx + i, cy + j) == owner(cx, cy);
            far.push_back(alone);
        }
    return far;
}

inline FrameDifference differenceFromCpu(const PatchMesh& mesh, const View& view, const Image& frame,
                                         const RasterizeOptions& options) {
    const auto expected = rasterize(mesh, view, options);
    EXPECT_TRUE(expected);
    const std::vector<bool> far = farFromEdges(mesh, view);
    FrameDifference result;
    size_t bad = 0;
    for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x) {
            double off = 0;
            for (int c = 0; c < mesh.channels(); ++c)
                off =
                    std::max(off, 255 * std::abs(double(frame.at(x, y, c)) - double(expected->at(x, y, c))));
            bad += !(off <= FrameDifference::kTolerance);
            result.worst = std::max(result.worst, off);
            if (!far[size_t(y) * size_t(view.width) + size_t(x)]) continue;
            result.inside.push_back(off);
            result.worstInside = std::max(result.worstInside, off);
        }
    result.badShare = double(bad) / (double(view.width) * view.height);
    return result;
}

// The rule of the two renderers: 99.9 % of the pixels within the tolerance, and all away from edges; with
// four samples, whose mean is taken to second order, there within half as much again. Where features are
// blurred, one pixel in ten thousand may lie where the nearest feature changes, which rounding decides.
inline void expectSamePicture(const PatchMesh& mesh, const View& view, const render::DrawOptions& options) {
    const Image frame = drawOffscreen(mesh, view, options);
    const FrameDifference difference =
        differenceFromCpu(mesh, view, frame, {options.samples, options.sharpen});
    EXPECT_LE(difference.badShare, .001) << "worst " << difference.worst;
    const double inside = (options.samples == 1 ? 1 : 1.5) * FrameDifference::kTolerance;
    const double ties = options.sharpen > 0 ? 1e-4 * view.width * view.height : 0;
    EXPECT_LE(double(std::count_if(difference.inside.begin(), difference.inside.end(),
                                   [&](double off) { return off > inside; })),
              ties)
        << "worst " << difference.worstInside;
}

// Part of a mesh's picture at `zoom`, around its middle but on no round coordinate.
inline View zoomedView(const PatchMesh& mesh, double zoom, int width, int height) {
    View view;
    view.scale = {zoom, zoom};
    view.width = width;
    view.height = height;
    view.origin = glm::dvec2(mesh.width() * .47, mesh.height() * .43) -
                  glm::dvec2(width, height) * .5 / zoom + glm::dvec2(.1234, .3777) / zoom;
    return view;
}

}  // namespace tessera::testing
