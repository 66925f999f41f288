// The queue of contractions against a sorted list: the same order, whatever the threshold was.
#include "core/vectorize/candidate_queue.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace tessera {
namespace {

struct Order {
    bool operator()(const Candidate& a, const Candidate& b) const { return a.before(b); }
};

const auto kAll = [](const Candidate&) { return true; };

TEST(CandidateQueue, CheapestFirstAndTiesByHalfedge) {
    CandidateQueue queue;
    EXPECT_TRUE(queue.empty());
    queue.push({2, 5, 0});
    queue.push({1, 9, 0});
    queue.push({1, 3, 0});
    queue.push({7, 1, 0});
    for (const uint32_t halfedge : {3U, 9U, 5U, 1U}) EXPECT_EQ(queue.pop(kAll).halfedge, halfedge);
    EXPECT_TRUE(queue.empty());
}

TEST(CandidateQueue, TheOrderOfASortedList) {
    std::mt19937 random(6);
    for (const bool ties : {false, true}) {
        CandidateQueue queue;
        std::set<Candidate, Order> expected;
        uint32_t next = 0;
        const auto push = [&](float least) {
            const auto step = ties ? random() % 7 : random() % 1000000;
            const Candidate c{least + float(step) / (ties ? 7 : 1e6F), next++, 0};
            queue.push(c);
            expected.insert(c);
        };
        for (int k = 0; k < 60000; ++k) push(0);
        // While it empties, new ones come: dearer than the last, as a simplification's are, or anywhere.
        float last = 0;
        while (!expected.empty()) {
            ASSERT_FALSE(queue.empty());
            const Candidate c = queue.pop(kAll);
            ASSERT_EQ(c.halfedge, expected.begin()->halfedge);
            last = c.cost;
            expected.erase(expected.begin());
            if (next < 80000) push(next % 3 ? last : 0);
        }
        EXPECT_TRUE(queue.empty());
    }
}

TEST(CandidateQueue, VoidCandidatesMayBeDropped) {
    CandidateQueue queue;
    for (uint32_t k = 0; k < 20000; ++k) queue.push({float(k % 100), k, k % 5});
    const auto alive = [](const Candidate& c) { return c.stamp == 2; };
    uint32_t seen = 0;
    float last = 0;
    while (!queue.empty()) {
        const Candidate c = queue.pop(alive);
        if (c.halfedge == std::numeric_limits<uint32_t>::max() || !alive(c)) continue;
        ++seen;
        EXPECT_GE(c.cost, last);
        last = c.cost;
    }
    EXPECT_EQ(seen, 4000U);

    for (uint32_t k = 0; k < 100; ++k) queue.push({200, k, 0});
    EXPECT_EQ(queue.pop(alive).halfedge, std::numeric_limits<uint32_t>::max()) << "none is left";
    EXPECT_TRUE(queue.empty());
}

TEST(CandidateQueue, ClearedItStartsAnew) {
    CandidateQueue queue;
    for (uint32_t k = 0; k < 10000; ++k) queue.push({float(k), k, 0});
    queue.pop(kAll);
    queue.clear();
    EXPECT_TRUE(queue.empty());
    queue.push({1, 1, 0});
    EXPECT_EQ(queue.pop(kAll).halfedge, 1U);
}

TEST(CandidateQueue, StopsWithWhatItHas) {
    std::stop_source stop;
    CandidateQueue queue;
    for (uint32_t k = 0; k < 10000; ++k) queue.push({float(k), k, 0});
    stop.request_stop();
    EXPECT_EQ(queue.pop(kAll, stop.get_token()).halfedge, std::numeric_limits<uint32_t>::max());
    EXPECT_FALSE(queue.empty());
    EXPECT_EQ(queue.pop(kAll).halfedge, 0U) << "nothing was lost";
}

}  // namespace
}  // namespace tessera
