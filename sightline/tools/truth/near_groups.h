// Divides a scene into objects that lie near together: each group has a frame of its own, in which float keeps its detail.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/math/box.h"
#include "sightline/tools/truth/scene_facts.h"

namespace sightline::tools {

inline constexpr size_t kMostNearGroups = 256;

struct NearGroup {
    std::vector<uint32_t> objects;  ///< [Scene::objects]
    Box3d box;                      ///< of the objects
    glm::dvec3 middle{0.0};         ///< where most of their detail is; coordinates count from it
};

/// The median of a mesh's corners, axis by axis; of large meshes of 65,536 corners. A part that strayed, or a dome, does not
/// move it.  [object space]
glm::dvec3 medianCorner(const Mesh& mesh);

/// Every object that has a box is in one group. A group is at most 1024 times as wide as the median of its objects. So a
/// step of float is at most 2^-13 of that width, wherever else the scene reaches: a stray object, a dome and a second
/// town are groups of their own. Where that would make more than kMostNearGroups, the last ones are wider.
/// @param middles  medianCorner() of each mesh  [Scene::meshes]
std::vector<NearGroup> nearGroups(const SceneFacts& facts, std::span<const glm::dvec3> middles);

}  // namespace sightline::tools
