#include "core/base/shared_list.h"

#include <gtest/gtest.h>

namespace tessera {
namespace {

TEST(SharedList, HasTheElementsThatItWasMadeOf) {
    const std::vector<uint8_t> elements{4, 2, 7};
    const SharedList<uint8_t> list = elements;
    ASSERT_EQ(list.size(), 3U);
    EXPECT_TRUE(std::equal(list.begin(), list.end(), elements.begin()));
    EXPECT_EQ(list[2], 7);
    const std::span<const uint8_t> span = list;
    EXPECT_EQ(span.data(), list.data());
    EXPECT_EQ(list, (SharedList<uint8_t>{4, 2, 7}));
}

TEST(SharedList, EmptyOnesAreEqualAndHoldNothing) {
    const SharedList<int> none, made(std::vector<int>{});
    EXPECT_TRUE(none.empty() && made.empty());
    EXPECT_EQ(none, made);
    EXPECT_EQ(none.begin(), none.end());
    EXPECT_EQ(made.data(), nullptr);
}

TEST(SharedList, CopiesShareAndAssigningLeavesThemAlone) {
    SharedList<int> list{1, 2};
    const SharedList<int> copy = list;
    EXPECT_TRUE(copy.shares(list));
    list = {3};
    EXPECT_FALSE(copy.shares(list));
    EXPECT_EQ(copy, (SharedList<int>{1, 2}));
    EXPECT_EQ(list, (SharedList<int>{3}));
}

TEST(SharedList, ComparesElementsNotMemory) {
    const SharedList<int> list{1, 2}, same{1, 2}, longer{1, 2, 3}, other{1, 3};
    EXPECT_FALSE(list.shares(same));
    EXPECT_TRUE(list == same);
    EXPECT_FALSE(list == longer);
    EXPECT_FALSE(list == other);
}

}  // namespace
}  // namespace tessera
