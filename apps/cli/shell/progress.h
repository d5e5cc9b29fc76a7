// Progress of long work on standard error: a bar with the time left on a terminal, lines when piped.
// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <mutex>
#include <string>

namespace sightline::cli {

/// What somebody else than standard error is told of: all work, quiet or not.
/// @param what  "culling"; empty: a piece of work has ended
/// @param part  [0 to 1]
using ProgressWatch = std::function<void(const std::string& what, double part)>;

/// From here on; empty: nobody is. It is called in the threads that work, one at a time.
void watchProgress(ProgressWatch watch);

/// Shows how far one piece of work has come, unless quiet. Thread-safe. Work that is done within half a second shows
/// nothing.
class Progress {
public:
    /// @param what   what is being done: "culling"
    /// @param unit   what is counted: "frames"
    Progress(const std::string& what, std::string unit, size_t total);
    /// Clears the bar.
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// One more is done.
    void step();
    /// So many of so many are done.
    void set(size_t done, size_t total);

private:
    using Clock = std::chrono::steady_clock;

    void show();

    std::mutex mutex_;
    std::string what_, unit_;
    size_t done_ = 0, total_ = 0;
    bool terminal_ = false, shown_ = false;
    Clock::time_point start_, next_;
};

}  // namespace sightline::cli
