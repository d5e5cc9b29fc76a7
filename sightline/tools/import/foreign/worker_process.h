// A program that reads for us: started with a pipe, given a time, ended for good.
// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "sightline/base/result.h"

namespace sightline::tools {

/// A child process whose standard output is read here. It inherits nothing but its working directory and environment: standard input
/// and error are /dev/null, other files are closed, signals are as at the start of a program. Any thread may have its
/// own, and several at once.
class WorkerProcess {
public:
    /// How it ended.
    struct Exit {
        int code = -1;   ///< of exit(), or -1
        int signal = 0;  ///< that ended it, or 0
    };

    WorkerProcess() = default;
    /// Kills the child and all that it has started.
    ~WorkerProcess();
    WorkerProcess(const WorkerProcess&) = delete;
    WorkerProcess& operator=(const WorkerProcess&) = delete;

    /// @param words  the program's path and its arguments
    /// @param seconds  from now on, until reading stops  [> 0]
    /// Errors are one line that names the program.
    Status start(const std::vector<std::string>& words, double seconds);

    /// Waits for bytes. 0: its output has ended, or the time is over (see timedOut()).
    /// @param waiting  called a few times a second while nothing comes; may be empty
    size_t read(unsigned char* to, size_t size, const std::function<void()>& waiting);

    bool timedOut() const { return timed_out_; }

    /// Gives it what is left of its time to end by itself, if it was not told to end; then kills it.
    /// @param now  do not wait
    Exit finish(bool now);

private:
    using Clock = std::chrono::steady_clock;

    bool late() const { return Clock::now() >= deadline_; }

    int child_ = -1, pipe_ = -1;
    Clock::time_point deadline_;
    bool timed_out_ = false;
};

}  // namespace sightline::tools
