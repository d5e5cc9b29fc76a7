// A program that reads for us: started with a pipe, given a time, ended for good.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/foreign/worker_process.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>

#include <fcntl.h>
#include <fmt/core.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace sightline::tools {
namespace {

constexpr double kLongest = 1e8;  // [seconds], so that clocks do not overflow

/// What posix_spawn is to do in the child before it runs the program.
class SpawnPlan {
public:
    explicit SpawnPlan(int output) {
        posix_spawn_file_actions_init(&files);
        posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        posix_spawn_file_actions_adddup2(&files, output, STDOUT_FILENO);
        posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
        posix_spawn_file_actions_addclosefrom_np(&files, STDERR_FILENO + 1);

        // A group of its own: it dies with all that it starts, and Ctrl-C is the parent's to answer.
        posix_spawnattr_init(&attributes);
        posix_spawnattr_setpgroup(&attributes, 0);
        sigset_t none, all;
        sigemptyset(&none);
        sigfillset(&all);
        posix_spawnattr_setsigmask(&attributes, &none);
        posix_spawnattr_setsigdefault(&attributes, &all);
        posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    }
    ~SpawnPlan() {
        posix_spawn_file_actions_destroy(&files);
        posix_spawnattr_destroy(&attributes);
    }
    SpawnPlan(const SpawnPlan&) = delete;
    SpawnPlan& operator=(const SpawnPlan&) = delete;

    posix_spawn_file_actions_t files;
    posix_spawnattr_t attributes;
};

}  // namespace

Status WorkerProcess::start(const std::vector<std::string>& words, double seconds) {
    const auto failed = [&](int error) {
        return Error{Error::Kind::kInput, fmt::format("{} cannot be started: {}", words[0], std::strerror(error))};
    };
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) return failed(errno);
    // The ends must not be where the child's own standard files go.
    for (int& end : ends)
        if (end <= STDERR_FILENO) {
            const int moved = fcntl(end, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
            close(end);
            end = moved;
        }
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    deadline_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                   std::chrono::duration<double>(std::clamp(seconds, 0.0, kLongest)));
    const SpawnPlan plan(ends[1]);
    pid_t child = -1;
    const int error = posix_spawn(&child, words[0].c_str(), &plan.files, &plan.attributes, arguments.data(), environ);
    close(ends[1]);
    if (error != 0) {
        close(ends[0]);
        return failed(error);
    }
    child_ = child;
    pipe_ = ends[0];
    return success();
}

size_t WorkerProcess::read(unsigned char* to, size_t size, const std::function<void()>& waiting) {
    constexpr int kPatience = 200;  // [ms]
    for (;;) {
        if (late()) {
            timed_out_ = true;
            return 0;
        }
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline_ - Clock::now()).count();
        pollfd wait{pipe_, POLLIN, 0};
        const int ready = poll(&wait, 1, static_cast<int>(std::clamp<long>(left, 0, kPatience)));
        if (ready < 0 && errno != EINTR) return 0;
        if (ready <= 0) {
            if (waiting) waiting();
            continue;
        }
        const ssize_t got = ::read(pipe_, to, size);
        if (got >= 0) return static_cast<size_t>(got);
        if (errno != EINTR && errno != EAGAIN) return 0;
    }
}

WorkerProcess::Exit WorkerProcess::finish(bool now) {
    Exit out;
    if (child_ < 0) return out;
    int status = 0;
    pid_t ended = 0;
    bool killed = false;
    for (useconds_t pause = 100; ended == 0; pause = std::min<useconds_t>(2 * pause, 20000)) {
        if (!killed && (now || late())) {
            timed_out_ |= !now;
            kill(-child_, SIGKILL);
            killed = true;
        }
        ended = waitpid(child_, &status, killed ? 0 : WNOHANG);
        if (ended < 0 && errno == EINTR) ended = 0;
        if (ended == 0 && !killed) usleep(pause);
    }
    if (!killed) kill(-child_, SIGKILL);  // what it may have left behind
    if (ended == child_ && WIFEXITED(status)) out.code = WEXITSTATUS(status);
    if (ended == child_ && WIFSIGNALED(status)) out.signal = WTERMSIG(status);
    close(pipe_);
    child_ = pipe_ = -1;
    return out;
}

WorkerProcess::~WorkerProcess() { finish(true); }

}  // namespace sightline::tools
