// The rows of an object's screen, their inverse, and how long they are.
// SPDX-License-Identifier: MIT
#include "sightline/buffer/draw/frame.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sightline {
namespace {

double sizeOf(const glm::dmat3& m) { return glm::length(m[0]) + glm::length(m[1]) + glm::length(m[2]); }

/// Nothing beyond the near plane is nearer.
float nearestOf(const Screen& object) {
    constexpr float kUnknown = std::numeric_limits<float>::infinity();
    if (object.perspective) return object.near_w > 0 ? static_cast<float>((1 + 0x1p-22) / object.near_w) : kUnknown;
    // near.h = a d.h + b, with a < 0, unless the near plane is oblique.
    const glm::dvec3 near(object.near), d(object.d);
    const double a = glm::dot(near, d) / glm::dot(d, d), b = object.near.w - a * object.d.w;
    if (!(a < 0) || !(glm::distance(near, a * d) <= 1e-12 * glm::length(near))) return kUnknown;
    const double size = std::abs(object.near.w / a) + std::abs(object.d.w);
    return static_cast<float>((-b / a + 0x1p-22 * std::abs(b / a) + 0x1p-45 * size) / object.w.w);
}

}  // namespace

ObjectFrame objectFrame(const Screen& object, bool flips, double place_error, bool clips) {
    constexpr double kWorst = 1e9;  // of the rows' condition: what is left of a double are seven digits
    ObjectFrame out;
    out.x = object.x;
    out.y = object.y;
    out.w = object.w;
    out.d = object.d;
    out.near = object.near;
    out.perspective = object.perspective;
    const glm::dvec4& third = object.perspective ? object.w : object.d;
    // As far as pixels go, so that their size does not count against it.
    const double pixels = std::max(object.width, object.height);
    const glm::dmat3 rows =
        glm::transpose(glm::dmat3(glm::dvec3(out.x) / pixels, glm::dvec3(out.y) / pixels, glm::dvec3(third)));
    const glm::dmat3 inverse = glm::inverse(rows);
    if (!(sizeOf(rows) * sizeOf(inverse) < kWorst)) return out;
    if (object.perspective) out.eye = -(inverse * glm::dvec3(out.x.w / pixels, out.y.w / pixels, third.w));
    else out.eye = glm::normalize(inverse[2]);
    for (int column = 0; column < 3; ++column) {
        out.to_image[column][0] = inverse[0][column] / pixels;
        out.to_image[column][1] = inverse[1][column] / pixels;
        out.to_image[column][2] = inverse[2][column];
    }
    out.near_guard = object.near_guard;
    out.nearest = nearestOf(object);
    const auto length = [](const glm::dvec4& row) {
        return static_cast<float>(glm::length(glm::dvec3(row)) * (1 + 1e-6));
    };
    out.length_x = length(out.x);
    out.length_y = length(out.y);
    out.length_w = length(out.w);
    out.length_d = length(out.d);
    out.length_near = length(out.near);
    out.place_error = static_cast<float>(place_error * (1 + 1e-6));
    out.clips = clips;
    out.sign = object.mirrored != flips ? -1 : 1;
    out.usable = std::isfinite(out.eye.x + out.eye.y + out.eye.z) && std::isfinite(out.place_error);
    return out;
}

}  // namespace sightline
