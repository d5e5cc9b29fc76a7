// The refinement of a query's frustum stage, on scenes.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "bench/table.h"
#include "sightline/scene/scene.h"

namespace sightline::bench {

/// Queries from the scene's seeded cameras, with the frustum alone and with all default stages; each with a far plane, too.
/// @param where  its name in the table
void addQueryRefinement(Table& table, const std::string& where, const Scene& scene, int repeat);

}  // namespace sightline::bench
