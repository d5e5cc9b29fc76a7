// What an answer of a query says of its objects: which are kept, and by which stage the others were culled.
// SPDX-License-Identifier: MIT
#pragma once

#include <set>
#include <vector>

#include "sightline/query/query.h"

namespace sightline::test {

inline std::vector<uint64_t> keysOf(const VisibleSet& set) {
    std::vector<uint64_t> keys;
    for (const Visible& v : set.objects) keys.push_back(v.key);
    return keys;
}

inline std::set<uint64_t> keySetOf(const VisibleSet& set) {
    const std::vector<uint64_t> keys = keysOf(set);
    return {keys.begin(), keys.end()};
}

/// 1 for each key below `count` that is kept.
inline std::vector<uint8_t> keptOf(const VisibleSet& set, size_t count) {
    std::vector<uint8_t> kept(count, 0);
    for (const Visible& v : set.objects) kept[v.key] = 1;
    return kept;
}

/// Of the query's last answer, by item: 0 visible, 1 + Stage, 255 outside the layers.
inline std::vector<uint8_t> reasonsOf(const Query& query, const Snapshot& now) {
    std::vector<uint8_t> reasons(now.objectCount());
    query.reasons(reasons);
    return reasons;
}

inline uint64_t culledBy(const QueryStats& stats, Stage stage) { return stats.stages[static_cast<int>(stage)].culled; }

/// Those that are visible and those that a stage culled: each object once.
inline uint64_t accountedFor(const QueryStats& stats) {
    uint64_t sum = stats.visible;
    for (const StageStats& stage : stats.stages) sum += stage.culled;
    return sum;
}

}  // namespace sightline::test
