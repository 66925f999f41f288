// See cli_bench.h.
#include "app/cli_bench.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>

#include "app/cli_bench_child.h"
#include "app/cli_bench_features.h"
#include "app/cli_bench_magnify.h"
#include "app/cli_bench_measure.h"
#include "app/cli_bench_peer.h"
#include "app/cli_bench_shapes.h"
#include "app/cli_bench_table.h"
#include "app/cli_support.h"
#include "app/cli_vectorize.h"
#include "core/base/atomic_file.h"
#include "core/base/parallel.h"
#include "core/image/image_probe.h"
#include "core/vectorize/vectorize.h"

namespace tessera::cli {

namespace {

namespace fs = std::filesystem;

struct Arguments {
    std::vector<std::string> inputs;
    std::vector<int> patches{1000, 2000, 4000};
    std::vector<std::string> methods = methodNames();
    std::vector<std::string> settings;
    QualityArguments quality;  // of the methods that have it
    std::string jsonFile;
    std::string peer;  // a command, or empty
    int threads = 0;
    bool times4 = false;
    bool quiet = false;
};

// One thing to measure, and the table that it is a row of.
struct Job {
    enum class Table { Peers, Runs, Magnified, Shapes };
    Table table;
    Json name;  // the row's first columns
    std::function<Result<Json>()> measure;
};

std::string joined(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
    return text;
}

// The pictures in a folder, by what their files hold, ordered by name.
Result<std::vector<std::string>> picturesInFolder(const std::string& folder) {
    std::vector<std::string> files, found;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
        std::error_code ignored;
        if (entry->is_regular_file(ignored)) files.push_back(entry->path().string());
    }
    if (error)
        return failure(ErrorCode::CannotRead, "folder '" + folder + "' cannot be read: " + error.message());
    std::ranges::sort(files);
    for (const std::string& file : files) {
        const auto bytes = readFile(file);
        if (!bytes) return tl::unexpected(bytes.error());
        if (!probeImage(*bytes).format.empty()) found.push_back(file);
    }
    if (found.empty())
        return failure(ErrorCode::CannotRead,
                       "there is no picture in folder '" + folder + "'; name one that has some");
    return found;
}

Result<std::vector<std::string>> picturesIn(const std::vector<std::string>& inputs) {
    std::vector<std::string> pictures;
    for (const std::string& input : inputs) {
        std::error_code error;
        if (!fs::is_directory(input, error)) {
            pictures.push_back(input);
            continue;
        }
        const auto found = picturesInFolder(input);
        if (!found) return found;
        pictures.insert(pictures.end(), found->begin(), found->end());
    }
    return pictures;
}

Result<VectorizeSettings> settingsOf(const Arguments& arguments, const std::string& method, int patches) {
    const std::vector<std::string> known = methodNames();
    if (std::ranges::find(known, method) == known.end())
        return failure(ErrorCode::Usage, "there is no method '" + method + "'; use " + joined(known));
    VectorizeArguments how;
    how.method = method;
    how.patches = patches;
    how.threads = arguments.threads;
    if (method != "paper") how.quality = arguments.quality;
    how.settings = arguments.settings;
    return settingsFrom(how);
}

// Every measurement that is asked for, or why one of them makes no sense.
Result<std::vector<Job>> jobsOf(const Arguments& arguments, const std::vector<std::string>& pictures) {
    std::vector<Job> jobs;
    for (const std::string& path : pictures) {
        const std::string name = fs::path(path).stem().string();
        if (!arguments.peer.empty())
            jobs.push_back({Job::Table::Peers, {{"picture", name}}, [path, command = arguments.peer] {
                                return measurePeer(command, path);
                            }});
        for (const std::string& method : arguments.methods)
            for (const int patches : arguments.patches) {
                const auto settings = settingsOf(arguments, method, patches);
                if (!settings) return tl::unexpected(settings.error());
                jobs.push_back(
                    {Job::Table::Runs,
                     {{"picture", name}, {"method", settings->method}, {"wanted", settings->patches}},
                     [path, s = *settings] { return measureRun(path, s); }});
            }
    }
    if (!arguments.times4) return jobs;
    for (const std::string& path : pictures)
        for (const std::string& method : arguments.methods)
            jobs.push_back({Job::Table::Magnified,
                            {{"picture", fs::path(path).stem().string()}, {"method", method}},
                            [path, s = *settingsOf(arguments, method, 2)] {
                                return readPicture(path).and_then(
                                    [&](const Image& picture) { return measureMagnified(picture, s); });
                            }});
    for (const std::string& shape : shapeNames())
        for (const std::string& method : arguments.methods)
            jobs.push_back({Job::Table::Shapes,
                            {{"picture", shape}, {"method", method}},
                            [shape, s = *settingsOf(arguments, method, 2)] {
                                return measureMagnified(drawShape(shape), s);
                            }});
    return jobs;
}

// A picture that cannot be read is told before the long work.
Result<Json> readAll(const std::vector<std::string>& pictures) {
    for (const std::string& path : pictures)
        if (const auto picture = readPicture(path); !picture) return tl::unexpected(picture.error());
    return Json();
}

struct Tables {
    Json peer;  // of the picture whose runs come next
    std::vector<Json> runs, magnified, shapes;

    void add(Job::Table table, Json row);
};

void Tables::add(Job::Table table, Json row) {
    switch (table) {
        case Job::Table::Peers:
            peer = std::move(row);
            return;
        case Job::Table::Runs:
            if (!peer.is_null()) {
                row.update(peer);
                row["cpu_of_peer"] = row["cpu_seconds"].get<double>() / row["peer_cpu_seconds"].get<double>();
            }
            runs.push_back(std::move(row));
            return;
        case Job::Table::Magnified:
            magnified.push_back(std::move(row));
            return;
        case Job::Table::Shapes:
            shapes.push_back(std::move(row));
            return;
    }
}

std::string labelOf(const Job& job) {
    std::string label;
    for (const auto& [key, value] : job.name.items())
        label += (value.is_string() ? value.get<std::string>() : value.dump()) + " ";
    label.pop_back();
    if (job.table == Job::Table::Peers) return label + " peer";
    return job.table == Job::Table::Runs ? label : "x4: " + label;
}

Result<Tables> measureAll(const Arguments& arguments, const std::vector<Job>& jobs, std::stop_token stop) {
    ProgressDisplay display(arguments.quiet);
    Tables tables;
    for (size_t i = 0; i < jobs.size(); ++i) {
        const Job& job = jobs[i];
        const std::string label = labelOf(job);
        display.show(label, double(i) / double(jobs.size()));
        auto figures = inChild(
            [&] {
                Result<Json> measured;
                withThreads(arguments.threads, [&] { measured = job.measure(); });
                return measured;
            },
            stop);
        if (!figures) {
            display.clear();
            if (figures.error().code != ErrorCode::Stopped)
                figures.error().message = label + ": " + figures.error().message;
            return tl::unexpected(figures.error());
        }
        Json row = job.name;
        row.update(*figures);
        tables.add(job.table, std::move(row));
    }
    return tables;
}

std::vector<Json> withMeans(const std::vector<Json>& rows, const std::vector<std::string>& keys) {
    std::vector<Json> all = rows;
    for (Json& mean : meansOf(rows, keys)) all.push_back(std::move(mean));
    return all;
}

void printRuns(const std::vector<Json>& runs) {
    const std::vector<Json> rows = withMeans(runs, {"method", "wanted"});
    const std::vector<Column> name{{"picture", "picture"}, {"method", "method"}, {"wanted", "wanted", 0}};
    const auto columns = [&](const std::vector<Column>& more) {
        std::vector<Column> all = name;
        all.insert(all.end(), more.begin(), more.end());
        return all;
    };
    printFigures("Quality",
                 columns({{"patches", "patches", 0},
                          {"MAE", "mae"},
                          {"euclid", "euclid"},
                          {"MAE luma", "mae_luma"},
                          {"PSNR", "psnr"},
                          {"SSIM", "ssim", 3},
                          {"seam", "seam_mean"},
                          {"seam p95", "seam_p95"},
                          {"slivers %", "sliver_share", 2, 100},
                          {"median angle", "median_angle", 1},
                          {"folds", "folds"}}),
                 rows);
    printFigures("Features",
                 columns({{"reference px", "reference_px", 0},
                          {"recall %", "recall", 1, 100},
                          {"detail px", "detail_px", 0},
                          {"detail recall %", "detail_recall", 1, 100},
                          {"cut px", "cut_px", 0},
                          {"feature edges %", "feature_share", 1, 100},
                          {"error at edges", "edge_error_ratio"}}),
                 rows);
    std::vector<Column> cost;
    for (const StageVariants& stage : stageTable(methodNames().front()))
        cost.push_back({stage.stage + " s", "seconds_" + stage.stage});
    for (const Column& column :
         {Column{"total s", "seconds"}, Column{"CPU s", "cpu_seconds"}, Column{"MB", "peak_rss_mb", 1},
          Column{"kB", "bytes", 1, 1e-3}, Column{"PSNR decoded", "psnr_decoded"},
          Column{"loss dB", "codec_loss_db", 3}, Column{"JPEG kB", "jpeg_bytes", 1, 1e-3},
          Column{"of JPEG", "bytes_of_jpeg"}})
        cost.push_back(column);
    if (runs.front().contains("cpu_of_peer")) {
        cost.push_back({"peer CPU s", "peer_cpu_seconds"});
        cost.push_back({"CPU of peer", "cpu_of_peer"});
    }
    printFigures("Cost", columns(cost), rows);
}

void printMagnified(const std::string& title, const std::vector<Json>& rows) {
    printFigures(title,
                 {{"picture", "picture"},
                  {"method", "method"},
                  {"patches", "patches", 0},
                  {"coefficients", "coefficients", 0},
                  {"samples", "samples", 0},
                  {"within", "within_budget"},
                  {"PSNR", "psnr"},
                  {"SSIM", "ssim", 3},
                  {"bicubic", "psnr_bicubic"},
                  {"SSIM", "ssim_bicubic", 3},
                  {"Lanczos", "psnr_lanczos"},
                  {"SSIM", "ssim_lanczos", 3},
                  {"over bicubic dB", "advantage_db"}},
                 withMeans(rows, {"method"}));
}

Json toJson(const Arguments& arguments, const Tables& tables) {
    Json json;
    json["version"] = TESSERA_VERSION;
    json["settings"] = arguments.settings;
    if (!arguments.peer.empty()) json["peer"] = arguments.peer;
    json["runs"] = tables.runs;
    json["means"] = meansOf(tables.runs, {"method", "wanted"});
    if (!arguments.times4) return json;
    json["times4"] = tables.magnified;
    json["times4_means"] = meansOf(tables.magnified, {"method"});
    json["shapes"] = tables.shapes;
    json["shapes_means"] = meansOf(tables.shapes, {"method"});
    return json;
}

int run(const Arguments& arguments) {
    if (!arguments.peer.empty())
        if (const auto checked = checkPeer(arguments.peer); !checked) return report(checked.error());
    const auto pictures = picturesIn(arguments.inputs);
    if (!pictures) return report(pictures.error());
    const auto jobs = jobsOf(arguments, *pictures);
    if (!jobs) return report(jobs.error());
    if (!arguments.jsonFile.empty())
        if (const auto writable = checkWritable(arguments.jsonFile); !writable)
            return report(writable.error());

    StopOnSignal stop;
    if (const auto read = inChild([&] { return readAll(*pictures); }, stop.token()); !read)
        return report(read.error());
    auto tables = measureAll(arguments, *jobs, stop.token());
    if (!tables) return report(tables.error());
    printRuns(tables->runs);
    if (arguments.times4) {
        printMagnified("x4, pictures shrunk by 4", tables->magnified);
        printMagnified("x4, shapes drawn from formulas", tables->shapes);
    }
    if (arguments.jsonFile.empty()) return kSuccess;
    const std::string text = toJson(arguments, *tables).dump(2) + "\n";
    const auto written = stop.whileWriting([&] {
        return writeFileAtomically(arguments.jsonFile,
                                   {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
    });
    return written ? kSuccess : report(written.error());
}

constexpr const char* kFooter =
    "Each measurement runs in a child process of its own. Seconds and CPU s (of all threads) are those of "
    "the\n"
    "vectorization; MB is the most memory that the child has held up to its end, with the picture.\n"
    "Errors are those of 'compare', of a rendering with 4 samples a pixel. seam: mean difference of colours\n"
    "across edges that are no features, of the document as stored.\n"
    "slivers: patches whose base triangle has an angle below 8 degrees.\n"
    "folds: what 'validate' finds. kB: the document without the photo; loss dB: what storing it costs.\n"
    "JPEG kB: a JPEG, 4:2:0 with optimized tables, of the stored document's PSNR; of JPEG: kB over it.\n"
    "--peer: a command for the shell, run once for each picture before it; CPU s of all its processes.\n"
    "Reference edges: OpenCV's Canny on 8-bit luma, thresholds 100 and 200, chains of at least 20 pixels.\n"
    "recall: their part within 1 px of a feature. error at edges: mean error within 2 px of them over that\n"
    "of the picture. --times4 uses as many patches as store no more coefficients than the small picture has\n"
    "samples.";

}  // namespace

void addBenchCommand(CLI::App& app, int& exitCode) {
    auto arguments = std::make_shared<Arguments>();
    CLI::App* command = app.add_subcommand("bench", "Measure methods side by side on pictures");
    command->add_option("inputs", arguments->inputs, "Pictures, and folders of pictures")->required();
    command->add_option("--patches", arguments->patches, "How many patches to aim at, one run for each")
        ->type_name("N,N,...")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->capture_default_str();
    command->add_option("--methods", arguments->methods, "The methods to measure")
        ->type_name("NAME,NAME,...")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->capture_default_str();
    command->add_option("--set", arguments->settings, "A setting for all runs; may be given several times")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
    addQualityOptions(*command, arguments->quality);
    command->add_option("--json", arguments->jsonFile, "Write every figure to this file")->type_name("FILE");
    command
        ->add_option("--peer", arguments->peer,
                     "Another program to time beside these; {in} stands for the picture")
        ->type_name("COMMAND");
    command->add_flag("--times4", arguments->times4,
                      "Shrink by 4, vectorize, magnify by 4; beside bicubic and Lanczos");
    command
        ->add_option("--threads", arguments->threads, "Threads, 0 for one a core; never changes the result")
        ->capture_default_str();
    command->add_flag("--quiet", arguments->quiet, "Show no progress");
    command->footer(kFooter);
    command->callback([arguments, &exitCode] { exitCode = run(*arguments); });
}

}  // namespace tessera::cli
