// Bounds of what is to be drawn: items that lie outside of the view as a whole, and the depths that a list spans.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/zbuffer/depth_buffer_items.h"

#include <algorithm>
#include <cmath>

namespace sightline::studies {

ItemBounds::ItemBounds(const View& view)
    : eye_(eyePosition(view)),
      rotation_(glm::dmat3(view.view)),
      projection_(view.projection),
      room_x_(1 + 8.0 / view.width),
      room_y_(1 + 8.0 / view.height) {}

const Box3d& ItemBounds::boxOf(const MeshView& mesh) {
    const auto [place, is_new] = boxes_.try_emplace(mesh.positions.data());
    if (is_new) {
        glm::vec3 low(std::numeric_limits<float>::infinity()), high(-low);
        for (const glm::vec3& p : mesh.positions) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
        place->second = {glm::dvec3(low), glm::dvec3(high)};
    }
    return place->second;
}

glm::dmat4 ItemBounds::toEye(const DrawItem& item) const {
    glm::dmat4 to_eye(rotation_ * glm::dmat3(item.transform));
    to_eye[3] = glm::dvec4(rotation_ * (glm::dvec3(item.transform[3]) - eye_), 1.0);
    return to_eye;
}

Box3d ItemBounds::inEyeSpace(const DrawItem& item) { return transformBox(boxOf(item.mesh), toEye(item)); }

bool ItemBounds::isOutside(const DrawItem& item) {
    const Box3d& box = boxOf(item.mesh);
    if (!box.finite()) return box.empty();
    const glm::dmat4 to_clip = projection_ * toEye(item);
    constexpr double kRoom = 1 + 1e-9;  // for the near and the far plane: more than rounding
    int left = 0, right = 0, bottom = 0, top = 0, before = 0, beyond = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec4 p =
            to_clip * glm::dvec4(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                                 corner & 4 ? box.max.z : box.min.z, 1.0);
        left += p.x < -room_x_ * p.w && p.x < -p.w;
        right += p.x > room_x_ * p.w && p.x > p.w;
        bottom += p.y < -room_y_ * p.w && p.y < -p.w;
        top += p.y > room_y_ * p.w && p.y > p.w;
        before += p.z < -p.w && p.z + p.w < -1e-9 * (std::abs(p.z) + std::abs(p.w));
        beyond += p.z > kRoom * std::abs(p.w);
    }
    return left == 8 || right == 8 || bottom == 8 || top == 8 || before == 8 || beyond == 8;
}

DepthRange fitDepthRange(const DrawList& list, const View& view) {
    DepthRange range = depthRange(view);
    ItemBounds bounds(view);
    double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
    for (const DrawItem& item : list.items()) {
        const Box3d box = bounds.inEyeSpace(item);
        if (!box.finite() || bounds.isOutside(item)) continue;
        nearest = std::min(nearest, -box.max.z);
        farthest = std::max(farthest, -box.min.z);
    }
    if (!(nearest <= farthest)) return range;
    if (!range.orthographic) {  // distances are w, whatever that is of an eye-space z
        farthest *= std::abs(view.projection[2][3]);
        if (farthest > range.near_plane) range.far_plane = std::min(range.far_plane, farthest * (1 + 1e-3));
        return range;
    }
    const double room = 1e-3 * (farthest - nearest) + 1e-6 * (std::abs(farthest) + std::abs(nearest)) + 1e-30;
    const double near_plane = std::max(range.near_plane, nearest - room);
    const double far_plane = std::min(range.far_plane, farthest + room);
    if (near_plane < far_plane) {
        range.near_plane = near_plane;
        range.far_plane = far_plane;
    }
    return range;
}

}  // namespace sightline::studies
