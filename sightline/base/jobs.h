// The job hook: work that can be shared out is offered to threads that the caller owns.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <type_traits>

namespace sightline {

/// Where work goes that several threads may do. The library starts no thread: who has some offers them here. Without a
/// hook (a null pointer) all work is done one task after the other, on the thread that calls.
///
/// What a task writes, no other task of its run reads or writes: so the answer is the same in any order and on any number
/// of threads. Tasks do not throw, do not wait for one another or for a lock, and do not call run() themselves. What they
/// need they take from their owner's Memory, which must then be thread-safe.
class Jobs {
public:
    using Task = void (*)(void* context, uint32_t index);

    /// Calls task(context, i) exactly once for each i of [0, count), in any order, on any threads, the caller's among
    /// them, at once or one after the other. Returns when all of them have returned; what they wrote can then be read.
    /// Does not throw. Called by several threads at once, if objects of several threads were given the same hook.
    virtual void run(uint32_t count, Task task, void* context) = 0;

protected:
    ~Jobs() = default;
};

/// Calls work(i) for each i of [0, count) through the hook, or here one after the other if there is none.
template <class Work>
void runJobs(Jobs* jobs, uint32_t count, Work&& work) {
    if (!jobs || count < 2) {
        for (uint32_t i = 0; i < count; ++i) work(i);
        return;
    }
    using Plain = std::remove_reference_t<Work>;
    jobs->run(
        count, [](void* context, uint32_t i) { (*static_cast<Plain*>(context))(i); },
        const_cast<void*>(static_cast<const void*>(&work)));
}

}  // namespace sightline
