// How long edits take on a document with many patches: edit_bench DOCUMENT.tessera. Wall and processor time
// of a call, the median of some.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <functional>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "core/document/codec.h"
#include "core/edit/brush.h"
#include "core/edit/drag_colour.h"
#include "core/edit/enclosed_region.h"
#include "core/edit/palette.h"
#include "core/edit/recolour.h"
#include "core/edit/refit.h"
#include "core/edit/reshape.h"
#include "core/edit/select.h"
#include "core/edit/snap.h"
#include "core/edit/split_merge.h"
#include "core/export/rasterize.h"
#include "tests/support/colour_change.h"

namespace {

using namespace tessera;

double median(std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + long(values.size() / 2), values.end());
    return values[values.size() / 2];
}

void measure(const std::string& what, int times, const std::function<void(int)>& run) {
    using Clock = std::chrono::steady_clock;
    std::vector<double> wall, processor;
    for (int i = 0; i < times; ++i) {
        const auto before = Clock::now();
        const std::clock_t ticks = std::clock();
        run(i);
        processor.push_back(1e3 * double(std::clock() - ticks) / CLOCKS_PER_SEC);
        wall.push_back(std::chrono::duration<double, std::milli>(Clock::now() - before).count());
    }
    std::printf("%-46s %9.2f ms wall %9.2f ms cpu %9.2f ms worst\n", what.c_str(), median(wall),
                median(processor), *std::max_element(wall.begin(), wall.end()));
}

// About `count` patches around a seed.
PatchSet region(const PatchMesh& mesh, PatchId seed, size_t count) {
    PatchSet set{seed};
    while (set.size() < count && set.size() < mesh.patchCount()) set = grown(mesh, set);
    return set;
}

void measureSelection(const PatchMesh& mesh) {
    const auto seed = [&](int i) { return PatchId(uint32_t(size_t(i) * 997 % mesh.patchCount())); };
    measure("patch colours, once", 5, [&](int) { PatchColours{mesh}; });
    const PatchColours colours(mesh);
    size_t found = 0;
    measure("wand", 41, [&](int i) { found += wand(mesh, colours, seed(i), {}).size(); });
    measure("wand, whole picture", 41,
            [&](int i) { found += wand(mesh, colours, seed(i), {.1, false}).size(); });
    measure("wand without colours", 5, [&](int i) { found += wand(mesh, seed(i), {}).size(); });
    measure("region enclosed by features", 41,
            [&](int i) { found += enclosedByFeatures(mesh, colours, seed(i), 32).size(); });
    const PatchSet set = region(mesh, seed(3), mesh.patchCount() / 4);
    measure("grow a quarter", 11, [&](int) { found += grown(mesh, set).size(); });
    measure("outline of a quarter", 11, [&](int) { found += outline(mesh, set).size(); });
    measure("palette of 8", 5, [&](int) { found += palette(mesh, colours, 8).entries.size(); });
    std::printf("  (%zu patches found)\n", found);
}

void measureRecolour(const PatchMesh& mesh) {
    for (const size_t count : {size_t(200), size_t(2000), mesh.patchCount()}) {
        const PatchSet set = region(mesh, PatchId(uint32_t(mesh.patchCount() / 2)), count);
        const std::string of = ", " + std::to_string(set.size()) + " patches";
        const Recolourer gesture(mesh, set);
        PatchMesh work = mesh;
        measure("recolour frame, levels" + of, 21, [&](int i) {
            work = mesh;
            gesture.apply(work, Levels{.01 * (i + 1), 0});
        });
        measure("recolour frame, hue" + of, 21, [&](int i) {
            work = mesh;
            gesture.preview(work, ColourShift{8.0 * (i + 1), 1, 0});
        });
        measure("recolour frame, gradient" + of, 3, [&](int i) {
            work = mesh;
            gesture.preview(work, GradientRecolour{{0, 0}, {900.0 + i, 700}, {1, 0, 0}, {0, 0, 1}, .5});
        });
        measure("recolour, last frame, hue" + of, 3, [&](int i) {
            work = mesh;
            gesture.apply(work, ColourShift{8.0 * (i + 1), 1, 0});
        });
        measure("recolour at once, hue" + of, 3, [&](int i) {
            work = mesh;
            recolour(work, set, ColourShift{8.0 * (i + 1), 1, 0});
        });
    }
    const PatchSet some = region(mesh, PatchId(uint32_t(mesh.patchCount() / 2)), 2000);
    measure("start of a feathered gesture, 2000 patches", 3, [&](int) { Recolourer(mesh, some, {30}); });
    const Recolourer feathered(mesh, some, {30});
    measure("feathered frame, hue, 2000 patches", 5, [&](int i) {
        PatchMesh work = mesh;
        feathered.preview(work, ColourShift{8.0 * (i + 1), 1, 0});
    });
    const PatchQuery query(mesh);
    measure("brush of 40 px, one stroke of 300 px", 11, [&](int i) {
        PatchMesh work = mesh;
        const glm::dvec2 from(.3 * mesh.width() + i, .4 * mesh.height());
        brush(work, query, std::vector{from, from + glm::dvec2(300, 60)}, {40, .5, {1, 0, 0}, .7, true});
    });
    measure("drag a colour", 21, [&](int i) {
        PatchMesh work = mesh;
        dragColour(work, PatchId(uint32_t(i * 311)), Barycentric(1.0 / 3), {1, 0, 0});
    });
}

void measureShape(const PatchMesh& mesh) {
    const HalfedgeMesh& c = mesh.connectivity();
    std::vector<VertexId> inner;
    mesh.forEachVertex([&](VertexId v) {
        if (!c.onBorder(v)) inner.push_back(v);
    });
    PatchMesh work = mesh;
    measure("start a drag", 21,
            [&](int i) { ShapeDrag{mesh, {ControlPointRef::of(inner[size_t(i) * 37 % inner.size()])}}; });
    std::vector<ShapeDrag> drags;
    for (size_t i = 0; i < 60; ++i)
        drags.emplace_back(mesh, std::vector{ControlPointRef::of(inner[i * 53 % inner.size()])});
    measure("point drag frame, free (1 px)", 60, [&](int i) { drags[size_t(i)].drag(work, {1, .5}); });
    measure("point drag frame, at the limit (200 px)", 60,
            [&](int i) { drags[size_t(i)].drag(work, {200, 90}); });
    for (const double radius : {150.0, 500.0}) {
        std::vector<ControlPointRef> points;
        const glm::dvec2 middle(.5 * mesh.width(), .5 * mesh.height());
        for (const VertexId v : inner)
            if (glm::distance(toPixels(mesh.position(v)), middle) < radius)
                points.push_back(ControlPointRef::of(v));
        const ShapeDrag drag(mesh, points);
        const std::string of = ", " + std::to_string(points.size()) + " points";
        measure("drag frame, free" + of, 11, [&](int i) { drag.drag(work, {.05 * i, .02}); });
        measure("drag frame, at the limit" + of, 3, [&](int) { drag.drag(work, {200, 90}); });
    }
    const auto photo = rasterize(mesh, wholePicture(mesh, {1, 1}));
    measure("refit the patches of a drag and their ring", 5, [&](int i) {
        PatchMesh copy = mesh;
        refitColours(copy, *photo, drags[size_t(i)].patches());
    });
    std::vector<EdgeId> features;
    mesh.forEachEdge([&](EdgeId e) {
        if (mesh.curve(e).feature) features.push_back(e);
    });
    measure("snap a curve", 11, [&](int i) {
        PatchMesh copy = mesh;
        (void)snapToFeature(copy, *photo, std::array{features[size_t(i) * 31 % features.size()]});
    });
    measure("split an edge", 11, [&](int i) {
        PatchMesh copy = mesh;
        splitEdge(copy, EdgeId(uint32_t(i * 501)), .5);
    });
    measure("merge an edge", 11, [&](int i) {
        PatchMesh copy = mesh;
        mergeEdge(copy, EdgeId(uint32_t(i * 501)));
    });
    for (const uint32_t count : {100U, 3000U}) {
        const std::string of = ", " + std::to_string(count) + " one after the other";
        measure("split patches" + of, 1, [&](int) {
            PatchMesh copy = mesh;
            for (uint32_t i = 0; i < count; ++i)
                (void)splitPatch(copy, PatchId(i * 6 % uint32_t(mesh.patchCount())), Barycentric(1.0 / 3));
        });
        measure("merge edges" + of, 1, [&](int) {
            PatchMesh copy = mesh;
            for (uint32_t i = 0; i < count; ++i) {
                const EdgeId e(i * 9 % uint32_t(c.edgeCapacity()));
                if (copy.connectivity().alive(e)) (void)mergeEdge(copy, e);
            }
        });
    }
    const auto changeBy = [&](const char* what, const auto& edit) {
        std::vector<double> changes;
        for (uint32_t i = 0; i < 101; ++i) {
            PatchMesh copy = mesh;
            const Result<Touched> touched = edit(copy, i * 501);
            if (touched) changes.push_back(testing::meanColourChange(mesh, copy, touched->patches));
        }
        const double worst = *std::max_element(changes.begin(), changes.end());
        std::printf("%-46s %9.3f levels, at most %.3f, of %zu\n", what, median(changes), worst,
                    changes.size());
    };
    changeBy("colour change by a merge",
             [](PatchMesh& copy, uint32_t i) { return mergeEdge(copy, EdgeId(i)); });
    changeBy("colour change by the split of an edge",
             [](PatchMesh& copy, uint32_t i) { return splitEdge(copy, EdgeId(i), .4); });
    changeBy("colour change by the split of a patch", [&](PatchMesh& copy, uint32_t i) {
        return splitPatch(copy, PatchId(i % uint32_t(mesh.patchCount())), Barycentric(1.0 / 3));
    });
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: edit_bench DOCUMENT.tessera\n");
        return 2;
    }
    const auto document = loadDocument(argv[1]);
    if (!document) {
        std::fprintf(stderr, "%s\n", document.error().message.c_str());
        return 1;
    }
    const PatchMesh& mesh = document->mesh;
    std::printf("%d x %d px, %zu patches\n", mesh.width(), mesh.height(), mesh.patchCount());
    measure("open the document", 3, [&](int) { (void)loadDocument(argv[1]); });
    measureSelection(mesh);
    measureRecolour(mesh);
    measureShape(mesh);
    return 0;
}
