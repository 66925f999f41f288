// What the commands of tessera-cli share: exit codes, messages, progress, stopping, checks made before long
// work.
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <nlohmann/json.hpp>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "core/base/result.h"
#include "core/image/image_compare.h"
#include "core/vectorize/settings.h"

namespace tessera::cli {

using Json = nlohmann::ordered_json;

// 0, and one for each ErrorCode.
constexpr int kSuccess = 0;
int exitCodeOf(ErrorCode code);

// Prints the error as one line on stderr and gives its exit code.
int report(const Error& error);

// While one lives, SIGINT and SIGTERM stop the job instead of the program: token() is asked to stop at once,
// and where the job has not ended after a grace of kStopGraceMs (reading a large picture, say, cannot be
// interrupted) the program ends with exit code 130 all the same. One at a time.
class StopOnSignal {
  public:
    static constexpr int kStopGraceMs = 150;

    StopOnSignal();
    ~StopOnSignal();
    StopOnSignal(const StopOnSignal&) = delete;
    StopOnSignal& operator=(const StopOnSignal&) = delete;

    std::stop_token token() const { return mSource.get_token(); }

    // Runs `write`, which puts a file in its place, so that the program does not end in the middle of it;
    // Stopped where a stop was asked for before.
    template <class Write>
    Result<void> whileWriting(Write&& write) {
        const std::lock_guard lock(mWriting);
        if (token().stop_requested()) return stopped();
        return write();
    }

  private:
    void watch(std::stop_token end);

    std::stop_source mSource;
    std::mutex mWriting;
    std::jthread mWatcher;
};

// Shows a job's progress on stderr: a bar on a terminal, else a line for each stage; nothing where quiet.
class ProgressDisplay {
  public:
    explicit ProgressDisplay(bool quiet);
    ~ProgressDisplay() { clear(); }
    void show(std::string_view stage, double total);
    // Takes the bar off the terminal.
    void clear();

  private:
    bool mQuiet;
    bool mTerminal;
    bool mDrawn = false;
    std::string mStage;
};

// CannotWrite where a file at `path` could not be created or replaced. Changes nothing.
Result<void> checkWritable(const std::string& path);

Result<std::vector<uint8_t>> readFile(const std::string& path);

double secondsSince(std::chrono::steady_clock::time_point start);
// The most memory that this process has held so far, in MiB.
double peakRssMb();

// Measures of a difference, by the names and units of the field: 0..255, dB; null where infinite or missing.
Json toJson(const ImageDifference& difference);
Json toJson(const VectorizeReport& report);
// Settings by key.
Json toJson(const VectorizeSettings& settings);

// Lines "name  value" for people, aligned; nested objects indented.
void printTable(const Json& object, int indent = 0);

}  // namespace tessera::cli
