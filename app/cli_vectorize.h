// `tessera-cli vectorize`: a picture becomes a document.
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/vectorize/settings.h"

namespace tessera::cli {

// The options that say how to vectorize: shared by `vectorize` and `stages`.
struct VectorizeArguments {
    std::string method;
    int patches = VectorizeSettings{}.patches;
    int threads = 0;
    std::vector<std::string> stages;    // NAME=VARIANT
    std::vector<std::string> settings;  // KEY=VALUE
    bool quiet = false;
};
void addVectorizeOptions(CLI::App& command, VectorizeArguments& arguments);

// What they ask for; Usage where it makes no sense. --set wins over --method and --patches, --stage over
// --set.
Result<VectorizeSettings> settingsFrom(const VectorizeArguments& arguments);

void addVectorizeCommand(CLI::App& app, int& exitCode);

}  // namespace tessera::cli
