// A priority queue of millions of contractions of which only the cheapest are ever compared: those below a
// threshold form a heap small enough for the cache, the rest wait unsorted until the heap is empty.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <stop_token>
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
    // any time. The queue must not be empty. Void where all were, or where `stop` is asked for.
    template <class Alive>
    Candidate pop(Alive&& alive, const std::stop_token& stop = {}) {
        while (mHeap.empty() && !mWaiting.empty() && !stop.stop_requested()) refill(alive, stop);
        if (mHeap.empty()) return {0, std::numeric_limits<uint32_t>::max(), 0};
        std::pop_heap(mHeap.begin(), mHeap.end(), after);
        const Candidate top = mHeap.back();
        mHeap.pop_back();
        return top;
    }

  private:
    static bool after(const Candidate& a, const Candidate& b) { return b.before(a); }

    // Moves about a sixteenth of those that wait into the heap. Which ones decides how fast the queue is, but
    // not in which order candidates come out, so that a sample is enough to choose the threshold.
    template <class Alive>
    void refill(Alive&& alive, const std::stop_token& stop) {
        constexpr size_t kLeast = 4096, kShare = 16, kSample = 4096, kStopInterval = 4096;
        const size_t count = mWaiting.size();
        std::vector<float> sample;
        for (size_t i = 0; i < count; i += std::max<size_t>(1, count / kSample))
            sample.push_back(mWaiting[i].cost);
        const size_t wanted = std::min(count, std::max(kLeast, count / kShare));
        const auto quantile = sample.begin() + int64_t((sample.size() - 1) * wanted / count);
        std::nth_element(sample.begin(), quantile, sample.end());
        mThreshold = *quantile;

        size_t kept = 0, i = 0;
        for (; i < count && (i % kStopInterval != 0 || !stop.stop_requested()); ++i) {
            const Candidate c = mWaiting[i];
            if (!alive(c)) continue;
            if (c.cost > mThreshold)
                mWaiting[kept++] = c;
            else
                mHeap.push_back(c);
        }
        mWaiting.erase(mWaiting.begin() + int64_t(kept), mWaiting.begin() + int64_t(i));
        std::make_heap(mHeap.begin(), mHeap.end(), after);
    }

    std::vector<Candidate> mHeap;     // cost <= mThreshold
    std::vector<Candidate> mWaiting;  // the rest
    float mThreshold = -std::numeric_limits<float>::infinity();
};

}  // namespace tessera
