// `tessera-cli bench`: measures methods side by side on pictures.
#pragma once

#include <CLI/App.hpp>

namespace tessera::cli {

void addBenchCommand(CLI::App& app, int& exitCode);

}  // namespace tessera::cli
