// See cli_vectorize.h.
#include "app/cli_vectorize.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "app/cli_document_facts.h"
#include "app/cli_support.h"
#include "core/base/atomic_file.h"
#include "core/base/parallel.h"
#include "core/document/codec.h"
#include "core/export/rasterize.h"
#include "core/image/image_io.h"
#include "core/vectorize/error_search.h"
#include "core/vectorize/quality.h"
#include "core/vectorize/vectorize.h"

namespace tessera::cli {

namespace {

constexpr double kPreviewSidePx = 256;

struct Arguments {
    std::string input;
    std::string output;
    VectorizeArguments how;
    bool embed = true;
    bool json = false;
};

// The document as a reader will find it: colours rounded as in the file, elements in the file's order. Errors
// and preview are taken from that, so that they are those of the stored document.
Result<Document> asStored(Document document) {
    return encodeDocument(document).and_then(
        [](const std::vector<uint8_t>& bytes) { return decodeDocument(bytes); });
}

Result<ImageDifference> errorsOf(const PatchMesh& mesh, const Image& image, Progress& progress) {
    auto rendering = rasterize(mesh, wholePicture(mesh, {1, 1}), {.samples = 4}, &progress);
    if (!rendering) return tl::unexpected(rendering.error());
    return compareImages(image, *rendering);
}

Result<void> addErrors(Document& document, const Image& image, Progress& progress) {
    auto difference = errorsOf(document.mesh, image, progress);
    if (!difference) return tl::unexpected(difference.error());
    document.difference = *difference;
    return {};
}

// Colours are rounded as finely as their errors deserve; then the errors are those of the rounded ones.
Result<Document> storedWithErrors(Document document, const Image& image, Progress& progress) {
    if (auto added = addErrors(document, image, progress); !added) return tl::unexpected(added.error());
    auto stored = asStored(std::move(document));
    if (!stored) return stored;
    if (auto added = addErrors(*stored, image, progress); !added) return tl::unexpected(added.error());
    return stored;
}

Result<void> addPreview(Document& document, Progress& progress) {
    const double side = std::max(document.mesh.width(), document.mesh.height());
    const double scale = std::min(1.0, kPreviewSidePx / side);
    auto preview =
        rasterize(document.mesh, wholePicture(document.mesh, {scale, scale}), {.samples = 4}, &progress);
    if (!preview) return tl::unexpected(preview.error());
    auto png = encodePng(*preview);
    if (!png) return tl::unexpected(png.error());
    document.previewPng = std::make_shared<const std::vector<uint8_t>>(std::move(*png));
    return {};
}

// From the picture's file to the document's bytes.
struct Outcome {
    Document document;
    std::vector<uint8_t> bytes;
};
Result<Outcome> vectorizeFile(const Arguments& arguments, VectorizeSettings settings, Progress& progress) {
    auto file = readFile(arguments.input);
    if (!file) return tl::unexpected(file.error());
    auto picture = readImage(*file, std::filesystem::path(arguments.input).filename().string());
    if (!picture) return tl::unexpected(picture.error());
    if (progress.stopRequested()) return stopped();
    auto vectorized = vectorizeAsAsked(picture->image, arguments.how, settings, progress);
    if (!vectorized) return tl::unexpected(vectorized.error());

    Document document;
    document.mesh = std::move(vectorized->mesh);
    document.settings = settings;
    document.report = std::move(vectorized->report);
    document.source = std::move(picture->source);
    auto stored = storedWithErrors(std::move(document), picture->image, progress);
    if (!stored) return tl::unexpected(stored.error());
    if (auto added = addPreview(*stored, progress); !added) return tl::unexpected(added.error());
    if (arguments.embed)
        stored->embeddedSource = std::make_shared<const std::vector<uint8_t>>(std::move(*file));
    auto bytes = encodeDocument(*stored);
    if (!bytes) return tl::unexpected(bytes.error());
    return Outcome{std::move(*stored), std::move(*bytes)};
}

void printOutcome(const Arguments& arguments, const Outcome& outcome, double seconds) {
    const Document& d = outcome.document;
    Json json = countsOf(d.mesh);
    json["seconds"] = seconds;
    json["stages"] = toJson(d.report);
    json["peak_rss_mb"] = peakRssMb();
    json["bytes"] = outcome.bytes.size();
    json["errors"] = toJson(*d.difference);
    json["shortfall"] = d.report.shortfall;
    if (arguments.json) {
        std::printf("%s\n", json.dump(2).c_str());
        return;
    }
    if (arguments.how.quiet) return;
    std::printf("%s: %zu patches in %.2f s, mean error %.3f of 255 (%.2f dB), %zu bytes\n",
                arguments.output.c_str(), d.mesh.patchCount(), seconds, d.difference->mae, d.difference->psnr,
                outcome.bytes.size());
    if (!d.report.shortfall.empty()) std::printf("%s\n", d.report.shortfall.c_str());
}

int run(const Arguments& arguments) {
    const auto start = std::chrono::steady_clock::now();
    const auto settings = settingsFrom(arguments.how);
    if (!settings) return report(settings.error());
    // Before the long work, not after it.
    if (const auto writable = checkWritable(arguments.output); !writable) return report(writable.error());

    StopOnSignal stop;
    ProgressDisplay display(arguments.how.quiet);
    Progress progress(stop.token(),
                      [&](std::string_view stage, double, double total) { display.show(stage, total); });
    Result<Outcome> outcome;
    withThreads(settings->threads, [&] { outcome = vectorizeFile(arguments, *settings, progress); });
    display.clear();
    if (!outcome) return report(outcome.error());
    const auto written =
        stop.whileWriting([&] { return writeFileAtomically(arguments.output, outcome->bytes); });
    if (!written) return report(written.error());
    printOutcome(arguments, *outcome, secondsSince(start));
    return kSuccess;
}

// "NAME=VARIANT" cut in two; Usage where there is no '='.
Result<std::pair<std::string, std::string>> cutAtEquals(const std::string& text, const std::string& option) {
    const size_t at = text.find('=');
    if (at == std::string::npos || at == 0)
        return failure(ErrorCode::Usage, option + " takes NAME=VALUE, not '" + text + "'");
    return std::pair(text.substr(0, at), text.substr(at + 1));
}

std::string stagesHelp() {
    std::string help;
    for (const std::string& method : methodNames()) {
        help += "Stages of method '" + method + "' and their variants, for --stage:";
        for (const StageVariants& row : stageTable(method)) {
            help += "\n  " + row.stage + ":";
            for (const std::string& variant : row.variants) help += " " + variant;
        }
        help += "\n";
    }
    help += "Settings and their defaults, for --set:";
    for (const auto& [key, value] : toKeyValues({})) help += "\n  " + key + "=" + value;
    return help;
}

}  // namespace

void addQualityOptions(CLI::App& command, QualityArguments& arguments) {
    command.add_option("--preset", arguments.preset, "draft, standard, fine or max (default: standard)")
        ->type_name("NAME");
    command.add_flag("--preview", arguments.preview, "The same as --preset draft");
    command
        .add_option("--features", arguments.features,
                    "How many outlines are kept sharp: 0 none, 0.5 as usual, 1 twice as many")
        ->type_name("0..1");
}

void addVectorizeOptions(CLI::App& command, VectorizeArguments& arguments) {
    command.add_option("--method", arguments.method,
                       "default, or paper: the method of 2009, to compare with");
    const std::string usual = std::to_string(VectorizeSettings{}.patches);
    command.add_option("--patches", arguments.patches, "How many patches to aim at (default: " + usual + ")")
        ->type_name("N");
    command
        .add_option("--detail", arguments.detail,
                    "As many patches as suit the picture's size: 0 a few large ones, 1 for every texture")
        ->type_name("0..1");
    command
        .add_option("--max-error", arguments.maxError,
                    "As many patches as leave this mean error of 255 a channel; one to four runs")
        ->type_name("E");
    addQualityOptions(command, arguments.quality);
    command
        .add_option("--stage", arguments.stages, "Another variant for one stage; may be given several times")
        ->type_name("NAME=VARIANT")
        ->allow_extra_args(false);
    command.add_option("--set", arguments.settings, "A setting; may be given several times")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
    command.add_option("--threads", arguments.threads, "Threads, 0 for one a core; never changes the result")
        ->capture_default_str();
    command.add_flag("--quiet", arguments.quiet, "Show no progress and no summary");
    command.footer(stagesHelp());
}

namespace {

// 0 to `most`, where it is given.
Result<void> checkRange(const char* option, const std::optional<double>& value, double most) {
    if (!value || (*value >= 0 && *value <= most)) return {};
    char text[40];
    std::snprintf(text, sizeof text, "%g", most);
    return failure(ErrorCode::Usage, std::string(option) + " is a number from 0 to " + text);
}

Result<void> checkOptions(const VectorizeArguments& arguments) {
    if (arguments.threads < 0 || arguments.threads > 1024)
        return failure(ErrorCode::Usage, "--threads is a number from 0 to 1024");
    if (int(bool(arguments.patches)) + int(bool(arguments.detail)) + int(bool(arguments.maxError)) > 1)
        return failure(ErrorCode::Usage, "give one of --patches, --detail and --max-error, not several");
    const QualityArguments& quality = arguments.quality;
    if (quality.preview && !quality.preset.empty() && quality.preset != "draft")
        return failure(ErrorCode::Usage,
                       "--preview is --preset draft; leave it out for --preset " + quality.preset);
    if (arguments.maxError && *arguments.maxError == 0)
        return failure(ErrorCode::Usage, "--max-error is a number above 0");
    for (const auto& checked :
         {checkRange("--detail", arguments.detail, 1), checkRange("--features", quality.features, 1),
          checkRange("--max-error", arguments.maxError, 255)})
        if (!checked) return checked;
    return {};
}

// The paper's method has no rounds, terms or budgets that they could change.
Result<void> checkMethod(const VectorizeArguments& arguments, const VectorizeSettings& settings) {
    if (settings.method != "paper") return {};
    const QualityArguments& quality = arguments.quality;
    const char* option = quality.preview           ? "--preview"
                         : !quality.preset.empty() ? "--preset"
                         : quality.features        ? "--features"
                         : arguments.maxError      ? "--max-error"
                                                   : nullptr;
    if (!option) return {};
    return failure(ErrorCode::Usage, std::string(option) + " is for --method default; leave out one of them");
}

}  // namespace

Result<VectorizeSettings> settingsFrom(const VectorizeArguments& arguments) {
    if (const auto checked = checkOptions(arguments); !checked) return tl::unexpected(checked.error());
    VectorizeSettings settings;
    settings.threads = arguments.threads;
    const QualityArguments& quality = arguments.quality;
    if (quality.preview || !quality.preset.empty())
        if (const auto set = applyPreset(settings, quality.preview ? "draft" : quality.preset); !set)
            return tl::unexpected(set.error());
    if (quality.features) setFeatureShare(settings, *quality.features);
    std::vector<std::pair<std::string, std::string>> pairs;
    if (arguments.patches) pairs.emplace_back("patches", std::to_string(*arguments.patches));
    if (!arguments.method.empty()) pairs.emplace_back("method", arguments.method);
    for (const std::string& text : arguments.settings) {
        auto pair = cutAtEquals(text, "--set");
        if (!pair) return tl::unexpected(pair.error());
        if (pair->first == "patches" && (arguments.detail || arguments.maxError))
            return failure(ErrorCode::Usage, "--set patches contradicts --detail and --max-error");
        pairs.push_back(std::move(*pair));
    }
    for (const std::string& text : arguments.stages) {
        auto pair = cutAtEquals(text, "--stage");
        if (!pair) return tl::unexpected(pair.error());
        pairs.emplace_back("stage." + pair->first, pair->second);
    }
    for (const auto& [key, value] : pairs)
        if (const auto set = setKeyValue(settings, key, value); !set) return tl::unexpected(set.error());
    if (const auto checked = checkMethod(arguments, settings); !checked)
        return tl::unexpected(checked.error());
    return settings;
}

Result<VectorImage> vectorizeAsAsked(const Image& image, const VectorizeArguments& arguments,
                                     VectorizeSettings& settings, Progress& progress,
                                     const StageObserver& observe) {
    if (arguments.detail)
        settings.patches = patchesForDetail(*arguments.detail, image.width(), image.height());
    if (!arguments.maxError) return vectorize(image, settings, progress, observe);
    const auto meanError = [&](const PatchMesh& mesh, Progress& measuring) {
        Document document;
        document.mesh = mesh;
        return storedWithErrors(std::move(document), image, measuring).map([](const Document& d) {
            return d.difference->mae;
        });
    };
    return vectorizeToError(image, settings, {*arguments.maxError, meanError}, progress, observe);
}

void addVectorizeCommand(CLI::App& app, int& exitCode) {
    auto arguments = std::make_shared<Arguments>();
    CLI::App* command =
        app.add_subcommand("vectorize", "Turn a picture into a document of coloured curved patches");
    command->add_option("input", arguments->input, "The picture: PNG, JPEG, TIFF, EXR, ...")->required();
    command->add_option("-o,--output", arguments->output, "The document to write")
        ->required()
        ->type_name("OUT.tessera");
    addVectorizeOptions(*command, arguments->how);
    command->add_flag("--embed,!--no-embed", arguments->embed,
                      "Keep the picture's file in the document (default)");
    command->add_flag("--json", arguments->json, "Print what was done as one JSON object");
    command->callback([arguments, &exitCode] { exitCode = run(*arguments); });
}

}  // namespace tessera::cli
