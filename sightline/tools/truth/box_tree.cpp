// A tree over boxes, built by halving: enough to find what a ray or a frustum may meet.
// SPDX-License-Identifier: MIT
#include "sightline/tools/truth/box_tree.h"

#include <algorithm>

namespace sightline::tools {
namespace {

constexpr uint32_t kLeafSize = 4;

}  // namespace

void BoxTree::build(std::span<const Box3d> boxes) {
    nodes_.clear();
    order_.clear();
    for (uint32_t i = 0; i < boxes.size(); ++i)
        if (boxes[i].finite()) order_.push_back(i);
    if (order_.empty()) return;
    nodes_.reserve(order_.size());
    split(boxes, 0, static_cast<uint32_t>(order_.size()));
}

void BoxTree::split(std::span<const Box3d> boxes, uint32_t begin, uint32_t end) {
    const size_t at = nodes_.size();
    nodes_.emplace_back();
    Box3d bounds, centers;
    for (uint32_t i = begin; i < end; ++i) {
        bounds.grow(boxes[order_[i]]);
        centers.grow(boxes[order_[i]].center());
    }
    nodes_[at].box = bounds;
    nodes_[at].begin = begin;
    nodes_[at].end = end;
    if (end - begin <= kLeafSize) return;
    const glm::dvec3 size = centers.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](uint32_t a, uint32_t b) {
                         const double ca = boxes[a].min[axis] + boxes[a].max[axis];
                         const double cb = boxes[b].min[axis] + boxes[b].max[axis];
                         return ca < cb || (ca == cb && a < b);
                     });
    split(boxes, begin, middle);
    nodes_[at].right = static_cast<uint32_t>(nodes_.size());
    split(boxes, middle, end);
}

}  // namespace sightline::tools
