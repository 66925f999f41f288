// The one place where core uses threads. Results never depend on how many there are: each index writes only
// what is its own, and sums over indices are taken afterwards, in order.
#pragma once

#include <cstddef>
#include <functional>

namespace tessera {

// Calls body(begin, end) over disjoint ranges that cover [0, count), each of at most `grain` indices.
void parallelFor(size_t count, size_t grain, const std::function<void(size_t begin, size_t end)>& body);

// Runs `body` so that parallelFor inside it uses at most `threads` threads; 0 means one for each core.
void withThreads(int threads, const std::function<void()>& body);

}  // namespace tessera
