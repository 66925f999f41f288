// The base domain: which vertices may go where, how far a mesh comes down, and that features stay where they
// are.
#include "core/vectorize/simplify.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/mesh/mesh_validate.h"
#include "core/vectorize/smooth_joins.h"

namespace tessera {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr int kPx = kLatticePerPixel;

struct Outcome {
    BaseDomain base;
    StageReport report;
    std::string shortfall;

    double figure(const std::string& name) const {
        for (const auto& [key, value] : report.figures)
            if (key == name) return value;
        ADD_FAILURE() << "no figure " << name;
        return 0;
    }
};

ChannelMeshes initialMesh(const Image& image, bool features, const VectorizeSettings& settings = {}) {
    Progress progress;
    StageReport report{"features", features ? "canny" : "none", 0, {}};
    const auto chains = detectFeatures(image, settings, report, progress);
    StageReport meshReport;
    return *buildInitialMesh(image, *chains, settings, meshReport, progress);
}

Outcome run(ChannelMeshes meshes, int patches, VectorizeSettings settings = {}) {
    settings.patches = patches;
    Outcome outcome;
    Progress progress;
    auto base = simplify(std::move(meshes), settings, outcome.report, outcome.shortfall, progress);
    EXPECT_TRUE(base.has_value());
    if (base) outcome.base = std::move(*base);
    return outcome;
}

template <class Value>
Image grey(int width, int height, Value&& value) {
    Image image(width, height, 3);
    for (int c = 0; c < 3; ++c)
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) image.at(x, y, c) = float(value(x + .5, y + .5));
    return image;
}

Image disc(int size, double radius) {
    return grey(size, size, [&](double x, double y) {
        return std::hypot(x - .5 * size, y - .5 * size) < radius ? .9 : .1;
    });
}

// Everything that a base domain promises.
void expectSound(const BaseDomain& base) {
    EXPECT_THAT(validate(base.mesh).violations, IsEmpty());
    const HalfedgeMesh& c = base.mesh.connectivity();
    ASSERT_EQ(base.paths.size(), c.edgeCapacity());
    base.mesh.forEachEdge([&](EdgeId e) {
        const HalfedgeId h = HalfedgeMesh::halfedge(e);
        const auto& path = base.paths[e.index];
        ASSERT_GE(path.size(), 2U);
        EXPECT_EQ(path.front(), toPixels(base.mesh.position(c.origin(h))));
        EXPECT_EQ(path.back(), toPixels(base.mesh.position(c.target(h))));
        if (base.mesh.curve(e).feature) return;
        const auto p = base.mesh.controlPoints(h);
        const auto straight = straightControlPoints(p[0], p[3]);
        EXPECT_EQ(p[1], straight[0]);
        EXPECT_EQ(p[2], straight[1]);
    });
}

size_t featureCount(const PatchMesh& mesh) {
    size_t count = 0;
    mesh.forEachEdge([&](EdgeId e) { count += mesh.curve(e).feature; });
    return count;
}

// Section 4.2, item 3: interior vertices collapse among themselves and into boundary vertices; boundary
// vertices are not absorbed by interior ones and contract along their own boundary alone.
TEST(CollapseRule, ThePapersTable) {
    using enum VertexKind;
    using enum CollapseRule;
    const std::array kinds{Interior, Feature, FeatureEnd, Border, Corner};
    for (const VertexKind to : kinds) EXPECT_EQ(collapseRule(Interior, to), Free);
    for (const VertexKind to : kinds) {
        EXPECT_EQ(collapseRule(FeatureEnd, to), Never);
        EXPECT_EQ(collapseRule(Corner, to), Never);
    }
    EXPECT_EQ(collapseRule(Feature, Interior), Never);
    EXPECT_EQ(collapseRule(Feature, Feature), AlongFeature);
    EXPECT_EQ(collapseRule(Feature, FeatureEnd), AlongFeature);
    EXPECT_EQ(collapseRule(Feature, Border), Never);
    EXPECT_EQ(collapseRule(Feature, Corner), Never);
    EXPECT_EQ(collapseRule(Border, Interior), Never);
    EXPECT_EQ(collapseRule(Border, Feature), Never);
    EXPECT_EQ(collapseRule(Border, FeatureEnd), Never);
    EXPECT_EQ(collapseRule(Border, Border), AlongBorder);
    EXPECT_EQ(collapseRule(Border, Corner), AlongBorder);
}

TEST(Simplify, AConstantPictureIsTwoPatches) {
    for (const auto& [w, h] : {std::pair{16, 12}, {1, 1}, {1, 9}, {3, 3}}) {
        const Outcome o = run(initialMesh(Image(w, h, 3, .5F), true), 2);
        expectSound(o.base);
        EXPECT_EQ(o.base.mesh.patchCount(), 2U) << w << 'x' << h;
        EXPECT_THAT(o.shortfall, IsEmpty());
        EXPECT_EQ(o.figure("patches"), 2);
    }
}

// Heights that are planes everywhere cost nothing to contract; the last vertices are the picture's corners.
TEST(Simplify, ALinearRampIsTwoPatches) {
    ChannelMeshes meshes =
        initialMesh(grey(14, 10, [](double x, double y) { return .02 * x + .03 * y; }), false);
    for (uint32_t v = 0; v < meshes.positions.size(); ++v)
        for (size_t c = 0; c < 3; ++c) {
            const glm::dvec2 p = toPixels(meshes.positions[v]);
            meshes.heights[3 * v + c] = float(.125 * p.x - .25 * p.y * double(c));
        }
    const Outcome o = run(std::move(meshes), 2);
    expectSound(o.base);
    EXPECT_EQ(o.base.mesh.patchCount(), 2U);
}

// A roof with its ridge at x = 7.5: whatever costs nothing leaves the ridge, so four patches are left without
// error.
TEST(Simplify, KeepsARidge) {
    ChannelMeshes meshes = initialMesh(Image(15, 12, 3, 0), false);
    for (uint32_t v = 0; v < meshes.positions.size(); ++v)
        for (size_t c = 0; c < 3; ++c)
            meshes.heights[3 * v + c] = float(std::abs(toPixels(meshes.positions[v]).x - 7.5) / 8);
    const Outcome o = run(std::move(meshes), 4);
    expectSound(o.base);
    EXPECT_EQ(o.base.mesh.patchCount(), 4U);
    o.base.mesh.forEachVertex([&](VertexId v) {
        const double x = toPixels(o.base.mesh.position(v)).x;
        EXPECT_TRUE(x == 0 || x == 7.5 || x == 15) << x;
    });
    o.base.mesh.forEachPatch([&](PatchId p) {
        bool left = false, right = false;
        for (const VertexId v : o.base.mesh.connectivity().corners(p)) {
            left = left || o.base.mesh.position(v).x < 15 * kPx / 2;
            right = right || o.base.mesh.position(v).x > 15 * kPx / 2;
        }
        EXPECT_FALSE(left && right) << "a patch across the ridge";
    });
}

TEST(Simplify, ReachesTheWantedCount) {
    const Image image =
        grey(24, 20, [](double x, double y) { return .5 + .3 * std::sin(.5 * x) * std::cos(.4 * y); });
    size_t last = SIZE_MAX;
    for (const int wanted : {1000, 300, 100, 30, 8, 2}) {
        const Outcome o = run(initialMesh(image, false), wanted);
        expectSound(o.base);
        EXPECT_LE(o.base.mesh.patchCount(), size_t(wanted));
        EXPECT_GE(int(o.base.mesh.patchCount()), wanted - 1) << "a contraction takes one or two faces";
        EXPECT_LE(o.base.mesh.patchCount(), last);
        EXPECT_THAT(o.shortfall, IsEmpty());
        last = o.base.mesh.patchCount();
    }
    const Outcome all = run(initialMesh(image, false), 100000);
    EXPECT_EQ(all.base.mesh.patchCount(), size_t(2 * 25 * 21)) << "nothing to do";
    EXPECT_EQ(all.figure("collapses"), 0);
}

TEST(Simplify, AStepKeepsItsFeature) {
    const Image image = grey(24, 24, [](double x, double y) { return x + .3 * y > 15 ? .8 : .2; });
    ChannelMeshes meshes = initialMesh(image, true);
    ASSERT_EQ(meshes.chains.size(), 1U);
    std::vector<glm::dvec2> original;
    for (const VertexId v : meshes.chains[0].vertices)
        original.push_back(toPixels(meshes.positions[v.index]));
    const Outcome o = run(std::move(meshes), 12);
    expectSound(o.base);
    EXPECT_LE(o.base.mesh.patchCount(), 12U);
    ASSERT_GE(featureCount(o.base.mesh), 1U);

    // The feature's paths, put together, are the whole polyline, and each curve is within a pixel of its own.
    size_t segments = 0;
    o.base.mesh.forEachEdge([&](EdgeId e) {
        if (!o.base.mesh.curve(e).feature) return;
        const auto& path = o.base.paths[e.index];
        segments += path.size() - 1;
        EXPECT_LE(maxDistance(toPixels(o.base.mesh.controlPoints(HalfedgeMesh::halfedge(e))), path), 1);
        for (const glm::dvec2 p : path)
            EXPECT_NE(std::find(original.begin(), original.end(), p), original.end());
    });
    EXPECT_EQ(segments, original.size() - 1);
}

// A finer tolerance needs more curves.
TEST(Simplify, ToleranceOfFeatureCurves) {
    size_t last = 0;
    for (const double tolerance : {2.0, .5, .2}) {
        VectorizeSettings settings;
        settings.curveTolerancePx = tolerance;
        const Outcome o = run(initialMesh(disc(40, 13), true), 2, settings);
        expectSound(o.base);
        o.base.mesh.forEachEdge([&](EdgeId e) {
            if (!o.base.mesh.curve(e).feature) return;
            EXPECT_LE(maxDistance(toPixels(o.base.mesh.controlPoints(HalfedgeMesh::halfedge(e))),
                                  o.base.paths[e.index]),
                      tolerance);
        });
        EXPECT_GE(featureCount(o.base.mesh), last);
        last = featureCount(o.base.mesh);
    }
}

TEST(Simplify, TellsWhyTheWantedCountWasNotReached) {
    const Outcome o = run(initialMesh(disc(40, 13), true), 2);
    expectSound(o.base);
    const size_t count = o.base.mesh.patchCount();
    ASSERT_GT(count, 2U);
    EXPECT_THAT(o.shortfall, HasSubstr("features pin the mesh at " + std::to_string(count) + " patches"));
    EXPECT_GE(featureCount(o.base.mesh), 3U) << "a closed curve has three vertices at least";
}

TEST(Simplify, BorderAndCornersStay) {
    const Image image =
        grey(30, 21, [](double x, double y) { return std::fmod(.37 * x + .11 * x * y, 1.0); });
    for (const int wanted : {200, 20}) {
        const Outcome o = run(initialMesh(image, true), wanted);
        expectSound(o.base);  // with validate(): corners are vertices, border edges straight on the sides
        EXPECT_NEAR(validate(o.base.mesh).areaError, 0, 1e-12);
    }
}

// Fig. 7 over many contractions: paths lead over vertices of the original mesh, in steps of neighbours at
// most.
TEST(Simplify, PathsRunThroughAbsorbedVertices) {
    const Image image =
        grey(24, 20, [](double x, double y) { return .5 + .3 * std::sin(.5 * x) * std::cos(.4 * y); });
    const Outcome o = run(initialMesh(image, false), 40);
    size_t longer = 0;
    o.base.mesh.forEachEdge([&](EdgeId e) {
        const auto& path = o.base.paths[e.index];
        longer += path.size() > 2;
        for (size_t k = 0; k + 1 < path.size(); ++k)
            EXPECT_LE(glm::distance(path[k], path[k + 1]), std::sqrt(2) + 1e-12)
                << "an edge of the pixel grid";
        for (size_t i = 0; i < path.size(); ++i)
            for (size_t j = i + 1; j < path.size(); ++j) EXPECT_NE(path[i], path[j]) << "pruned of loops";
    });
    EXPECT_GT(longer, o.base.mesh.connectivity().edgeCount() / 2);
}

TEST(Simplify, StopsOnRequest) {
    std::stop_source stop;
    stop.request_stop();
    Progress progress(stop.get_token());
    StageReport report;
    std::string shortfall;
    const auto base = simplify(initialMesh(Image(16, 12, 3, .5F), false), {}, report, shortfall, progress);
    ASSERT_FALSE(base.has_value());
    EXPECT_EQ(base.error().code, ErrorCode::Stopped);
}

TEST(SmoothJoins, ACirclesJoinsAreSmoothAndRecorded) {
    // At this size the contractions end in a few long arcs; where they get stuck, short ones turn by more
    // than a corner.
    const Outcome o = run(initialMesh(disc(72, 24), true), 20);
    expectSound(o.base);
    const PatchMesh& mesh = o.base.mesh;
    ASSERT_GE(mesh.smoothJoins().size(), 4U);
    EXPECT_EQ(o.figure("smooth joins"), double(mesh.smoothJoins().size()));
    EXPECT_EQ(o.figure("corners"), 0);
    EXPECT_EQ(double(mesh.smoothJoins().size()) + o.figure("corners") + o.figure("joins left G0"),
              double(featureCount(mesh)));
    for (const SmoothJoin& join : mesh.smoothJoins()) {
        glm::dvec2 tangents[2];
        for (int k = 0; k < 2; ++k) {
            const EdgeId e = k == 0 ? join.first : join.second;
            EXPECT_TRUE(mesh.curve(e).feature);
            HalfedgeId h = HalfedgeMesh::halfedge(e);
            if (mesh.connectivity().origin(h) != join.vertex) h = HalfedgeMesh::twin(h);
            ASSERT_EQ(mesh.connectivity().origin(h), join.vertex);
            tangents[k] = glm::normalize(toPixels(mesh.controlPoints(h)).derivative(0));
        }
        // One degree is about two lattice units at the end of a handle of half a pixel.
        EXPECT_LT(glm::dot(tangents[0], tangents[1]), -std::cos(1.0 * 3.14159265358979 / 180));
    }
}

TEST(SmoothJoins, ASquaresCornersStay) {
    const Image image = grey(48, 48, [](double x, double y) {
        return std::max(std::abs(x - 24), std::abs(y - 24)) < 14 ? .9 : .1;
    });
    const Outcome o = run(initialMesh(image, true), 20);
    expectSound(o.base);
    EXPECT_GE(o.figure("corners"), 3);
}

// Two straight feature curves that turn by 20 degrees at (12, 12), in a mesh by hand: above the limit a
// corner, below it one tangent.
TEST(SmoothJoins, CornerDegrees) {
    const auto px = [](double x, double y) { return toLattice({x, y}); };
    const double rise = 12 * std::tan(10.0 * 3.14159265358979 / 180);
    const std::vector<LatticePoint> positions{px(0, 0),
                                              px(24, 0),
                                              px(24, 24),
                                              px(0, 24),
                                              px(12, 12),
                                              px(3, 12 + .75 * rise),
                                              px(21, 12 + .75 * rise)};
    const std::vector<std::array<uint32_t, 3>> triangles{{0, 1, 4}, {0, 4, 5}, {5, 3, 0}, {5, 4, 3},
                                                         {4, 2, 3}, {4, 6, 2}, {6, 1, 2}, {4, 1, 6}};
    for (const double limit : {15.0, 25.0}) {
        BaseDomain base{PatchMesh(24, 24, 3, HalfedgeMesh::fromTriangles(7, triangles), positions), {}};
        const HalfedgeMesh& c = base.mesh.connectivity();
        base.paths.resize(c.edgeCapacity());
        base.mesh.forEachEdge([&](EdgeId e) {
            const HalfedgeId h = HalfedgeMesh::halfedge(e);
            base.paths[e.index] = {toPixels(base.mesh.position(c.origin(h))),
                                   toPixels(base.mesh.position(c.target(h)))};
        });
        for (const uint32_t end : {5U, 6U}) {
            const EdgeId e = HalfedgeMesh::edge(c.find(VertexId(4), VertexId(end)));
            EdgeCurve curve = base.mesh.curve(e);
            curve.feature = true;
            base.mesh.setCurve(e, curve);
        }
        ASSERT_THAT(validate(base.mesh).violations, IsEmpty());
        VectorizeSettings settings;
        settings.cornerDegrees = limit;
        Outcome o;
        const PatchMesh before = base.mesh;
        smoothJoins(base, settings, o.report);
        EXPECT_THAT(validate(base.mesh).violations, IsEmpty());
        EXPECT_EQ(o.figure("corners"), limit < 20 ? 1 : 0);
        EXPECT_EQ(base.mesh.smoothJoins().size(), limit < 20 ? 0U : 1U);
        const auto handle = base.mesh.controlPoints(c.find(VertexId(4), VertexId(6)));
        if (limit < 20) {
            EXPECT_EQ(handle, before.controlPoints(c.find(VertexId(4), VertexId(6))));
        } else {
            EXPECT_EQ(handle[1].y, handle[0].y) << "the common tangent is level";
        }
    }
}

}  // namespace
}  // namespace tessera
