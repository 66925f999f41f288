// See progress.h.
#include "core/base/progress.h"

#include <algorithm>
#include <chrono>

namespace tessera {

namespace {

constexpr int64_t kReportIntervalNs = 20'000'000;

int64_t nowNs() {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(
               std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

}  // namespace

Progress::Progress(std::stop_token stop, Callback callback)
    : mStop(std::move(stop)), mCallback(std::move(callback)) {}

void Progress::beginStage(std::string_view name, double weight) {
    const std::lock_guard lock(mMutex);
    mDone = std::min(1.0, mDone + mWeight);
    mWeight = weight;
    mStage = name;
    report(0);
}

bool Progress::step(double fraction) {
    if (stopRequested()) return false;
    const auto due = [this] { return nowNs() >= mNextReportNs.load(std::memory_order_relaxed); };
    const bool ends = fraction >= 1;
    if (mCallback && (ends || due())) {
        const std::lock_guard lock(mMutex);
        // Again under the lock: another thread may have reported while this one waited for it.
        if (due() || (ends && mTotal < std::min(1.0, mDone + mWeight)))
            report(std::clamp(fraction, 0.0, 1.0));
    }
    return !stopRequested();  // whoever was told may have asked for it
}

void Progress::report(double fraction) {
    if (!mCallback) return;
    mNextReportNs.store(nowNs() + kReportIntervalNs, std::memory_order_relaxed);
    mTotal = std::max(mTotal, std::min(1.0, mDone + mWeight * fraction));
    mCallback(mStage, fraction, mTotal);
}

}  // namespace tessera
