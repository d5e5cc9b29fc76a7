// Times several ways of doing the same work in turn, so that a machine's moods meet them all alike.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>
#include <ctime>
#include <functional>
#include <vector>

namespace sightline::bench {

/// The time that this thread has been computing [microseconds]. For work of one thread: other programs' turns on the
/// processor do not count, though their use of its caches does.
inline double threadTime() {
    timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) * 1e6 + static_cast<double>(now.tv_nsec) * 1e-3;
}

/// By the time that this thread computes.
inline double millisecondsOf(const std::function<void()>& job) {
    const double start = threadTime();
    job();
    return (threadTime() - start) * 1e-3;
}

inline double medianOf(std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
    return values[values.size() / 2];
}

inline double meanOf(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
}

/// @param share  0: the least, 1: the greatest
inline double percentileOf(std::vector<double> values, double share) {
    std::sort(values.begin(), values.end());
    return values[static_cast<size_t>(share * static_cast<double>(values.size() - 1))];
}

/// Runs each job once to warm up and then all of them `repeat` times, one after the other each time.
/// @param now  reads a clock [microseconds]
/// @returns each job's median time [microseconds]
inline std::vector<double> timeInTurn(const std::vector<std::function<void()>>& jobs, int repeat, double (*now)()) {
    std::vector<std::vector<double>> times(jobs.size());
    for (int round = -1; round < repeat; ++round)
        for (size_t i = 0; i < jobs.size(); ++i) {
            const double start = now();
            jobs[i]();
            if (round >= 0) times[i].push_back(now() - start);
        }
    std::vector<double> medians;
    for (const std::vector<double>& t : times) medians.push_back(medianOf(t));
    return medians;
}

/// As timeInTurn(), by the wall's clock.
inline std::vector<double> timeInterleaved(const std::vector<std::function<void()>>& jobs, int repeat) {
    return timeInTurn(jobs, repeat, [] {
        const auto now = std::chrono::steady_clock::now().time_since_epoch();
        return std::chrono::duration<double, std::micro>(now).count();
    });
}

/// As timeInTurn(), by the time that this thread computes.
inline std::vector<double> threadTimes(const std::vector<std::function<void()>>& jobs, int repeat) {
    return timeInTurn(jobs, repeat, threadTime);
}

}  // namespace sightline::bench
