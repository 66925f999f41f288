// Runs a measurement in a process of its own, so that its memory and time are its own too.
#pragma once

#include <functional>
#include <stop_token>

#include "app/cli_support.h"

namespace tessera::cli {

// What `measure` returns, from a fork of this process, which must not have started threads of core's before.
// Infinite and undefined numbers come back as null. Where `stop` is asked for, the child is killed and the
// result is Stopped; where it dies, or memory runs out in it, the result is Internal.
Result<Json> inChild(const std::function<Result<Json>()>& measure, const std::stop_token& stop);

}  // namespace tessera::cli
