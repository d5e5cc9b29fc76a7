// A view as the GL is to draw it: relative to the eye, reversed depth from 1 at the near plane to 0.
// SPDX-License-Identifier: MIT
#include "apps/gl/gl_view.h"

#include <algorithm>
#include <cmath>

namespace sightline {
using namespace studies;
namespace {

void setRow(glm::dmat4& matrix, int row, const glm::dvec4& values) {
    for (int column = 0; column < 4; ++column) matrix[column][row] = values[column];
}

glm::dvec4 rowOf(const glm::dmat4& matrix, int row) {
    return {matrix[0][row], matrix[1][row], matrix[2][row], matrix[3][row]};
}

/// The least depth, as a part of w, of all vertices; within [0, 1).
double farthest(const GlView& view, std::span<const DrawItem> items) {
    double least = 1.0;
    for (const DrawItem& item : items) {
        const glm::dmat4 to_clip = view.objectToClip(item.transform);
        for (const glm::vec3& position : item.mesh.positions) {
            const glm::dvec4 clip = to_clip * glm::dvec4(glm::dvec3(position), 1.0);
            const double depth = clip.z / clip.w;
            if (std::isfinite(depth)) least = std::min(least, depth);
        }
    }
    least = std::max(least, 0.0);
    const double room = 1e-3 * (1.0 - least) + 1e-12;
    return std::max(least - room, 0.0);
}

}  // namespace

glm::dmat4 GlView::objectToClip(const glm::dmat4& transform) const {
    glm::dmat4 to_eye(rotation * glm::dmat3(transform));
    to_eye[3] = glm::dvec4(rotation * (glm::dvec3(transform[3]) - eye), 1.0);
    return to_clip * to_eye;
}

bool GlView::frontIsClockwise(const glm::dmat4& transform) const {
    return (glm::determinant(glm::dmat3(transform)) < 0) != mirrored;
}

GlView makeGlView(const View& view, std::span<const DrawItem> items) {
    GlView result;
    result.rotation = glm::dmat3(view.view);
    result.eye = eyePosition(view);
    result.to_clip = view.projection;
    // A right-handed eye space seen by the usual projection has a negative determinant: eye z is -w there. Of reversed depth
    // z stands for its opposite.
    const bool reversed = isUsable(view) && !runsOutward(view);
    result.mirrored = (glm::determinant(result.rotation) < 0) != ((glm::determinant(view.projection) > 0) != reversed);
    const glm::dvec4 z = (reversed ? -1.0 : 1.0) * rowOf(view.projection, 2), w = rowOf(view.projection, 3);
    setRow(result.to_clip, 2, 0.5 * (w - z));
    if (isOrthographic(view)) {
        const double least = farthest(result, items);
        setRow(result.to_clip, 2, (0.5 * (w - z) - least * w) / (1.0 - least));
    }
    return result;
}

}  // namespace sightline
