// Memory goes back to the system.
#include "core/base/memory.h"

#include <gtest/gtest.h>

#include <fstream>
#include <memory>
#include <vector>

namespace tessera {
namespace {

// Of the process, in pages; 0 where the system does not say.
size_t residentPages() {
    size_t all = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> all >> resident;
    return resident;
}

TEST(Memory, FreedPartsGoBackToTheSystem) {
#if !defined(__GLIBC__) || defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "another allocator";
#endif
    if (residentPages() == 0) GTEST_SKIP() << "no /proc/self/statm";
    constexpr size_t kParts = 100'000, kBytes = 1000;
    const size_t before = residentPages();
    std::vector<std::unique_ptr<char[]>> parts(kParts);
    for (auto& part : parts) {
        part = std::make_unique<char[]>(kBytes);  // zeroed, so that its pages are there
    }
    const auto last = std::make_unique<char[]>(kBytes);  // holds what lies below it
    const size_t held = residentPages();
    parts.clear();
    releaseFreeMemory();
    ASSERT_GT(held, before + 20'000);
    EXPECT_LT(residentPages(), before + (held - before) / 4);
}

}  // namespace
}  // namespace tessera
