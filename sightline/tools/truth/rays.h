// Rays through the scene, by Embree: what a line of sight meets, and what it passes on its way.
// SPDX-License-Identifier: MIT
//
// Ingo Wald, Sven Woop, Carsten Benthin, Gregory Johnson, Manfred Ernst. Embree: A Kernel Framework for Efficient CPU
// Ray Tracing. 2014.
#pragma once

#include <memory>
#include <vector>

#include "sightline/tools/truth/scene_facts.h"
#include "sightline/tools/truth/sight.h"

namespace sightline::tools {

/// What one ray saw, in float: candidates for ExactSight.
struct RaySighting {
    static constexpr uint32_t kNone = ~0u;
    struct Passed {
        uint32_t object = 0;
        float t = 0;
    };

    uint32_t object = kNone;     ///< the first front that hides what is behind it
    double t = 0;                ///< there, along SightRay; or t_far
    double rounding = 0;         ///< how far the place that was met may be off  [world units]
    std::vector<Passed> passed;  ///< met before it: seen, but hiding nothing; in no order, may repeat
};

/// One Embree scene for each group of objects that lie near together (NearGroup), about the group's middle: what is far off
/// coarsens nothing. One more for each shared mesh, of which objects are instances. Thread-safe once made.
class RayScene {
public:
    /// @param facts  outlive this
    explicit RayScene(const SceneFacts& facts);
    ~RayScene();

    /// Single-sided back faces are passed unseen; the ray begins at the near plane and ends at the far plane.
    /// @param eye  that the ray is relative to, in world space
    void look(const SightRay& ray, const glm::dvec3& eye, RaySighting& sighting) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace sightline::tools
