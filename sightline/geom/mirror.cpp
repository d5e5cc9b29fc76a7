// What a flat mirror shows, as a view of its own: of the same world, from the eye's place behind the glass.
// SPDX-License-Identifier: MIT
#include "sightline/geom/mirror.h"

#include <algorithm>
#include <cmath>

#include "sightline/geom/view_limits.h"
#include "sightline/geom/view_volume.h"

namespace sightline {
namespace {

/// The mean plane of an outline, of unit length, towards those that see it counter-clockwise (Newell's); zero if it has
/// none.
glm::dvec4 planeOf(std::span<const glm::dvec3> outline) {
    glm::dvec3 center(0.0), normal(0.0);
    for (const glm::dvec3& corner : outline) center += corner / static_cast<double>(outline.size());
    for (size_t i = 0; i < outline.size(); ++i)
        normal += glm::cross(outline[i] - center, outline[(i + 1) % outline.size()] - center);
    const double length = glm::length(normal);
    if (!(length > 0.0) || !std::isfinite(length)) return glm::dvec4(0.0);
    normal /= length;
    return {normal, -glm::dot(normal, center)};
}

/// A rectangle in the plane that holds all corners.
ViewOutline rectangleAround(std::span<const glm::dvec3> outline, const glm::dvec3& normal) {
    const glm::dvec3 along = glm::normalize(outline[1] - outline[0]), across = glm::cross(normal, along);
    glm::dvec2 low(0.0), high(0.0);
    for (const glm::dvec3& corner : outline) {
        const glm::dvec2 at(glm::dot(corner - outline[0], along), glm::dot(corner - outline[0], across));
        low = glm::min(low, at);
        high = glm::max(high, at);
    }
    ViewOutline rectangle;
    for (const glm::dvec2& at : {low, glm::dvec2(high.x, low.y), high, glm::dvec2(low.x, high.y)})
        rectangle.points[rectangle.count++] = outline[0] + at.x * along + at.y * across;
    return rectangle;
}

ViewOutline outlineOf(std::span<const glm::dvec3> outline, const glm::dvec3& normal) {
    if (outline.size() > ViewOutline::kMost) return rectangleAround(outline, normal);
    ViewOutline out;
    for (const glm::dvec3& corner : outline) out.points[out.count++] = corner;
    return out;
}

}  // namespace

std::optional<View> mirroredView(const View& view, std::span<const glm::dvec3> outline) {
    if (outline.size() < 3) return std::nullopt;
    for (const glm::dvec3& corner : outline)
        for (int axis = 0; axis < 3; ++axis)
            if (!std::isfinite(corner[axis])) return std::nullopt;
    const glm::dvec4 plane = planeOf(outline);
    const glm::dvec3 normal(plane);
    if (normal == glm::dvec3(0.0) || outline[0] == outline[1]) return std::nullopt;
    const glm::dvec3 eye = eyePosition(view);
    const glm::dvec3 backward(view.view[0][2], view.view[1][2], view.view[2][2]);
    if (!((isOrthographic(view) ? glm::dot(normal, backward) : glm::dot(normal, eye) + plane.w) > 0.0))
        return std::nullopt;

    glm::dmat4 reflection(1.0);
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row) reflection[column][row] -= 2.0 * normal[row] * normal[column];
    reflection[3] = glm::dvec4(-2.0 * plane.w * normal, 1.0);
    // Two reflections are a rotation: the second one turns the image left to right, before and behind the projection.
    glm::dmat4 turn(1.0);
    turn[0][0] = -1.0;
    View mirrored = view;
    mirrored.view = turn * view.view * reflection;
    mirrored.projection = turn * view.projection * turn;
    mirrored.sections = {};
    mirrored.sections.add(plane);
    mirrored.window = {};
    mirrored.through = outlineOf(outline, normal);
    if (isOrthographic(view)) return mirrored;
    const glm::dvec3 behind = eye - 2.0 * (glm::dot(normal, eye) + plane.w) * normal;
    addWindow(mirrored, volumeOfWindow(behind, {mirrored.through.points, mirrored.through.count}, false));
    return mirrored;
}

}  // namespace sightline
