// `tessera-cli validate`: whether a document's mesh is what it claims to be.
#pragma once

#include <CLI/App.hpp>

namespace tessera::cli {

void addValidateCommand(CLI::App& app, int& exitCode);

}  // namespace tessera::cli
