// What the witnesses know of a scene beyond its data: where objects lie, and which triangles show and hide.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "sightline/tools/scene/scene.h"
#include "sightline/tools/truth/box_tree.h"

namespace sightline::tools {

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
    const glm::dvec3& center() const { return center_; }
    double radius() const { return radius_; }  ///< largest distance of a box from the centre, per axis

private:
    const Scene& scene_;
    std::vector<std::unique_ptr<MeshFacts>> meshes_;
    std::vector<Box3d> boxes_;
    BoxTree tree_;
    glm::dvec3 center_{0.0};
    double radius_ = 0;
};

}  // namespace sightline::tools
