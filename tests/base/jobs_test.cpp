// The law of the job hook: each task once, and all of it done when run() returns.
// SPDX-License-Identifier: MIT
#include "sightline/base/jobs.h"

#include <atomic>
#include <numeric>
#include <set>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "sightline/base/thread_pool.h"

namespace sightline {
namespace {

TEST(Jobs, WithoutAHookRunHereInOrder) {
    std::vector<uint32_t> order;
    const std::thread::id here = std::this_thread::get_id();
    runJobs(nullptr, 5, [&](uint32_t i) {
        EXPECT_EQ(std::this_thread::get_id(), here);
        order.push_back(i);
    });
    EXPECT_EQ(order, (std::vector<uint32_t>{0, 1, 2, 3, 4}));
    runJobs(nullptr, 0, [](uint32_t) { FAIL(); });
}

TEST(Jobs, TakeAWorkThatIsConstant) {
    ThreadPool pool(2);
    std::vector<int> done(100);
    const auto work = [&done](uint32_t i) { done[i] = 1; };
    runJobs(&pool, 100, work);
    EXPECT_EQ(std::accumulate(done.begin(), done.end(), 0), 100);
}

/// What the tasks write is plain memory: a thread sanitizer finds it if run() returns too early.
TEST(ThreadPool, DoesEachTaskOnce) {
    for (const uint32_t workers : {1u, 2u, 3u, 8u})
        for (const int spin : {0, 100}) {
            ThreadPool pool(workers, std::chrono::microseconds(spin));
            EXPECT_LE(pool.workers(), workers);
            for (uint32_t count = 0; count < 40; ++count) {
                std::vector<uint32_t> done(count, 0);
                runJobs(&pool, count, [&](uint32_t i) { done[i] += i + 1; });
                for (uint32_t i = 0; i < count; ++i) ASSERT_EQ(done[i], i + 1) << count << " tasks, task " << i;
            }
        }
}

TEST(ThreadPool, SharesTasksAmongThreads) {
    ThreadPool pool(2);
    if (pool.workers() < 2) GTEST_SKIP() << "no second thread to be had";
    // Each waits for the other, which no thread alone could end.
    std::atomic<int> met{0};
    runJobs(&pool, 2, [&](uint32_t) {
        ++met;
        while (met < 2) std::this_thread::yield();
    });
    EXPECT_EQ(met, 2);
}

TEST(ThreadPool, DoesATasksOwnRunOnItsThread) {
    ThreadPool pool(3);
    std::vector<std::vector<uint32_t>> done(6, std::vector<uint32_t>(7, 0));
    runJobs(&pool, 6, [&](uint32_t i) {
        const std::thread::id here = std::this_thread::get_id();
        runJobs(&pool, 7, [&](uint32_t k) {
            EXPECT_EQ(std::this_thread::get_id(), here);
            ++done[i][k];
        });
    });
    for (const auto& inner : done) EXPECT_EQ(inner, std::vector<uint32_t>(7, 1));
}

TEST(ThreadPool, ServesSeveralThreadsAtOnce) {
    ThreadPool pool(2);
    std::vector<std::vector<uint32_t>> done(4, std::vector<uint32_t>(50, 0));
    std::vector<std::thread> callers;
    for (auto& mine : done)
        callers.emplace_back([&pool, &mine] {
            for (int again = 0; again < 20; ++again) runJobs(&pool, 50, [&](uint32_t i) { ++mine[i]; });
        });
    for (std::thread& caller : callers) caller.join();
    for (const auto& mine : done) EXPECT_EQ(mine, std::vector<uint32_t>(50, 20));
}

}  // namespace
}  // namespace sightline
