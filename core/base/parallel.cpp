// See parallel.h.
#include "core/base/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <thread>
#include <utility>
#include <vector>

namespace tessera {

// The thread sanitizer cannot see into TBB, which is not built for it, and would take every hand-over for a
// race; suppressed, ours in the bodies would be too. So its build has plain threads.
#if defined(__SANITIZE_THREAD__)

namespace {

thread_local int tThreads = 0;  // 0: one a core

}  // namespace

void parallelFor(size_t count, size_t grain, const std::function<void(size_t, size_t)>& body) {
    const size_t step = std::max<size_t>(grain, 1), ranges = (count + step - 1) / step;
    const size_t allowed = tThreads > 0 ? size_t(tThreads) : std::thread::hardware_concurrency();
    std::atomic<size_t> next = 0;
    const auto work = [&] {
        for (size_t i = next++; i < ranges; i = next++) body(i * step, std::min(count, (i + 1) * step));
    };
    std::vector<std::jthread> helpers;
    for (size_t t = 1; t < std::min(allowed, ranges); ++t)
        helpers.emplace_back([&] { withThreads(1, work); });
    work();
}

void withThreads(int threads, const std::function<void()>& body) {
    const int before = std::exchange(tThreads, threads);
    body();
    tThreads = before;
}

#else

void parallelFor(size_t count, size_t grain, const std::function<void(size_t, size_t)>& body) {
    if (count == 0) return;
    tbb::parallel_for(
        tbb::blocked_range<size_t>(0, count, std::max<size_t>(grain, 1)),
        [&](const tbb::blocked_range<size_t>& range) { body(range.begin(), range.end()); },
        tbb::simple_partitioner());
}

void withThreads(int threads, const std::function<void()>& body) {
    tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
    arena.execute(body);
}

#endif

}  // namespace tessera
