// See parallel.h.
#include "core/base/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace tessera {

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

}  // namespace tessera
