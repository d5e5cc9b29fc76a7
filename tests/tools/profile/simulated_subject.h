// A frame of known parts that takes no time: its clocks are computed, with seeded noise.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "sightline/base/random.h"
#include "sightline/tools/profile/frame_load.h"

namespace sightline::test {
using namespace tools;

struct SimulatedSubject {
    double parts[kFrameStages] = {};  ///< of the frame, by FrameStage  [s]
    double rest = 0;                  ///< in none of them  [s]
    bool pipelined = false;           ///< the frame takes the longest part, not all
    double noise = 0;                 ///< standard deviation of a frame's time, as a share of it
    double spikes = 0;                ///< how often a frame takes twice as long: somebody else's turn
    double drift = 0;                 ///< by how much a frame is slower than the one before, as a share
    double refresh = 0;               ///< a frame takes a whole number of these; 0: as long as it takes  [s]
    Random random{1};
    uint64_t frames = 0;

    FrameTimes operator()(const StageLoads& loads) {
        const double factors[kFrameStages] = {loads.fill, loads.transform, loads.bus, loads.cpu};
        double sum = rest, longest = 0;
        for (int i = 0; i < kFrameStages; ++i) {
            sum += parts[i] * factors[i];
            longest = std::max(longest, parts[i] * factors[i]);
        }
        double wall = pipelined ? longest + rest : sum;
        // Twelve uniform numbers less six are nearly normal.
        double normal = -6;
        for (int i = 0; i < 12; ++i) normal += random.uniform();
        wall *= std::max(0.1, 1 + noise * normal) * std::pow(1 + drift, static_cast<double>(frames++));
        if (random.uniform() < spikes) wall *= 2;
        const double busy = wall;
        if (refresh > 0) wall = std::ceil(wall / refresh) * refresh;
        return {wall, busy, 0.0};
    }
};

}  // namespace sightline::test
