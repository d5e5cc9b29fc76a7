// Asks a caller whether to stop, from any thread, and remembers the answer.
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <functional>
#include <mutex>

namespace sightline::bake {

/// Once the caller has said so, it is true for good.
class StopAsker {
public:
    /// @param ask  is called by one thread at a time; outlives this; may be empty
    explicit StopAsker(const std::function<bool()>& ask) : ask_(ask) {}

    bool asks() {
        if (stopped_.load(std::memory_order_relaxed) || !ask_) return stopped_.load(std::memory_order_relaxed);
        const std::unique_lock lock(mutex_, std::try_to_lock);
        if (lock && ask_()) stopped_.store(true, std::memory_order_relaxed);
        return stopped_.load(std::memory_order_relaxed);
    }
    bool stopped() const { return stopped_.load(std::memory_order_relaxed); }

private:
    const std::function<bool()>& ask_;
    std::mutex mutex_;
    std::atomic<bool> stopped_{false};
};

}  // namespace sightline::bake
