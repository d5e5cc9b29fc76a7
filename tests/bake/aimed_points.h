// Points at the edges of portals and a little beside them, where walls and holes meet.
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include <glm/glm.hpp>

#include "sightline/base/random.h"
#include "sightline/cells/cells.h"

namespace sightline::test {

/// @pre the graph has a portal
inline glm::dvec3 pointAtPortal(const CellGraph& graph, Random& random) {
    const auto outline = graph.outline(graph.portals[random.below(graph.portals.size())]);
    const size_t i = random.below(outline.size());
    const double off = std::pow(10, random.uniform(-7, 0)) * (random.below(2) ? 1 : -1);
    return glm::mix(outline[i], outline[(i + 1) % outline.size()], random.uniform()) +
           off * (outline[(i + 2) % outline.size()] - outline[i]);
}

}  // namespace sightline::test
