// Bounds of meshes that bones or morph targets move, for every pose.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include <assimp/scene.h>
#include <glm/glm.hpp>

#include "sightline/math/box.h"

namespace sightline::import {

/// A matrix of Assimp's, in double.
glm::dmat4 toMatrix(const aiMatrix4x4& matrix);

/// Joints may turn in any way; they are shifted and scaled as at rest or as an animation asks. Morph weights go from 0
/// to 1, and to what animations make of them.
class Poses {
public:
    explicit Poses(const aiScene& scene);

    /// Whether an animation takes a node from where it stands at rest.
    bool moves(const aiNode& node) const;

    static bool deforms(const aiMesh& mesh) { return mesh.HasBones() || mesh.mNumAnimMeshes > 0; }

    /// A box, in the space of its node, around all poses of a mesh.
    /// @param world  transform of the node that draws it, as the file has it
    /// Throws a Fault where there is no such box.
    Box3d bounds(const aiMesh& mesh, const glm::dmat4& world) const;

private:
    struct Motion {
        double longest_shift = 0;  ///< of any key
        double largest_scale = 0;
        bool shifts = false;
        std::vector<aiMatrix4x4> first;  ///< place at the first key, of each animation
        bool changes = false;            ///< some key differs from the first
    };
    /// A joint's origin is in this sphere, in the world, and the joint stretches what hangs on it no more than so.
    struct Reach {
        glm::dvec3 center{0};
        double distance = 0, scale = 1;
    };

    void readMotions(const aiAnimation& animation);
    const Motion* motionOf(const aiNode& node) const;
    double scaleOf(const aiNode& node) const;
    double shiftOf(const aiNode& node) const;
    Reach reachOf(const aiNode& joint) const;
    /// How far morph targets move one vertex.
    double morphReach(const aiMesh& mesh, unsigned vertex) const;
    Box3d morphBounds(const aiMesh& mesh) const;

    std::unordered_map<std::string, const aiNode*> nodes_;
    std::unordered_map<std::string, Motion> motions_;
    std::unordered_set<std::string> joints_;
    double largest_weight_ = 1;  ///< of any morph target, in any animation
};

}  // namespace sightline::import
