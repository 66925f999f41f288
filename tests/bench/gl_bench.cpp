// Frames a second of the OpenGL renderer and of the CPU renderer, and the spline evaluations that a pixel
// takes: about 2,000 and 20,000 patches, at three sizes of window, redrawn as it is, panned, and with one
// point dragged.
//
//   gl_bench [DOCUMENT...]   documents to draw; without, meshes made for the purpose
#include <chrono>
#include <cstdio>
#include <ctime>
#include <functional>
#include <string>

#include "core/document/codec.h"
#include "core/export/rasterize.h"
#include "render/gl_objects.h"
#include "render/offscreen_gl.h"
#include "render/renderer.h"
#include "tests/support/test_meshes.h"

namespace tessera {
namespace {

struct Size {
    const char* name;
    int width, height;
};
constexpr Size kSizes[] = {{"768x512", 768, 512}, {"1080p", 1920, 1080}, {"4K", 3840, 2160}};

// The mean time of a frame in milliseconds, and that of all processors together, which other programs disturb
// less: after one to warm up, for kSeconds. A frame that takes longer is its own measure, so that a software
// GL gets to the end.
struct FrameTime {
    double wall = 0, processor = 0;
};
FrameTime timeOf(const std::function<void(int)>& frame) {
    constexpr double kSeconds = 1;
    using Clock = std::chrono::steady_clock;
    const auto meanFrom = [](Clock::time_point start, std::clock_t processorStart, int frames) {
        const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
        const double processor = double(std::clock() - processorStart) / CLOCKS_PER_SEC;
        return FrameTime{seconds / frames * 1e3, processor / frames * 1e3};
    };
    auto start = Clock::now();
    std::clock_t processorStart = std::clock();
    frame(0);
    FrameTime time = meanFrom(start, processorStart, 1);
    if (time.wall > 1e3 * kSeconds) return time;
    start = Clock::now();
    processorStart = std::clock();
    for (int i = 1;; ++i) {
        frame(i);
        time = meanFrom(start, processorStart, i);
        if (time.wall * i >= 1e3 * kSeconds) return time;
    }
}

// A view of the given size that the whole picture fills.
View filledView(const PatchMesh& mesh, const Size& size) {
    View view;
    view.width = size.width;
    view.height = size.height;
    view.scale = glm::dvec2(std::max(double(size.width) / mesh.width(), double(size.height) / mesh.height()));
    return view;
}

View panned(View view, int frame) {
    view.origin += glm::dvec2(frame % 7, frame % 5) * 1.37 / view.scale;
    return view;
}

// Moves a vertex in the middle back and forth; gives the patches around it.
std::vector<PatchId> dragVertex(PatchMesh& mesh, int frame) {
    const HalfedgeMesh& c = mesh.connectivity();
    VertexId middle;
    double nearest = 1e30;
    mesh.forEachVertex([&](VertexId v) {
        const glm::dvec2 off = toPixels(mesh.position(v)) - glm::dvec2(mesh.width(), mesh.height()) * .5;
        const double distance = off.x * off.x + off.y * off.y;
        if (distance >= nearest || c.onBorder(v)) return;
        nearest = distance;
        middle = v;
    });
    std::vector<PatchId> patches;
    mesh.setPosition(middle, mesh.position(middle) + LatticePoint{frame % 2 == 0 ? 40 : -40, 0});
    c.forEachOutgoing(middle, [&](HalfedgeId h) { patches.push_back(c.face(h)); });
    return patches;
}

void report(const char* what, const FrameTime& time) {
    std::printf("    %-24s %8.1f frames/s  (%.2f ms, %.2f ms of processors)\n", what, 1e3 / time.wall,
                time.wall, time.processor);
    std::fflush(stdout);
}

void benchGl(render::Renderer& renderer, const PatchMesh& mesh, const Size& size) {
    const render::OffscreenTarget target(size.width, size.height);
    target.bind();
    const View view = filledView(mesh, size);
    const auto draw = [&](const View& v, const render::DrawOptions& options) {
        const auto drawn = renderer.draw(v, options);
        if (!drawn) std::printf("    %s\n", drawn.error().message.c_str());
        glFinish();
    };
    renderer.setMesh(mesh);
    for (const int samples : {1, 4}) {
        const render::DrawOptions options{.samples = samples};
        std::printf("   OpenGL, %d sample%s a pixel\n", samples, samples > 1 ? "s" : "");
        report("still", timeOf([&](int) { draw(view, options); }));
        report("panning", timeOf([&](int frame) { draw(panned(view, frame), options); }));
        PatchMesh dragged = mesh;
        size_t bytes = 0;
        report("one point dragged", timeOf([&](int frame) {
                   const auto patches = dragVertex(dragged, frame);
                   renderer.update(dragged, patches);
                   draw(view, options);
                   bytes = renderer.uploadedBytes();
               }));
        renderer.setMesh(mesh);
        const auto counts = renderer.drawCounted(view, options);
        const double pixels = double(size.width) * size.height;
        if (counts)
            std::printf(
                "    evaluations a pixel: %.3f, and %.3f for blur; a drag uploads %zu bytes a frame\n",
                counts->colours / pixels, counts->blur / pixels, bytes);
    }
}

void benchCpu(const PatchMesh& mesh, const Size& size) {
    const View view = filledView(mesh, size);
    for (const int samples : {1, 4}) {
        const std::string name = "CPU, " + std::to_string(samples) + (samples > 1 ? " samples" : " sample");
        report(name.c_str(), timeOf([&](int) { (void)rasterize(mesh, view, {samples}); }));
    }
}

// Curved patches, splines of 16 terms, and a blur on a sixth of the edges.
PatchMesh madeMesh(int columns, int rows) {
    PatchMesh mesh = testing::curvedMesh(24 * columns, 24 * rows, columns, rows, 7);
    mesh.forEachEdge([&](EdgeId e) {
        EdgeCurve curve = mesh.curve(e);
        if (!curve.feature || e.index % 2 != 0) return;
        curve.blurSigma = {.8F, .8F};
        mesh.setCurve(e, curve);
    });
    return mesh;
}

int run(int argc, char** argv) {
    std::vector<std::pair<std::string, PatchMesh>> meshes;
    for (int i = 1; i < argc; ++i) {
        auto document = loadDocument(argv[i]);
        if (!document) {
            std::fprintf(stderr, "%s\n", document.error().message.c_str());
            return 1;
        }
        meshes.emplace_back(argv[i], std::move(document->mesh));
    }
    if (meshes.empty()) {
        meshes.emplace_back("made", madeMesh(39, 26));
        meshes.emplace_back("made", madeMesh(123, 82));
    }
    const auto context = render::OffscreenGl::create();
    auto renderer = context ? render::Renderer::create() : tl::unexpected(context.error());
    if (renderer) {
        const render::GlDevice device = render::currentDevice();
        std::printf("%s, OpenGL %s%s\n", device.name.c_str(), device.version.c_str(),
                    device.software ? " (software)" : "");
    } else {
        std::printf("%s\n", renderer.error().message.c_str());
    }
    for (const auto& [name, mesh] : meshes) {
        std::printf("%s: %zu patches\n", name.c_str(), mesh.patchCount());
        for (const Size& size : kSizes) {
            std::printf("  %s\n", size.name);
            if (renderer) benchGl(*renderer, mesh, size);
            benchCpu(mesh, size);
        }
    }
    return 0;
}

}  // namespace
}  // namespace tessera

int main(int argc, char** argv) {
    return tessera::run(argc, argv);
}
