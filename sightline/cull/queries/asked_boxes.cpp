// The boxes that stand for a node in a question: padded for the rounding of the rasterizer, and tight around what is below.
// SPDX-License-Identifier: MIT
//
// Oliver Mattausch, Jiri Bittner, Michael Wimmer. CHC++: Coherent Hierarchical Culling Revisited. 2008 (tight bounds).
#include "sightline/cull/queries/asked_boxes.h"

#include <algorithm>
#include <cmath>

#include "sightline/geom/frustum.h"
#include "sightline/tree/descend.h"

namespace sightline {
namespace {

/// The length of the shortest image of a vector of length one: a ball's image holds a disk of that radius.
double leastStretch(const glm::dmat2& matrix) {
    const double a = glm::dot(matrix[0], matrix[0]), b = glm::dot(matrix[0], matrix[1]),
                 c = glm::dot(matrix[1], matrix[1]);
    const double most = 0.5 * (a + c + std::hypot(a - c, 2 * b));  // the greater eigenvalue of its square
    return std::abs(glm::determinant(matrix)) / std::sqrt(most);
}

}  // namespace

BoxPadding::BoxPadding(const View& view, const RasterRounding& rounding)
    : eye_(eyePosition(view)),
      forward_(-view.view[0][2], -view.view[1][2], -view.view[2][2]),
      parallel_(isOrthographic(view)) {
    const Frustum frustum = makeFrustum(view);
    const int near_side = runsOutward(view) ? 4 : 5;  // of reversed depth, the planes change places
    for (uint32_t plane = 0; plane < frustum.count; ++plane)
        if (frustum.side[plane] == near_side) near_ = frustum.planes[plane];
    // A factor of the whole matrix changes no image.
    const glm::dmat4 p = view.projection / std::abs(view.projection[parallel_ ? 3 : 2][3]);
    const glm::dmat2 across(p[0][0], p[0][1], p[1][0], p[1][1]);  // from eye space at depth one
    const glm::dvec2 half(0.5 * view.width, 0.5 * view.height);
    per_depth_ = rounding.pixels / leastStretch({half * across[0], half * across[1]});
    // A ball reaches nearer along the ray of a pixel, which leans away from the direction of view.
    const glm::dvec2 corner = glm::dvec2(parallel_ ? 0.0 : 1.0) + glm::abs(glm::dvec2(p[2]));
    const double lean = glm::length(glm::dvec2(1.0, glm::length(corner) / leastStretch(across)));
    // The depth that is written is a + b / depth, or a + b * depth, of a range of two.
    if (parallel_) per_depth_ += lean * 2.0 * rounding.depth_step / std::abs(p[2][2]);
    else per_square_ = lean * 2.0 * rounding.depth_step / std::abs(p[3][2]);
}

/// How far a box reaches along a direction from the eye: no farther than [0], no less than [1].
glm::dvec2 BoxPadding::along(const glm::dvec3& direction, const Box3d& box) const {
    glm::dvec2 reach(0.0);
    for (int axis = 0; axis < 3; ++axis) {
        const double low = direction[axis] * (box.min[axis] - eye_[axis]);
        const double high = direction[axis] * (box.max[axis] - eye_[axis]);
        reach += glm::dvec2(std::max(low, high), std::min(low, high));
    }
    return reach;
}

Box3d BoxPadding::padded(const Box3d& box) const {
    const double depth = std::max(0.0, along(forward_, box)[0]);
    const double by = parallel_ ? per_depth_ : depth * (per_depth_ + depth * per_square_);
    return {box.min - by, box.max + by};
}

bool BoxPadding::isBeyondNear(const Box3d& padded) const {
    // Written so that a NaN is not beyond.
    return along(glm::dvec3(near_), padded)[1] > 1e-6 * std::abs(near_.w) - near_.w &&
           (parallel_ || along(forward_, padded)[1] > 0.0);
}

void appendBoxes(const PlacedBvh& tree, uint32_t slot, bool tight, Array<Box3f>& boxes) {
    constexpr float kEnough = 1.4f;
    const BvhNode& parent = tree.nodes[slot / 8];
    const Box3f own = slotBox(parent, static_cast<int>(slot % 8));
    const uint32_t child = parent.child[slot % 8];
    if (!tight || (child & BvhNode::kLeaf) != 0) return boxes.push_back(own);
    const BvhNode& node = tree.nodes[child];
    const size_t before = boxes.size();
    float area = 0;
    forEachSlot(usedSlots(node), [&](int below) {
        boxes.push_back(slotBox(node, below));
        area += halfArea(boxes.back());
    });
    if (area <= kEnough * halfArea(own)) return;
    boxes.resize(before);
    boxes.push_back(own);
}

}  // namespace sightline
