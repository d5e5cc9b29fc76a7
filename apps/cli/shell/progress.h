// Progress of long work on standard error: a bar with the time left on a terminal, lines when piped.
// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace sightline::cli {

/// What somebody else than standard error is told of: all work, quiet or not.
/// @param what  "culling"; empty: a piece of work has ended
/// @param part  [0 to 1]
using ProgressWatch = std::function<void(const std::string& what, double part)>;

/// From here on; empty: nobody is. It is called in the threads that work, one at a time.
void watchProgress(ProgressWatch watch);

/// Shows how far one piece of work has come, unless quiet. Thread-safe. Work that is done within half a second shows
/// nothing; longer work shows something from then on, though no step of it be done yet. The time left is that of the
/// steps that this run has done, counted from the first set().
class Progress {
public:
    /// @param what   what is being done: "culling"
    /// @param unit   what is counted: "frames"
    /// @param total  0: not known, and the time that has gone by is shown
    Progress(const std::string& what, std::string unit, size_t total);
    /// Clears the bar.
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// One more is done.
    void step();
    /// So many of so many are done. What the first call says was done before: it tells nothing of the time.
    void set(size_t done, size_t total);

private:
    using Clock = std::chrono::steady_clock;

    void begin(size_t done);
    void show();
    void watch();

    std::mutex mutex_;
    std::condition_variable ended_;
    bool has_ended_ = false;
    std::string what_, unit_;
    size_t done_ = 0, total_ = 0;
    size_t done_before_ = 0;  ///< by an earlier run
    bool terminal_ = false, shown_ = false, counts_ = false;
    Clock::time_point start_;       ///< of the work
    Clock::time_point count_from_;  ///< of what was done after `done_before_`
    Clock::time_point next_;
    std::thread watch_;
};

/// Of a verb as a whole: where nothing has shown progress for two seconds, it says that the work goes on, unless quiet. Work
/// between two Progresses, and several short ones in turn, are so heard of, too.
class SilenceWatch {
public:
    /// @param verb  "cull"
    explicit SilenceWatch(std::string verb);
    ~SilenceWatch();
    SilenceWatch(const SilenceWatch&) = delete;
    SilenceWatch& operator=(const SilenceWatch&) = delete;

private:
    void watch();

    std::string verb_;
    std::mutex mutex_;
    std::condition_variable ended_;
    bool has_ended_ = false;
    std::thread watch_;
};

/// "12 of 100 frames, 3 s left", as Progress shows it.
/// @param before   done by an earlier run, in no time of this one
/// @param seconds  for the steps after these
std::string progressText(size_t before, size_t done, size_t total, const std::string& unit, double seconds);

}  // namespace sightline::cli
