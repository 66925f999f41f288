// Progress of a long job and the way to stop it. A stage calls step() at least every 50 ms of work.
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <stop_token>
#include <string>
#include <string_view>

namespace tessera {

class Progress {
  public:
    // Called with the stage's name, the fraction of the stage and of the whole job, both 0..1. Calls never
    // overlap, but come from any thread; `total` never decreases.
    using Callback = std::function<void(std::string_view stage, double fraction, double total)>;

    Progress() = default;
    explicit Progress(std::stop_token stop, Callback callback = {});

    // Starts a stage that takes `weight` of the whole job (the weights of a job's stages add up to 1).
    void beginStage(std::string_view name, double weight);

    // Reports `fraction` (0..1) of the current stage; at most 50 reports a second reach the callback, and
    // the stage's end.
    // Returns false once the job shall stop. Thread-safe.
    bool step(double fraction);

    bool stopRequested() const { return mStop.stop_requested(); }
    const std::stop_token& stopToken() const { return mStop; }

  private:
    void report(double fraction);

    std::stop_token mStop;
    Callback mCallback;
    std::mutex mMutex;
    std::string mStage;
    double mDone = 0;    // weights of the finished stages
    double mWeight = 0;  // weight of the current one
    double mTotal = 0;
    std::atomic<int64_t> mNextReportNs{0};
};

// A part of a stage: its fractions are those of the stage from `from` to `to`.
class ProgressPart {
  public:
    // Of the whole stage, where no part is named. `progress` outlives this.
    ProgressPart(Progress& progress, double from = 0, double to = 1)
        : mProgress(progress), mFrom(from), mTo(to) {}

    bool step(double fraction) const { return mProgress.step(mFrom + (mTo - mFrom) * fraction); }
    bool stopRequested() const { return mProgress.stopRequested(); }
    ProgressPart part(double from, double to) const {
        return {mProgress, mFrom + (mTo - mFrom) * from, mFrom + (mTo - mFrom) * to};
    }

  private:
    Progress& mProgress;
    double mFrom, mTo;
};

}  // namespace tessera
