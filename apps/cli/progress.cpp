// Progress of long work on standard error: a bar with the time left on a terminal, lines when piped.
// SPDX-License-Identifier: MIT
#include "apps/cli/progress.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "apps/cli/session.h"
#include "sightline/scene/one_line.h"

namespace sightline::cli {
namespace {

std::string duration(double seconds) {
    const auto whole = static_cast<long>(seconds + 0.5);
    if (whole >= 86400) return fmt::format("{} d {:02} h", whole / 86400, whole / 3600 % 24);
    if (whole >= 3600) return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
    if (whole >= 60) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
    return fmt::format("{} s", whole);
}

/// A reader of standard error who has left is no reason to stop.
void print(const std::string& text) {
    (void)std::fwrite(text.data(), 1, text.size(), stderr);
    (void)std::fflush(stderr);
}

}  // namespace

Progress::Progress(std::string what, std::string unit, size_t total)
    : what_(oneLine(what)),
      unit_(std::move(unit)),
      total_(total),
      quiet_(quiet()),
      terminal_(isatty(STDERR_FILENO)),
      colour_(terminal_ && isColoured(stderr)),
      start_(Clock::now()),
      last_(start_),
      last_logged_(start_) {
    logLine(total_ > 0 ? fmt::format("{}: {} {}", what_, total_, unit_) : what_);
}

Progress::~Progress() {
    if (terminal_ && shown_) print("\r\033[K");
    const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
    logLine(fmt::format("{}: ended after {} of {} {}, {:.3f} s", what_, done_, total_, unit_, elapsed));
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
    const double piped_pause = 5.0, terminal_pause = 0.1, log_pause = 1.0, patience = 0.5;  // [seconds]
    const auto now = Clock::now();
    const auto since = [&](Clock::time_point then) { return std::chrono::duration<double>(now - then).count(); };
    const double elapsed = since(start_);
    if (elapsed < patience || total_ == 0) return;
    const double part = std::min(1.0, static_cast<double>(done_) / static_cast<double>(total_));
    const auto left = [&] {
        return part > 0 ? fmt::format("{} left", duration(elapsed * (1 - part) / part)) : std::string("just begun");
    };
    if (since(last_logged_) >= log_pause) {
        last_logged_ = now;
        logLine(fmt::format("{}: {} of {} {}, {}", what_, done_, total_, unit_, left()));
    }
    if (quiet_ || (since(last_) < (terminal_ ? terminal_pause : piped_pause) && !(terminal_ && !shown_))) return;
    last_ = now;
    shown_ = true;
    if (!terminal_) return print(fmt::format("{}: {} of {} {}, {}\n", what_, done_, total_, unit_, left()));
    constexpr int kWidth = 30;
    const int full = static_cast<int>(part * kWidth);
    print(fmt::format("\r\033[K{} {}{}{}{} {:3.0f} %  {} of {} {}, {}", what_, colour_ ? "\033[32m" : "",
                      std::string(full, '#'), colour_ ? "\033[0m" : "", std::string(kWidth - full, '.'), 100 * part,
                      done_, total_, unit_, left()));
}

}  // namespace sightline::cli
