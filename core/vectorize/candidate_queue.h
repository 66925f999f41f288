// A priority queue of millions of contractions of which only the cheapest are ever compared: those below a
// threshold form a heap small enough for the cache, the rest wait unsorted until the heap is empty.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

namespace tessera {

struct Candidate {
    float cost;
    uint32_t halfedge;
    uint32_t stamp;

    // The order in which candidates come out: by cost, ties by halfedge.
    bool before(const Candidate& o) const { return cost != o.cost ? cost < o.cost : halfedge < o.halfedge; }
};

class CandidateQueue {
  public:
    bool empty() const { return mHeap.empty() && mWaiting.empty(); }

    void clear() {
        mHeap.clear();
        mWaiting.clear();
        mThreshold = -std::numeric_limits<float>::infinity();
    }

    void push(const Candidate& c) {
        if (c.cost > mThreshold) {
            mWaiting.push_back(c);
            return;
        }
        mHeap.push_back(c);
        std::push_heap(mHeap.begin(), mHeap.end(), after);
    }

    // Takes the first candidate out. `alive(candidate)` tells which still count: the others may be dropped at
    // any time. The queue must not be empty.
    template <class Alive>
    Candidate pop(Alive&& alive) {
        if (mHeap.empty()) refill(alive);
        if (mHeap.empty()) return {0, std::numeric_limits<uint32_t>::max(), 0};  // all were void
        std::pop_heap(mHeap.begin(), mHeap.end(), after);
        const Candidate top = mHeap.back();
        mHeap.pop_back();
        return top;
    }

  private:
    static bool after(const Candidate& a, const Candidate& b) { return b.before(a); }

    template <class Alive>
    void refill(Alive&& alive) {
        std::erase_if(mWaiting, [&](const Candidate& c) { return !alive(c); });
        if (mWaiting.empty()) return;
        constexpr size_t kLeast = 4096, kShare = 16;
        const size_t count = std::min(mWaiting.size(), std::max(kLeast, mWaiting.size() / kShare));
        std::nth_element(mWaiting.begin(), mWaiting.begin() + int64_t(count - 1), mWaiting.end(),
                         [](const Candidate& a, const Candidate& b) { return a.before(b); });
        mThreshold = mWaiting[count - 1].cost;
        const auto rest = std::partition(mWaiting.begin(), mWaiting.end(),
                                         [this](const Candidate& c) { return c.cost > mThreshold; });
        mHeap.assign(rest, mWaiting.end());
        mWaiting.erase(rest, mWaiting.end());
        std::make_heap(mHeap.begin(), mHeap.end(), after);
    }

    std::vector<Candidate> mHeap;     // cost <= mThreshold
    std::vector<Candidate> mWaiting;  // the rest
    float mThreshold = -std::numeric_limits<float>::infinity();
};

}  // namespace tessera
