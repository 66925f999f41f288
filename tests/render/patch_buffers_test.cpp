// What an edit uploads follows the patches that it touches.
#include "render/patch_buffers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/gl.h"
#include "tests/support/test_meshes.h"

namespace tessera::render {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(Coalesced, JoinsWhatLiesNear) {
    std::vector<uint32_t> indices{40, 3, 4, 4, 20, 12, 5};
    EXPECT_THAT(coalesced(indices, 100, 8), ElementsAre(IndexRange{3, 21}, IndexRange{40, 41}));
    std::vector<uint32_t> apart{0, 2};
    EXPECT_THAT(coalesced(apart, 100, 0), ElementsAre(IndexRange{0, 1}, IndexRange{2, 3}));
    std::vector<uint32_t> none;
    EXPECT_THAT(coalesced(none, 100, 8), IsEmpty());
}

TEST(Coalesced, LeavesOutWhatIsGone) {
    std::vector<uint32_t> indices{2, 9, 10, 11};
    EXPECT_THAT(coalesced(indices, 10, 8), ElementsAre(IndexRange{2, 10}));
    EXPECT_THAT(coalesced(indices, 2, 8), IsEmpty());
}

class MirrorBufferTest : public testing::GlTest {};

TEST_F(MirrorBufferTest, UploadsNothingBeyondItsEndAfterGrowingAndShrinking) {
    MirrorBuffer<glm::ivec4> buffer(GL_RGBA32I);
    buffer.resize(64);
    buffer.upload();
    buffer.resize(4);
    buffer.upload();
    buffer.resize(40);
    buffer.resize(6);
    EXPECT_EQ(buffer.upload(), 2 * sizeof(glm::ivec4));
}

TEST(TermHeapTest, RunsAreApartAndUsedAgain) {
    TermHeap heap;
    const TermHeap::Run a = heap.fit({}, 5), b = heap.fit({}, 7);
    EXPECT_GE(a.room, 5U);
    EXPECT_GE(b.first, a.first + a.room);
    EXPECT_EQ(heap.fit(a, a.room).first, a.first);  // it fits
    const TermHeap::Run larger = heap.fit(a, a.room + 1);
    EXPECT_GE(larger.first, b.first + b.room);
    EXPECT_EQ(heap.fit({}, 5).first, a.first);  // given back
    EXPECT_EQ(heap.size(), larger.first + larger.room);
}

class UploadedBytes : public testing::GlTest {
  protected:
    // The bytes that the frame after an edit uploads.
    size_t bytesFor(Renderer& renderer) {
        const OffscreenTarget target(32, 32);
        target.bind();
        View view;
        view.width = view.height = 32;
        EXPECT_TRUE(renderer.draw(view));
        return renderer.uploadedBytes();
    }
};

// Blurred features near a column of the mesh alone.
PatchMesh largeMesh() {
    PatchMesh mesh = testing::curvedMesh(600, 400, 40, 25, 4);
    mesh.forEachEdge([&](EdgeId e) {
        EdgeCurve curve = mesh.curve(e);
        const bool left =
            toPixels(mesh.position(mesh.connectivity().origin(HalfedgeMesh::halfedge(e)))).x < 150;
        curve.feature = curve.feature && left;
        if (curve.feature) curve.blurSigma = {1, 1};
        mesh.setCurve(e, curve);
    });
    return mesh;
}

TEST_F(UploadedBytes, FollowThePatchesTouched) {
    PatchMesh mesh = largeMesh();
    auto renderer = Renderer::create();
    ASSERT_TRUE(renderer);
    renderer->setMesh(mesh);
    EXPECT_GT(bytesFor(*renderer), 1000000U);
    EXPECT_EQ(bytesFor(*renderer), 0U);

    // Colours of a patch: its record and its terms.
    const PatchId p(900);
    PatchSpline spline = mesh.spline(p);
    for (float& c : spline.coefficients) c *= .5F;
    mesh.setSpline(p, spline);
    renderer->update(mesh, std::array{p});
    const size_t recoloured = bytesFor(*renderer);
    EXPECT_GE(recoloured, sizeof(GpuPatch));
    EXPECT_LE(recoloured, sizeof(GpuPatch) + 20 * sizeof(GpuTerm));

    // The same values again: nothing.
    renderer->update(mesh, std::array{p});
    EXPECT_EQ(bytesFor(*renderer), 0U);

    // A vertex far from features, and one among them.
    for (const double x : {500.0, 70.0}) {
        VertexId moved;
        mesh.forEachVertex([&](VertexId v) {
            const glm::dvec2 at = toPixels(mesh.position(v));
            if (std::abs(at.x - x) < 10 && std::abs(at.y - 200) < 10) moved = v;
        });
        ASSERT_TRUE(moved.valid());
        mesh.setPosition(moved, mesh.position(moved) + LatticePoint{40, 30});
        std::vector<PatchId> around;
        mesh.connectivity().forEachOutgoing(
            moved, [&](HalfedgeId h) { around.push_back(mesh.connectivity().face(h)); });
        renderer->update(mesh, around);
        const size_t bytes = bytesFor(*renderer);
        EXPECT_GE(bytes, around.size() * sizeof(GpuEdge));
        EXPECT_LE(bytes, around.size() * (x > 150 ? 1000U : 8000U)) << x;
    }
}

}  // namespace
}  // namespace tessera::render
