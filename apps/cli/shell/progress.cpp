// Progress of long work on standard error: a bar with the time left on a terminal, lines when piped.
// SPDX-License-Identifier: MIT
#include "apps/cli/shell/progress.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include <fmt/core.h>
#include <unistd.h>

#include "apps/cli/shell/session.h"
#include "sightline/tools/scene/one_line.h"

namespace sightline::cli {
using namespace tools;
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kPatience(500), kTerminalPause(100), kPipedPause(5000);

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

/// A reader of standard error who has left is no reason to stop.
void print(const std::string& text) {
    tell(stderr, text);
    (void)std::fflush(stderr);
}

}  // namespace

void watchProgress(ProgressWatch watch) {
    const std::lock_guard lock(g_watch_mutex);
    g_watch = std::move(watch);
}

Progress::Progress(const std::string& what, std::string unit, size_t total)
    : what_(oneLine(what)),
      unit_(std::move(unit)),
      total_(total),
      terminal_(isatty(STDERR_FILENO)),
      start_(Clock::now()),
      next_(start_ + kPatience) {
    tellWatch(what_, 0, total_);
}

Progress::~Progress() {
    tellWatch({}, 0, 0);
    if (terminal_ && shown_) print("\r\033[K");
}

void Progress::step() {
    const std::lock_guard lock(mutex_);
    ++done_;
    show();
}

void Progress::set(size_t done, size_t total) {
    const std::lock_guard lock(mutex_);
    done_ = done;
    total_ = total;
    show();
}

void Progress::show() {
    tellWatch(what_, done_, total_);
    const auto now = Clock::now();
    if (now < next_ || total_ == 0) return;
    next_ = now + (terminal_ ? kTerminalPause : kPipedPause);
    shown_ = true;
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    const double part = std::min(1.0, static_cast<double>(done_) / static_cast<double>(total_));
    const std::string left = part > 0 ? duration(elapsed * (1 - part) / part) + " left" : "just begun";
    const std::string counts = fmt::format("{} of {} {}, {}", done_, total_, unit_, left);
    if (!terminal_) return print(fmt::format("{}: {}\n", what_, counts));
    constexpr int kWidth = 30;
    const auto full = static_cast<size_t>(part * kWidth);
    print(fmt::format("\r\033[K{} {}{} {:3.0f} %  {}", what_, paint(stderr, Tone::kGood, std::string(full, '#')),
                      std::string(kWidth - full, '.'), 100 * part, counts));
}

}  // namespace sightline::cli
