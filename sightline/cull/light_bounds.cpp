// Bounds of what a light reaches, so that lights are culled as objects are: by views, trees, occlusion and boxes.
// SPDX-License-Identifier: MIT
#include "sightline/cull/light_bounds.h"

#include <cmath>
#include <limits>

#include <glm/gtc/constants.hpp>

namespace sightline {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();
constexpr double kLightRounding = 0x1p-48;  // of some ten steps, each by at most 2^-53, of sines and cosines 2^-52

/// The light's numbers, if a bound can be made of them.
struct Sector {
    glm::dvec3 apex{0.0}, axis{0.0};
    double range = 0, cosine = -1, sine = 0;  ///< of the half angle
    bool bounded = false;

    explicit Sector(const Light& light) : apex(light.position), range(light.range) {
        if (light.kind == LightKind::kDirectional) return;
        const glm::dvec3 all = apex + range;
        if (!(range >= 0) || !std::isfinite(all.x) || !std::isfinite(all.y) || !std::isfinite(all.z)) return;
        bounded = true;
        if (light.kind == LightKind::kPoint) return;
        // A direction is measured by its largest number first, so that its square neither overflows nor vanishes.
        const double largest =
            glm::max(std::abs(light.direction.x), glm::max(std::abs(light.direction.y), std::abs(light.direction.z)));
        const glm::dvec3 scaled = light.direction / largest;
        axis = scaled / glm::length(scaled);
        bounded = std::isfinite(axis.x) && std::isfinite(axis.y) && std::isfinite(axis.z) && light.half_angle >= 0;
        if (light.half_angle >= glm::pi<double>()) return;
        cosine = std::cos(light.half_angle);
        sine = std::sin(light.half_angle);
    }

    /// How far it reaches along an axis of the world, or (with -1) against it.
    double reach(int i, double sign) const {
        const double along = sign * axis[i];
        if (along >= cosine) return range;  // the sector holds that direction itself
        const double across = std::hypot(axis[(i + 1) % 3], axis[(i + 2) % 3]);  // exact where `along` is nearly 1
        return range * glm::max(0.0, along * cosine + across * sine);  // its side that leans there, or the apex
    }
};

}  // namespace

Box3d lightBox(const Light& light) {
    const Sector sector(light);
    if (!sector.bounded) return {glm::dvec3(-kUnbounded), glm::dvec3(kUnbounded)};
    Box3d box;
    for (int i = 0; i < 3; ++i) {
        const double slack = kLightRounding * (std::abs(sector.apex[i]) + sector.range);
        box.min[i] = sector.apex[i] - sector.reach(i, -1.0) - slack;
        box.max[i] = sector.apex[i] + sector.reach(i, 1.0) + slack;
    }
    return box;
}

Sphere lightSphere(const Light& light) {
    const Sector sector(light);
    if (!sector.bounded) return {light.position, kUnbounded};
    // The rim of the round end, with the apex where the sector is slim; a wide one holds a great circle of the ball.
    double along = 0, radius = sector.range;
    if (sector.cosine > sector.sine) along = radius = sector.range / (2 * sector.cosine);
    else if (sector.cosine > 0) along = sector.range * sector.cosine, radius = sector.range * sector.sine;
    const glm::dvec3 center = sector.apex + along * sector.axis;
    const double size = std::abs(sector.apex.x) + std::abs(sector.apex.y) + std::abs(sector.apex.z) + 4 * sector.range;
    return {center, radius + kLightRounding * size};
}

}  // namespace sightline
