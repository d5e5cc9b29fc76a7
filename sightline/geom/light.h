// A light: a sun, a spot or a point, and how far it reaches.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

namespace sightline {

enum class LightKind : uint8_t {
    kDirectional,  ///< a sun: parallel rays
    kSpot,         ///< a cone from a point
    kPoint,        ///< all around a point
};

struct Light {
    LightKind kind = LightKind::kDirectional;
    glm::dvec3 direction{0.0, -1.0, 0.0};    ///< in which it shines: of a sun and of a spot  [not zero]
    glm::dvec3 position{0.0};                ///< of a spot and of a point light
    double half_angle = 0.7853981633974483;  ///< of a spot's cone  [radians, above 0, below 1.5]
    double near = 0.05;  ///< what is nearer to a spot or a point light casts nothing  [world units, > 0]
    double range = 1e4;  ///< what is farther from it is not lit  [world units, > near]
};

}  // namespace sightline
