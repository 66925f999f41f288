// The initial channel meshes of pictures of a few pixels, checked by hand.
#include "core/vectorize/initial_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/mesh/mesh_validate.h"

namespace tessera {
namespace {

using ::testing::IsEmpty;

constexpr int kPx = kLatticePerPixel;

ChannelMeshes build(const Image& image, const std::vector<PixelChain>& features = {}, double fairing = 0) {
    VectorizeSettings settings;
    settings.fairingRadiusPx = fairing;
    StageReport report;
    Progress progress;
    auto meshes = buildInitialMesh(image, features, settings, report, progress);
    EXPECT_TRUE(meshes.has_value());
    return meshes ? *meshes : ChannelMeshes{};
}

Image verticalStep(int width, int height, int firstBright) {
    Image image(width, height, 3, .25F);
    for (int c = 0; c < 3; ++c)
        for (int y = 0; y < height; ++y)
            for (int x = firstBright; x < width; ++x) image.at(x, y, c) = .75F;
    return image;
}

// The pixels of a column, downwards. The normal of that direction points to the left.
PixelChain column(int x, int top, int bottom, bool onLeft) {
    PixelChain chain;
    for (int y = top; y <= bottom; ++y) chain.pixels.emplace_back(x, y);
    chain.onPositiveSide = onLeft;
    return chain;
}

// Whether a pixel belongs to the square [low, high]^2 without its four corner pixels.
bool inBlunted(int x, int y, int low, int high) {
    const bool corner = (x == low || x == high) && (y == low || y == high);
    return x >= low && x <= high && y >= low && y <= high && !corner;
}

// The closed ring of the outermost pixels of that blunted square (a chain has no right angles), to the right
// along its top: inside is positive.
PixelChain ring(int low, int high, bool inside) {
    PixelChain chain;
    chain.closed = true;
    chain.onPositiveSide = inside;
    for (int k = low + 1; k < high; ++k) chain.pixels.emplace_back(k, low);
    for (int k = low + 1; k < high; ++k) chain.pixels.emplace_back(high, k);
    for (int k = high - 1; k > low; --k) chain.pixels.emplace_back(k, high);
    for (int k = high - 1; k > low; --k) chain.pixels.emplace_back(low, k);
    return chain;
}

// What holds for every initial mesh: sound connectivity, positive triangles that cover the picture, copies
// that belong to their vertices, and the same sector of faces on one copy.
void expectSound(const ChannelMeshes& m) {
    EXPECT_THAT(connectivityViolations(m.mesh), IsEmpty());
    ASSERT_EQ(m.positions.size(), m.mesh.vertexCapacity());
    ASSERT_EQ(m.kinds.size(), m.positions.size());
    ASSERT_EQ(m.copyOfCorner.size(), 2 * m.mesh.edgeCapacity());
    ASSERT_EQ(m.partOfEdge.size(), m.mesh.edgeCapacity());
    int64_t area2 = 0;
    for (uint32_t f = 0; f < m.mesh.faceCapacity(); ++f) {
        const auto c = m.mesh.corners(FaceId(f));
        const LatticePoint a = m.positions[c[0].index];
        const int64_t twice = cross(m.positions[c[1].index] - a, m.positions[c[2].index] - a);
        EXPECT_GT(twice, 0) << "face " << f;
        area2 += twice;
    }
    EXPECT_EQ(area2, 2 * int64_t(m.width) * m.height * kPx * kPx);
    std::vector<VertexId> owner(m.copyCount());
    for (uint32_t h = 0; h < m.copyOfCorner.size(); ++h) {
        if (!m.mesh.face(HalfedgeId(h)).valid()) continue;
        const uint32_t copy = m.copyOfCorner[h];
        ASSERT_LT(copy, m.copyCount());
        if (owner[copy].valid()) {
            EXPECT_EQ(owner[copy], m.mesh.origin(HalfedgeId(h)));
        } else {
            owner[copy] = m.mesh.origin(HalfedgeId(h));
        }
        // Across an edge that is no feature, both faces see one copy of the origin.
        const HalfedgeId t = HalfedgeMesh::twin(HalfedgeId(h));
        if (m.mesh.face(t).valid() && !m.isFeature(HalfedgeMesh::edge(t))) {
            EXPECT_EQ(m.copyOfCorner[m.mesh.next(t).index], copy);
        }
    }
    for (const VertexId v : owner) EXPECT_TRUE(v.valid()) << "a copy that no face uses";
}

// The copies that the faces around a vertex use.
std::set<uint32_t> copiesAt(const ChannelMeshes& m, VertexId v) {
    std::set<uint32_t> copies;
    m.mesh.forEachOutgoing(v, [&](HalfedgeId h) {
        if (m.mesh.face(h).valid()) copies.insert(m.copyOfCorner[h.index]);
    });
    return copies;
}

TEST(InitialMesh, CountsWithoutFeatures) {
    for (const auto& [w, h] : {std::pair{1, 1}, {3, 2}, {1, 5}, {7, 4}}) {
        const ChannelMeshes m = build(Image(w, h, 3, .5F));
        expectSound(m);
        EXPECT_EQ(m.mesh.vertexCount(), size_t((w + 2) * (h + 2)));
        EXPECT_EQ(m.mesh.faceCount(), size_t(2 * (w + 1) * (h + 1)));
        EXPECT_EQ(m.copyCount(), m.mesh.vertexCount());
        EXPECT_THAT(m.chains, IsEmpty());
        EXPECT_EQ(std::count(m.kinds.begin(), m.kinds.end(), VertexKind::Corner), 4);
        EXPECT_EQ(std::count(m.kinds.begin(), m.kinds.end(), VertexKind::Border), 2 * (w + h));
        EXPECT_EQ(std::count(m.kinds.begin(), m.kinds.end(), VertexKind::Interior), w * h);
    }
}

TEST(InitialMesh, PixelCentresAndTheRingAroundThem) {
    Image image(2, 1, 3);
    for (int c = 0; c < 3; ++c) {
        image.at(0, 0, c) = .25F;
        image.at(1, 0, c) = .75F;
    }
    const ChannelMeshes m = build(image);
    const std::vector<LatticePoint> expected{{0, 0},   {128, 0},   {384, 0},   {512, 0},    // the top side
                                             {0, 128}, {128, 128}, {384, 128}, {512, 128},  // the pixels' row
                                             {0, 256}, {128, 256}, {384, 256}, {512, 256}};
    EXPECT_EQ(m.positions, expected);
    for (uint32_t v = 0; v < 12; ++v) EXPECT_EQ(m.heightsOf(v)[1], v % 4 < 2 ? .25F : .75F) << v;
}

TEST(InitialMesh, DiagonalsJoinTheMoreSimilarPixels) {
    // One of four pixels differs: the diagonal between the others.
    for (const bool rising : {false, true}) {
        Image image(2, 2, 3, 0);
        for (int c = 0; c < 3; ++c) image.at(!rising, 0, c) = 1;
        const ChannelMeshes m = build(image);
        expectSound(m);
        const VertexId a(5), b(6), c(9), d(10);  // of the inner cell: 4 vertices a row
        EXPECT_EQ(m.mesh.find(a, d).valid(), !rising);
        EXPECT_EQ(m.mesh.find(b, c).valid(), rising);
    }
}

// A chain of two pixels, (1, 1) and (1, 2), the discontinuity on its right. Diagonals of a flat picture fall
// ("\"). Fig. 3(d): the triangle with two subpixels becomes three, those with one become two.
TEST(InitialMesh, RetriangulationPatterns) {
    const Image flat(4, 4, 3, .5F);
    const ChannelMeshes m = build(flat, {column(1, 1, 2, false)});
    expectSound(m);
    ASSERT_EQ(m.chains.size(), 1U);
    ASSERT_EQ(m.chains[0].vertices.size(), 2U);
    EXPECT_EQ(m.positions[m.chains[0].vertices[0].index], (LatticePoint{2 * kPx, 2 * kPx}))
        << "on the diagonal";
    EXPECT_EQ(m.positions[m.chains[0].vertices[1].index], (LatticePoint{2 * kPx, 5 * kPx / 2}))
        << "on the row";
    EXPECT_EQ(m.mesh.faceCount(), size_t(2 * 5 * 5 + 2 + 1 + 1));
    // The triangle of both: pixels (1, 1), (2, 2), (1, 2), which are the vertices 14, 21 and 20.
    const VertexId first = m.chains[0].vertices[0], second = m.chains[0].vertices[1];
    const HalfedgeId between = m.mesh.find(first, second);
    ASSERT_TRUE(between.valid());
    EXPECT_TRUE(m.mesh.find(first, VertexId(14)).valid());
    EXPECT_TRUE(m.mesh.find(first, VertexId(21)).valid());
    EXPECT_TRUE(m.mesh.find(second, VertexId(20)).valid());
    EXPECT_TRUE(m.mesh.find(second, VertexId(21)).valid());
    EXPECT_FALSE(m.mesh.find(VertexId(14), VertexId(21)).valid()) << "cut";
    EXPECT_FALSE(m.mesh.find(VertexId(20), VertexId(21)).valid()) << "cut";
}

// Each subpixel cuts one edge: one more vertex, one more triangle on either side of it.
TEST(InitialMesh, EachSubpixelAddsTwoTriangles) {
    const ChannelMeshes m = build(verticalStep(8, 12, 4), {column(3, 1, 10, false)});
    expectSound(m);
    const size_t n = m.chains[0].vertices.size();
    EXPECT_EQ(m.mesh.vertexCount(), 10 * 14 + n);
    EXPECT_EQ(m.mesh.faceCount(), 2 * 9 * 13 + 2 * n);
    for (const VertexId v : m.chains[0].vertices)
        EXPECT_EQ(m.positions[v.index].x, 4 * kPx) << "between the columns";
}

TEST(InitialMesh, DualVerticesHaveTheColoursOfTheirSides) {
    for (const int x : {3, 4}) {  // the detected pixels on either side of the step between columns 3 and 4
        const ChannelMeshes m = build(verticalStep(8, 12, 4), {column(x, 1, 10, x == 4)});
        expectSound(m);
        const auto& vertices = m.chains[0].vertices;
        EXPECT_EQ(m.copyCount(), m.mesh.vertexCount() + vertices.size() - 2);
        for (size_t k = 0; k < vertices.size(); ++k) {
            const VertexId v = vertices[k];
            EXPECT_EQ(m.positions[v.index].x, 4 * kPx);
            const bool tip = k == 0 || k + 1 == vertices.size();
            EXPECT_EQ(m.kinds[v.index], tip ? VertexKind::FeatureEnd : VertexKind::Feature);
            EXPECT_EQ(copiesAt(m, v).size(), tip ? 1U : 2U);
            m.mesh.forEachOutgoing(v, [&](HalfedgeId h) {
                const float height = m.heightsOf(m.copyOfCorner[h.index])[0];
                if (tip) {
                    EXPECT_EQ(height, .5F) << "a tip stays in one piece";
                    return;
                }
                const auto c = m.mesh.corners(m.mesh.face(h));
                const int32_t middle =
                    m.positions[c[0].index].x + m.positions[c[1].index].x + m.positions[c[2].index].x;
                EXPECT_EQ(height, middle < 12 * kPx ? .25F : .75F);
            });
        }
    }
}

TEST(InitialMesh, PartsRunAlongTheChain) {
    const ChannelMeshes m = build(verticalStep(8, 12, 4), {column(3, 1, 10, false)});
    const auto& chain = m.chains[0];
    ASSERT_EQ(m.parts.size(), chain.vertices.size() - 1);
    for (uint32_t k = 0; k + 1 < chain.vertices.size(); ++k) {
        const HalfedgeId h = m.mesh.find(chain.vertices[k], chain.vertices[k + 1]);
        ASSERT_TRUE(h.valid());
        const ChainPart& part = m.parts[size_t(m.partOfEdge[HalfedgeMesh::edge(h).index])];
        EXPECT_EQ(part.chain, 0U);
        EXPECT_EQ(part.from, k);
        EXPECT_EQ(part.to, k + 1);
    }
    EXPECT_EQ(std::count_if(m.partOfEdge.begin(), m.partOfEdge.end(), [](int32_t p) { return p >= 0; }),
              int64_t(m.parts.size()));
}

TEST(InitialMesh, AClosedChainIsDualEverywhere) {
    // A bright blunted square and the ring of its outermost pixels: the step lies outside them.
    Image image(12, 12, 3, .25F);
    for (int c = 0; c < 3; ++c)
        for (int y = 3; y <= 8; ++y)
            for (int x = 3; x <= 8; ++x)
                if (inBlunted(x, y, 3, 8)) image.at(x, y, c) = .75F;
    const ChannelMeshes m = build(image, {ring(3, 8, false)});
    expectSound(m);
    ASSERT_EQ(m.chains.size(), 1U);
    EXPECT_TRUE(m.chains[0].closed);
    EXPECT_EQ(m.parts.size(), m.chains[0].vertices.size());
    EXPECT_EQ(m.copyCount(), m.mesh.vertexCount() + m.chains[0].vertices.size());
    for (const VertexId v : m.chains[0].vertices) {
        EXPECT_EQ(m.kinds[v.index], VertexKind::Feature);
        std::set<float> heights;
        for (const uint32_t copy : copiesAt(m, v)) heights.insert(m.heightsOf(copy)[0]);
        EXPECT_EQ(heights, (std::set<float>{.25F, .75F}));
        const glm::dvec2 p = toPixels(m.positions[v.index]) - 6.0;
        EXPECT_LE(std::max(std::abs(p.x), std::abs(p.y)), 3);
        EXPECT_GE(std::max(std::abs(p.x), std::abs(p.y)), 2.5) << "half a pixel outside the ring's pixels";
    }
    // The other side of the same ring: a smaller square.
    const ChannelMeshes inner = build(image, {ring(3, 8, true)});
    expectSound(inner);
    for (const VertexId v : inner.chains[0].vertices) {
        const glm::dvec2 p = toPixels(inner.positions[v.index]) - 6.0;
        EXPECT_NEAR(std::max(std::abs(p.x), std::abs(p.y)), 2, 1e-12);
    }
}

TEST(InitialMesh, SeveralChains) {
    const ChannelMeshes m = build(Image(12, 12, 3, .5F),
                                  {column(2, 1, 10, false), column(5, 1, 10, true), column(8, 2, 9, true)});
    expectSound(m);
    EXPECT_EQ(m.chains.size(), 3U);
    std::set<uint32_t> all;
    size_t count = 0;
    for (const SubpixelChain& chain : m.chains) {
        count += chain.vertices.size();
        for (const VertexId v : chain.vertices) all.insert(v.index);
    }
    EXPECT_EQ(all.size(), count);
}

// A noisy step in a closed ring, so that no tip joins the sides.
TEST(InitialMesh, FairingKeepsConstantsAndSides) {
    Image image(14, 14, 3, .2F), noisy = image;
    for (int c = 0; c < 3; ++c)
        for (int y = 0; y < 14; ++y)
            for (int x = 0; x < 14; ++x) {
                image.at(x, y, c) = inBlunted(x, y, 4, 9) ? .8F : .2F;
                noisy.at(x, y, c) = image.at(x, y, c) + ((x + y) % 2 ? .02F : -.02F);
            }
    const auto feature = ring(4, 9, false);
    const ChannelMeshes plain = build(image, {feature}), faired = build(image, {feature}, 2);
    ASSERT_EQ(plain.heights.size(), faired.heights.size());
    for (size_t i = 0; i < plain.heights.size(); ++i) EXPECT_NEAR(faired.heights[i], plain.heights[i], 1e-6);

    const ChannelMeshes before = build(noisy, {feature}), after = build(noisy, {feature}, 2);
    double off = 0, offBefore = 0;
    size_t moved = 0;
    for (size_t i = 0; i < before.heights.size(); ++i) {
        const float clean = plain.heights[i];
        EXPECT_NEAR(after.heights[i], clean, .03) << "the other side is .6 away";
        if (after.heights[i] == before.heights[i]) continue;
        ++moved;
        off += std::abs(double(after.heights[i] - clean));
        offBefore += std::abs(double(before.heights[i] - clean));
    }
    EXPECT_GT(moved, 100U);
    EXPECT_LT(off, .75 * offBefore);
    // A corner of the picture is far from the feature.
    EXPECT_EQ(after.heights[0], before.heights[0]);
}

TEST(InitialMesh, ChannelsDifferInHeightsAlone) {
    Image image(9, 12, 3), turned(9, 12, 3);
    for (int c = 0; c < 3; ++c)
        for (int y = 0; y < 12; ++y)
            for (int x = 0; x < 9; ++x) {
                const float value = x > 4 ? .1F * float(c + 1) : .05F * float((x * 3 + y * 5 + c * 7) % 11);
                image.at(x, y, c) = value;
                turned.at(x, y, (c + 1) % 3) = value;
            }
    const ChannelMeshes a = build(image, {column(4, 1, 10, false)}),
                        b = build(turned, {column(4, 1, 10, false)});
    expectSound(a);
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.copyOfCorner, b.copyOfCorner);
    EXPECT_EQ(a.partOfEdge, b.partOfEdge);
    for (uint32_t copy = 0; copy < a.copyCount(); ++copy)
        for (size_t c = 0; c < 3; ++c) EXPECT_EQ(a.heightsOf(copy)[c], b.heightsOf(copy)[(c + 1) % 3]);
}

TEST(InitialMesh, FourChannels) {
    Image image(5, 4, 4, .5F);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 5; ++x) image.at(x, y, 3) = .2F * float(x);
    const ChannelMeshes m = build(image);
    EXPECT_EQ(m.channels, 4);
    EXPECT_EQ(m.copyCount(), 7U * 6);
    EXPECT_EQ(m.heightsOf(7 + 3)[3], .4F) << "pixel (2, 0)";
}

}  // namespace
}  // namespace tessera
