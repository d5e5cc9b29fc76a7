// A scene's own hierarchy beside a world's, over the same objects.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "bench/table.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::bench {
using namespace tools;

/// Queries from the scene's seeded cameras; then a part of the scene moves as one.
/// @param where  its name in the table
void addSceneTree(Table& table, const std::string& where, const Scene& scene, int repeat);

}  // namespace sightline::bench
