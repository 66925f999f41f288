// See cli_render.h.
#include "app/cli_render.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>

#include "app/cli_support.h"
#include "core/document/codec.h"
#include "core/export/rasterize.h"
#include "core/image/image_io.h"
#include "render/gl_objects.h"
#include "render/offscreen_gl.h"
#include "render/renderer.h"

namespace tessera::cli {

namespace {

constexpr double kMaxOutputPixels = 400e6;
constexpr double kMinScale = 1e-6, kMaxScale = 1e6;
constexpr double kMaxSharpen = 4;

struct Arguments {
    std::string input;
    std::string output;
    double scale = 1;
    int width = 0;
    int height = 0;
    int samples = 4;
    double sharpen = 1;
    bool reference = false;
    std::string backend = "cpu";
    bool quiet = false;
};

Result<View> viewFor(const Arguments& arguments, const PatchMesh& mesh) {
    double scale = arguments.scale;
    if (arguments.width > 0) scale = double(arguments.width) / mesh.width();
    if (arguments.height > 0) scale = double(arguments.height) / mesh.height();
    if (scale * mesh.width() * scale * mesh.height() > kMaxOutputPixels)
        return failure(ErrorCode::Usage,
                       "the rendering would have more than 400 million pixels; use a smaller scale");
    return wholePicture(mesh, {scale, scale});
}

// With OpenGL, tile by tile, since a driver limits the size of a framebuffer.
Result<Image> drawWithGl(const PatchMesh& mesh, const View& view, const Arguments& arguments,
                         Progress& progress) {
    constexpr int kTile = 1024;
    const auto context = render::OffscreenGl::create();
    if (!context) return tl::unexpected(context.error());
    auto renderer = render::Renderer::create();
    if (!renderer) return tl::unexpected(renderer.error());
    renderer->setMesh(mesh);
    // As from the processor, with alpha where a patch is left out.
    bool cutOut = false;
    mesh.forEachPatch([&](PatchId p) { cutOut = cutOut || mesh.attributes(p).cutOut; });
    const int channels = cutOut ? kMaxChannels : mesh.channels();
    Image image(view.width, view.height, channels);
    for (int y0 = 0; y0 < view.height; y0 += kTile)
        for (int x0 = 0; x0 < view.width; x0 += kTile) {
            View tile = view;
            tile.origin += glm::dvec2(x0, y0) / view.scale;
            tile.width = std::min(kTile, view.width - x0);
            tile.height = std::min(kTile, view.height - y0);
            const render::OffscreenTarget target(tile.width, tile.height);
            target.bind();
            const auto drawn =
                renderer->draw(tile, {.samples = arguments.samples, .sharpen = arguments.sharpen});
            if (!drawn) return tl::unexpected(drawn.error());
            const Image part = target.read(channels);
            for (int c = 0; c < channels; ++c)
                for (int y = 0; y < tile.height; ++y)
                    for (int x = 0; x < tile.width; ++x) image.at(x0 + x, y0 + y, c) = part.at(x, y, c);
            if (!progress.step(double(y0) / view.height)) return stopped();
        }
    return image;
}

Result<Image> draw(const PatchMesh& mesh, const View& view, const Arguments& arguments, Progress& progress) {
    if (arguments.reference) return rasterizeReference(mesh, view, arguments.sharpen);
    if (arguments.backend == "gl") return drawWithGl(mesh, view, arguments, progress);
    return rasterize(mesh, view, {arguments.samples, arguments.sharpen}, &progress);
}

int run(const Arguments& arguments) {
    if (arguments.backend == "gl" && arguments.samples > 4)
        return report(
            {ErrorCode::Usage, "--backend gl draws 1 or 4 samples a pixel; take --backend cpu for 16"});
    if (const auto format = pictureFormatFor(arguments.output); !format) return report(format.error());
    if (!(arguments.scale >= kMinScale && arguments.scale <= kMaxScale))  // CLI11's range lets NaN through
        return report({ErrorCode::Usage, "--scale is a number from 1e-6 to 1e6"});
    if (!(arguments.sharpen >= 0 && arguments.sharpen <= kMaxSharpen))
        return report({ErrorCode::Usage, "--sharpen is a number from 0 to 4"});
    if (const auto writable = checkWritable(arguments.output); !writable) return report(writable.error());

    StopOnSignal stop;
    const auto document = loadDocument(arguments.input);
    if (!document) return report(document.error());
    const auto view = viewFor(arguments, document->mesh);
    if (!view) return report(view.error());

    ProgressDisplay display(arguments.quiet);
    Progress progress(stop.token(),
                      [&](std::string_view stage, double, double total) { display.show(stage, total); });
    progress.beginStage("render", 1);
    const PatchMesh& mesh = document->mesh;
    const Result<Image> image = draw(mesh, *view, arguments, progress);
    display.clear();
    if (!image) return report(image.error());
    const auto written = stop.whileWriting([&] { return writeImage(*image, arguments.output); });
    return written ? kSuccess : report(written.error());
}

}  // namespace

void addRenderCommand(CLI::App& app, int& exitCode) {
    auto arguments = std::make_shared<Arguments>();
    CLI::App* command = app.add_subcommand("render", "Draw a document as a picture of any size");
    command->add_option("document", arguments->input, "The document")->required();
    command->add_option("-o,--output", arguments->output, "The picture; its suffix says the format")
        ->required()
        ->type_name("OUT.{png,jpg,tif,exr}");
    auto* scale =
        command->add_option("--scale", arguments->scale, "Pixels of the rendering for each of the source")
            ->check(CLI::Range(1e-6, 1e6))
            ->capture_default_str();
    auto* width = command->add_option("--width", arguments->width, "Width in pixels; the height follows")
                      ->check(CLI::Range(1, 1'000'000));
    auto* height = command->add_option("--height", arguments->height, "Height in pixels; the width follows")
                       ->check(CLI::Range(1, 1'000'000));
    scale->excludes(width)->excludes(height);
    width->excludes(height);
    auto* samples = command->add_option("--samples", arguments->samples, "Samples a pixel, averaged")
                        ->check(CLI::IsMember({1, 4, 16}))
                        ->capture_default_str();
    command
        ->add_option("--sharpen", arguments->sharpen,
                     "Factor on the blur of soft edges: 0 draws them hard, 1 as they are, more softer")
        ->check(CLI::Range(0.0, kMaxSharpen))
        ->capture_default_str();
    auto* backend = command
                        ->add_option("--backend", arguments->backend,
                                     "What draws: the processor, or OpenGL 4.5 (no window is needed)")
                        ->check(CLI::IsMember({"cpu", "gl"}))
                        ->capture_default_str();
    command
        ->add_flag("--reference", arguments->reference,
                   "Use the slow renderer that the fast one is tested against: one sample a pixel")
        ->excludes(samples)
        ->excludes(backend);
    command->add_flag("--quiet", arguments->quiet, "Show no progress");
    command->callback([arguments, &exitCode] { exitCode = run(*arguments); });
}

}  // namespace tessera::cli
