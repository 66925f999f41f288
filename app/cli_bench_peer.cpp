// See cli_bench_peer.h.
#include "app/cli_bench_peer.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>

namespace tessera::cli {

namespace {

constexpr std::string_view kPlace = "{in}";

std::string quoted(const std::string& path) {
    std::string text = "'";
    for (const char c : path) text += c == '\'' ? "'\\''" : std::string(1, c);
    return text + "'";
}

std::string lineFor(const std::string& command, const std::string& picture) {
    const std::string path = quoted(picture);
    std::string line = command;
    for (size_t at = line.find(kPlace); at != std::string::npos; at = line.find(kPlace, at + path.size()))
        line.replace(at, kPlace.size(), path);
    return line;
}

double secondsOf(const timeval& time) {
    return double(time.tv_sec) + 1e-6 * double(time.tv_usec);
}

[[noreturn]] void become(const std::string& line) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (nowhere >= 0) dup2(nowhere, STDOUT_FILENO);
    execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
    _exit(127);
}

}  // namespace

Result<void> checkPeer(const std::string& command) {
    if (command.find(kPlace) != std::string::npos) return {};
    return failure(ErrorCode::Usage,
                   "--peer takes a command with {in} in the place of the picture, not '" + command + "'");
}

Result<Json> measurePeer(const std::string& command, const std::string& picture) {
    const std::string line = lineFor(command, picture);
    const auto start = std::chrono::steady_clock::now();
    const pid_t child = fork();
    if (child == 0) become(line);
    if (child < 0) return failure(ErrorCode::Internal, "no process for the peer could be started");
    int status = 0;
    rusage usage{};
    while (wait4(child, &status, 0, &usage) < 0 && errno == EINTR) {
    }
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        return failure(ErrorCode::Usage, "the peer failed: " + line);
    return Json{{"peer_seconds", secondsSince(start)},
                {"peer_cpu_seconds", secondsOf(usage.ru_utime) + secondsOf(usage.ru_stime)}};
}

}  // namespace tessera::cli
