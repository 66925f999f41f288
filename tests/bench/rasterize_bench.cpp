// Frames a second of both CPU renderers, and the cost of a spline evaluation.
//
//   rasterize_bench [DOCUMENT...]   the fast one alone, of documents that fill views of three sizes
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <limits>

#include "core/base/parallel.h"
#include "core/document/codec.h"
#include "core/export/rasterize.h"
#include "core/mesh/edge_blur.h"
#include "tests/support/test_meshes.h"

namespace tessera {
namespace {

// The shortest of `rounds` runs, in milliseconds.
template <class Body>
double shortest(int rounds, Body&& body) {
    double best = std::numeric_limits<double>::infinity();
    for (int i = 0; i < rounds; ++i) {
        const auto start = std::chrono::steady_clock::now();
        body();
        const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
        best = std::min(best, took.count());
    }
    return best;
}

void benchSplines() {
    std::mt19937 random(1);
    const PatchSpline spline = testing::randomSpline(3, random);
    constexpr size_t kPixels = 768 * 512, kBatch = 256;
    std::uniform_real_distribution<float> unit(0, 1);
    std::vector<float> x(kPixels), y(kPixels);
    for (size_t i = 0; i < kPixels; ++i) {
        const float s = unit(random), t = unit(random) * (1 - s);
        x[i] = s + .5f * t;
        y[i] = float(kDomainHeight) * t;
    }
    float out[3][kBatch];
    float* const outs[] = {out[0], out[1], out[2]};
    std::printf("splines, 16 terms x 3 channels, 768 x 512 points, one thread:\n");
    for (const SplineInstructions instructions : splineInstructions()) {
        const double best = shortest(5, [&] {
            for (size_t i = 0; i < kPixels; i += kBatch)
                evaluateSplinesWith(instructions, spline, 3, x.data() + i, y.data() + i, kBatch, outs);
        });
        std::printf("  %-8s %8.2f ms  %6.2f ns a point\n", nameOf(instructions), best, best * 1e6 / kPixels);
    }
}

void benchRenderers() {
    const PatchMesh curved = testing::curvedMesh(768, 512, 39, 26, 7);
    PatchMesh straight = testing::gridMesh(768, 512, 39, 26);
    straight.forEachPatch([&](PatchId p) { straight.setSpline(p, curved.spline(p)); });
    std::printf("768 x 512 pixels, %zu patches, frames a second (milliseconds):\n", curved.patchCount());
    const auto report = [](const char* what, double ms) {
        std::printf("  %-44s %8.1f  (%.2f)\n", what, 1000 / ms, ms);
    };
    const View view = wholePicture(curved, {1, 1});
    report("reference, curved", shortest(2, [&] { (void)rasterizeReference(curved, view); }));
    for (const int threads : {1, 2})
        withThreads(threads, [&] {
            std::printf(" %d thread%s\n", threads, threads > 1 ? "s" : "");
            report("fast, curved", shortest(200, [&] { (void)rasterize(curved, view); }));
            report("fast, straight", shortest(200, [&] { (void)rasterize(straight, view); }));
            report("fast, curved, owners alone", shortest(20, [&] { (void)locatePixels(curved, view); }));
            report("fast, curved, 4 samples", shortest(5, [&] { (void)rasterize(curved, view, {4}); }));
            View zoomed = view;
            zoomed.scale = {16, 16};
            zoomed.origin = {300.3, 200.7};
            report("fast, curved, x16 zoom into 48 x 32 px",
                   shortest(20, [&] { (void)rasterize(curved, zoomed); }));
        });
}

void benchBlur() {
    PatchMesh mesh = testing::curvedMesh(768, 512, 39, 26, 7);
    size_t features = 0;
    mesh.forEachEdge([&](EdgeId e) {
        EdgeCurve curve = mesh.curve(e);
        if (curve.feature) curve.blurSigma = {.8f, .8f};
        features += curve.feature;
        mesh.setCurve(e, curve);
    });
    const View view = wholePicture(mesh, {1, 1});
    std::printf("the same with a blur of .8 px on %zu features, one thread, milliseconds:\n", features);
    withThreads(1, [&] {
        const auto report = [](const char* what, double ms) { std::printf("  %-44s %8.2f\n", what, ms); };
        report("index of the features", shortest(50, [&] { (void)EdgeBlur(mesh); }));
        report("fast, hard", shortest(50, [&] { (void)rasterize(mesh, view, {.sharpen = 0}); }));
        report("fast, blurred", shortest(50, [&] { (void)rasterize(mesh, view); }));
        report("fast, blurred 4 times as much",
               shortest(20, [&] { (void)rasterize(mesh, view, {.sharpen = 4}); }));
    });
}

// The least of each over `rounds` frames: other programs disturb the time of the processors, too.
void benchDocument(const char* path) {
    const auto document = loadDocument(path);
    if (!document) {
        std::fprintf(stderr, "%s\n", document.error().message.c_str());
        return;
    }
    const PatchMesh& mesh = document->mesh;
    std::printf("%s, %zu patches: milliseconds, and of all processors\n", path, mesh.patchCount());
    for (const auto& [width, height] : {std::pair{768, 512}, {1920, 1080}, {3840, 2160}})
        for (const int samples : {1, 4}) {
            View view;
            view.width = width;
            view.height = height;
            view.scale = glm::dvec2(std::max(double(width) / mesh.width(), double(height) / mesh.height()));
            const int rounds = width < 1000 ? 60 : 12;
            double processors = std::numeric_limits<double>::infinity();
            const double wall = shortest(rounds, [&] {
                const std::clock_t start = std::clock();
                (void)rasterize(mesh, view, {samples});
                processors = std::min(processors, double(std::clock() - start) * 1e3 / CLOCKS_PER_SEC);
            });
            std::printf("  %4d x %4d, %d sample%s %8.2f  (%.2f)\n", width, height, samples,
                        samples > 1 ? "s" : " ", wall, processors);
        }
}

}  // namespace
}  // namespace tessera

int main(int argc, char** argv) {
    for (int i = 1; i < argc; ++i) tessera::benchDocument(argv[i]);
    if (argc > 1) return 0;
    tessera::benchSplines();
    tessera::benchRenderers();
    tessera::benchBlur();
}
