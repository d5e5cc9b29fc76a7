// How far animations move joints and morph weights: ranges that hold at every time.
// SPDX-License-Identifier: MIT
//
// Khronos Group. glTF 2.0 Specification, appendix C: interpolation. 2021.
#pragma once

#include <vector>

#include "sightline/math/box.h"
#include "sightline/tools/import/gltf/gltf_document.h"
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

/// One motion a node. Channels that KHR_animation_pointer aims at a node's translation, rotation, scale or
/// weights count like ordinary ones.
/// @param targets  how many morph targets each mesh has  [size: meshes]
std::vector<Motion> readMotions(Document& document, const NodeTree& tree, const std::vector<size_t>& targets);

}  // namespace sightline::tools::gltf
