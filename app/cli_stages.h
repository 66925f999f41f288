// `tessera-cli stages`: pictures of what each stage of a vectorization hands to the next.
#pragma once

#include <CLI/App.hpp>

namespace tessera::cli {

void addStagesCommand(CLI::App& app, int& exitCode);

}  // namespace tessera::cli
