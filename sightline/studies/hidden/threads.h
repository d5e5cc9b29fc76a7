// Threads for as much of a work as there are any to be had.
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace sightline::studies {

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

/// The first of what several threads throw. Nothing may leave a thread's own function: that would end the process.
class FirstFault {
public:
    /// Calls work(), and keeps what it throws.
    template <class Work>
    void guard(const Work& work) noexcept {
        try {
            work();
        } catch (...) {
            const std::lock_guard lock(mutex_);
            if (!fault_) fault_ = std::current_exception();
            any_ = true;
        }
    }
    bool any() const noexcept { return any_; }
    /// Throws it, if there is one. Once the threads have ended.
    void rethrow() const {
        if (fault_) std::rethrow_exception(fault_);
    }

private:
    std::mutex mutex_;
    std::exception_ptr fault_;
    std::atomic<bool> any_{false};
};

}  // namespace sightline::studies
