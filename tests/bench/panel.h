// A scene of one panel and what is put around it.
// SPDX-License-Identifier: MIT
#pragma once

#include <utility>
#include <vector>

#include "bench/occlusion_scenes.h"

namespace sightline::bench {

/// A wall of one panel at z = 10, 4 wide and 4 high, and what the caller puts around it; the camera looks along z.
inline OcclusionScene onePanel(std::vector<Box3f> boxes) {
    OcclusionScene scene{"panel", 1.0, {OcclusionCamera()}, {}, std::move(boxes)};
    OccluderBatch panel;
    panel.positions = {{-2, -2, 10}, {-2, 2, 10}, {2, 2, 10}, {2, -2, 10}};
    panel.indices = {0, 1, 2, 0, 2, 3};
    for (const glm::vec3& p : panel.positions) panel.bounds.grow(p);
    scene.batches.push_back(panel);
    return scene;
}

inline Box3f cube(float x, float y, float z, float half) {
    Box3f box;
    box.min = glm::vec3(x, y, z) - half;
    box.max = glm::vec3(x, y, z) + half;
    return box;
}

}  // namespace sightline::bench
