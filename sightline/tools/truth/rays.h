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
    std::vector<Passed> passed;  ///< met before it: seen, but hiding nothing; in no order, may repeat
};

/// One Embree scene per shared mesh and one instance per object that shares it, relative to the scene's centre.
/// Thread-safe once made.
class RayScene {
public:
    explicit RayScene(const SceneFacts& facts);
    ~RayScene();

    /// Single-sided back faces are passed unseen; the ray begins at the near plane and ends at the far plane.
    /// @param eye  that the ray is relative to, in world space
    void look(const SightRay& ray, const glm::dvec3& eye, RaySighting& sighting) const;

    /// How far positions may be off, over all of the scene [world units].
    double rounding() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace sightline::tools
