// Which hiders a segment crosses: a tree of boxes over them.
// SPDX-License-Identifier: MIT
#include "sightline/bake/view_cells/hider_tree.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "sightline/tree/descend.h"

namespace sightline::bake {
namespace {

/// How far along a segment crosses a hider; less than 0 if it does not.
double crossing(const FlatHider& hider, const glm::dvec3& from, const glm::dvec3& to) {
    const glm::dvec3 normal(hider.plane);
    const double above = glm::dot(normal, from) + hider.plane.w, below = glm::dot(normal, to) + hider.plane.w;
    if (!(above > 0 && below < 0)) return -1;
    const double along = above / (above - below);
    const glm::dvec3 point = from + along * (to - from);
    for (size_t i = 0; i < hider.corners.size(); ++i) {
        const glm::dvec3 &a = hider.corners[i], &b = hider.corners[(i + 1) % hider.corners.size()];
        if (glm::dot(glm::cross(normal, b - a), point - a) < 0) return -1;
    }
    return along;
}

}  // namespace

HiderTree::HiderTree(std::span<const FlatHider> hiders) : hiders_(hiders) {
    std::vector<Box3d> boxes;
    boxes.reserve(hiders.size());
    for (const FlatHider& hider : hiders) boxes.push_back(hider.bounds);
    tree_ = buildBvh(boxes);
}

uint32_t HiderTree::crossed(const glm::dvec3& from, const glm::dvec3& to, size_t most,
                            std::vector<Crossed>& found) const {
    if (tree_.nodes.empty() || most == 0) return 0;
    const glm::vec3 start(from - tree_.origin), way(to - from);
    glm::vec3 inverse;
    for (int axis = 0; axis < 3; ++axis)
        inverse[axis] = std::abs(way[axis]) > 1e-30f ? 1 / way[axis] : std::copysign(1e30f, way[axis]);
    const auto nearer = [](const Crossed& a, const Crossed& b) {
        return a.at != b.at ? a.at < b.at : a.hider < b.hider;
    };
    constexpr float kSlack = 1e-5f;
    struct Waiting {
        float enter;
        uint32_t child;
    };
    Waiting stack[256];
    uint32_t depth = 0, opened = 0;
    float last = 1 + kSlack;  // nothing farther is looked for
    stack[depth++] = {0, 0};
    while (depth > 0) {
        const Waiting at = stack[--depth];
        if (at.enter > last) continue;
        if ((at.child & BvhNode::kLeaf) != 0) {
            const uint32_t hider = tree_.order[at.child ^ BvhNode::kLeaf];
            const double along = crossing(hiders_[hider], from, to);
            if (along < 0) continue;
            found.insert(std::upper_bound(found.begin(), found.end(), Crossed{along, hider}, nearer), {along, hider});
            if (found.size() > most) found.pop_back();
            if (found.size() == most) last = static_cast<float>(found.back().at) + kSlack;
            continue;
        }
        const BvhNode& node = tree_.nodes[at.child];
        ++opened;
        float enter[8], leave[8];
        for (int slot = 0; slot < 8; ++slot) {
            enter[slot] = -kSlack;
            leave[slot] = last;
        }
        for (int axis = 0; axis < 3; ++axis)
            for (int slot = 0; slot < 8; ++slot) {
                const float a = (node.min[axis][slot] - start[axis]) * inverse[axis];
                const float b = (node.max[axis][slot] - start[axis]) * inverse[axis];
                enter[slot] = std::max(enter[slot], std::min(a, b));
                leave[slot] = std::min(leave[slot], std::max(a, b));
            }
        uint32_t met = 0;
        for (int slot = 0; slot < 8; ++slot) met |= uint32_t{enter[slot] <= leave[slot] + kSlack} << slot;
        met &= usedSlots(node);
        const uint32_t first = depth;
        forEachSlot(met, [&](int slot) {
            if (depth == std::size(stack)) return;
            // The nearest is opened first.
            uint32_t place = depth++;
            for (; place > first && stack[place - 1].enter < enter[slot]; --place) stack[place] = stack[place - 1];
            stack[place] = {enter[slot], node.child[slot]};
        });
    }
    return opened;
}

}  // namespace sightline::bake
