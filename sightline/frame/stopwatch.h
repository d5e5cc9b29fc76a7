// Time since a moment, in nanoseconds.
// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>

namespace sightline::detail {

class Stopwatch {
public:
    uint64_t nanoseconds() const { return count(Clock::now()); }
    /// The time so far; it begins again.
    uint64_t lap() {
        const Clock::time_point now = Clock::now();
        const uint64_t took = count(now);
        start_ = now;
        return took;
    }

private:
    using Clock = std::chrono::steady_clock;
    uint64_t count(Clock::time_point now) const {
        return static_cast<uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(now - start_).count());
    }
    Clock::time_point start_ = Clock::now();
};

}  // namespace sightline::detail
