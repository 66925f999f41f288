// See cli_render.h.
#include "app/cli_render.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>

#include "app/cli_support.h"
#include "core/document/codec.h"
#include "core/export/rasterize.h"
#include "core/image/image_io.h"

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

int run(const Arguments& arguments) {
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
    const Result<Image> image =
        arguments.reference ? Result<Image>(rasterizeReference(mesh, *view, arguments.sharpen))
                            : rasterize(mesh, *view, {arguments.samples, arguments.sharpen}, &progress);
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
    command
        ->add_flag("--reference", arguments->reference,
                   "Use the slow renderer that the fast one is tested against: one sample a pixel")
        ->excludes(samples);
    command->add_flag("--quiet", arguments->quiet, "Show no progress");
    command->callback([arguments, &exitCode] { exitCode = run(*arguments); });
}

}  // namespace tessera::cli
