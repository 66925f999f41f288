// Preconditions and invariants that hold in release builds too. A failed check is a bug of ours, never bad
// input.
#pragma once

namespace tessera {

// Prints the condition and its place to stderr and aborts.
[[noreturn]] void checkFailed(const char* condition, const char* file, int line);

}  // namespace tessera

#define TESSERA_CHECK(condition) \
    ((condition) ? static_cast<void>(0) : ::tessera::checkFailed(#condition, __FILE__, __LINE__))
