// How long long work goes on after it was asked to stop.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <limits>
#include <stop_token>
#include <thread>

#include "core/base/progress.h"
#include "core/base/result.h"

namespace tessera {

// A machine that is busy with other things may hold up any one run: work is too slow where it is so each
// time.
constexpr int kStopTries = 3;

// The least of up to kStopTries measurements; the first that is below `limit` is enough.
inline double leastOfTries(double limit, const std::function<double()>& measure) {
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < kStopTries && least >= limit; ++i) least = std::min(least, measure());
    return least;
}

// Milliseconds from a request to stop, made `delayMs` after the start of work(progress), until that returns;
// it must return Stopped.
template <class Work>
double stopLatencyMs(int delayMs, Work&& work) {
    using Clock = std::chrono::steady_clock;
    std::stop_source source;
    Progress progress(source.get_token());
    Clock::time_point asked;
    std::jthread stopper([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(delayMs));
        asked = Clock::now();
        source.request_stop();
    });
    const auto result = work(progress);
    const Clock::time_point ended = Clock::now();
    stopper.join();
    EXPECT_FALSE(result.has_value()) << "was done before it was asked to stop after " << delayMs << " ms";
    if (!result) {
        EXPECT_EQ(result.error().code, ErrorCode::Stopped);
    }
    return std::chrono::duration<double, std::milli>(ended - asked).count();
}

}  // namespace tessera
