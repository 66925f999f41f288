// Files that appear whole or not at all: a temporary beside the target is written, synced and renamed over
// it.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "core/base/result.h"

namespace tessera {

// Puts `bytes` at `path`. An existing file is replaced and its permissions are kept; a symbolic link is
// followed. On failure (CannotWrite) the target is as it was and no temporary is left.
Result<void> writeFileAtomically(const std::string& path, std::span<const uint8_t> bytes);

// The same for libraries that want a path: `write` fills the (existing, empty) file that it is given; what it
// returns or throws is a failure of the whole.
using WriteTemporary = std::function<Result<void>(const std::string& temporaryPath)>;
Result<void> writeFileAtomically(const std::string& path, const WriteTemporary& write);

}  // namespace tessera
