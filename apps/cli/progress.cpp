// Progress of long work on standard error: a bar with the time left on a terminal, lines when piped.
// SPDX-License-Identifier: MIT
#include "apps/cli/progress.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <utility>

#include <fmt/core.h>
#include <unistd.h>

namespace sightline::cli {
namespace {

std::string duration(double seconds) {
    const auto whole = static_cast<long>(seconds + 0.5);
    if (whole >= 3600) return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
    if (whole >= 60) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
    return fmt::format("{} s", whole);
}

bool wantsColour() {
    const char* no_colour = std::getenv("NO_COLOR");
    const char* term = std::getenv("TERM");
    return !(no_colour && *no_colour) && term && std::strcmp(term, "dumb") != 0;
}

}  // namespace

Progress::Progress(std::string what, std::string unit, size_t total)
    : what_(std::move(what)),
      unit_(std::move(unit)),
      total_(total),
      terminal_(isatty(STDERR_FILENO)),
      colour_(terminal_ && wantsColour()),
      start_(Clock::now()),
      last_(start_) {}

Progress::~Progress() {
    if (terminal_ && shown_) std::fputs("\r\033[K", stderr);
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
    const double piped_pause = 5.0, terminal_pause = 0.1, patience = 0.5;  // [seconds]
    const auto now = Clock::now();
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    const double since_last = std::chrono::duration<double>(now - last_).count();
    if (elapsed < patience || total_ == 0) return;
    if (since_last < (terminal_ ? terminal_pause : piped_pause) && !(terminal_ && !shown_)) return;
    last_ = now;
    shown_ = true;
    const double part = std::min(1.0, static_cast<double>(done_) / static_cast<double>(total_));
    const std::string left =
        part > 0 ? fmt::format("{} left", duration(elapsed * (1 - part) / part)) : std::string("just begun");
    if (!terminal_) {
        fmt::print(stderr, "{}: {} of {} {}, {}\n", what_, done_, total_, unit_, left);
        return;
    }
    constexpr int kWidth = 30;
    const int full = static_cast<int>(part * kWidth);
    fmt::print(stderr, "\r\033[K{} {}{}{}{} {:3.0f} %  {} of {} {}, {}", what_, colour_ ? "\033[32m" : "",
               std::string(full, '#'), colour_ ? "\033[0m" : "", std::string(kWidth - full, '.'), 100 * part, done_,
               total_, unit_, left);
    std::fflush(stderr);
}

}  // namespace sightline::cli
