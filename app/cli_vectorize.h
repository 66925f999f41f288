// `tessera-cli vectorize`: a picture becomes a document.
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/vectorize/settings.h"
#include "core/vectorize/vectorize.h"

namespace tessera::cli {

// How good the result shall be: shared by `vectorize`, `stages` and `bench`.
struct QualityArguments {
    std::string preset;
    bool preview = false;
    std::optional<double> features;  // 0..1
};
void addQualityOptions(CLI::App& command, QualityArguments& arguments);

// The options that say how to vectorize: shared by `vectorize` and `stages`.
struct VectorizeArguments {
    std::string method;
    std::optional<int> patches;
    std::optional<double> detail;    // 0..1
    std::optional<double> maxError;  // mean absolute error of a channel, 0..255
    QualityArguments quality;
    int threads = 0;
    std::vector<std::string> stages;    // NAME=VARIANT
    std::vector<std::string> settings;  // KEY=VALUE
    bool quiet = false;
};
void addVectorizeOptions(CLI::App& command, VectorizeArguments& arguments);

// What they ask for, but for a number of patches that depends on the picture; Usage where it makes no sense.
// --set wins over all options but --stage, and --stage over --set.
Result<VectorizeSettings> settingsFrom(const VectorizeArguments& arguments);

// vectorize() with as many patches as --patches, --detail or --max-error ask for, which settings.patches then
// says.
Result<VectorImage> vectorizeAsAsked(const Image& image, const VectorizeArguments& arguments,
                                     VectorizeSettings& settings, Progress& progress,
                                     const StageObserver& observe = {});

void addVectorizeCommand(CLI::App& app, int& exitCode);

}  // namespace tessera::cli
