// `tessera-cli render`: a document becomes a picture.
#pragma once

#include <CLI/App.hpp>

namespace tessera::cli {

void addRenderCommand(CLI::App& app, int& exitCode);

}  // namespace tessera::cli
