// What the witnesses know of a scene beyond its data: where objects lie, and which triangles show and hide.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "sightline/math/box.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

/// Finds boxes by a test that holds for a box whenever it holds for a part of it.
class BoxTree {
public:
    /// Boxes that are not finite are left out.
    void build(std::span<const Box3d> boxes);

    /// Calls visit(index) for each box in the leaves that touches(box of the leaf) accepts.
    template <class Touches, class Visit>
    void walk(Touches&& touches, Visit&& visit) const {
        if (nodes_.empty()) return;
        uint32_t stack[64];
        int depth = 0;
        stack[depth++] = 0;
        while (depth > 0) {
            const Node& node = nodes_[stack[--depth]];
            if (!touches(node.box)) continue;
            if (node.right == 0) {
                for (uint32_t i = node.begin; i < node.end; ++i) visit(order_[i]);
                continue;
            }
            stack[depth++] = node.right;
            stack[depth++] = static_cast<uint32_t>(&node - nodes_.data()) + 1;
        }
    }

private:
    struct Node {
        Box3d box;
        uint32_t begin = 0, end = 0;
        uint32_t right = 0;  ///< 0: a leaf; the left child is the next node
    };
    void split(std::span<const Box3d> boxes, uint32_t begin, uint32_t end);

    std::vector<Node> nodes_;
    std::vector<uint32_t> order_;
};

/// Facts of one mesh, in object space.
struct MeshFacts {
    std::vector<uint8_t> double_sided;  ///< per triangle
    std::vector<uint8_t> hides;         ///< per triangle: 0 if it is seen but hides nothing
    std::vector<double> area_sum;       ///< per triangle: areas up to and with it
    bool all_plain = true;              ///< every triangle is double-sided and hides
    bool all_hide = true;
    Box3d bounds;  ///< of the triangles' vertices in the rest pose

    /// Boxes of the triangles; built when first asked for. Thread-safe.
    const BoxTree& triangles(const Mesh& mesh) const;

private:
    mutable std::once_flag built_;
    mutable BoxTree tree_;
};

/// Facts of a scene, which must outlive them. Objects whose transform is not finite, or that reach
/// beyond 1e15, lie nowhere: nobody can bear witness to them.
class SceneFacts {
public:
    explicit SceneFacts(const Scene& scene);

    const Scene& scene() const { return scene_; }
    const Mesh& mesh(uint32_t object) const { return scene_.meshes[scene_.objects[object].mesh]; }
    const MeshFacts& facts(uint32_t object) const { return *meshes_[scene_.objects[object].mesh]; }
    const MeshFacts& meshFacts(uint32_t mesh) const { return *meshes_[mesh]; }
    const Box3d& box(uint32_t object) const { return boxes_[object]; }  ///< world space; empty: not drawn
    const BoxTree& objects() const { return tree_; }
    /// The same without those that equal an earlier one: what hides is hidden behind each of them alike.
    const BoxTree& distinct() const { return twins_ > 0 ? distinct_ : tree_; }
    /// The first object that equals this one: the same triangles, to the bit, in the same place, that show and hide alike.
    uint32_t firstEqual(uint32_t object) const { return twins_ > 0 ? first_equal_[object] : object; }
    /// Whether another object equals it.
    bool hasEqual(uint32_t object) const { return twins_ > 0 && has_equal_[object]; }

private:
    void findEqual();
    bool areEqual(uint32_t a, uint32_t b) const;

    const Scene& scene_;
    std::vector<std::unique_ptr<MeshFacts>> meshes_;
    std::vector<Box3d> boxes_;
    BoxTree tree_, distinct_;
    std::vector<uint32_t> first_equal_;
    std::vector<uint8_t> has_equal_;
    size_t twins_ = 0;  ///< objects that equal an earlier one
};

}  // namespace sightline::tools
