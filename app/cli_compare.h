// `tessera-cli compare`: how far two pictures are apart.
#pragma once

#include <CLI/App.hpp>

namespace tessera::cli {

void addCompareCommand(CLI::App& app, int& exitCode);

}  // namespace tessera::cli
