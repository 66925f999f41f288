// See cli_bench_child.h.
#include "app/cli_bench_child.h"

#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <exception>
#include <new>

namespace tessera::cli {

namespace {

constexpr int kPollMs = 20;

Result<Json> guarded(const std::function<Result<Json>()>& measure) {
    try {
        return measure();
    } catch (const std::bad_alloc&) {
        return failure(ErrorCode::Internal, "memory ran out; try smaller pictures or fewer patches");
    } catch (const std::exception& error) {
        return failure(ErrorCode::Internal, std::string("unexpected failure: ") + error.what());
    }
}

// The child's whole life. Signals kill it at once: it has no file that could be left half written.
[[noreturn]] void live(const std::function<Result<Json>()>& measure, int pipeEnd) {
    for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, SIG_DFL);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    const Result<Json> result = guarded(measure);
    const Json answer = result
                            ? Json{{"value", *result}}
                            : Json{{"code", int(result.error().code)}, {"message", result.error().message}};
    const std::string text = answer.dump(-1, ' ', false, Json::error_handler_t::replace);
    for (size_t done = 0; done < text.size();) {
        const ssize_t n = write(pipeEnd, text.data() + done, text.size() - done);
        if (n < 0 && errno != EINTR) _exit(1);
        if (n > 0) done += size_t(n);
    }
    _exit(0);
}

// All that the child writes, until it ends or a stop is asked for.
std::string readAll(int pipeEnd, const std::stop_token& stop) {
    std::string text;
    char buffer[4096];
    while (!stop.stop_requested()) {
        pollfd wait{pipeEnd, POLLIN, 0};
        if (poll(&wait, 1, kPollMs) <= 0) continue;
        const ssize_t n = read(pipeEnd, buffer, sizeof buffer);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) break;
        text.append(buffer, size_t(n));
    }
    return text;
}

}  // namespace

Result<Json> inChild(const std::function<Result<Json>()>& measure, const std::stop_token& stop) {
    int ends[2];
    if (pipe(ends) != 0) return failure(ErrorCode::Internal, "no pipe to a process for a measurement");
    const pid_t child = fork();
    if (child == 0) live(measure, ends[1]);
    close(ends[1]);
    if (child < 0) {
        close(ends[0]);
        return failure(ErrorCode::Internal, "no process for a measurement could be started");
    }
    const std::string text = readAll(ends[0], stop);
    close(ends[0]);
    if (stop.stop_requested()) kill(child, SIGKILL);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (stop.stop_requested()) return stopped();
    const Json answer = Json::parse(text, nullptr, false);
    if (!answer.is_object())
        return failure(ErrorCode::Internal, WIFSIGNALED(status) ? "a measurement ended by signal " +
                                                                      std::to_string(WTERMSIG(status)) +
                                                                      "; memory may have run out"
                                                                : "a measurement ended without a result");
    if (answer.contains("message"))
        return failure(ErrorCode(answer["code"].get<int>()), answer["message"].get<std::string>());
    return answer["value"];
}

}  // namespace tessera::cli
