// Where an occludee stands before an eye, and how exactly that is known.
// SPDX-License-Identifier: MIT
#include "sightline/cull/occludee_place.h"

#include <algorithm>
#include <cmath>

namespace sightline {

OccludeePlace makeOccludeePlace(const Screen& screen, const glm::dmat4& transform, const Box3d& bounds) {
    OccludeePlace place;
    place.screen = objectScreen(screen, transform);
    place.reverse = (glm::determinant(glm::dmat3(transform)) < 0.0) != screen.mirrored;
    double size = 0;
    for (int row = 0; row < 3; ++row) {
        size += std::abs(transform[3][row]) + std::abs(screen.eye[row]);
        for (int column = 0; column < 3; ++column)
            size +=
                std::abs(transform[column][row]) * std::max(std::abs(bounds.min[column]), std::abs(bounds.max[column]));
    }
    const double world_error = size * 0x1p-49;  // sixteen roundings of 2^-53
    const auto errorOf = [&](const glm::dvec4& row) { return world_error * glm::length(glm::dvec3(row)); };
    place.pixel_error =
        errorOf(screen.x) + errorOf(screen.y) + 2.0 * std::max(screen.width, screen.height) * errorOf(screen.w);
    place.depth_error = screen.perspective ? errorOf(screen.w) : errorOf(screen.d);
    place.clips = 4.0 * errorOf(screen.near) < screen.near_guard;
    return place;
}

}  // namespace sightline
