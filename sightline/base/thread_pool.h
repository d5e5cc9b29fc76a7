// A small pool of threads behind the job hook, for programs that have none of their own: tools, benchmarks, tests.
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "sightline/base/jobs.h"

namespace sightline {

/// Threads that wait for tasks. The one that calls run() works with them. Tasks are taken in rising order.
///
/// One run at a time is shared out. A second thread that calls run() meanwhile, or a task that does, does its tasks
/// itself. Programs that include this link the system's threads.
class ThreadPool final : public Jobs {
public:
    /// @param workers  threads that work on a run, the caller's included; fewer where the system gives no more, which ends
    ///                 a program that is compiled without exceptions  [>= 1]
    /// @param spin     how long a thread looks for work before it sleeps: waking one takes some tens of microseconds
    explicit ThreadPool(uint32_t workers, std::chrono::microseconds spin = std::chrono::microseconds(100))
        : spin_(spin) {
#ifdef __cpp_exceptions
        try {
            start(workers);
        } catch (const std::exception&) {}  // no more threads, or no memory for them: those that run do it all
#else
        start(workers);
#endif
    }
    ~ThreadPool() {
        {
            const std::lock_guard lock(mutex_);
            ending_ = true;
            offered_.fetch_add(1, std::memory_order_release);
        }
        wake_.notify_all();
        for (std::thread& thread : threads_) thread.join();
    }
    ThreadPool(const ThreadPool&) = delete;
    ThreadPool& operator=(const ThreadPool&) = delete;

    uint32_t workers() const { return static_cast<uint32_t>(threads_.size()) + 1; }

    void run(uint32_t count, Task task, void* context) override {
        if (threads_.empty() || count < 2 || busy_.exchange(true, std::memory_order_acquire)) {
            for (uint32_t i = 0; i < count; ++i) task(context, i);
            return;
        }
        {
            const std::lock_guard lock(mutex_);
            run_ = {task, context, count};
            next_.store(0, std::memory_order_relaxed);
            open_ = true;
            offered_.fetch_add(1, std::memory_order_release);
        }
        wake_.notify_all();
        takeTasks(run_);
        std::unique_lock lock(mutex_);
        open_ = false;  // nobody joins any more
        lock.unlock();
        spinUntil([this] { return inside_.load(std::memory_order_acquire) == 0; });
        lock.lock();
        done_.wait(lock, [this] { return inside_.load(std::memory_order_acquire) == 0; });
        lock.unlock();
        busy_.store(false, std::memory_order_release);
    }

private:
    struct Run {
        Task task = nullptr;
        void* context = nullptr;
        uint32_t count = 0;
    };

    void start(uint32_t workers) {
        for (uint32_t i = 1; i < workers; ++i) threads_.emplace_back([this] { work(); });
    }

    void takeTasks(const Run& run) {
        for (uint32_t i; (i = next_.fetch_add(1, std::memory_order_relaxed)) < run.count;) run.task(run.context, i);
    }

    template <class Condition>
    void spinUntil(Condition condition) const {
        const auto end = std::chrono::steady_clock::now() + spin_;
        while (!condition() && std::chrono::steady_clock::now() < end) std::this_thread::yield();
    }

    void work() {
        uint64_t seen = 0;
        for (;;) {
            spinUntil([&] { return offered_.load(std::memory_order_acquire) != seen; });
            std::unique_lock lock(mutex_);
            wake_.wait(lock, [&] { return offered_.load(std::memory_order_relaxed) != seen; });
            seen = offered_.load(std::memory_order_relaxed);
            if (ending_) return;
            if (!open_) continue;
            const Run run = run_;
            inside_.fetch_add(1, std::memory_order_relaxed);
            lock.unlock();
            takeTasks(run);
            lock.lock();
            if (inside_.fetch_sub(1, std::memory_order_release) == 1) done_.notify_one();
        }
    }

    const std::chrono::microseconds spin_;
    std::mutex mutex_;
    std::condition_variable wake_, done_;
    Run run_;                           ///< under the mutex, but for the thread that offers it
    bool open_ = false;                 ///< under the mutex: `run_` may be joined
    bool ending_ = false;               ///< under the mutex
    std::atomic<bool> busy_{false};     ///< a run is shared out
    std::atomic<uint64_t> offered_{0};  ///< runs so far; changed under the mutex
    std::atomic<uint32_t> next_{0};     ///< task of the run
    std::atomic<uint32_t> inside_{0};   ///< threads that work on the run, without the one that offers it
    std::vector<std::thread> threads_;  ///< last: they use the others
};

}  // namespace sightline
