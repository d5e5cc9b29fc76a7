// A graph of cells laid out for a walk each frame: the portals that leave a cell stand together.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include <glm/glm.hpp>

#include "sightline/base/memory.h"
#include "sightline/math/box.h"
#include "sightline/space/cell_space.h"

namespace sightline {

/// Made once of a CellSpace; immutable, so that any number of threads may walk it.
class PortalGraph {
public:
    static constexpr uint32_t kNoCell = CellGraph::kNoCell;

    /// @param space  finite
    explicit PortalGraph(const CellSpace& space, Memory* memory = defaultMemory());

    uint32_t cells() const;
    uint32_t portals() const;
    uint32_t doors() const;
    uint32_t outside() const;             ///< CellSpace::outside
    uint32_t rowOf(uint32_t cell) const;  ///< kNoCell: it has none

    /// The cells that a convex body meets, or comes as close to as the space's tolerance: points and a radius around
    /// their hull.
    /// @param cells  receives them, each once, rising
    /// @returns false if a part of the body may be in no cell: then it is not known what is seen from there
    bool cellsAround(std::span<const glm::dvec3> points, double radius, Array<uint32_t>& cells) const;
    /// The same of a box, for what stands in the cells. Of what reaches out of all cells, the cells that it reaches into.
    /// @returns false if it is in no cell at all
    bool cellsOf(const Box3d& box, Array<uint32_t>& cells) const;
};

}  // namespace sightline
