// Bounds of skinned and morphed meshes that hold for every pose.
// SPDX-License-Identifier: MIT
//
// Khronos Group. glTF 2.0 Specification, appendix C: interpolation. 2021.
#pragma once

#include <optional>
#include <vector>

#include "sightline/math/box.h"
#include "sightline/tools/import/gltf/gltf_document.h"
#include "sightline/tools/import/gltf/gltf_meshes.h"
#include "sightline/tools/import/gltf/gltf_nodes.h"

namespace sightline::tools::gltf {

struct Range {
    double low = 0, high = 0;
    void grow(double value) {
        low = value < low ? value : low;
        high = value > high ? value : high;
    }
};

/// What a node may do: its rest pose and whatever the animations ask of it.
struct Motion {
    bool animated = false;       ///< translated, rotated or scaled by some animation
    Box3d translation;           ///< in the parent's frame
    double scale = 0;            ///< the most by which it stretches any vector
    std::vector<Range> weights;  ///< animated weights of morph targets; empty: none
};

/// One motion a node. Channels that KHR_animation_pointer aims at a node's translation, rotation, scale or weights, or at
/// a mesh's weights, count like ordinary ones.
/// @param targets  how many morph targets each mesh has  [size: meshes]
std::vector<Motion> readMotions(Document& document, const NodeTree& tree, const std::vector<size_t>& targets);

/// Nodes that an animation moves, shows or hides, and those that an extension of the whole file points at.
NodeChanges nodeChanges(Document& document, size_t nodes);

/// Where morph targets may take the vertices of a mesh.
struct MorphReach {
    std::vector<glm::dvec3> rest, low, high;  ///< [size: vertices]; finite, low <= high on each axis
};

/// @param rest    weights of the rest pose; missing ones are 0
/// @param ranges  what each weight may be, whatever the other weights are
MorphReach morphReach(Document& document, const BuiltMesh& built, const std::vector<float>& rest,
                      const std::vector<Range>& ranges);

/// Makes a mesh that only morphs: positions of the rest pose, bounds of all.
void applyMorph(const MorphReach& reach, Mesh& mesh);

struct Skin {
    std::vector<uint32_t> joints;  ///< nodes
    std::optional<uint32_t> inverse_binds;
};

std::vector<Skin> readSkins(const Document& document, size_t nodes);

/// Poses a skinned mesh: positions of the rest pose in the world's axes, relative to an anchor, and bounds of
/// every pose.
///
/// A pose may turn every joint in any way; a node is translated and scaled as at rest or as some animation
/// asks. So a point that hangs from a chain of nodes stays in a ball around the uppermost moving node, of
/// radius scale * (|translation of the next node| + its radius); blending stays in the balls' common box.
///
/// @return  the anchor, a place in the world near the mesh: precision far from the origin is kept
glm::dvec3 applySkin(Document& document, const NodeTree& tree, const std::vector<Motion>& motions, const Skin& skin,
                     const MorphReach& reach, const std::string& place, BuiltMesh& built);

}  // namespace sightline::tools::gltf
