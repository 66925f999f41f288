// Another program, timed beside ours by `tessera-cli bench --peer`.
#pragma once

#include <string>

#include "app/cli_support.h"

namespace tessera::cli {

// Usage where the command does not name the picture by {in}.
Result<void> checkPeer(const std::string& command);

// Runs the command by the shell with the picture's path, quoted, in the place of each {in}; what it prints on
// stdout is dropped. "peer_seconds", and "peer_cpu_seconds" of all its processes that it has waited for.
// Usage where it does not end with exit code 0.
Result<Json> measurePeer(const std::string& command, const std::string& picture);

}  // namespace tessera::cli
