// Progress of a job: totals that only grow, weights of stages, stopping, and how often it reports.
#include "core/base/progress.h"

#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <thread>
#include <vector>

namespace tessera {
namespace {

struct Report {
    std::string stage;
    double fraction;
    double total;
};

// A progress whose reports are kept.
struct Recorder {
    std::stop_source stop;
    std::vector<Report> reports;
    Progress progress{stop.get_token(), [this](std::string_view stage, double fraction, double total) {
                          reports.push_back({std::string(stage), fraction, total});
                      }};

    // step() after the pause that lets it through to the callback.
    bool stepAfterPause(double fraction) {
        std::this_thread::sleep_for(std::chrono::milliseconds(25));
        return progress.step(fraction);
    }
};

TEST(Progress, WithoutCallbackOrStopGoesOn) {
    Progress progress;
    progress.beginStage("only", 1);
    EXPECT_TRUE(progress.step(.5));
    EXPECT_FALSE(progress.stopRequested());
}

TEST(Progress, StagesHaveTheirWeights) {
    Recorder r;
    r.progress.beginStage("first", .25);
    EXPECT_TRUE(r.stepAfterPause(.5));
    r.progress.beginStage("second", .75);
    EXPECT_TRUE(r.stepAfterPause(1));
    ASSERT_EQ(r.reports.size(), 4U);
    EXPECT_EQ(r.reports[0].stage, "first");
    EXPECT_DOUBLE_EQ(r.reports[0].total, 0);
    EXPECT_DOUBLE_EQ(r.reports[1].fraction, .5);
    EXPECT_DOUBLE_EQ(r.reports[1].total, .125);
    EXPECT_EQ(r.reports[2].stage, "second");
    EXPECT_DOUBLE_EQ(r.reports[2].fraction, 0);
    EXPECT_DOUBLE_EQ(r.reports[2].total, .25);
    EXPECT_DOUBLE_EQ(r.reports[3].total, 1);
}

TEST(Progress, AStagesEndIsReportedOnceHoweverSoon) {
    Recorder r;
    r.progress.beginStage("quick", 1);
    for (const double fraction : {.5, 1.0, 1.0}) EXPECT_TRUE(r.progress.step(fraction));
    ASSERT_EQ(r.reports.size(), 2U);
    EXPECT_EQ(r.reports[1].fraction, 1);
    EXPECT_EQ(r.reports[1].total, 1);
}

TEST(Progress, TotalNeverDecreases) {
    Recorder r;
    r.progress.beginStage("only", 1);
    for (const double fraction : {.6, .2, -1.0, 2.0, .4}) r.stepAfterPause(fraction);
    ASSERT_EQ(r.reports.size(), 6U);
    for (size_t i = 1; i < r.reports.size(); ++i) {
        EXPECT_GE(r.reports[i].total, r.reports[i - 1].total);
        EXPECT_GE(r.reports[i].fraction, 0);
        EXPECT_LE(r.reports[i].fraction, 1);
    }
    EXPECT_DOUBLE_EQ(r.reports[2].total, .6);
    EXPECT_DOUBLE_EQ(r.reports.back().total, 1);
}

TEST(Progress, StopsOnRequest) {
    Recorder r;
    r.progress.beginStage("only", 1);
    EXPECT_TRUE(r.progress.step(.1));
    r.stop.request_stop();
    EXPECT_FALSE(r.progress.step(.2));
    EXPECT_TRUE(r.progress.stopRequested());
    EXPECT_EQ(r.reports.size(), 1U) << "a stopped job reports no more";
}

TEST(Progress, AStopThatAReportBringsIsHeededByItsStep) {
    std::stop_source stop;
    Progress progress(stop.get_token(), [&](std::string_view, double fraction, double) {
        if (fraction >= 1) stop.request_stop();
    });
    progress.beginStage("only", 1);
    EXPECT_TRUE(progress.step(.5));
    EXPECT_FALSE(progress.step(1));
}

TEST(Progress, ReportsAtMostFiftyTimesASecond) {
    Recorder r;
    const auto start = std::chrono::steady_clock::now();
    r.progress.beginStage("only", 1);
    std::chrono::duration<double> took{};
    for (int i = 0; (took = std::chrono::steady_clock::now() - start).count() < .2; ++i)
        r.progress.step(std::min(1.0, i * 1e-6));
    // The stage's beginning is a report, too.
    EXPECT_LE(double(r.reports.size()), 2 + took.count() * 50);
    EXPECT_GE(r.reports.size(), 2U);
}

// The first to arrive reports; those that wait for it meanwhile have nothing to add.
TEST(Progress, CallsFromSeveralThreadsNeitherOverlapNorPileUp) {
    int inside = 0, most = 0;
    std::vector<std::chrono::steady_clock::time_point> calls;
    Progress progress({}, [&](std::string_view, double, double) {
        calls.push_back(std::chrono::steady_clock::now());
        most = std::max(most, ++inside);
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        --inside;
    });
    progress.beginStage("only", 1);
    {
        std::vector<std::jthread> threads;
        for (int t = 0; t < 4; ++t)
            threads.emplace_back([&] {
                for (int i = 0; i < 200; ++i) {
                    progress.step(i / 200.0);
                    std::this_thread::sleep_for(std::chrono::microseconds(500));
                }
            });
    }
    EXPECT_EQ(most, 1);
    ASSERT_GE(calls.size(), 2U);
    for (size_t i = 1; i < calls.size(); ++i)
        EXPECT_GE(std::chrono::duration<double>(calls[i] - calls[i - 1]).count(), .019) << i;
}

// A report is made of the first step alone here: the others come too soon.
double reportedBy(double from, double to, double fraction) {
    double reported = -1;
    Progress progress({}, [&](std::string_view, double stage, double) { reported = stage; });
    progress.beginStage("only", 1);
    std::this_thread::sleep_for(std::chrono::milliseconds(25));
    EXPECT_TRUE(ProgressPart(progress).part(.2, .6).part(from, to).step(fraction));
    return reported;
}

TEST(ProgressPart, FractionsAreOfAPartOfAPart) {
    EXPECT_DOUBLE_EQ(reportedBy(0, 1, 0), .2);
    EXPECT_DOUBLE_EQ(reportedBy(0, 1, 1), .6);
    EXPECT_DOUBLE_EQ(reportedBy(.5, 1, .5), .5);
}

TEST(ProgressPart, KnowsOfAStop) {
    std::stop_source source;
    Progress progress(source.get_token());
    const ProgressPart part(progress, .2, .6);
    EXPECT_FALSE(part.stopRequested());
    source.request_stop();
    EXPECT_TRUE(part.stopRequested());
    EXPECT_FALSE(part.step(.5));
}

}  // namespace
}  // namespace tessera
