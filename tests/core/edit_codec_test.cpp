// What editing adds to a document: that it comes back, by element and not by number, and what is refused.
#include "core/document/edit_codec.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <map>
#include <random>

#include "core/document/codec.h"
#include "core/edit/drag_colour.h"
#include "core/edit/recolour.h"
#include "core/edit/reshape.h"
#include "core/edit/select.h"
#include "core/edit/split_merge.h"
#include "tests/support/edit_meshes.h"

namespace tessera {
namespace {

using testing::expectValid;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::sceneMesh;

// Where a patch is, whatever its number.
glm::dvec2 middle(const PatchMesh& mesh, PatchId p) {
    return evaluate(toPixels(mesh.controlPoints(p)), Barycentric(1.0 / 3));
}

// The patches of a mesh that lie where those of another do.
PatchId twin(const PatchMesh& from, PatchId p, const PatchMesh& to) {
    PatchId nearest;
    double distance = .01;
    to.forEachPatch([&](PatchId q) {
        const double d = glm::distance(middle(from, p), middle(to, q));
        if (d >= distance) return;
        nearest = q;
        distance = d;
    });
    return nearest;
}

// A document in which everything has been edited, ids with holes included.
Document editedDocument() {
    static const PatchMesh scene = sceneMesh();
    Document d;
    d.mesh = scene;
    d.fitted = d.mesh;
    recolour(d.mesh, grown(d.mesh, {PatchId(20)}), Levels{.2, 0});
    VertexId inner;
    d.mesh.forEachVertex([&](VertexId v) {
        if (!d.mesh.connectivity().onBorder(v)) inner = v;
    });
    const PatchMesh start = d.mesh;
    ShapeDrag(start, {ControlPointRef::of(inner)}).drag(d.mesh, {2, 1});
    EXPECT_TRUE(splitPatch(d.mesh, PatchId(100), Barycentric(1.0 / 3)));
    for (uint32_t e = 200; e < 230; ++e)
        if (mergeEdge(d.mesh, EdgeId(e))) break;
    const PatchSet live = allSelectable(d.mesh);
    d.mesh.setAttributes(live[7], {true, false, false});
    d.mesh.setAttributes(live[8], {false, true, true});
    d.selections = {{"sky", {live[1], live[5], live[9]}}, {"", {}}, {"all", live}};
    return d;
}

std::vector<uint8_t> encoded(Document& d) {
    auto bytes = encodeDocument(d);
    EXPECT_TRUE(bytes) << bytes.error().message;
    return bytes ? *bytes : std::vector<uint8_t>();
}

TEST(EditChunks, ComeBack) {
    Document d = editedDocument();
    const auto bytes = encoded(d);
    auto back = decodeDocument(bytes);
    ASSERT_TRUE(back) << back.error().message;
    ASSERT_EQ(back->mesh.patchCount(), d.mesh.patchCount());
    expectValid(back->mesh);
    size_t breaks = 0, backBreaks = 0;
    d.mesh.forEachEdge([&](EdgeId e) { breaks += d.mesh.curve(e).colourBreak; });
    back->mesh.forEachEdge([&](EdgeId e) { backBreaks += back->mesh.curve(e).colourBreak; });
    EXPECT_GT(breaks, 0U);
    EXPECT_EQ(backBreaks, breaks);
    d.mesh.forEachPatch([&](PatchId p) {
        const PatchId q = twin(d.mesh, p, back->mesh);
        ASSERT_TRUE(q.valid());
        EXPECT_EQ(back->mesh.attributes(q), d.mesh.attributes(p));
        for (size_t i = 0; i < d.selections.size(); ++i)
            EXPECT_EQ(contains(back->selections[i].patches, q), contains(d.selections[i].patches, p));
        ASSERT_TRUE(back->fitted);
        ASSERT_EQ(hasFitted(back->mesh, *back->fitted, q), hasFitted(d.mesh, *d.fitted, p)) << p.index;
        if (!hasFitted(d.mesh, *d.fitted, p)) return;
        EXPECT_EQ(back->fitted->controlPoints(q).p, d.fitted->controlPoints(p).p);
        if (d.mesh.spline(p) == d.fitted->spline(p)) return;
        EXPECT_EQ(back->fitted->spline(q), d.fitted->spline(p));
    });
    EXPECT_EQ(back->selections[0].name, "sky");
    EXPECT_EQ(back->selections[2].patches.size(), d.selections[2].patches.size());
    EXPECT_EQ(encoded(*back), bytes);
    // And leads back.
    resetShape(back->mesh, *back->fitted, allSelectable(back->mesh));
    resetColours(back->mesh, *back->fitted, allSelectable(back->mesh));
    expectValid(back->mesh);
}

TEST(EditChunks, AreThereOnlyWhereTheySaySomething) {
    Document d;
    d.mesh = sceneMesh(80, 60, 40);
    const auto plain = encoded(d);
    d.fitted = d.mesh;
    EXPECT_EQ(encoded(d), plain);
    const auto sizes = chunkSizes(plain);
    ASSERT_TRUE(sizes);
    for (const ChunkSize& chunk : *sizes)
        EXPECT_THAT((std::vector<std::string>{"ATTR", "BRKS", "SELS", "FITD"}),
                    ::testing::Not(::testing::Contains(chunk.tag)));
    const auto back = decodeDocument(plain);
    ASSERT_TRUE(back);
    EXPECT_FALSE(back->fitted);
    EXPECT_THAT(back->selections, IsEmpty());
}

// The chunks by themselves, each with damage of its own.
TEST(EditChunks, RefuseWhatCannotBe) {
    Document d = editedDocument();
    auto bytes = encoded(d);
    const auto back = decodeDocument(bytes);
    ASSERT_TRUE(back);
    const FileNumbers numbers(back->mesh.connectivity());
    const auto attributes = encodePatchAttributes(back->mesh, numbers);
    const auto breaks = encodeColourBreaks(back->mesh, numbers);
    const auto selections = encodeSelections(back->selections, numbers);
    const auto fitted = encodeFitted(back->mesh, *back->fitted, numbers);
    PatchMesh mesh = back->mesh;
    std::vector<NamedSelection> names;
    std::optional<PatchMesh> then;
    EXPECT_EQ(decodePatchAttributes(attributes, mesh), "");
    EXPECT_EQ(decodeColourBreaks(breaks, mesh), "");
    EXPECT_EQ(decodeSelections(selections, mesh, names), "");
    EXPECT_EQ(decodeFitted(fitted, kFormatVersion, mesh, then), "");
    // Every shorter one is cut short somewhere.
    const auto cut = [](const std::vector<uint8_t>& all, size_t n) {
        return std::span<const uint8_t>(all).first(n);
    };
    for (size_t n = 0; n < attributes.size(); ++n)
        EXPECT_NE(decodePatchAttributes(cut(attributes, n), mesh), "");
    for (size_t n = 0; n < breaks.size(); ++n) EXPECT_NE(decodeColourBreaks(cut(breaks, n), mesh), "");
    for (size_t n = 0; n < selections.size(); n += 3) {
        names.clear();
        EXPECT_NE(decodeSelections(cut(selections, n), mesh, names), "");
    }
    for (size_t n = 0; n < fitted.size(); n += 7)
        EXPECT_NE(decodeFitted(cut(fitted, n), kFormatVersion, mesh, then), "");
    // Ids beyond the mesh, and none twice.
    auto wrong = attributes;
    wrong[4 + 3] = 0xFF;
    EXPECT_THAT(decodePatchAttributes(wrong, mesh), HasSubstr("cannot be"));
    wrong = attributes;
    std::copy_n(attributes.begin() + 4, 4, wrong.begin() + 9);
    EXPECT_THAT(decodePatchAttributes(wrong, mesh), HasSubstr("cannot be"));
    // A feature is no break.
    PatchMesh features = mesh;
    features.forEachEdge([&](EdgeId e) {
        EdgeCurve curve = features.curve(e);
        curve.feature = !features.connectivity().onBorder(e);
        curve.colourBreak = false;
        features.setCurve(e, curve);
    });
    EXPECT_THAT(decodeColourBreaks(breaks, features), HasSubstr("feature"));
}

// Any change of bytes gives an error or a mesh that resets to something valid.
TEST(EditChunks, DamageNeverBreaksAMesh) {
    Document d = editedDocument();
    const auto back = decodeDocument(encoded(d));
    ASSERT_TRUE(back);
    const auto fitted = encodeFitted(back->mesh, *back->fitted, FileNumbers(back->mesh.connectivity()));
    std::mt19937 random(17);
    int accepted = 0;
    for (int i = 0; i < 400; ++i) {
        auto damaged = fitted;
        for (int k = 0; k < 3; ++k)
            damaged[random() % std::min<size_t>(damaged.size(), 400)] = uint8_t(random());
        std::optional<PatchMesh> then;
        if (!decodeFitted(damaged, kFormatVersion, back->mesh, then).empty()) continue;
        ++accepted;
        if (accepted % 8 != 1) continue;
        PatchMesh mesh = back->mesh;
        resetShape(mesh, *then, allSelectable(mesh));
        resetColours(mesh, *then, allSelectable(mesh));
        for (const std::string& violation : validate(mesh).violations)
            EXPECT_THAT(violation, HasSubstr("side conditions"));
    }
    EXPECT_GT(accepted, 20);
}

}  // namespace
}  // namespace tessera
