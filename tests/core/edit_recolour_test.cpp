// Recolouring: exact where it is affine, within a level where it is not, and never across a feature.
#include "core/edit/recolour.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>
#include <random>

#include "core/base/parallel.h"
#include "core/edit/brush.h"
#include "core/edit/colour_samples.h"
#include "core/edit/drag_colour.h"
#include "core/edit/repaint.h"
#include "core/edit/select.h"
#include "core/export/rasterize.h"
#include "core/image/oklab.h"
#include "tests/support/edit_meshes.h"
#include "tests/support/test_meshes.h"

namespace tessera {
namespace {

using testing::changedPatches;
using testing::curvedMesh;
using ::testing::ElementsAreArray;
using ::testing::IsEmpty;
using testing::sceneMesh;

const PatchMesh& scene() {
    static const PatchMesh mesh = sceneMesh();
    return mesh;
}

PatchSet all(const PatchMesh& mesh) {
    return allSelectable(mesh);
}

std::vector<Barycentric> randomPoints(size_t count) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<Barycentric> points;
    while (points.size() < count) {
        const double v = unit(random), w = unit(random);
        if (v + w <= 1) points.emplace_back(1 - v - w, v, w);
    }
    return points;
}

glm::dvec2 middleOf(const PatchMesh& mesh, PatchId p) {
    return evaluate(toPixels(mesh.controlPoints(p)), Barycentric(1.0 / 3));
}

glm::dvec3 shown(glm::dvec3 colour) {
    return glm::clamp(colour, 0.0, 1.0);
}

glm::dvec3 asItIs(glm::dvec3 colour) {
    return colour;
}

struct Deviation {
    double mean = 0, most = 0;
    double p99 = 0;
};

// How far the colours of `after` are from wanted(colour in `before`), in levels.
template <class Wanted>
Deviation deviationFrom(const PatchMesh& before, const PatchMesh& after, const PatchSet& set, Wanted&& wanted,
                        glm::dvec3 (*look)(glm::dvec3) = shown) {
    const DomainPoints points(randomPoints(60));
    Deviation result;
    std::vector<double> all;
    for (const PatchId p : set) {
        const auto from = sampleColours(before, p, points), to = sampleColours(after, p, points);
        for (size_t i = 0; i < from.size(); ++i) {
            const glm::dvec3 off = look(to[i].srgb) - look(wanted(look(from[i].srgb)));
            for (int c = 0; c < 3; ++c) {
                all.push_back(255 * std::abs(off[c]));
            }
        }
    }
    std::sort(all.begin(), all.end());
    result.mean = std::accumulate(all.begin(), all.end(), 0.0) / double(all.size());
    result.p99 = all[all.size() * 99 / 100];
    result.most = all.back();
    return result;
}

TEST(Recolour, AffineEditsAreExact) {
    for (const PatchMesh& before : {scene(), curvedMesh(120, 90, 6, 5, 3)}) {
        const PatchSet set = all(before);
        PatchMesh mesh = before;
        recolour(mesh, set, Levels{.1, -.3});
        const auto levels =
            deviationFrom(before, mesh, set, [](glm::dvec3 c) { return .7 * (c - .5) + .5 + .1; }, asItIs);
        EXPECT_LT(levels.most, .05);
        mesh = before;
        recolour(mesh, set, Tint{{.8, .3, .1}, .6});
        const auto tint = deviationFrom(
            before, mesh, set,
            [](glm::dvec3 c) {
                const glm::dvec3 luma(.2126, .7152, .0722), colour(.8, .3, .1);
                return .4 * c + .6 * (colour + glm::dot(luma, c - colour));
            },
            asItIs);
        EXPECT_LT(tint.most, .05);
        testing::expectValid(mesh);
        mesh = before;
        recolour(mesh, set, ReplaceColour{{.2, .5, .7}});
        const glm::dvec3 mean = meanColour(mesh, set);
        EXPECT_NEAR(mean.x, .2, 1e-5);
        EXPECT_NEAR(mean.y, .5, 1e-5);
        EXPECT_NEAR(mean.z, .7, 1e-5);
    }
}

TEST(Recolour, ChannelsTakeTheLongestPrefix) {
    const PatchMesh& mesh = scene();
    PatchId uneven;
    mesh.forEachPatch([&](PatchId p) {
        const auto& terms = mesh.spline(p).terms;
        if (terms[0] > terms[1] && terms[1] > terms[2]) uneven = p;
    });
    ASSERT_TRUE(uneven.valid());
    const PatchSpline& spline = mesh.spline(uneven);
    const auto terms = spline.terms;
    // Scaling mixes no channels of the opponent basis.
    EXPECT_EQ(mixed(spline, 3, mesh.colourBasis(), {glm::dmat3(.5), {}}).terms, terms);
    // R and B change places: (R - B) and (R - 2 G + B) are still apart.
    const glm::dmat3 exchanged(glm::dvec3(0, 0, 1), glm::dvec3(0, 1, 0), glm::dvec3(1, 0, 0));
    EXPECT_EQ(mixed(spline, 3, mesh.colourBasis(), {exchanged, {}}).terms, terms);
    const glm::dmat3 turned(glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0));
    const PatchSpline result = mixed(spline, 3, mesh.colourBasis(), {turned, {}});
    EXPECT_EQ(result.terms, (std::array<uint8_t, kMaxChannels>{terms[0], terms[1], terms[1], 0}));
    EXPECT_EQ(result.sites, spline.sites);
}

TEST(Recolour, NothingIsAskedForNothingChanges) {
    PatchMesh mesh = scene();
    for (const Recolouring& nothing : {Recolouring(ColourShift{}), Recolouring(Tint{}), Recolouring(Levels{}),
                                       Recolouring(GradientRecolour{{0, 0}, {1, 1}, {}, {}, 0})})
        EXPECT_TRUE(recolour(mesh, {PatchId(3), PatchId(4)}, nothing).empty());
    EXPECT_TRUE(testing::sameMesh(mesh, scene()));
}

TEST(Recolour, CurvedEditsStayWithinALevel) {
    for (const auto& before : {scene(), curvedMesh(120, 90, 6, 5, 3)}) {
        const PatchSet set = all(before);
        for (const ColourShift shift :
             {ColourShift{70, 1, 0}, ColourShift{0, 1.6, .05}, ColourShift{-150, .5, -.1}}) {
            PatchMesh mesh = before;
            recolour(mesh, set, shift);
            const auto off = deviationFrom(before, mesh, set, [&](glm::dvec3 c) {
                glm::dvec3 lch = toOklch(c);
                return fromOklch(
                    {lch.x + shift.lightnessShift, lch.y * shift.chromaFactor, lch.z + shift.hueDegrees});
            });
            EXPECT_LE(off.mean, 1);
            EXPECT_LE(off.p99, 12);
            testing::expectValid(mesh);
        }
    }
}

// The comparison itself must see a wrong hue.
TEST(Recolour, DeviationFindsAWrongEdit) {
    PatchMesh mesh = scene();
    recolour(mesh, all(mesh), ColourShift{70, 1, 0});
    const auto off = deviationFrom(scene(), mesh, all(mesh), [&](glm::dvec3 c) {
        const glm::dvec3 lch = toOklch(c);
        return fromOklch({lch.x, lch.y, lch.z + 60});
    });
    EXPECT_GT(off.mean, 1);
}

TEST(Recolour, SeamsInsideTheSelectionStayNarrow) {
    PatchMesh mesh = scene();
    const SeamStatistics before = measureSeams(mesh);
    recolour(mesh, all(mesh), ColourShift{90, 1.2, 0});
    const SeamStatistics after = measureSeams(mesh);
    EXPECT_LE(after.mean, before.mean * 1.5 + .5);
    EXPECT_LE(after.p95, before.p95 * 1.5 + 1);
}

TEST(Recolour, AHardBorderIsAColourBreakThatSeamsReportApart) {
    PatchMesh mesh = scene();
    const SeamStatistics before = measureSeams(mesh);
    PatchSet set = grown(mesh, grown(mesh, {PatchId(10)}));
    const Touched touched = recolour(mesh, set, Levels{.3, 0});
    EXPECT_EQ(touched.patches, set);
    ASSERT_FALSE(touched.edges.empty());
    for (const EdgeId e : touched.edges) EXPECT_TRUE(mesh.curve(e).colourBreak);
    const SeamStatistics after = measureSeams(mesh);
    EXPECT_NEAR(after.p95, before.p95, .5);
    EXPECT_GT(after.breakMean, 50);
    EXPECT_EQ(before.breakLength, 0);
    testing::expectValid(mesh);
}

TEST(Recolour, AFeatheredBorderIsNone) {
    PatchMesh mesh = scene();
    const SeamStatistics before = measureSeams(mesh);
    PatchSet set = {PatchId(10)};
    for (int i = 0; i < 5; ++i) set = grown(mesh, set);
    const Touched touched = recolour(mesh, set, Levels{.3, 0}, {20});
    EXPECT_THAT(touched.edges, IsEmpty());
    const SeamStatistics after = measureSeams(mesh);
    EXPECT_EQ(after.breakLength, 0);
    EXPECT_LE(after.mean, before.mean + 1);
    EXPECT_LE(after.p95, before.p95 + 3);
    // It is there inside.
    EXPECT_GT(deviationFrom(scene(), mesh, set, [](glm::dvec3 c) { return c; }).mean, 5);
}

// Cells of one grey, 10 px each; the left half is selected.
TEST(Recolour, AFeatherFadesToBothSidesOfTheBorder) {
    PatchMesh mesh = testing::gridMesh(200, 40, 20, 4);
    mesh.forEachPatch([&](PatchId p) { mesh.setSpline(p, constantSpline(std::array{.4f, .4f, .4f})); });
    PatchSet left;
    mesh.forEachPatch([&](PatchId p) {
        if (middleOf(mesh, p).x < 100) left.push_back(p);
    });
    constexpr double kFeather = 25;
    recolour(mesh, left, Levels{.4, 0}, {kFeather});
    testing::expectValid(mesh);
    const auto image = rasterize(mesh, wholePicture(mesh, {1, 1}));
    for (int x = 0; x < 200; ++x) {
        const double t = std::clamp((kFeather + 100 - (x + .5)) / (2 * kFeather), 0., 1.);
        EXPECT_NEAR(image->at(x, 20, 0), .4 + .4 * t * t * (3 - 2 * t), 2.5 / 255) << x;
    }
}

TEST(Recolour, AFeatherEndsAtFeaturesAndLockedPatches) {
    PatchMesh mesh = testing::gridMesh(200, 40, 20, 4);
    PatchSet left, beyondFeature, locked;
    mesh.forEachPatch([&](PatchId p) {
        mesh.setSpline(p, constantSpline(std::array{.4f, .4f, .4f}));
        const glm::dvec2 at = middleOf(mesh, p);
        if (at.x < 100) left.push_back(p);
        if (at.x > 110 && at.y < 20) beyondFeature.push_back(p);
        if (at.x > 110 && at.y > 20) locked.push_back(p);
    });
    const auto beyond = membership(mesh, beyondFeature);
    mesh.forEachEdge([&](EdgeId e) {
        const HalfedgeId h = HalfedgeMesh::halfedge(e);
        const PatchId a = mesh.connectivity().face(h), b = mesh.connectivity().face(HalfedgeMesh::twin(h));
        if (!a.valid() || !b.valid() || beyond[a.index] == beyond[b.index]) return;
        EdgeCurve curve = mesh.curve(e);
        curve.feature = true;
        mesh.setCurve(e, curve);
    });
    for (const PatchId p : locked) mesh.setAttributes(p, {.locked = true});
    const PatchMesh before = mesh;
    const Touched touched = recolour(mesh, left, Levels{.4, 0}, {30});
    EXPECT_THAT(changedPatches(before, mesh), ElementsAreArray(touched.patches));
    EXPECT_THAT(intersected(touched.patches, united(beyondFeature, locked)), IsEmpty());
    EXPECT_GT(touched.patches.size(), left.size()) << "the column in between";
    ASSERT_EQ(touched.edges.size(), 2u) << "where locked patches end the fade";
    for (const EdgeId e : touched.edges) {
        const HalfedgeId h = HalfedgeMesh::halfedge(e);
        EXPECT_EQ(toPixels(mesh.position(mesh.connectivity().origin(h))).x, 110);
        EXPECT_TRUE(mesh.curve(e).colourBreak);
    }
}

TEST(Recolour, LockedPatchesStay) {
    PatchMesh mesh = scene();
    mesh.setAttributes(PatchId(5), {false, true, false});
    const PatchMesh before = mesh;
    const Touched touched = recolour(mesh, all(scene()), Levels{.2, 0});
    EXPECT_FALSE(contains(touched.patches, PatchId(5)));
    EXPECT_EQ(mesh.spline(PatchId(5)), before.spline(PatchId(5)));
    EXPECT_THAT(changedPatches(before, mesh), ElementsAreArray(touched.patches));
}

TEST(Recolour, GesturesGiveWhatSingleEditsGive) {
    const PatchSet set = grown(scene(), grown(scene(), {PatchId(40)}));
    const Recolourer gesture(scene(), set);
    for (const double hue : {10.0, 60.0, 20.0}) {
        PatchMesh one = scene(), other = scene();
        const Touched a = gesture.apply(one, ColourShift{hue, 1, 0});
        const Touched b = recolour(other, set, ColourShift{hue, 1, 0});
        EXPECT_EQ(a, b);
        EXPECT_TRUE(testing::sameMesh(one, other));
    }
}

TEST(Recolour, ThreadsMakeNoDifference) {
    PatchMesh one = scene(), many = scene();
    withThreads(1, [&] { recolour(one, all(one), ColourShift{75, 1.2, 0}); });
    withThreads(4, [&] { recolour(many, all(many), ColourShift{75, 1.2, 0}); });
    EXPECT_TRUE(testing::sameMesh(one, many));
}

TEST(Recolour, PreviewsAreNearlyTheSame) {
    const PatchSet set = all(scene());
    const Recolourer gesture(scene(), set);
    const GradientRecolour gradient{{20, 0}, {180, 150}, {1, .2, 0}, {0, .3, 1}, .7};
    const auto off = [](const Recolourer& recolourer, const Recolouring& how) {
        PatchMesh quick = scene(), full = scene();
        EXPECT_EQ(recolourer.preview(quick, how), recolourer.apply(full, how));
        testing::expectValid(quick);
        const View view = wholePicture(quick, {1, 1});
        const auto one = rasterize(quick, view), other = rasterize(full, view);
        double sum = 0;
        for (int y = 0; y < 150; ++y)
            for (int x = 0; x < 200; ++x)
                for (int c = 0; c < 3; ++c)
                    sum += std::abs(std::clamp(double(one->at(x, y, c)), 0.0, 1.0) -
                                    std::clamp(double(other->at(x, y, c)), 0.0, 1.0));
        return 255 * sum / (3 * 150 * 200);
    };
    EXPECT_LT(off(gesture, ColourShift{60, 1.1, 0}), 4);
    EXPECT_LT(off(gesture, gradient), 1.5);
    // Where feathers fall on coarse patches they are shown more coarsely: the mean over places.
    double levels = 0, gradients = 0;
    int places = 0;
    for (uint32_t id = 0; id < 220; id += 20, ++places) {
        PatchSet part{PatchId(id)};
        for (int i = 0; i < 4; ++i) part = grown(scene(), part);
        const Recolourer feathered(scene(), part, {15});
        levels += off(feathered, Levels{.2, 0});
        gradients += off(feathered, gradient);
    }
    EXPECT_LT(levels, 2.5 * places);
    EXPECT_LT(gradients, 2.5 * places);
    EXPECT_EQ(off(gesture, Levels{.1, .2}), 0);
}

TEST(Recolour, AGradientGoesFromColourToColour) {
    PatchMesh mesh = scene();
    const PatchSet set = all(mesh);
    recolour(mesh, set, GradientRecolour{{0, 0}, {200, 0}, {1, 0, 0}, {0, 0, 1}, 1});
    const auto image = rasterize(mesh, wholePicture(mesh, {1, 1}), {1, 0});
    ASSERT_TRUE(image);
    double off = 0;
    for (int y = 0; y < 150; ++y)
        for (int x = 0; x < 200; ++x) off += std::abs(double(image->at(x, y, 0)) - (1 - (x + .5) / 200));
    EXPECT_LT(255 * off / (150 * 200), 1);
}

// The paper's Fig. 17: one side of a feature is recoloured; hard features, no pixel of the other side moves.
TEST(Recolour, OneSideOfAFeatureLeavesTheOtherAlone) {
    PatchMesh mesh = scene();
    const HalfedgeMesh& c = mesh.connectivity();
    PatchId beside;
    mesh.forEachEdge([&](EdgeId e) {
        if (mesh.curve(e).feature && !beside.valid()) beside = c.face(HalfedgeMesh::halfedge(e));
    });
    ASSERT_TRUE(beside.valid());
    PatchSet set = {beside};
    for (int i = 0; i < 2; ++i) {  // on this side of features
        std::vector<PatchId> more = set;
        for (const PatchId p : set)
            for (const HalfedgeId side : c.sides(p))
                if (!mesh.curve(HalfedgeMesh::edge(side)).feature && c.face(HalfedgeMesh::twin(side)).valid())
                    more.push_back(c.face(HalfedgeMesh::twin(side)));
        set = patchSet(more);
    }
    for (const Recolouring& how :
         {Recolouring(ColourShift{120, 1.3, .1}), Recolouring(ReplaceColour{{1, 0, 1}})}) {
        mesh = scene();
        recolour(mesh, set, how);
        for (const double scale : {4.0, 16.0}) {
            const Rect box = controlBounds(mesh, beside);
            const View view =
                scale == 4 ? wholePicture(mesh, {4, 4}) : View{box.min - glm::dvec2(4), {16, 16}, 600, 600};
            const auto before = rasterize(scene(), view, {1, 0}), after = rasterize(mesh, view, {1, 0});
            ASSERT_TRUE(before && after);
            const auto owners = locatePixels(mesh, view);
            size_t outside = 0, changedOutside = 0, changedInside = 0;
            for (int y = 0; y < view.height; ++y)
                for (int x = 0; x < view.width; ++x) {
                    bool same = true;
                    for (int k = 0; k < 3; ++k) same = same && before->at(x, y, k) == after->at(x, y, k);
                    const bool inside =
                        contains(set, owners[size_t(y) * size_t(view.width) + size_t(x)].patch);
                    outside += !inside;
                    changedOutside += !inside && !same;
                    changedInside += inside && !same;
                }
            EXPECT_EQ(changedOutside, 0U);
            EXPECT_GT(outside, 1000U);
            EXPECT_GT(changedInside, 1000U);
        }
    }
}

TEST(Recolour, AlphaStaysAndColoursChangeBeforeIt) {
    const PatchMesh before = sceneMesh(120, 90, 80, 4);
    PatchMesh mesh = before;
    recolour(mesh, all(mesh), Levels{.2, 0});
    recolour(mesh, all(mesh), ColourShift{40, 1, 0});
    PatchMesh once = before;
    recolour(once, all(once), Levels{.2, 0});
    const DomainPoints points(randomPoints(20));
    for (const PatchId p : all(mesh)) {
        const auto from = sampleColours(before, p, points), to = sampleColours(mesh, p, points),
                   lighter = sampleColours(once, p, points);
        for (size_t i = 0; i < from.size(); ++i) {
            EXPECT_NEAR(to[i].alpha, from[i].alpha, 2.0 / 255);
            if (from[i].alpha <= .4) continue;
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(lighter[i].srgb[c], from[i].srgb[c] + .2, 1e-4);
        }
    }
    testing::expectValid(mesh);
}

TEST(Brush, AGrowingStrokeIsTheWholeOne) {
    const PatchMesh start = scene();
    const PatchQuery query(start);
    const std::vector<glm::dvec2> stroke{{40, 30}, {60, 35}, {120, 60}, {160, 120}, {50, 33}};
    const BrushOptions options{18, .5, {1, 0, 0}, .8, true};
    BrushStroke growing(start, query, options);
    for (size_t n = 0; n <= stroke.size(); ++n) {
        const std::span part(stroke.data(), n);
        PatchMesh grown = start, whole = start;
        const Touched touched = growing.draw(grown, part), expected = brush(whole, query, part, options);
        EXPECT_EQ(touched.patches, expected.patches) << n;
        for (const PatchId p : all(start)) EXPECT_EQ(grown.spline(p), whole.spline(p)) << n;
    }
}

TEST(Brush, PaintsUnderTheStrokeAlone) {
    PatchMesh mesh = scene();
    const PatchQuery query(mesh);
    const std::vector<glm::dvec2> stroke{{40, 30}, {120, 60}, {160, 120}};
    const Touched touched = brush(mesh, query, stroke, {18, .5, {1, 0, 0}, 1, false});
    EXPECT_THAT(changedPatches(scene(), mesh), ElementsAreArray(touched.patches));
    const auto image = rasterize(mesh, wholePicture(mesh, {1, 1}), {1, 0}),
               before = rasterize(scene(), wholePicture(mesh, {1, 1}), {1, 0});
    ASSERT_TRUE(image && before);
    EXPECT_NEAR(image->at(40, 30, 0), 1, .06);
    EXPECT_NEAR(image->at(120, 60, 1), 0, .06);
    EXPECT_EQ(image->at(190, 10, 0), before->at(190, 10, 0));
    EXPECT_LE(measureSeams(mesh).mean, measureSeams(scene()).mean + 1);
    testing::expectValid(mesh);
    EXPECT_TRUE(brush(mesh, query, {}, {}).empty());
}

TEST(DragColour, GivesTheColourAndLeavesSeamsAsTheyWere) {
    const SeamStatistics before = measureSeams(scene());
    for (const uint32_t p : {10U, 33U, 90U, 120U}) {
        for (const Barycentric& at :
             {Barycentric(.5, .3, .2), Barycentric(1.0 / 3), Barycentric(.96, .02, .02)}) {
            PatchMesh mesh = scene();
            const Touched touched = dragColour(mesh, PatchId(p), at, {.9, .2, .4});
            const ColourSample now = sampleColour(mesh, PatchId(p), at);
            EXPECT_NEAR(now.srgb.x, .9, .5 / 255);
            EXPECT_NEAR(now.srgb.y, .2, .5 / 255);
            EXPECT_NEAR(now.srgb.z, .4, .5 / 255);
            EXPECT_NEAR(measureSeams(mesh).mean, before.mean, .15);
            EXPECT_NEAR(measureSeams(mesh).p95, before.p95, 1);
            EXPECT_THAT(changedPatches(scene(), mesh), ElementsAreArray(touched.patches));
            EXPECT_GT(touched.patches.size(), 2U);
            EXPECT_LT(touched.patches.size(), 40U);
            testing::expectValid(mesh);
        }
    }
}

// The largest rise of a single seam in levels, over all of them.
double largestRise(const PatchMesh& before, const PatchMesh& after) {
    const HalfedgeMesh& c = before.connectivity();
    double worst = 0;
    const auto side = [&](HalfedgeId h, double t) {
        const auto sides = c.sides(c.face(h));
        const int s = int(std::find(sides.begin(), sides.end(), h) - sides.begin());
        Barycentric b(0);
        b[s] = 1 - t;
        b[(s + 1) % 3] = t;
        return b;
    };
    before.forEachEdge([&](EdgeId e) {
        if (c.onBorder(e) || before.curve(e).feature) return;
        const HalfedgeId h = HalfedgeMesh::halfedge(e), t = HalfedgeMesh::twin(h);
        double rise = 0;
        for (double s = .05; s < 1; s += .1) {
            const auto jump = [&](const PatchMesh& mesh) {
                const glm::dvec3 d = sampleColour(mesh, c.face(h), side(h, s)).srgb -
                                     sampleColour(mesh, c.face(t), side(t, 1 - s)).srgb;
                return 255 * (std::abs(d.x) + std::abs(d.y) + std::abs(d.z)) / 3;
            };
            rise += (jump(after) - jump(before)) / 10;
        }
        worst = std::max(worst, rise);
    });
    return worst;
}

TEST(DragColour, NoSeamRisesByALevel) {
    for (const uint32_t p : {10U, 33U, 90U, 120U, 140U}) {
        PatchMesh mesh = scene();
        dragColour(mesh, PatchId(p), {.5, .3, .2}, {.9, .2, .4});
        EXPECT_LE(largestRise(scene(), mesh), 1) << p;
    }
    // As a recolouring of one patch does.
    PatchMesh mesh = scene();
    recolour(mesh, {PatchId(33)}, Levels{.2, 0});
    EXPECT_GT(largestRise(scene(), mesh), 10);
}

TEST(DragColour, LockedPatchesStay) {
    PatchMesh mesh = scene();
    const HalfedgeId side = mesh.connectivity().sides(PatchId(33))[0];
    const PatchId beyond = mesh.connectivity().face(HalfedgeMesh::twin(side));
    ASSERT_TRUE(beyond.valid());
    mesh.setAttributes(beyond, {false, true, false});
    EXPECT_FALSE(contains(dragColour(mesh, PatchId(33), Barycentric(1.0 / 3), {1, 1, 1}).patches, beyond));
    EXPECT_TRUE(dragColour(mesh, beyond, Barycentric(1.0 / 3), {1, 1, 1}).empty());
}

TEST(ResetColours, BringsBackTheFittedOnes) {
    PatchMesh mesh = scene();
    const PatchSet set = grown(mesh, grown(mesh, {PatchId(60)}));
    recolour(mesh, set, ColourShift{100, 1, 0});
    EXPECT_FALSE(testing::sameMesh(mesh, scene()));
    const Touched touched = resetColours(mesh, scene(), set);
    EXPECT_EQ(touched.patches, set);
    EXPECT_TRUE(testing::sameMesh(mesh, scene()));
}

}  // namespace
}  // namespace tessera
