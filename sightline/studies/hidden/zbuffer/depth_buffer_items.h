// Bounds of what is to be drawn: items that lie outside of the view as a whole, and the depths that a list spans.
// SPDX-License-Identifier: MIT
#pragma once

#include <unordered_map>

#include "sightline/geom/view.h"
#include "sightline/math/box.h"
#include "sightline/studies/hidden/draw_item.h"
#include "sightline/studies/hidden/zbuffer/depth_format.h"

namespace sightline::studies {

/// One thread's own. Boxes of meshes that several items share are computed once.
class ItemBounds {
public:
    explicit ItemBounds(const View& view);

    /// True only if no sample can show anything of an item: its box lies beyond one plane of the view volume, with four
    /// samples to spare at the sides. False in doubt.
    bool isOutside(const DrawItem& item);

    /// The item's box in eye space, eye and view direction as in View; empty for an item without vertices.
    Box3d inEyeSpace(const DrawItem& item);

private:
    const Box3d& boxOf(const MeshView& mesh);
    glm::dmat4 toEye(const DrawItem& item) const;

    glm::dvec3 eye_;
    glm::dmat3 rotation_;
    glm::dmat4 projection_;
    double room_x_, room_y_;
    std::unordered_map<const glm::vec3*, Box3d> boxes_;
};

/// A view's range, and what of it a list's items span if that is wanted: a little more on both sides.
DepthRange fitDepthRange(const DrawList& list, const View& view);

}  // namespace sightline::studies
