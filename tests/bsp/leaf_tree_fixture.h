// Trees of planes to be tested on, and a walk of a segment through one.
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <vector>

#include "sightline/geom/leaf_tree.h"
#include "tests/support/random.h"

namespace sightline::test {

/// Planes of every unpleasant kind: through points of a lattice, the same once more, turned round, moved by the rounding
/// of a float or of a double, nearly parallel, of no normal at all. Within +-4 of `center`.
/// @param repeated  whether planes come again, moved or not: leaves may then be thinner than rounding
inline LeafTree randomLeafTree(uint64_t seed, int depth, const glm::dvec3& center = glm::dvec3(0.0),
                               bool repeated = true) {
    Random random(seed);
    LeafTree tree;
    tree.bounds = {center - 4.0, center + 4.0};
    std::vector<glm::dvec4> used;
    const auto plane = [&]() {
        const uint64_t kind = random.below(repeated ? 20 : 12);
        if (kind >= 12 && !used.empty()) {
            glm::dvec4 again = used[random.below(used.size())];
            const double up = random.below(2) ? 1 : -1;
            if (kind > 15) again.w = again.w == 0 ? up * 1e-20 : std::nextafter(again.w, up * 1e9);
            if (kind == 13) again = -again;
            if (kind == 14) again.w = static_cast<double>(static_cast<float>(again.w) * (1 + 0x1p-23f));
            if (kind == 15)
                for (int i = 0; i < 3; ++i) again[i] += random.uniform(-1e-6, 1e-6);
            return again;
        }
        glm::dvec3 normal(0.0), point = center;
        for (int i = 0; i < 3; ++i)
            point[i] += repeated ? static_cast<double>(random.below(7)) - 3 : random.uniform(-3, 3);
        if (kind < 7) {
            normal[static_cast<int>(random.below(3))] = random.below(2) ? 1 : -1;
        } else if (kind < 11) {
            while (glm::length(normal) == 0)
                for (int i = 0; i < 3; ++i) normal[i] = static_cast<double>(random.below(5)) - 2;
            normal = glm::normalize(normal);
            for (int i = 0; i < 3; ++i) normal[i] = static_cast<float>(normal[i]);
        } else if (!repeated || random.below(8) != 0) {
            for (int i = 0; i < 3; ++i) normal[i] = random.uniform(-1, 1);
            normal = glm::normalize(normal);
        }
        used.emplace_back(normal, -glm::dot(normal, point));
        return used.back();
    };
    const auto grow = [&](const auto& self, int left) -> uint32_t {
        if (left == 0 || (left < 4 && random.below(6) == 0)) {
            const uint64_t kind = random.below(8);
            tree.contents.push_back(kind < 4   ? LeafContents::kEmpty
                                    : kind < 5 ? LeafContents::kLiquid
                                    : kind < 6 ? LeafContents::kSky
                                               : LeafContents::kSolid);
            return LeafTreeNode::kLeaf | static_cast<uint32_t>(tree.contents.size() - 1);
        }
        const uint32_t index = static_cast<uint32_t>(tree.nodes.size());
        tree.nodes.emplace_back();
        tree.nodes[index].plane = plane();
        for (uint32_t side = 0; side < 2; ++side) {
            const uint32_t child = self(self, left - 1);
            tree.nodes[index].child[side] = child;
        }
        return index;
    };
    grow(grow, depth);
    return tree;
}

/// A stretch of a segment in one leaf, from one parameter to another; it entered through a node's plane.
struct Stretch {
    uint32_t leaf = 0;
    double from = 0, to = 1;
    uint32_t node = ~0u;
};

/// All leaves that a segment passes, in order, solid ones too. Of a point in a plane the leaf in front.
inline std::vector<Stretch> stretchesOf(const LeafTree& tree, const glm::dvec3& a, const glm::dvec3& b) {
    std::vector<Stretch> stretches;
    const auto walk = [&](const auto& self, uint32_t child, double from, double to, uint32_t entered) -> void {
        if ((child & LeafTreeNode::kLeaf) != 0) {
            stretches.push_back({child & ~LeafTreeNode::kLeaf, from, to, entered});
            return;
        }
        const LeafTreeNode& node = tree.nodes[child];
        const double at_a = glm::dot(node.plane, glm::dvec4(a, 1)), at_b = glm::dot(node.plane, glm::dvec4(b, 1));
        const double low = at_a + from * (at_b - at_a), high = at_a + to * (at_b - at_a);
        if ((low >= 0) == (high >= 0)) return self(self, node.child[low >= 0], from, to, entered);
        const double cross = std::min(std::max(at_a / (at_a - at_b), from), to);
        self(self, node.child[low >= 0], from, cross, entered);
        self(self, node.child[high >= 0], cross, to, child);
    };
    walk(walk, tree.nodes.empty() ? LeafTreeNode::kLeaf : 0, 0, 1, ~0u);
    return stretches;
}

/// Per leaf the planes above it. Leaves that several children name have those of the last.
inline std::vector<std::vector<glm::dvec4>> boundsOfLeaves(const LeafTree& tree) {
    std::vector<std::vector<glm::dvec4>> bounds(tree.contents.size());
    std::vector<glm::dvec4> path;
    const auto walk = [&](const auto& self, uint32_t child) -> void {
        if ((child & LeafTreeNode::kLeaf) != 0) {
            bounds[child & ~LeafTreeNode::kLeaf] = path;
            return;
        }
        for (uint32_t side = 0; side < 2; ++side) {
            path.push_back(side == 1 ? tree.nodes[child].plane : -tree.nodes[child].plane);
            self(self, tree.nodes[child].child[side]);
            path.pop_back();
        }
    };
    walk(walk, tree.nodes.empty() ? LeafTreeNode::kLeaf : 0);
    return bounds;
}

}  // namespace sightline::test
