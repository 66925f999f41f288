// Arrays whose copies share pages: a copy is a snapshot, and an edit reaches one page of one array.
#include "core/base/paged_array.h"

#include <gtest/gtest.h>

namespace tessera {
namespace {

using Small = PagedArray<int, 2>;  // pages of 4, so that a few elements span several

Small counting(int count) {
    Small array;
    for (int i = 0; i < count; ++i) array.pushBack(i);
    return array;
}

TEST(PagedArray, StartsEmptyAndGrows) {
    EXPECT_TRUE(Small().empty());
    const Small array = counting(9);
    ASSERT_EQ(array.size(), 9U);
    EXPECT_FALSE(array.empty());
    for (size_t i = 0; i < 9; ++i) EXPECT_EQ(array[i], int(i));
    EXPECT_EQ(Small::kPageSize, 4U);
}

TEST(PagedArray, ConstructsFilled) {
    const Small array(6, 7);
    ASSERT_EQ(array.size(), 6U);
    for (size_t i = 0; i < 6; ++i) EXPECT_EQ(array[i], 7);
}

TEST(PagedArray, EqualsByValue) {
    Small array = counting(9);
    const Small snapshot = array;
    EXPECT_TRUE(array == snapshot);
    EXPECT_TRUE(array == counting(9)) << "no page is shared";
    EXPECT_FALSE(array == counting(8));
    array.edit(8) = 7;
    EXPECT_FALSE(array == snapshot);
    array.edit(8) = 8;
    EXPECT_TRUE(array == snapshot);
    // What lies in the last page beyond the end does not count.
    array.resize(5);
    EXPECT_TRUE(array == counting(5));
}

TEST(PagedArray, SnapshotDoesNotSeeEdits) {
    Small array = counting(9);
    const Small snapshot = array;
    array.edit(0) = 100;
    array.edit(8) = 108;
    EXPECT_EQ(array[0], 100);
    EXPECT_EQ(array[8], 108);
    for (size_t i = 0; i < 9; ++i) EXPECT_EQ(snapshot[i], int(i));
}

TEST(PagedArray, OriginalDoesNotSeeEditsOfItsCopy) {
    const Small array = counting(9);
    Small copy = array;
    copy.edit(5) = -5;
    EXPECT_EQ(array[5], 5);
    EXPECT_EQ(copy[5], -5);
}

TEST(PagedArray, AnEditCopiesItsPageAlone) {
    Small array = counting(12);
    const Small snapshot = array;
    for (size_t i = 0; i < 12; ++i) EXPECT_TRUE(array.sharesPage(snapshot, i));
    array.edit(5) = 5;  // the same value: what counts is the page
    for (size_t i = 0; i < 12; ++i) EXPECT_EQ(array.sharesPage(snapshot, i), i < 4 || i >= 8) << i;
}

TEST(PagedArray, ReplacingLeavesSnapshotsAlone) {
    Small array = counting(11);
    const Small snapshot = array;
    array.edit(9) = 90;  // its page is the array's own
    const std::vector<size_t> indices{0, 1, 2, 3, 6, 9, 10};
    std::vector<int> values{100, 101, 102, 103, 106, 109, 110};
    array.replace(indices, values);
    const std::vector<int> expected{100, 101, 102, 103, 4, 5, 106, 7, 8, 109, 110};
    for (size_t i = 0; i < 11; ++i) {
        EXPECT_EQ(array[i], expected[i]);
        EXPECT_EQ(snapshot[i], int(i));
    }
    array.replace({}, {});
    EXPECT_EQ(array[0], 100);
}

TEST(PagedArray, SharesPageOnlyWithinBothArrays) {
    const Small array = counting(6);
    Small shorter = array;
    shorter.resize(5);
    EXPECT_TRUE(array.sharesPage(shorter, 4));
    EXPECT_FALSE(array.sharesPage(shorter, 5));
    EXPECT_FALSE(shorter.sharesPage(array, 5));
    EXPECT_FALSE(array.sharesPage(array, 6));
    EXPECT_FALSE(array.sharesPage(counting(6), 0)) << "equal is not the same";
}

TEST(PagedArray, PushingBackLeavesSnapshotsAlone) {
    Small array = counting(5);
    const Small snapshot = array;
    array.pushBack(5);
    EXPECT_EQ(snapshot.size(), 5U);
    EXPECT_EQ(array.size(), 6U);
    EXPECT_EQ(array[5], 5);
    EXPECT_TRUE(array.sharesPage(snapshot, 0));
    EXPECT_FALSE(array.sharesPage(snapshot, 4));
}

TEST(PagedArray, ResizeShrinksAndFills) {
    Small array = counting(10);
    const Small snapshot = array;
    array.resize(3);
    ASSERT_EQ(array.size(), 3U);
    array.resize(10, -1);
    ASSERT_EQ(array.size(), 10U);
    for (size_t i = 0; i < 3; ++i) EXPECT_EQ(array[i], int(i));
    for (size_t i = 3; i < 10; ++i) EXPECT_EQ(array[i], -1) << "not what stood there before";
    for (size_t i = 0; i < 10; ++i) EXPECT_EQ(snapshot[i], int(i));
    array.resize(0);
    EXPECT_TRUE(array.empty());
}

}  // namespace
}  // namespace tessera
