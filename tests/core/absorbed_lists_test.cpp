// Absorbed lists: Fig. 7's concatenation, reading backwards, and pruning.
#include "core/vectorize/absorbed_lists.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace tessera {
namespace {

using List = AbsorbedLists::List;
using Path = std::vector<uint32_t>;

Path pathOf(const AbsorbedLists& lists, List list) {
    Path path;
    for (const VertexId v : lists.prunedPath(list)) path.push_back(v.index);
    return path;
}

// The list of consecutive pairs of `vertices`, appended one after the other.
List listOf(AbsorbedLists& lists, const Path& vertices) {
    List list = lists.pair(VertexId(vertices[0]), VertexId(vertices[1]));
    for (size_t k = 2; k < vertices.size(); ++k)
        list = lists.joined(list, lists.pair(VertexId(vertices[k - 1]), VertexId(vertices[k])));
    return list;
}

TEST(AbsorbedLists, APairIsItsTwoEnds) {
    AbsorbedLists lists;
    const List list = lists.pair(VertexId(7), VertexId(3));
    EXPECT_EQ(pathOf(lists, list), (Path{7, 3}));
    EXPECT_EQ(pathOf(lists, list.reversed()), (Path{3, 7}));
}

// Fig. 7: v_i collapses into v_j; the three surviving edges k-i append L_ij, and L_kj begins and ends with
// its ends.
TEST(AbsorbedLists, Figure7) {
    constexpr uint32_t i = 0, j = 1;
    AbsorbedLists lists;
    const List contracted = lists.pair(VertexId(i), VertexId(j));
    for (const uint32_t k : {2U, 3U, 4U}) {
        const List ki = lists.pair(VertexId(k), VertexId(i));
        const List kj = lists.joined(ki, contracted);
        EXPECT_EQ(pathOf(lists, kj), (Path{k, i, j}));
        EXPECT_EQ(pathOf(lists, kj.reversed()), (Path{j, i, k}));
        EXPECT_EQ(pathOf(lists, ki), (Path{k, i})) << "the parts are as they were";
    }
}

// The edges are stored in either direction; what was reversed is read so within a longer list, too.
TEST(AbsorbedLists, ReversedPartsInsideAList) {
    AbsorbedLists lists;
    const List ki = lists.pair(VertexId(0), VertexId(2)).reversed();  // 2, 0
    const List ij = lists.pair(VertexId(1), VertexId(0)).reversed();  // 0, 1
    const List kj = lists.joined(ki, ij);
    EXPECT_EQ(pathOf(lists, kj), (Path{2, 0, 1}));
    // Next j collapses into 9.
    const List next = lists.joined(kj, lists.pair(VertexId(1), VertexId(9)));
    EXPECT_EQ(pathOf(lists, next), (Path{2, 0, 1, 9}));
    EXPECT_EQ(pathOf(lists, next.reversed()), (Path{9, 1, 0, 2}));
    // And k into 8, at the other end.
    const List both = lists.joined(next.reversed(), lists.pair(VertexId(2), VertexId(8)));
    EXPECT_EQ(pathOf(lists, both), (Path{9, 1, 0, 2, 8}));
}

TEST(AbsorbedLists, PrunesBranches) {
    AbsorbedLists lists;
    EXPECT_EQ(pathOf(lists, listOf(lists, {0, 1, 2, 1, 3})), (Path{0, 1, 3}));
    EXPECT_EQ(pathOf(lists, listOf(lists, {0, 1, 2, 3, 2, 1, 4})), (Path{0, 1, 4}));
    // A branch at the very end and at the very beginning.
    EXPECT_EQ(pathOf(lists, listOf(lists, {0, 1, 2, 1})), (Path{0, 1}));
    EXPECT_EQ(pathOf(lists, listOf(lists, {0, 5, 0, 1})), (Path{0, 1}));
}

TEST(AbsorbedLists, PrunesLoops) {
    AbsorbedLists lists;
    const List loop = listOf(lists, {0, 1, 2, 3, 1, 4});
    EXPECT_EQ(pathOf(lists, loop), (Path{0, 1, 4}));
    EXPECT_EQ(pathOf(lists, loop.reversed()), (Path{4, 1, 0}));
    // A loop inside a loop, and a vertex of a pruned loop that is passed again later.
    EXPECT_EQ(pathOf(lists, listOf(lists, {0, 1, 2, 3, 2, 1, 4})), (Path{0, 1, 4}));
    EXPECT_EQ(pathOf(lists, listOf(lists, {0, 1, 2, 3, 1, 4, 3, 5})), (Path{0, 1, 4, 3, 5}));
}

TEST(AbsorbedLists, LongListsKeepTheirOrder) {
    AbsorbedLists lists;
    Path expected;
    for (uint32_t k = 0; k < 20000; ++k) expected.push_back(k);
    const List list = listOf(lists, expected);
    EXPECT_EQ(pathOf(lists, list), expected);
    // Joined to a long one from the other side, and read backwards.
    const List more = lists.joined(lists.pair(VertexId(19999), VertexId(20000)).reversed(), list.reversed());
    Path backwards(expected.rbegin(), expected.rend());
    backwards.insert(backwards.begin(), 20000);
    EXPECT_EQ(pathOf(lists, more), backwards);
    std::reverse(backwards.begin(), backwards.end());
    EXPECT_EQ(pathOf(lists, more.reversed()), backwards);
}

// There and back again doubles a list each time; it must neither grow without bound nor overflow its length.
TEST(AbsorbedLists, ListsThatDoubleAreCutShort) {
    AbsorbedLists lists;
    List list = listOf(lists, {0, 1, 2, 3});
    for (int round = 0; round < 40; ++round) {
        list = lists.joined(list, list.reversed());                       // 0 .. 3 .. 0
        list = lists.joined(list, lists.pair(VertexId(0), VertexId(1)));  // .. 1
        list = lists.joined(list, lists.pair(VertexId(1), VertexId(0)));  // .. 0
    }
    EXPECT_EQ(pathOf(lists, list), (Path{0}));
    EXPECT_EQ(pathOf(lists, lists.joined(list, listOf(lists, {0, 7, 8}))), (Path{0, 7, 8}));
}

}  // namespace
}  // namespace tessera
