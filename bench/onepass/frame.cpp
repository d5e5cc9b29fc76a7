// The rows of an object's screen, their inverse, and how long they are.
// SPDX-License-Identifier: MIT
#include "bench/onepass/frame.h"

#include <cmath>

namespace sightline::bench {

ObjectFrame objectFrame(const Screen& object, bool flips) {
    ObjectFrame out;
    out.x = object.x;
    out.y = object.y;
    out.w = object.w;
    const glm::dmat3 rows = glm::transpose(glm::dmat3(glm::dvec3(out.x), glm::dvec3(out.y), glm::dvec3(out.w)));
    const double size = glm::determinant(rows);
    if (!object.perspective || !(object.near_w > 0) || !(std::abs(size) > 0) || !std::isfinite(1 / size)) return out;
    const glm::dmat3 inverse = glm::inverse(rows);
    out.eye = -(inverse * glm::dvec3(out.x.w, out.y.w, out.w.w));
    out.to_image = glm::transpose(inverse);
    out.near_w = object.near_w;
    const auto length = [](const glm::dvec4& row) {
        return static_cast<float>(glm::length(glm::dvec3(row)) * (1 + 1e-6));
    };
    out.length_x = length(out.x);
    out.length_y = length(out.y);
    out.length_w = length(out.w);
    out.sign = object.mirrored != flips ? -1 : 1;
    out.usable = true;
    return out;
}

}  // namespace sightline::bench
