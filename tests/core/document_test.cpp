// The document codec: what comes back, what is refused, and that storing a second time changes nothing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>

#include "core/document/chunk_file.h"
#include "core/document/codec.h"
#include "core/document/colour_codec.h"
#include "core/document/site_basis.h"
#include "core/document/xxhash64.h"
#include "tests/support/random_documents.h"

namespace tessera {
namespace {

using ::testing::AnyOf;
using testing::curvedMesh;
using testing::gridMesh;
using ::testing::HasSubstr;
using testing::richDocument;
using testing::siteMesh;

std::vector<uint8_t> encoded(Document& d) {
    auto bytes = encodeDocument(d);
    EXPECT_TRUE(bytes) << bytes.error().message;
    return bytes ? *bytes : std::vector<uint8_t>();
}

Document decoded(const std::vector<uint8_t>& bytes) {
    auto d = decodeDocument(bytes);
    EXPECT_TRUE(d) << d.error().message;
    return d ? *d : Document();
}

// A patch as geometry alone: what must be the same whatever its number.
struct PatchShape {
    LatticeTriangle points;
    std::array<bool, 3> features{};
    std::array<std::array<float, 2>, 3> blurs{};  // along the side
    auto key() const { return std::pair(points.p, features); }
    bool operator<(const PatchShape& o) const { return key() < o.key(); }
};

PatchShape shapeOf(const PatchMesh& mesh, PatchId p) {
    PatchShape shape{mesh.controlPoints(p), {}, {}};
    const auto sides = mesh.connectivity().sides(p);
    for (size_t s = 0; s < 3; ++s) {
        const EdgeCurve& curve = mesh.curve(HalfedgeMesh::edge(sides[s]));
        shape.features[s] = curve.feature;
        shape.blurs[s] = curve.blurSigma;
        if (HalfedgeMesh::halfedge(HalfedgeMesh::edge(sides[s])) != sides[s])
            std::swap(shape.blurs[s][0], shape.blurs[s][1]);
    }
    return shape;
}

double largestColourChange(const PatchSpline& a, const PatchSpline& b, int channels) {
    double largest = 0;
    for (int i = 0; i <= 24; ++i)
        for (int j = 0; i + j <= 24; ++j) {
            const glm::dvec2 at = domainPoint({1 - (i + j) / 24.0, i / 24.0, j / 24.0});
            for (int c = 0; c < channels; ++c)
                largest = std::max(largest, std::abs(evaluateSpline(a, c, at) - evaluateSpline(b, c, at)));
        }
    return largest;
}

TEST(Checksum, IsXxh64) {
    const auto hash = [](std::string_view text) {
        return xxhash64({reinterpret_cast<const uint8_t*>(text.data()), text.size()});
    };
    EXPECT_EQ(hash(""), 0xEF46DB3751D8E999u);
    EXPECT_EQ(hash("a"), 0xD24EC4F1A98C6E5Bu);
    EXPECT_EQ(hash("abc"), 0x44BC2CF5AD770999u);
    EXPECT_EQ(hash("Nobody inspects the spammish repetition"), 0xFBCEA83C8A378BF1u);
}

TEST(Document, KeepsEveryPatch) {
    for (const unsigned seed : {1u, 2u, 3u, 4u}) {
        Document d = richDocument(seed, seed % 2 == 0 ? 4 : 3, seed > 2 ? 30 : 0);
        const Document back = decoded(encoded(d));
        ASSERT_EQ(back.mesh.patchCount(), d.mesh.patchCount());
        EXPECT_EQ(back.mesh.connectivity().edgeCount(), d.mesh.connectivity().edgeCount());
        EXPECT_EQ(back.mesh.connectivity().vertexCount(), d.mesh.connectivity().vertexCount());
        EXPECT_EQ(back.mesh.smoothJoins().size(), d.mesh.smoothJoins().size());
        std::map<PatchShape, PatchId> originals;
        d.mesh.forEachPatch([&](PatchId p) { originals[shapeOf(d.mesh, p)] = p; });
        ASSERT_EQ(originals.size(), d.mesh.patchCount());
        back.mesh.forEachPatch([&](PatchId p) {
            const PatchShape shape = shapeOf(back.mesh, p);
            const auto original = originals.find(shape);
            ASSERT_NE(original, originals.end());
            for (size_t s = 0; s < 3; ++s)
                for (size_t i = 0; i < 2; ++i)
                    EXPECT_NEAR(shape.blurs[s][i], original->first.blurs[s][i], .5001 / 256);
            const PatchSpline& spline = d.mesh.spline(original->second);
            EXPECT_EQ(back.mesh.spline(p).terms, spline.terms);
            EXPECT_LE(largestColourChange(back.mesh.spline(p), spline, d.mesh.channels()), .1 / 255);
        });
    }
}

TEST(Document, KeepsSmoothJoins) {
    Document d = richDocument(5, 3, 25);
    const Document back = decoded(encoded(d));
    const auto places = [](const PatchMesh& mesh) {
        std::vector<std::array<LatticePoint, 3>> all;
        const HalfedgeMesh& c = mesh.connectivity();
        for (const SmoothJoin& join : mesh.smoothJoins()) {
            std::array<LatticePoint, 2> inner;
            for (size_t i = 0; i < 2; ++i) {
                const HalfedgeId h = HalfedgeMesh::halfedge(i == 0 ? join.first : join.second);
                const auto points =
                    mesh.controlPoints(c.origin(h) == join.vertex ? h : HalfedgeMesh::twin(h));
                EXPECT_EQ(points[0], mesh.position(join.vertex));
                inner[i] = points[1];
            }
            std::sort(inner.begin(), inner.end());
            all.push_back({mesh.position(join.vertex), inner[0], inner[1]});
        }
        std::sort(all.begin(), all.end());
        return all;
    };
    ASSERT_FALSE(d.mesh.smoothJoins().empty());
    EXPECT_EQ(places(back.mesh), places(d.mesh));
}

TEST(Document, KeepsAllThatIsNotMesh) {
    Document d = richDocument(6);
    const Document back = decoded(encoded(d));
    EXPECT_EQ(back.settings, d.settings);
    EXPECT_EQ(back.report, d.report);
    EXPECT_EQ(back.source, d.source);
    EXPECT_EQ(back.colourStep, d.colourStep);
    EXPECT_EQ(back.unknownChunks, d.unknownChunks);
    ASSERT_TRUE(back.difference);
    EXPECT_EQ(back.difference->psnr, 31.25);
    EXPECT_EQ(back.difference->ssim, .875);
    ASSERT_TRUE(back.embeddedSource && back.previewPng);
    EXPECT_EQ(*back.embeddedSource, *d.embeddedSource);
    EXPECT_EQ(*back.previewPng, *d.previewPng);
}

TEST(Document, StoredTwiceIsTheSameBytes) {
    for (unsigned seed = 10; seed < 30; ++seed) {
        Document d = richDocument(seed, seed % 2 == 0 ? 4 : 3, int(seed % 3) * 20);
        const auto bytes = encoded(d);
        Document back = decoded(bytes);
        ASSERT_EQ(encoded(back), bytes) << seed;
        Document again = decoded(encoded(back));
        EXPECT_EQ(encoded(again), bytes) << seed;
    }
}

TEST(Document, WithSitesStoredTwiceIsTheSameBytes) {
    for (unsigned seed = 10; seed < 30; ++seed) {
        Document d = richDocument(seed, seed % 2 == 0 ? 4 : 3, int(seed % 3) * 20, true);
        const auto bytes = encoded(d);
        Document back = decoded(bytes);
        EXPECT_EQ(back.mesh.colourBasis(), ColourBasis::Opponent);
        ASSERT_EQ(encoded(back), bytes) << seed;
        Document again = decoded(encoded(back));
        EXPECT_EQ(encoded(again), bytes) << seed;
    }
}

TEST(Document, WithSitesOnPlanesAloneStoredTwiceIsTheSameBytes) {
    for (const uint8_t terms : {uint8_t(0), uint8_t(3)}) {
        Document d;
        d.mesh = gridMesh(40, 30, 3, 3);
        d.mesh.forEachPatch([&](PatchId p) {
            PatchSpline spline;
            spline.sites = {0, 1, 2};
            for (int c = 0; c < 3; ++c) {
                spline.terms[size_t(c)] = terms;
                spline.coefficients.insert(spline.coefficients.end(), 3u + terms, 0.F);
                spline.coefficients[spline.offset(c)] = .5F;
            }
            d.mesh.setSpline(p, spline);
        });
        const auto bytes = encoded(d);
        Document back = decoded(bytes);
        EXPECT_EQ(encoded(back), bytes);
    }
}

TEST(Document, KeepsWildSplinesOnSitesExactly) {
    Document d;
    d.mesh = siteMesh(3, 3);
    const Document back = decoded(encoded(d));
    std::map<PatchShape, PatchId> originals;
    d.mesh.forEachPatch([&](PatchId p) { originals[shapeOf(d.mesh, p)] = p; });
    size_t wild = 0, onSites = 0;
    back.mesh.forEachPatch([&](PatchId p) {
        const PatchSpline& stored = back.mesh.spline(p);
        const PatchSpline& spline = d.mesh.spline(originals.at(shapeOf(back.mesh, p)));
        const bool corners = spline.sites.size() > 2 && spline.sites[0] == 0 && spline.sites[1] == 1;
        const double change = largestColourChange(spline, stored, 3);
        if (spline.maxTerms(3) > 0 && !corners) {
            ++wild;
            EXPECT_EQ(stored, spline);
        } else {
            ++onSites;
            // Without a known PSNR the error is that of 45 dB and 0.1 dB: a quarter of a level on the
            // average.
            EXPECT_LT(change, 4.0 / 255);
        }
    });
    EXPECT_GT(wild, 3u);
    EXPECT_GT(onSites, 50u);
}

TEST(Document, StoredTwiceIsTheSameBytesForColoursOfAnySize) {
    for (const float size : {1e-6f, .01f, 1.f, 7.f, 64.f, 1e4f, 1e12f, 3e37f}) {
        std::mt19937 random(7);
        Document d;
        d.mesh = curvedMesh(100, 80, 6, 5, 3);
        d.mesh.forEachPatch([&](PatchId p) {
            PatchSpline spline = testing::randomSpline(3, random);
            for (float& k : spline.coefficients) k *= size / 100;
            d.mesh.setSpline(p, spline);
        });
        const auto bytes = encoded(d);
        Document back = decoded(bytes);
        EXPECT_EQ(encoded(back), bytes) << size;
    }
}

TEST(Document, NumbersElementsByFormatAndKeepsThatNumbering) {
    // Decoded meshes are a fixed point: their ids do not move any more.
    Document d = richDocument(31, 3, 40);
    Document once = decoded(encoded(d));
    const Document twice = decoded(encoded(once));
    once.mesh.forEachPatch([&](PatchId p) {
        EXPECT_EQ(once.mesh.controlPoints(p).p, twice.mesh.controlPoints(p).p);
        EXPECT_EQ(once.mesh.spline(p), twice.mesh.spline(p));
    });
    once.mesh.forEachEdge([&](EdgeId e) { EXPECT_EQ(once.mesh.curve(e), twice.mesh.curve(e)); });
    once.mesh.forEachVertex([&](VertexId v) { EXPECT_EQ(once.mesh.position(v), twice.mesh.position(v)); });
    EXPECT_EQ(once.mesh.smoothJoins(), twice.mesh.smoothJoins());
}

TEST(ColourCodec, RoundingStaysWithinTheBound) {
    // The worst splines for the bound: nodal values off by half a step with the signs of a cardinal function.
    const double step = defaultColourStep();
    std::mt19937 random(11);
    double largest = 0;
    for (int i = 0; i < 400; ++i) {
        const int n = i % 14 + 3;
        const NodalBasis basis = nodalBasis(std::span(defaultCentres()).first(size_t(n)));
        PatchSpline spline;
        for (int c = 0; c < 3; ++c) {
            std::vector<double> values;
            for (int j = 0; j < n; ++j)
                values.push_back((double(random() % 2000) + (random() % 2 == 0 ? .499 : -.499)) * step);
            spline.terms[size_t(c)] = uint8_t(n);
            for (int r = 0; r < n + 3; ++r) {
                double sum = 0;
                for (int j = 0; j < n; ++j)
                    sum += basis.toCoefficients[size_t(r * n + j)] * values[size_t(j)];
                spline.coefficients.push_back(float(sum));
            }
        }
        const FileColour colour = quantized(spline, 3, step);
        EXPECT_FALSE(colour.exact);
        largest = std::max(largest, largestColourChange(spline, dequantized(colour, 3, step), 3));
    }
    EXPECT_LE(largest, kColourBound);
    EXPECT_GT(largest, .5 * kColourBound);  // so that the test does test
}

TEST(ColourCodec, KeepsSplinesThatBreakTheSideConditionsExactly) {
    PatchSpline spline;
    spline.terms = {16, 16, 16, 0};
    for (int i = 0; i < 3 * 19; ++i) spline.coefficients.push_back(float(i % 7) - 3);
    const FileColour colour = quantized(spline, 3, defaultColourStep());
    EXPECT_TRUE(colour.exact);
    EXPECT_EQ(dequantized(colour, 3, defaultColourStep()), spline);
}

TEST(Document, DropsUnsafeChunksAfterAnEdit) {
    Document d = richDocument(8);
    d.markEdited();
    ASSERT_EQ(d.unknownChunks.size(), 1u);
    EXPECT_TRUE(d.unknownChunks[0].safeToCopy);
    EXPECT_FALSE(d.previewPng);
    EXPECT_FALSE(d.difference);
    EXPECT_TRUE(d.embeddedSource);
}

TEST(Document, IsRefusedWithoutFiniteColours) {
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        Document d;
        d.mesh = gridMesh(10, 10, 2, 2);
        PatchSpline spline = d.mesh.spline(PatchId(3));
        spline.coefficients[1] = bad;
        d.mesh.setSpline(PatchId(3), spline);
        const auto bytes = encodeDocument(d);
        ASSERT_FALSE(bytes);
        EXPECT_EQ(bytes.error().code, ErrorCode::Internal);
        EXPECT_THAT(bytes.error().message, HasSubstr("not finite"));
    }
}

TEST(Document, IsRefusedWithSitesThatCannotBe) {
    for (const std::vector<uint8_t>& sites :
         {std::vector<uint8_t>{0, 1, 2, 3, 3}, std::vector<uint8_t>{0, 1, 2, 3, kCentreSites}}) {
        Document d;
        d.mesh = gridMesh(10, 10, 2, 2);
        PatchSpline spline = d.mesh.spline(PatchId(3));
        spline.sites = sites;
        d.mesh.setSpline(PatchId(3), spline);
        const auto bytes = encodeDocument(d);
        ASSERT_FALSE(bytes);
        EXPECT_THAT(bytes.error().message, HasSubstr("list of sites"));
    }
}

TEST(Document, IsRefusedWhereItCouldNotBeLoaded) {
    Document empty;
    EXPECT_FALSE(encodeDocument(empty));
    Document d;
    d.mesh = gridMesh(10, 10, 2, 2);
    d.mesh.setPosition(VertexId(0), {5, 5});
    EXPECT_FALSE(encodeDocument(d));
    d.mesh = gridMesh(10, 10, 2, 2);
    EdgeCurve curve = d.mesh.curve(EdgeId(2));
    curve.blurSigma = {-1, 0};
    d.mesh.setCurve(EdgeId(2), curve);
    EXPECT_FALSE(encodeDocument(d));
    d.mesh = gridMesh(10, 10, 2, 2);
    d.mesh.setSmoothJoins({{VertexId(0), EdgeId(0), EdgeId(0)}});
    EXPECT_FALSE(encodeDocument(d));
}

std::vector<Chunk> chunksOf(const std::vector<uint8_t>& bytes) {
    const auto chunks = unpackChunks(bytes, kFormatVersion);
    EXPECT_TRUE(chunks);
    return chunks ? *chunks : std::vector<Chunk>();
}

// Bytes of a small document, for damaging.
std::vector<uint8_t> smallDocument(bool sites = true) {
    Document d;
    d.mesh = sites ? siteMesh(4, 3, 0, 2, 2) : curvedMesh(32, 24, 2, 2, 5);
    d.unknownChunks = {{{'n', 'e', 'w', '1'}, true, {1, 2, 3}}};
    return encoded(d);
}

void expectRefused(const std::vector<uint8_t>& bytes, const std::string& what) {
    const auto d = decodeDocument(bytes);
    ASSERT_FALSE(d) << what;
    EXPECT_EQ(d.error().code, ErrorCode::DamagedDocument) << what;
    EXPECT_FALSE(d.error().message.empty());
}

TEST(DamagedDocument, IsRefusedAtEveryLength) {
    const auto bytes = smallDocument();
    for (size_t length = 0; length < bytes.size(); ++length)
        expectRefused({bytes.begin(), bytes.begin() + ptrdiff_t(length)}, "cut at " + std::to_string(length));
    auto longer = bytes;
    longer.push_back(0);
    expectRefused(longer, "longer");
}

TEST(DamagedDocument, IsRefusedWithAnyByteChanged) {
    const auto bytes = smallDocument();
    for (size_t at = 0; at < bytes.size(); ++at)
        for (const int flip : {0x01, 0x80, 0xFF}) {
            auto changed = bytes;
            changed[at] = uint8_t(changed[at] ^ flip);
            expectRefused(changed, "byte " + std::to_string(at));
        }
}

// The document with one chunk replaced and all checksums right: what gets past the container.
std::vector<uint8_t> withChunk(const std::vector<uint8_t>& bytes, const std::string& tag,
                               const std::vector<uint8_t>& content, uint32_t version = kFormatVersion) {
    auto chunks = chunksOf(bytes);
    for (Chunk& chunk : chunks)
        if (tagText(chunk.tag) == tag) chunk.bytes = content;
    return packChunks(version, chunks);
}

// With splines on sites, or without.
class DamagedContent : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Colours, DamagedContent, ::testing::Bool());

TEST_P(DamagedContent, WithRightChecksumsIsRefusedOrSound) {
    // Every byte of every chunk changed behind the container's back: an error, or a document that can be
    // stored.
    const auto bytes = smallDocument(GetParam());
    size_t refused = 0, sound = 0;
    for (const Chunk& chunk : chunksOf(bytes))
        for (size_t at = 0; at < chunk.bytes.size(); ++at)
            for (const int flip : {0x01, 0x10, 0xFF}) {
                std::vector<uint8_t> content(chunk.bytes.begin(), chunk.bytes.end());
                content[at] = uint8_t(content[at] ^ flip);
                auto d = decodeDocument(withChunk(bytes, tagText(chunk.tag), content));
                if (!d) {
                    EXPECT_EQ(d.error().code, ErrorCode::DamagedDocument);
                    ++refused;
                    continue;
                }
                ++sound;
                const auto stored = encodeDocument(*d);
                ASSERT_TRUE(stored) << tagText(chunk.tag) << " " << at << " " << stored.error().message;
                Document again = decoded(*stored);
                EXPECT_EQ(encoded(again), *stored) << tagText(chunk.tag) << " " << at;
            }
    EXPECT_GT(refused, 100u);
    EXPECT_GT(sound, 100u);
}

TEST_P(DamagedContent, CutChunksWithRightChecksumsDoNoHarm) {
    const auto bytes = smallDocument(GetParam());
    for (const Chunk& chunk : chunksOf(bytes))
        for (size_t length = 0; length < chunk.bytes.size(); ++length) {
            const std::vector<uint8_t> content(chunk.bytes.begin(), chunk.bytes.begin() + ptrdiff_t(length));
            auto d = decodeDocument(withChunk(bytes, tagText(chunk.tag), content));
            if (!d) continue;
            EXPECT_TRUE(encodeDocument(*d));
        }
}

TEST(DamagedDocument, IsNamedWithItsChunkAndOffset) {
    const auto bytes = smallDocument();
    const auto chunks = chunksOf(bytes);
    auto changed = bytes;
    changed[size_t(chunks[1].offset) + 3] ^= 1;
    const auto d = decodeDocument(changed);
    ASSERT_FALSE(d);
    EXPECT_THAT(d.error().message, HasSubstr("GEOM at byte " + std::to_string(chunks[1].offset)));
    const auto cut = decodeDocument(withChunk(bytes, "COLR", {}));
    ASSERT_FALSE(cut);
}

TEST(DamagedDocument, TextModeAndForeignFilesAreTold) {
    auto bytes = smallDocument();
    EXPECT_TRUE(looksLikeDocument(bytes));
    std::vector<uint8_t> unixEnds = bytes;
    unixEnds.erase(unixEnds.begin() + 4);  // \r\n became \n
    const auto d = decodeDocument(unixEnds);
    ASSERT_FALSE(d);
    EXPECT_THAT(d.error().message, HasSubstr("text mode"));
    const std::vector<uint8_t> png{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n', 0, 0};
    EXPECT_FALSE(looksLikeDocument(png));
    EXPECT_THAT(decodeDocument(png).error().message, HasSubstr("does not begin like"));
}

TEST(DamagedDocument, OfANewerVersionIsRefusedWithASentence) {
    const auto newer = withChunk(smallDocument(), "", {}, kFormatVersion + 1);
    const auto d = decodeDocument(newer);
    ASSERT_FALSE(d);
    EXPECT_THAT(d.error().message, HasSubstr("newer Tessera"));
}

TEST(DamagedDocument, CannotClaimMorePatchesThanItsBytes) {
    auto bytes = smallDocument();
    auto chunks = chunksOf(bytes);
    std::vector<uint8_t> content(chunks[0].bytes.begin(), chunks[0].bytes.end());
    content[11] = 0x03;  // the count's high bytes
    content[12] = 0x01;
    expectRefused(withChunk(bytes, "MESH", content), "count");
}

TEST(Document, OfATrivialMeshCanStillBeLoaded) {
    // So regular that its colours take less than a byte a patch: the bound on counts must not refuse it.
    Document d;
    d.mesh = gridMesh(400, 400, 100, 100);
    const auto bytes = encoded(d);
    EXPECT_EQ(decoded(bytes).mesh.patchCount(), 20'000u);
    EXPECT_LT(bytes.size(), 60'000u);
}

TEST(Document, SizesOfChunksAddUpToTheFile) {
    Document d = richDocument(9);
    const auto bytes = encoded(d);
    uint64_t sum = 8 + 4 + 4 + 8;
    const auto sizes = chunkSizes(bytes);
    ASSERT_TRUE(sizes);
    for (const ChunkSize& size : *sizes) sum += size.bytes;
    EXPECT_EQ(sum, bytes.size());
}

std::vector<uint8_t> fixtureBytes(const std::string& name) {
    std::ifstream file(TESSERA_TEST_DATA "/" + name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

// A document of version 1 with all that a document can hold. It is never made again: what was stored once
// must load for ever.
class FixtureOfVersion1 : public ::testing::Test {
  protected:
    static std::vector<uint8_t> bytes() { return fixtureBytes("v1.tessera"); }
};

TEST_F(FixtureOfVersion1, LoadsWithItsNumbers) {
    const Document d = decoded(bytes());
    const PatchMesh& mesh = d.mesh;
    ASSERT_EQ(mesh.patchCount(), 32u);
    EXPECT_EQ(mesh.width(), 211);
    EXPECT_EQ(mesh.height(), 150);
    EXPECT_EQ(mesh.channels(), 4);
    EXPECT_EQ(mesh.connectivity().vertexCount(), 26u);
    EXPECT_EQ(mesh.connectivity().edgeCount(), 57u);

    using Points = std::array<LatticePoint, 10>;
    EXPECT_EQ(mesh.controlPoints(PatchId(0)).p, (Points{{{0, 0},
                                                         {3601, 0},
                                                         {7202, 0},
                                                         {10803, 0},
                                                         {10159, 2059},
                                                         {12079, 5798},
                                                         {8984, 9093},
                                                         {3372, 6746},
                                                         {525, 1456},
                                                         {6596, 3031}}}));
    EXPECT_EQ(mesh.controlPoints(PatchId(20)).p, (Points{{{31791, 10944},
                                                          {45240, 11229},
                                                          {47518, 18939},
                                                          {54016, 19200},
                                                          {48780, 19816},
                                                          {44911, 20592},
                                                          {44073, 20815},
                                                          {41238, 16727},
                                                          {41064, 16235},
                                                          {47429, 16760}}}));
    size_t features = 0, blurred = 0;
    double blurs = 0;
    int64_t sumX = 0, sumY = 0;
    mesh.forEachEdge([&](EdgeId e) {
        const EdgeCurve& c = mesh.curve(e);
        features += c.feature;
        blurred += c.blurSigma[0] > 0;
        blurs += c.blurSigma[0] + c.blurSigma[1];
        sumX += c.c1.x + 3 * c.c2.x;
        sumY += c.c1.y + 3 * c.c2.y;
    });
    EXPECT_EQ(features, 8u);
    EXPECT_EQ(blurred, 2u);
    EXPECT_NEAR(blurs, 70.4882812, 1e-6);
    EXPECT_EQ(sumX, 5947886);
    EXPECT_EQ(sumY, 4272904);
    ASSERT_EQ(mesh.smoothJoins().size(), 11u);
    EXPECT_EQ(mesh.smoothJoins()[0], (SmoothJoin{VertexId(0), EdgeId(1), EdgeId(2)}));
    EXPECT_EQ(mesh.smoothJoins()[3], (SmoothJoin{VertexId(8), EdgeId(28), EdgeId(29)}));

    EXPECT_EQ(mesh.spline(PatchId(0)).terms[0], 16);
    EXPECT_EQ(mesh.spline(PatchId(20)).terms[0], 4);
    EXPECT_NEAR(evaluateSpline(mesh.spline(PatchId(0)), 1, {.5, .2}), .354092057, 1e-6);
    EXPECT_NEAR(evaluateSpline(mesh.spline(PatchId(7)), 1, {.5, .2}), .245044552, 1e-6);
    EXPECT_NEAR(evaluateSpline(mesh.spline(PatchId(20)), 1, {.5, .2}), .591021632, 1e-6);
    size_t ownCentres = 0;
    mesh.forEachPatch([&](PatchId p) { ownCentres += !mesh.spline(p).centres.empty(); });
    EXPECT_EQ(ownCentres, 3u);

    EXPECT_EQ(d.settings.patches, 126);
    EXPECT_EQ(d.settings.stageVariants.at("curves"), "straight");
    ASSERT_EQ(d.report.stages.size(), 2u);
    EXPECT_EQ(d.report.stages[0].figures[1], (std::pair<std::string, double>("edge pixels", 3456)));
    EXPECT_EQ(d.report.shortfall, "It got stuck.");
    EXPECT_EQ(d.difference->euclid, 4);
    EXPECT_EQ(d.source.iccProfile.size(), 300u);
    EXPECT_EQ(d.embeddedSource->size(), 1000u);
    EXPECT_EQ(*d.previewPng, std::vector<uint8_t>(200, 7));
    ASSERT_EQ(d.unknownChunks.size(), 2u);
    EXPECT_EQ(d.unknownChunks[0].bytes, (std::vector<uint8_t>{1, 2, 3}));
}

TEST_F(FixtureOfVersion1, StoresAsTheNewestVersionWithoutLoss) {
    Document d = decoded(bytes());
    const auto stored = encoded(d);
    Document back = decoded(stored);
    EXPECT_EQ(chunkFileVersion(bytes()), 1u);
    EXPECT_EQ(chunkFileVersion(stored), kFormatVersion);
    d.mesh.forEachPatch([&](PatchId p) {
        EXPECT_EQ(back.mesh.controlPoints(p).p, d.mesh.controlPoints(p).p);
        EXPECT_EQ(back.mesh.spline(p), d.mesh.spline(p));
    });
    d.mesh.forEachEdge([&](EdgeId e) { EXPECT_EQ(back.mesh.curve(e), d.mesh.curve(e)); });
    EXPECT_EQ(back.mesh.smoothJoins(), d.mesh.smoothJoins());
    EXPECT_EQ(back.unknownChunks, d.unknownChunks);
    EXPECT_EQ(encoded(back), stored);
}

// The same of version 2, with splines on the sites of its lattice, in the opponent basis.
TEST(FixtureOfVersion2, LoadsWithItsNumbersAndStoresAndLoadsUnchanged) {
    const std::vector<uint8_t> bytes = fixtureBytes("v2.tessera");
    EXPECT_EQ(chunkFileVersion(bytes), 2u);
    Document d = decoded(bytes);
    const PatchMesh& mesh = d.mesh;
    ASSERT_EQ(mesh.patchCount(), 78u);
    EXPECT_EQ(mesh.connectivity().vertexCount(), 56u);
    EXPECT_EQ(mesh.connectivity().edgeCount(), 133u);
    EXPECT_EQ(mesh.channels(), 4);
    EXPECT_EQ(mesh.colourBasis(), ColourBasis::Opponent);
    EXPECT_EQ(d.colourStep, 0.0044171408641778395);
    using Points = std::array<LatticePoint, 10>;
    EXPECT_EQ(mesh.controlPoints(PatchId(20)).p, (Points{{{18172, 32794},
                                                          {19530, 33131},
                                                          {22294, 33120},
                                                          {24948, 32454},
                                                          {24060, 34228},
                                                          {24168, 35347},
                                                          {24007, 38400},
                                                          {21196, 35863},
                                                          {19665, 33288},
                                                          {22376, 34549}}}));
    const SiteLattice& lattice = SiteLattice::ofVersion(2);
    const auto siteAt = [&](glm::vec2 centre) {
        size_t site = 0;
        while (site < lattice.size() && glm::vec2(lattice.point(site)) != centre) ++site;
        return site;
    };
    size_t sites = 0, weighted = 0;
    mesh.forEachPatch([&](PatchId p) {
        const PatchSpline& spline = mesh.spline(p);
        EXPECT_TRUE(spline.sites.empty());
        sites += spline.centres.size();
        for (size_t i = 0; i < spline.centres.size(); ++i) weighted += (i + 1) * siteAt(spline.centres[i]);
    });
    EXPECT_EQ(sites, 1345u);
    EXPECT_EQ(weighted, 728923u);
    EXPECT_EQ(mesh.spline(PatchId(1)).terms, (std::array<uint8_t, 4>{25, 20, 12, 11}));
    EXPECT_EQ(mesh.spline(PatchId(3)).terms, (std::array<uint8_t, 4>{66, 49, 32, 42}));
    const auto value = [&](uint32_t p, int c) {
        return evaluateSpline(mesh.spline(PatchId(p)), c, {.5, .2});
    };
    EXPECT_NEAR(value(1, 0), .0938036566, 1e-5);
    EXPECT_NEAR(value(3, 1), .360416503, 1e-5);
    EXPECT_NEAR(value(20, 0), .18018786, 1e-5);
    EXPECT_NEAR(value(46, 1), .469969158, 1e-5);
    EXPECT_EQ(d.difference->psnr, 31.25);
    const auto stored = encoded(d);
    Document back = decoded(stored);
    mesh.forEachPatch([&](PatchId p) { EXPECT_EQ(back.mesh.spline(p), mesh.spline(p)); });
    EXPECT_EQ(encoded(back), stored);
}

// And of version 3, with sites of the finer lattice.
void expectSitesAndColoursOfVersion3(const PatchMesh& mesh, double tolerance) {
    EXPECT_EQ(mesh.patchCount(), 59u);
    EXPECT_EQ(mesh.connectivity().vertexCount(), 37u);
    EXPECT_EQ(mesh.channels(), 4);
    size_t sites = 0, weighted = 0;
    mesh.forEachPatch([&](PatchId p) {
        const PatchSpline& spline = mesh.spline(p);
        sites += spline.sites.size();
        for (size_t i = 0; i < spline.sites.size(); ++i) weighted += (i + 1) * spline.sites[i];
    });
    EXPECT_EQ(sites, 1440u);
    EXPECT_EQ(weighted, 1602709u);
    const auto value = [&](uint32_t p, int c) {
        return evaluateSpline(mesh.spline(PatchId(p)), c, {.5, .2});
    };
    EXPECT_NEAR(value(1, 0), .744115278, tolerance);
    EXPECT_NEAR(value(20, 1), .0296964656, tolerance);
    EXPECT_NEAR(value(46, 3), .999970859, tolerance);
}

TEST(FixtureOfVersion3, LoadsWithItsNumbersAndIsRoundedOnceMore) {
    const std::vector<uint8_t> bytes = fixtureBytes("v3.tessera");
    EXPECT_EQ(chunkFileVersion(bytes), 3u);
    Document d = decoded(bytes);
    expectSitesAndColoursOfVersion3(d.mesh, 1e-5);
    const auto stored = encoded(d);
    Document back = decoded(stored);
    expectSitesAndColoursOfVersion3(back.mesh, 3 * *d.colourStep);
    EXPECT_EQ(encoded(back), stored);
}

// Of version 4, in which factors have other steps: what storing that of version 3 gave.
TEST(FixtureOfVersion4, LoadsWithItsNumbersAndStoresToItsOwnBytes) {
    const std::vector<uint8_t> bytes = fixtureBytes("v4.tessera");
    EXPECT_EQ(chunkFileVersion(bytes), 4u);
    Document d = decoded(bytes);
    expectSitesAndColoursOfVersion3(d.mesh, 3 * *d.colourStep);
    EXPECT_NEAR(evaluateSpline(d.mesh.spline(PatchId(1)), 0, {.5, .2}), 0.745506161, 1e-5);
    EXPECT_EQ(encoded(d), bytes);
}

class SavedDocument : public ::testing::Test {
  protected:
    void SetUp() override {
        mFolder =
            std::filesystem::temp_directory_path() / ("tessera-document-test-" + std::to_string(getpid()));
        std::filesystem::create_directories(mFolder);
    }
    void TearDown() override {
        std::filesystem::permissions(mFolder, std::filesystem::perms::owner_all);
        std::filesystem::remove_all(mFolder);
    }
    std::filesystem::path mFolder;
};

TEST_F(SavedDocument, ReplacesTheFileThatWasThere) {
    const std::string path = (mFolder / "a.tessera").string();
    Document first = richDocument(1), second = richDocument(2);
    ASSERT_TRUE(saveDocument(first, path));
    ASSERT_TRUE(saveDocument(second, path));
    auto back = loadDocument(path);
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(encoded(*back), encoded(second));
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(mFolder), {}), 1);
}

TEST_F(SavedDocument, IsNotWrittenWhereItCannotBe) {
    Document d = richDocument(1);
    const auto saved = saveDocument(d, (mFolder / "no-folder" / "a.tessera").string());
    ASSERT_FALSE(saved);
    EXPECT_EQ(saved.error().code, ErrorCode::CannotWrite);
    if (geteuid() == 0) GTEST_SKIP() << "root may write into a read-only folder";
    std::filesystem::permissions(mFolder,
                                 std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
    const auto refused = saveDocument(d, (mFolder / "a.tessera").string());
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::CannotWrite);
}

TEST_F(SavedDocument, ErrorsNameTheFile) {
    const std::string path = (mFolder / "a.tessera").string();
    const auto missing = loadDocument(path);
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().code, ErrorCode::CannotRead);
    EXPECT_THAT(missing.error().message, HasSubstr(path));
    const auto folder = loadDocument(mFolder.string());
    ASSERT_FALSE(folder);
    EXPECT_EQ(folder.error().code, ErrorCode::CannotRead);
    std::ofstream(path) << "nothing of the kind";
    const auto damaged = loadDocument(path);
    ASSERT_FALSE(damaged);
    EXPECT_EQ(damaged.error().code, ErrorCode::DamagedDocument);
    EXPECT_THAT(damaged.error().message, HasSubstr(path));
}

}  // namespace
}  // namespace tessera
