// How a piece of work is shared out among threads that somebody else owns.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>

namespace sightline::studies {

/// Calls work(i) for each i of [0, count), in any order, perhaps on several threads; returns when all are done. An empty
/// one stands for one after the other.
using ShareWork = std::function<void(size_t count, const std::function<void(size_t)>& work)>;

inline void shareOut(const ShareWork& share, size_t count, const std::function<void(size_t)>& work) {
    if (share) return share(count, work);
    for (size_t i = 0; i < count; ++i) work(i);
}

}  // namespace sightline::studies
