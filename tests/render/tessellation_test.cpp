// Patches are tessellated without gaps: the points on an edge are the same bits from both of its sides, at
// every zoom and where one side is presplit and the other is not.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "render/lod_pass.h"
#include "render/patch_buffers.h"
#include "render/shader_library.h"
#include "tests/support/gl.h"
#include "tests/support/test_meshes.h"

namespace tessera::render {
namespace {

// What the tessellation hands to the rasterizer for each corner of a triangle.
struct Corner {
    glm::vec4 position;
    glm::vec2 parameters;
    uint32_t patch;
    bool operator==(const Corner&) const = default;
};
static_assert(sizeof(Corner) == 28);

class Tessellation : public testing::GlTest {
  protected:
    // All corners of all triangles of a view.
    std::vector<Corner> tessellate(const PatchMesh& mesh, const View& view) {
        const VertexArray vertexArray = makeVertexArray();
        glBindVertexArray(vertexArray.name());
        PatchBuffers buffers;
        buffers.setMesh(mesh, 0);
        buffers.upload();
        auto lod = LodPass::create();
        EXPECT_TRUE(lod);
        GpuView block = gpuView(mesh, view, 1, {0, 0});
        block.patchCount = uint32_t(buffers.patchCount());
        block.edgeCount = uint32_t(buffers.edgeCount());
        lod->plan(block);
        Buffer viewBlock;
        viewBlock.reserve(sizeof(block));
        viewBlock.write(0, &block, sizeof(block));
        glBindBufferBase(GL_UNIFORM_BUFFER, 0, viewBlock.name());
        buffers.bind();
        const PieceDraws draws = lod->run(block);
        mLevels.assign(block.edgeCount, 0);
        lod->edgeLevels().read(std::span(mLevels));

        auto program = makeProgram(
            std::array<std::string_view, 4>{"patch.vert", "patch.tesc", "patch.tese", "patch.frag"});
        EXPECT_TRUE(program);
        const char* const outputs[] = {"gl_Position", "fParameters", "fPatch"};
        glTransformFeedbackVaryings(program->name(), 3, outputs, GL_INTERLEAVED_ATTRIBS);
        glLinkProgram(program->name());
        glUseProgram(program->name());
        const OffscreenTarget target(1, 1);  // nothing is drawn into it, but there has to be one
        target.bind();
        constexpr size_t kMost = 1 << 20;
        Buffer feedback;
        feedback.reserve(kMost * sizeof(Corner));
        glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, feedback.name());
        GLuint query = 0, triangles = 0;
        glCreateQueries(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN, 1, &query);
        glEnable(GL_RASTERIZER_DISCARD);
        glPatchParameteri(GL_PATCH_VERTICES, 1);
        glBindBuffer(GL_DRAW_INDIRECT_BUFFER, draws.commands);
        glBeginQuery(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN, query);
        glBeginTransformFeedback(GL_TRIANGLES);
        glMultiDrawArraysIndirect(GL_PATCHES, reinterpret_cast<const void*>(draws.offset), draws.count, 0);
        glEndTransformFeedback();
        glEndQuery(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN);
        glDisable(GL_RASTERIZER_DISCARD);
        glGetQueryObjectuiv(query, GL_QUERY_RESULT, &triangles);
        glDeleteQueries(1, &query);
        EXPECT_LT(3 * triangles, kMost);
        std::vector<Corner> corners(3 * triangles);
        if (!corners.empty()) feedback.read(std::span(corners));
        return corners;
    }

    // The positions on each halfedge by the parameter along its edge.
    using Points = std::map<float, std::set<std::pair<float, float>>>;
    static std::map<uint32_t, Points> pointsOnSides(const PatchMesh& mesh,
                                                    const std::vector<Corner>& corners) {
        std::map<uint32_t, Points> result;
        for (const Corner& corner : corners) {
            const float v = corner.parameters.x, w = corner.parameters.y;
            const bool on[3] = {w == 0, v + w == 1, v == 0};
            const float along[3] = {v, w, 1 - w};
            const auto sides = mesh.connectivity().sides(PatchId(corner.patch));
            for (size_t s = 0; s < 3; ++s) {
                if (!on[s]) continue;
                const bool forward = HalfedgeMesh::halfedge(HalfedgeMesh::edge(sides[s])) == sides[s];
                result[sides[s].index][forward ? along[s] : 1 - along[s]].insert(
                    {corner.position.x, corner.position.y});
            }
        }
        return result;
    }

    // How many edges between drawn patches have other points from one side than from the other.
    static size_t unequalEdges(const std::map<uint32_t, Points>& points, size_t& compared) {
        size_t unequal = 0;
        compared = 0;
        for (const auto& [halfedge, here] : points) {
            const auto twin = points.find(halfedge ^ 1);
            if ((halfedge & 1) != 0 || twin == points.end()) continue;
            ++compared;
            bool same = here == twin->second;
            for (const auto& [t, at] : here) same = same && at.size() == 1;
            unequal += !same;
        }
        return unequal;
    }

    std::vector<uint32_t> mLevels;
};

TEST_F(Tessellation, EdgesHaveTheSamePointsFromBothSides) {
    const PatchMesh mesh = testing::curvedMesh(300, 220, 9, 7, 12);
    for (const double zoom : {1.0, 3.7, 8.0}) {
        const View view = wholePicture(mesh, {zoom, zoom});
        const auto points = pointsOnSides(mesh, tessellate(mesh, view));
        size_t compared = 0;
        EXPECT_EQ(unequalEdges(points, compared), 0U) << zoom;
        EXPECT_GT(compared, 100U);
        for (const auto& [halfedge, here] : points)
            EXPECT_EQ(here.size(), (size_t{1} << mLevels[halfedge >> 1]) + 1) << zoom;
    }
}

TEST_F(Tessellation, TheComparisonFindsAMovedPoint) {
    const PatchMesh mesh = testing::curvedMesh(300, 220, 9, 7, 12);
    auto points = pointsOnSides(mesh, tessellate(mesh, testing::zoomedView(mesh, 1, 400, 300)));
    const auto shared = std::find_if(points.begin(), points.end(),
                                     [&](const auto& side) { return points.contains(side.first ^ 1); });
    ASSERT_NE(shared, points.end());
    const auto old = *shared->second.begin()->second.begin();
    shared->second.begin()->second = {{std::nextafter(old.first, 9.0F), old.second}};
    size_t compared = 0;
    EXPECT_EQ(unequalEdges(points, compared), 1U);
}

// A patch that fills the view many times over is split, and its neighbours, which may not be, agree with it.
TEST_F(Tessellation, PresplitPatchesMeetOthersWithoutGaps) {
    const PatchMesh mesh = testing::curvedMesh(300, 220, 3, 2, 12);
    for (const double zoom : {100.0, 1000.0}) {
        const HalfedgeMesh& c = mesh.connectivity();
        size_t deep = 0;
        mesh.forEachEdge([&](EdgeId e) {
            if (c.onBorder(e)) return;
            View view;
            view.scale = {zoom, zoom};
            view.width = 300;
            view.height = 200;
            view.origin =
                toPixels(mesh.controlPoints(HalfedgeMesh::halfedge(e))).at(.37) - glm::dvec2(150, 100) / zoom;
            const auto points = pointsOnSides(mesh, tessellate(mesh, view));
            deep += mLevels[e.index] > 6;
            // Pieces out of view are left out, so that the points in view are compared.
            const auto inView = [&](uint32_t halfedge) {
                Points seen;
                const auto found = points.find(halfedge);
                if (found == points.end()) return seen;
                for (const auto& [t, at] : found->second)
                    for (const auto& [x, y] : at)
                        if (std::abs(x) <= 1 && std::abs(y) <= 1) seen[t].insert({x, y});
                return seen;
            };
            const Points here = inView(2 * e.index), there = inView(2 * e.index + 1);
            EXPECT_EQ(here, there) << e.index << " at x" << zoom;
            for (const auto& [t, at] : here) EXPECT_EQ(at.size(), 1U);
        });
        EXPECT_GT(deep, 0U) << zoom;
    }
}

TEST_F(Tessellation, LevelsFollowFlatness) {
    const PatchMesh straight = testing::gridMesh(300, 220, 9, 7),
                    curved = testing::curvedMesh(300, 220, 9, 7, 12);
    const View whole = wholePicture(curved, {1, 1});
    EXPECT_EQ(tessellate(straight, whole).size(), 3 * straight.patchCount());
    for (const uint32_t level : mLevels) EXPECT_EQ(level, 0U);
    const size_t coarse = tessellate(curved, whole).size();
    const size_t fine = tessellate(curved, wholePicture(curved, {8, 8})).size();
    EXPECT_GT(coarse, 3 * curved.patchCount());
    EXPECT_GT(fine, 2 * coarse);
    // Nothing is drawn of what is out of view.
    View beside = whole;
    beside.origin.x = 1000;
    EXPECT_EQ(tessellate(curved, beside).size(), 0U);
}

}  // namespace
}  // namespace tessera::render
