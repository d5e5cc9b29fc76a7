// Threads for as much of a work as there are any to be had.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <exception>
#include <thread>
#include <utility>
#include <vector>

namespace sightline {

/// Starts work(i) for each i of [1, count) on a thread of its own; work(0) is the caller's.
/// @return the threads, fewer than asked for where the system gives no more: work(i) has been started for
///         i <= their number
template <class Work>
std::vector<std::thread> startThreads(uint32_t count, const Work& work) {
    std::vector<std::thread> threads;
    try {
        for (uint32_t i = 1; i < count; ++i) threads.emplace_back(work, i);
    } catch (const std::exception&) {}  // no more threads, or no memory for them: those that run do it all
    return threads;
}

}  // namespace sightline
