// The cells and portals of a procedural building, which its plan knows.
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "sightline/tools/scene/building/plan.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools::building {

/// Fills Scene::cells and Scene::portals.
/// @param leaves  what shuts each opening of each floor: an index into Scene::objects, or ~0  [size: as the plan's]
void addCells(const Plan& plan, const std::vector<std::vector<uint32_t>>& leaves, Scene& scene);

}  // namespace sightline::tools::building
