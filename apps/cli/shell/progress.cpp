// Progress of long work on standard error: a bar with the time left on a terminal, lines when piped.
// SPDX-License-Identifier: MIT
#include "apps/cli/shell/progress.h"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <system_error>
#include <utility>

#include <fmt/core.h>
#include <unistd.h>

#include "apps/cli/shell/session.h"
#include "sightline/tools/scene/one_line.h"

namespace sightline::cli {
using namespace tools;
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr milliseconds kSilence(2000), kPatience(500), kTerminalPause(100), kPipedPause(5000);

std::string duration(double seconds) {
    const auto whole = static_cast<long>(seconds + 0.5);
    if (whole >= 86400) return fmt::format("{} d {:02} h", whole / 86400, whole / 3600 % 24);
    if (whole >= 3600) return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
    if (whole >= 60) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
    return fmt::format("{} s", whole);
}

std::mutex g_watch_mutex;
ProgressWatch g_watch;

void tellWatch(const std::string& what, size_t done, size_t total) {
    const std::lock_guard lock(g_watch_mutex);
    if (g_watch)
        g_watch(what, total == 0 ? 0.0 : std::min(1.0, static_cast<double>(done) / static_cast<double>(total)));
}

// When anything was said last, and how many show progress now.
std::atomic<Clock::rep> g_said{0};
std::atomic<int> g_shown_by{0};

/// A reader of standard error who has left is no reason to stop.
void print(const std::string& text) {
    g_said = Clock::now().time_since_epoch().count();
    tell(stderr, text);
    (void)std::fflush(stderr);
}

/// Where the system gives no thread, there is a line with each step alone.
void startWatch(std::thread& thread, const std::function<void()>& watch) {
    if (quiet()) return;
    try {
        thread = std::thread(watch);
    } catch (const std::system_error&) {}
}

}  // namespace

void watchProgress(ProgressWatch watch) {
    const std::lock_guard lock(g_watch_mutex);
    g_watch = std::move(watch);
}

std::string progressText(size_t before, size_t done, size_t total, const std::string& unit, double seconds) {
    const std::string counts = fmt::format("{} of {} {}", done, total, unit);
    if (done >= total) return counts + ", 0 s left";
    if (done <= before) return counts + ", just begun";
    return fmt::format("{}, {} left", counts,
                       duration(seconds * static_cast<double>(total - done) / static_cast<double>(done - before)));
}

Progress::Progress(const std::string& what, std::string unit, size_t total)
    : what_(oneLine(what)),
      unit_(std::move(unit)),
      total_(total),
      terminal_(isatty(STDERR_FILENO)),
      start_(Clock::now()),
      count_from_(start_),
      next_(start_ + kPatience) {
    ++g_shown_by;
    tellWatch(what_, 0, total_);
    nameStep(what_);
    startWatch(watch_, [this] { watch(); });
}

Progress::~Progress() {
    {
        const std::lock_guard lock(mutex_);
        has_ended_ = true;
    }
    ended_.notify_all();
    if (watch_.joinable()) watch_.join();
    --g_shown_by;
    tellWatch({}, 0, 0);
    nameStep({});
    if (terminal_ && shown_) print("\r\033[K");
}

void Progress::step() {
    const std::lock_guard lock(mutex_);
    begin(0);
    ++done_;
    tellWatch(what_, done_, total_);
    show();
}

void Progress::set(size_t done, size_t total) {
    const std::lock_guard lock(mutex_);
    begin(done);
    done_ = done;
    total_ = total;
    tellWatch(what_, done_, total_);
    show();
}

void Progress::begin(size_t done) {
    if (std::exchange(counts_, true)) return;
    done_before_ = done;
    if (done > 0) count_from_ = Clock::now();
}

/// Shows that the work goes on, while a step of it takes long.
void Progress::watch() {
    std::unique_lock lock(mutex_);
    while (!ended_.wait_until(lock, next_, [this] { return has_ended_; })) show();
}

void Progress::show() {
    const auto now = Clock::now();
    if (now < next_) return;
    next_ = now + (terminal_ ? kTerminalPause : kPipedPause);
    shown_ = true;
    const auto secondsSince = [&](Clock::time_point then) { return std::chrono::duration<double>(now - then).count(); };
    const std::string counts = total_ == 0
                                   ? duration(secondsSince(start_)) + " so far"
                                   : progressText(done_before_, done_, total_, unit_, secondsSince(count_from_));
    if (!terminal_) return print(fmt::format("{}: {}\n", what_, counts));
    if (total_ == 0) return print(fmt::format("\r\033[K{}  {}", what_, counts));
    constexpr int kWidth = 30;
    const double part = std::min(1.0, static_cast<double>(done_) / static_cast<double>(total_));
    const auto full = static_cast<size_t>(part * kWidth);
    print(fmt::format("\r\033[K{} {}{} {:3.0f} %  {}", what_, paint(stderr, Tone::kGood, std::string(full, '#')),
                      std::string(kWidth - full, '.'), 100 * part, counts));
}

SilenceWatch::SilenceWatch(std::string verb) : verb_(std::move(verb)) {
    startWatch(watch_, [this] { watch(); });
}

SilenceWatch::~SilenceWatch() {
    {
        const std::lock_guard lock(mutex_);
        has_ended_ = true;
    }
    ended_.notify_all();
    if (watch_.joinable()) watch_.join();
}

void SilenceWatch::watch() {
    const bool terminal = isatty(STDERR_FILENO) == 1;
    const Clock::time_point start = Clock::now();
    Clock::time_point next = start + kSilence;
    std::unique_lock lock(mutex_);
    while (!ended_.wait_until(lock, next, [this] { return has_ended_; })) {
        const Clock::time_point now = Clock::now();
        const Clock::time_point quiet_until = Clock::time_point(Clock::duration(g_said.load())) + kSilence;
        next = std::max(quiet_until, now + kPatience);
        if (now < quiet_until || g_shown_by > 0) continue;
        print(fmt::format("{}: {} so far\n", verb_, duration(std::chrono::duration<double>(now - start).count())));
        next = now + (terminal ? kSilence : kPipedPause);
    }
}

}  // namespace sightline::cli
