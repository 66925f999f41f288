// See cli_support.h.
#include "app/cli_support.h"

#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>

namespace tessera::cli {

namespace {

// Set by the signal handler, which may do no more than that, on whichever thread it runs.
std::atomic<int> signalled = 0;
static_assert(std::atomic<int>::is_always_lock_free);

void onSignal(int) {
    signalled = 1;
}

constexpr auto kPollInterval = std::chrono::milliseconds(10);

std::string numberText(double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.6g", value);
    return text;
}

}  // namespace

int exitCodeOf(ErrorCode code) {
    switch (code) {
        case ErrorCode::Usage:
            return 2;
        case ErrorCode::CannotRead:
            return 3;
        case ErrorCode::DamagedDocument:
            return 4;
        case ErrorCode::CannotWrite:
            return 5;
        case ErrorCode::Internal:
            return 6;
        case ErrorCode::Stopped:
            return 130;
    }
    return 6;
}

int report(const Error& error) {
    std::fprintf(stderr, "tessera-cli: %s\n", error.message.c_str());
    return exitCodeOf(error.code);
}

StopOnSignal::StopOnSignal() {
    signalled = 0;
    struct sigaction action{};
    action.sa_handler = onSignal;
    sigemptyset(&action.sa_mask);
    action.sa_flags = SA_RESTART;
    for (const int signal : {SIGINT, SIGTERM}) sigaction(signal, &action, nullptr);
    mWatcher = std::jthread([this](std::stop_token end) { watch(end); });
}

StopOnSignal::~StopOnSignal() {
    for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, SIG_DFL);
}

void StopOnSignal::watch(std::stop_token end) {
    while (signalled == 0 && !end.stop_requested()) std::this_thread::sleep_for(kPollInterval);
    if (signalled == 0) return;
    mSource.request_stop();
    for (int waited = 0; waited < kStopGraceMs && !end.stop_requested(); waited += int(kPollInterval.count()))
        std::this_thread::sleep_for(kPollInterval);
    if (end.stop_requested()) return;
    const std::lock_guard lock(mWriting);
    if (end.stop_requested()) return;
    _exit(report({ErrorCode::Stopped, "stopped on request"}));
}

ProgressDisplay::ProgressDisplay(bool quiet) : mQuiet(quiet), mTerminal(isatty(STDERR_FILENO) == 1) {}

void ProgressDisplay::show(std::string_view stage, double total) {
    if (mQuiet) return;
    if (!mTerminal) {
        if (stage == mStage) return;
        mStage = stage;
        std::fprintf(stderr, "%s\n", mStage.c_str());
        return;
    }
    constexpr int kWidth = 30;
    const int filled = int(std::lround(total * kWidth));
    std::string bar(size_t(filled), '#');
    bar.resize(kWidth, '.');
    std::fprintf(stderr, "\r[%s] %3d %% %.*s\x1B[K", bar.c_str(), int(total * 100), int(stage.size()),
                 stage.data());
    std::fflush(stderr);
    mDrawn = true;
}

void ProgressDisplay::clear() {
    if (!mDrawn) return;
    std::fprintf(stderr, "\r\x1B[K");
    std::fflush(stderr);
    mDrawn = false;
}

Result<void> checkWritable(const std::string& path) {
    const auto refused = [&](const std::string& why) {
        return failure(ErrorCode::CannotWrite, "'" + path + "' cannot be written: " + why);
    };
    std::error_code error;
    if (path.empty()) return refused("it has no name");
    if (std::filesystem::is_directory(path, error)) return refused("it is a folder");
    if (!std::filesystem::path(path).has_filename()) return refused("it names no file");
    // Where it is a link, the file that the link leads to is what will be replaced.
    const auto target = std::filesystem::weakly_canonical(std::filesystem::absolute(path), error);
    if (error) return refused(error.message());
    const auto folder = target.parent_path();
    if (!std::filesystem::is_directory(folder, error))
        return refused("there is no folder '" + folder.string() + "'");
    if (access(folder.c_str(), W_OK | X_OK) != 0) return refused("the folder does not let files be written");
    if (std::filesystem::exists(target, error) && !std::filesystem::is_regular_file(target, error))
        return refused("it is not a plain file");
    return {};
}

Result<std::vector<uint8_t>> readFile(const std::string& path) {
    std::error_code error;
    const auto unreadable = [&](const std::string& why) {
        return failure(ErrorCode::CannotRead, "'" + path + "' cannot be read: " + why);
    };
    if (!std::filesystem::exists(path, error)) return unreadable("there is no such file");
    if (!std::filesystem::is_regular_file(path, error)) return unreadable("it is not a file");
    std::ifstream file(path, std::ios::binary);
    std::vector<uint8_t> bytes(std::filesystem::file_size(path, error));
    if (error || !file || !file.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(bytes.size())))
        return unreadable("check its permissions");
    return bytes;
}

double secondsSince(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double peakRssMb() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return double(usage.ru_maxrss) / 1024;
}

Json toJson(const ImageDifference& d) {
    const auto finite = [](double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); };
    Json json;
    json["mae"] = d.mae;
    json["mae_r"] = d.maeChannel[0];
    json["mae_g"] = d.maeChannel[1];
    json["mae_b"] = d.maeChannel[2];
    json["euclid"] = d.euclid;
    json["rmse"] = d.rmse;
    json["psnr"] = finite(d.psnr);
    json["mae_luma"] = d.maeLuma;
    json["psnr_luma"] = finite(d.psnrLuma);
    json["ssim"] = d.ssim ? finite(*d.ssim) : Json(nullptr);
    return json;
}

Json toJson(const VectorizeReport& report) {
    Json stages = Json::array();
    for (const StageReport& stage : report.stages) {
        Json figures = Json::object();
        for (const auto& [name, value] : stage.figures) figures[name] = value;
        stages.push_back({{"stage", stage.stage},
                          {"variant", stage.variant},
                          {"seconds", stage.seconds},
                          {"figures", std::move(figures)}});
    }
    return stages;
}

Json toJson(const VectorizeSettings& settings) {
    Json json = Json::object();
    for (const auto& [key, value] : toKeyValues(settings)) json[key] = value;
    return json;
}

void printTable(const Json& object, int indent) {
    size_t width = 0;
    for (const auto& [key, value] : object.items()) width = std::max(width, key.size());
    for (const auto& [key, value] : object.items()) {
        std::printf("%*s%-*s", indent, "", int(width), key.c_str());
        if (value.is_object() && !value.empty()) {
            std::printf("\n");
            printTable(value, indent + 2);
            continue;
        }
        const std::string text = value.is_string()         ? value.get<std::string>()
                                 : value.is_number_float() ? numberText(value.get<double>())
                                 : value.is_null()         ? "-"
                                                           : value.dump();
        std::printf("  %s\n", text.c_str());
    }
}

}  // namespace tessera::cli
