// What the C++ structs write is what the load functions of gpu_layout.glsl read: a shader copies every field.
#include "render/gpu_layout.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <numeric>

#include "render/shader_library.h"
#include "tests/support/gl.h"

namespace tessera::render {
namespace {

using ::testing::ElementsAreArray;

class GpuLayout : public testing::GlTest {
  protected:
    // Runs a shader whose main() hands words on with put(...); returns them.
    std::vector<uint32_t> wordsFrom(const std::string& body) {
        const std::string text =
            "#version 450 core\n#include \"include/gpu_layout.glsl\"\nlayout(local_size_x = 1) in;\n"
            "layout(std430, binding = 0) buffer Out { uint words[]; };\nuint at = 0u;\n"
            "void put(uint w) { words[at++] = w; }\nvoid put(int w) { put(uint(w)); }\n"
            "void put(float f) { put(floatBitsToUint(f)); }\nvoid put(vec2 v) { put(v.x); put(v.y); }\n"
            "void put(ivec2 v) { put(v.x); put(v.y); }\nvoid put(uvec2 v) { put(v.x); put(v.y); }\n"
            "void put(vec4 v) { put(v.xy); put(v.zw); }\nvoid put(ivec4 v) { put(v.xy); put(v.zw); }\n"
            "void main() {\n" +
            body + "}\n";
        std::map<std::string_view, std::string_view> sources = embeddedShaders();
        sources["test.comp"] = text;
        const auto program = makeProgram(std::array<std::string_view, 1>{"test.comp"}, {}, sources);
        EXPECT_TRUE(program) << program.error().message;
        if (!program) return {};
        Buffer out;
        std::vector<uint32_t> words(64, 0xdeadbeef);
        out.reserve(words.size() * sizeof(uint32_t));
        out.write(0, words.data(), words.size() * sizeof(uint32_t));
        out.bindStorage(Binding(0));
        glUseProgram(program->name());
        glDispatchCompute(1, 1, 1);
        glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
        out.read(std::span(words));
        return words;
    }

    // Two records with another number in every word; binds them as texels.
    template <class Record>
    std::vector<uint32_t> bindNumbered(Buffer& buffer, Unit unit) {
        std::vector<uint32_t> words(2 * sizeof(Record) / sizeof(uint32_t));
        std::iota(words.begin(), words.end(), 0x3f800001U);  // as floats, numbers a little above 1
        buffer.reserve(2 * sizeof(Record));
        buffer.write(0, words.data(), 2 * sizeof(Record));
        buffer.bindTexels(unit);
        words.erase(words.begin(), words.begin() + ptrdiff_t(words.size() / 2));
        return words;
    }

    template <class T>
    static void append(std::vector<uint32_t>& words, const T& field) {
        std::array<uint32_t, sizeof(T) / sizeof(uint32_t)> fieldWords;
        std::memcpy(fieldWords.data(), &field, sizeof(T));
        words.insert(words.end(), fieldWords.begin(), fieldWords.end());
    }
    static void expectBeginsWith(const std::vector<uint32_t>& words, const std::vector<uint32_t>& expected) {
        ASSERT_GE(words.size(), expected.size());
        EXPECT_THAT(std::span(words).first(expected.size()), ElementsAreArray(expected));
    }
};

TEST_F(GpuLayout, Edge) {
    Buffer buffer(GL_RGBA32I);
    const auto words = bindNumbered<GpuEdge>(buffer, Unit::Edges);
    expectBeginsWith(wordsFrom("ivec2 p[4]; loadEdge(1u, p); for (int i = 0; i < 4; ++i) put(p[i]);"), words);
}

TEST_F(GpuLayout, Patch) {
    Buffer buffer(GL_RGBA32UI);
    const auto words = bindNumbered<GpuPatch>(buffer, Unit::Patches);
    GpuPatch patch;
    std::memcpy(&patch, words.data(), sizeof(patch));
    std::vector<uint32_t> expected;
    append(expected, patch.sides);
    append(expected, patch.flags);
    append(expected, patch.interior);
    append(expected, patch.firstTerm);
    append(expected, patch.terms & 0xffffU);
    append(expected, patch.terms >> 16);
    append(expected, patch.polynomial);
    expectBeginsWith(
        wordsFrom(
            "PatchShape s = loadShape(1u); put(s.sides.x); put(s.sides.y); put(s.sides.z); put(s.flags);"
            "put(s.interior); SplineTerms t = loadTerms(1u); put(t.first); put(t.count); put(t.others);"
            "for (uint i = 0u; i < 3u; ++i) put(loadPolynomial(1u, i));"),
        expected);
}

TEST_F(GpuLayout, Term) {
    Buffer buffer(GL_RGBA32F);
    const auto words = bindNumbered<GpuTerm>(buffer, Unit::Terms);
    expectBeginsWith(wordsFrom("put(loadTerm(1u)); put(loadTermRest(1u));"),
                     {words.begin(), words.begin() + 6});
}

TEST_F(GpuLayout, Feature) {
    Buffer buffer(GL_RGBA32UI);
    const auto words = bindNumbered<GpuFeature>(buffer, Unit::Features);
    GpuFeature f;
    std::memcpy(&f, words.data(), sizeof(f));
    std::vector<uint32_t> expected;
    append(expected, f.ends);
    append(expected, f.inner);
    append(expected, f.bend);
    append(expected, f.flatness);
    append(expected, f.reach);
    append(expected, f.chainLength);
    append(expected, f.sigma);
    append(expected, f.patches);
    append(expected, f.endTangents);
    append(expected, f.chain);
    append(expected, f.flags);
    append(expected, f.arc);
    append(expected, f.chords);
    expectBeginsWith(
        wordsFrom("put(loadFeatureEnds(1u)); put(loadFeatureInner(1u));"
                  "FeatureBounds b = loadFeatureBounds(1u); put(b.bend); put(b.flatness); put(b.reach);"
                  "put(b.chainLength); put(loadFeatureSigma(1u)); put(loadFeaturePatches(1u));"
                  "put(loadFeatureEndTangents(1u)); put(loadFeatureChain(1u)); put(loadFeatureFlags(1u));"
                  "for (int i = 0; i < 9; ++i) put(loadFeatureArc(1u, i));"
                  "for (int i = 0; i < 4; ++i) put(loadFeatureChords(1u, i));"),
        expected);
}

TEST_F(GpuLayout, ListsLevelsAndPieces) {
    Buffer lists(GL_RG32UI), reaches(GL_R32UI), levels(GL_R32UI), pieces(GL_RG32UI);
    auto expected = bindNumbered<GpuReachList>(lists, Unit::ReachLists);
    for (const auto& more :
         {bindNumbered<uint32_t>(reaches, Unit::Reaches), bindNumbered<uint32_t>(levels, Unit::EdgeLevels),
          bindNumbered<GpuPiece>(pieces, Unit::Pieces)})
        expected.insert(expected.end(), more.begin(), more.end());
    expectBeginsWith(wordsFrom("put(loadReachList(1u)); put(loadReach(1u)); put(loadEdgeLevel(1u));"
                               "Piece p = loadPiece(1u); put(p.patchId); put(p.code);"),
                     expected);
}

TEST_F(GpuLayout, View) {
    Buffer buffer;
    std::vector<uint32_t> words(sizeof(GpuView) / sizeof(uint32_t));
    std::iota(words.begin(), words.end(), 0x3f800001U);
    buffer.reserve(sizeof(GpuView));
    buffer.write(0, words.data(), sizeof(GpuView));
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, buffer.name());
    expectBeginsWith(
        wordsFrom(
            "put(view.origin); put(view.fraction); put(view.gridPerUnit); put(view.gridSize);"
            "put(view.target); put(view.edgeTolerance); put(view.insideTolerance); put(view.patchCount);"
            "put(view.edgeCount); put(view.opponent); put(view.channels); put(view.pieceCapacity);"
            "put(view.drawVertices); put(view.drawCount); put(view.showHidden);"),
        {words.begin(), words.begin() + 20});
}

TEST_F(GpuLayout, FlagsAreTheSameInBothLanguages) {
    expectBeginsWith(
        wordsFrom("put(kDrawn); put(kAffine); put(kHidden); put(kEven); put(kFadesAtBegin);"
                  "put(kFadesAtEnd); put(kSideShift); put(kFeatureSegments); put(kReachFromLeft);"
                  "put(kReachFromRight); put(kNoPatch);"),
        {kGpuDrawn, kGpuAffine, kGpuHidden, kGpuEven, kGpuFadesAtBegin, kGpuFadesAtEnd, kGpuSideShift,
         uint32_t(kGpuFeatureSegments), kGpuReachFromLeft, kGpuReachFromRight, kGpuNoPatch});
}

}  // namespace
}  // namespace tessera::render
