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

    // Reports `fraction` (0..1) of the current stage; at most 50 reports a second reach the callback.
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

}  // namespace tessera
