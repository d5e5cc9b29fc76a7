// Where to aim: points on culled objects that would be seen first if one of them was culled wrongly.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sightline/base/random.h"
#include "sightline/tools/truth/exact.h"
#include "sightline/tools/truth/scene_facts.h"
#include "sightline/tools/truth/sight.h"

namespace sightline::tools {

/// So many rays at one culled object.
struct Aim {
    uint32_t object = 0;
    uint32_t rays = 0;
};

/// Spreads a budget over the culled objects whose boxes meet the frustum: half of it evenly over those that look
/// largest (at least four rays each), half by their apparent width.
std::vector<Aim> chooseAims(const SceneFacts& facts, const SightLines& sight, std::span<const uint8_t> culled,
                            uint64_t budget);

/// A point to look at.
struct Target {
    uint32_t triangle = 0;
    glm::dvec3 point{0.0};  ///< relative to the eye
    glm::dvec2 place{0.0};  ///< where it appears: clip x, y over w
};

/// A random point in the frustum on a triangle of the object that faces the eye: half of them inside triangles,
/// half on edges and corners. False if a few tries found none.
bool aimAt(const SceneFacts& facts, const SightLines& sight, const ExactSight& exact, uint32_t object, Random& random,
           Target& target);

}  // namespace sightline::tools
