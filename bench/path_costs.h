// What a query with one choice of settings or another costs and keeps along a path.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <vector>

#include "bench/stopwatch.h"
#include "sightline/query/query.h"
#include "sightline/tools/scene/camera_path.h"

namespace sightline::bench {

/// Means over the frames, of medians over the repeats. Times are the thread's own.
struct SettingsCost {
    double time = 0;  ///< [microseconds]
    double kept = 0, occluder_triangles = 0;
    double culled[kStageCount] = {};
};

/// One for each choice; in each frame the choices take turns.
inline std::vector<SettingsCost> costsAlong(const tools::CameraPath& path, const Snapshot& now,
                                            const std::vector<QuerySettings>& choices, int repeat) {
    std::vector<SettingsCost> costs(choices.size());
    const double part = 1.0 / static_cast<double>(std::max<size_t>(path.frames.size(), 1));
    Query query;
    for (const tools::CameraFrame& frame : path.frames) {
        const View view = makeView(frame, 1280, 720);
        std::vector<QueryStats> stats(choices.size());
        std::vector<std::function<void()>> jobs;
        for (size_t i = 0; i < choices.size(); ++i)
            jobs.push_back([&, i] { stats[i] = query.visible(now, view, choices[i]).stats; });
        const std::vector<double> times = threadTimes(jobs, repeat);
        for (size_t i = 0; i < choices.size(); ++i) {
            costs[i].time += part * times[i];
            costs[i].kept += part * static_cast<double>(stats[i].visible);
            costs[i].occluder_triangles += part * static_cast<double>(stats[i].occluder_triangles);
            for (int stage = 0; stage < kStageCount; ++stage)
                costs[i].culled[stage] += part * static_cast<double>(stats[i].stages[stage].culled);
        }
    }
    return costs;
}

}  // namespace sightline::bench
