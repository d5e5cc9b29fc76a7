// Worlds of cells with their rows, and eyes in them.
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sightline/base/bit_matrix.h"
#include "sightline/cells/portal_graph.h"
#include "sightline/geom/view.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::bench {
using namespace tools;

struct EyeWorld {
    std::string name;
    CellSpace space;
    std::unique_ptr<PortalGraph> graph;
    BitMatrix rows;                ///< what cells of a row see
    std::shared_ptr<Scene> scene;  ///< of buildings
    double size = 1;               ///< of what is near to an eye  [world units]

    /// A bit for each row that is seen from the cells that a view starts from; empty if that is not known.
    std::vector<uint64_t> rowsOf(const View& view) const;
};

/// The cells of a building, each a row.
EyeWorld buildingWorld(uint64_t seed, uint32_t floors);

/// The leaves of a compiled map of ../shared/maps, those that share a row of the file are one row. Without a graph if it is not there.
EyeWorld mapWorld(const std::string& name);

/// Views of 90 degrees from inside the cells, level and turned anyhow, seeded.
/// @param among  cells to stand in; empty: all
std::vector<View> eyesIn(const EyeWorld& world, uint64_t seed, size_t count, const std::vector<uint32_t>& among = {});

}  // namespace sightline::bench
