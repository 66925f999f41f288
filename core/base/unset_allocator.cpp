// See unset_allocator.h.
#include "core/base/unset_allocator.h"

#include <cstdlib>

#if defined(__linux__)
#include <sys/mman.h>

#include "core/base/round_up.h"
#endif

namespace tessera {

void* allocateLarge(size_t bytes) {
    constexpr size_t kPage = size_t{1} << 21, kMuch = 8 * kPage;
    void* memory = nullptr;
#if defined(__linux__)
    if (bytes >= kMuch) {
        const size_t whole = roundUp(bytes, kPage);
        memory = std::aligned_alloc(kPage, whole);
        if (!memory) throw std::bad_alloc();
        (void)madvise(memory, whole, MADV_HUGEPAGE);  // a wish, which may well be refused
        return memory;
    }
#endif
    memory = std::malloc(bytes);
    if (!memory) throw std::bad_alloc();
    return memory;
}

void freeLarge(void* memory) noexcept {
    std::free(memory);
}

}  // namespace tessera
