// See cli_stages.h.
#include "app/cli_stages.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "app/cli_support.h"
#include "app/cli_vectorize.h"
#include "core/export/rasterize.h"
#include "core/export/wireframe.h"
#include "core/image/image_io.h"
#include "core/vectorize/vectorize.h"

namespace tessera::cli {

namespace {

// Output pixels per image pixel: pixel chains are legible at 2, patches at 4, the pixel grid at 8.
constexpr int kFeatureScale = 2, kPatchScale = 4, kGridScale = 8;
// The initial mesh is drawn around the picture's middle only: all of it would be grey.
constexpr int kGridWindowPx = 160;
constexpr double kResidualGain = 4;

struct Arguments {
    std::string input;
    std::string folder;
    VectorizeArguments how;
};

// Writes the pictures one after another, as 1_NAME.png, 2_NAME.png, ...; keeps the first failure.
class StagePictures {
  public:
    StagePictures(std::filesystem::path folder, bool quiet) : mFolder(std::move(folder)), mQuiet(quiet) {}

    void write(const std::string& name, const Image& picture) {
        ++mNumber;
        if (!mResult) return;
        const std::string path = (mFolder / (std::to_string(mNumber) + "_" + name + ".png")).string();
        mResult = writeImage(picture, path);
        if (mResult && !mQuiet) std::printf("%s\n", path.c_str());
    }
    // From 1 again.
    void restart() { mNumber = 0; }
    const Result<void>& result() const { return mResult; }

  private:
    std::filesystem::path mFolder;
    bool mQuiet;
    int mNumber = 0;
    Result<void> mResult;
};

// Fig. 2 (b) to (g), from what the stages hand on.
StageObserver paperObserver(StagePictures& pictures, const Image& image) {
    StageObserver observe;
    observe.features = [&](const std::vector<PixelChain>& chains) {
        pictures.write("features", drawFeatures(chains, image.width(), image.height(), kFeatureScale, image));
    };
    observe.initialMesh = [&](const ChannelMeshes& meshes) {
        pictures.write("initial_mesh", drawInitialMesh(meshes, kGridWindowPx, kGridScale, image));
    };
    observe.baseDomain = [&](const BaseDomain& base) {
        pictures.write("simplified_mesh", drawPatches(base.mesh, Outline::Curves, kPatchScale, image));
        pictures.write("base_domain", drawPatches(base.mesh, Outline::Chords, kPatchScale, {}));
    };
    observe.initialCurves = [&](const PatchMesh& mesh) {
        pictures.write("initial_patches", drawPatches(mesh, Outline::Curves, kPatchScale, image));
    };
    observe.curves = [&](const PatchMesh& mesh) {
        pictures.write("optimized_patches", drawPatches(mesh, Outline::Curves, kPatchScale, image));
    };
    return observe;
}

StageObserver defaultObserver(StagePictures& pictures, const Image& image) {
    StageObserver observe;
    observe.network = [&](const FeatureNetwork& network) {
        pictures.restart();  // a search for an error may run twice
        pictures.write("features", drawFeatures(network, kPatchScale, image));
    };
    observe.cutMesh = [&](const CutMesh& cut) {
        pictures.write("initial_mesh",
                       drawPatches(toPatchMesh(cut, image.channels()), Outline::Curves, kPatchScale, image));
    };
    observe.refined = [&](const PatchMesh& mesh) {
        pictures.write("refined_mesh", drawPatches(mesh, Outline::Curves, kPatchScale, image));
    };
    observe.curves = [&](const PatchMesh& mesh) {
        pictures.write("curved_patches", drawPatches(mesh, Outline::Curves, kPatchScale, image));
    };
    return observe;
}

Result<void> drawStages(const Arguments& arguments, VectorizeSettings settings, Progress& progress) {
    const auto loaded = readImage(arguments.input);
    if (!loaded) return tl::unexpected(loaded.error());
    const Image& image = loaded->image;
    StagePictures pictures(arguments.folder, arguments.how.quiet);
    const auto vectorized = vectorizeAsAsked(
        image, arguments.how, settings, progress,
        settings.method == "paper" ? paperObserver(pictures, image) : defaultObserver(pictures, image));
    if (!vectorized) return tl::unexpected(vectorized.error());
    const auto rendering = rasterize(vectorized->mesh, wholePicture(vectorized->mesh, {1, 1}), {}, &progress);
    if (!rendering) return tl::unexpected(rendering.error());
    pictures.write("reconstruction", *rendering);
    pictures.write("residual_x4", residual(image, *rendering, kResidualGain));
    return pictures.result();
}

int run(const Arguments& arguments) {
    const auto settings = settingsFrom(arguments.how);
    if (!settings) return report(settings.error());
    std::error_code error;
    std::filesystem::create_directories(arguments.folder, error);
    if (!std::filesystem::is_directory(arguments.folder))
        return report({ErrorCode::CannotWrite,
                       "cannot make the folder '" + arguments.folder + "'; choose another with -o"});
    StopOnSignal stop;
    ProgressDisplay display(arguments.how.quiet);
    Progress progress(stop.token(),
                      [&](std::string_view stage, double, double total) { display.show(stage, total); });
    const auto drawn = drawStages(arguments, *settings, progress);
    display.clear();
    return drawn ? kSuccess : report(drawn.error());
}

}  // namespace

void addStagesCommand(CLI::App& app, int& exitCode) {
    auto arguments = std::make_shared<Arguments>();
    CLI::App* command =
        app.add_subcommand("stages", "Draw what each stage of a vectorization hands to the next, as PNGs");
    command->add_option("input", arguments->input, "The picture")->required();
    command->add_option("-o,--output", arguments->folder, "The folder for the pictures")
        ->required()
        ->type_name("DIR");
    addVectorizeOptions(*command, arguments->how);
    command->callback([arguments, &exitCode] { exitCode = run(*arguments); });
}

}  // namespace tessera::cli
