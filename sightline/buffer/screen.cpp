// From eye-relative positions to the pixels and the depth of an occlusion buffer.
// SPDX-License-Identifier: MIT
#include "sightline/buffer/screen.h"

#include <algorithm>
#include <cmath>

#include "sightline/base/assert.h"

namespace sightline {
namespace {

/// Row over (q, 1) to row over (v, 1), where q = A v + t.
glm::dvec4 throughTransform(const glm::dvec4& row, const glm::dmat4& transform, const glm::dvec3& t) {
    glm::dvec4 out;
    for (int column = 0; column < 3; ++column)
        out[column] = row.x * transform[column][0] + row.y * transform[column][1] + row.z * transform[column][2];
    out.w = row.x * t.x + row.y * t.y + row.z * t.z + row.w;
    return out;
}

/// The clip w on the near plane, or 0 if the plane is oblique and w varies over it.
double nearestW(const glm::dmat4& p, bool perspective) {
    if (!perspective) return p[3][3];
    if (p[0][3] != 0.0 || p[1][3] != 0.0 || p[3][3] != 0.0 || p[0][2] != 0.0 || p[1][2] != 0.0) return 0.0;
    return -p[2][3] * p[3][2] / (p[2][2] + p[2][3]);  // where z = -w
}

}  // namespace

Screen makeScreen(const View& view, uint32_t max_size) {
    SIGHTLINE_DEBUG_ASSERT(isUsable(view));
    Screen screen;
    screen.eye = eyePosition(view);
    screen.perspective = !isOrthographic(view);
    const double shrink =
        std::min(1.0, std::clamp(max_size, 1u, 8192u) / (std::max(view.width, view.height) + 2.0 * view.jitter));
    // Whole tiles only, so that no tile needs a special case; the pixels shrink by less than eight in a row.
    const auto pixels = [&](uint32_t n) {
        return 8 * static_cast<uint32_t>(std::max(1.0, std::ceil((n + 2.0 * view.jitter) * shrink / 8.0)));
    };
    screen.width = pixels(view.width);
    screen.height = pixels(view.height);
    SIGHTLINE_DEBUG_ASSERT(screen.width % 8 == 0 && screen.height % 8 == 0);

    const glm::dmat4 m = view.projection * glm::dmat4(glm::dmat3(view.view));
    const auto row = [&](int r) { return glm::dvec4(m[0][r], m[1][r], m[2][r], m[3][r]); };
    screen.w = row(3);
    // ndc -wide..wide becomes 0..buffer size.
    const double wide_x = 1.0 + 2.0 * view.jitter / view.width, wide_y = 1.0 + 2.0 * view.jitter / view.height;
    screen.x = 0.5 * screen.width * (row(0) / wide_x + row(3));
    screen.y = 0.5 * screen.height * (row(1) / wide_y + row(3));
    screen.near = row(3) + row(2);
    const glm::dmat3 rotation(view.view);
    const glm::dvec3 backward(rotation[0][2], rotation[1][2], rotation[2][2]);
    screen.d = screen.perspective ? glm::dvec4(0, 0, 0, 1) : glm::dvec4(backward, 0);
    const glm::dmat3 facing(glm::dvec3(screen.x), glm::dvec3(screen.y), backward);
    screen.mirrored = glm::determinant(facing) < 0.0;
    // A billionth of the near distance: far above rounding, far below anything that matters.
    const double scale = std::abs(screen.near.w) + 1e-9 * glm::length(glm::dvec3(screen.near));
    screen.near_guard = 0x1p-30 * scale;
    screen.near_w = nearestW(view.projection, screen.perspective);
    return screen;
}

Screen objectScreen(const Screen& screen, const glm::dmat4& transform) {
    Screen out = screen;
    const glm::dvec3 t = glm::dvec3(transform[3]) - screen.eye;
    out.x = throughTransform(screen.x, transform, t);
    out.y = throughTransform(screen.y, transform, t);
    out.w = throughTransform(screen.w, transform, t);
    out.d = throughTransform(screen.d, transform, t);
    out.near = throughTransform(screen.near, transform, t);
    return out;
}

}  // namespace sightline
