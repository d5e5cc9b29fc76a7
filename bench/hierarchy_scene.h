// A scene's own hierarchy beside a static tree and one that lives, over the same objects.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "bench/table.h"
#include "sightline/scene/scene.h"

namespace sightline::bench {

/// Queries from the scene's seeded cameras; then a part of the scene moves as one.
/// @param where  its name in the table
void addSceneTree(Table& table, const std::string& where, const Scene& scene, int repeat);

}  // namespace sightline::bench
