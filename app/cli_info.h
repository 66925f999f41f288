// `tessera-cli info`: what is in a document.
#pragma once

#include <CLI/App.hpp>

namespace tessera::cli {

void addInfoCommand(CLI::App& app, int& exitCode);

}  // namespace tessera::cli
