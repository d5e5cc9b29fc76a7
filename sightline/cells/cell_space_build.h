// Cells and portals from code: what a level's maker knows becomes a CellSpace, piece by piece.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sightline/base/result.h"
#include "sightline/cells/cell_space.h"

namespace sightline {

/// Nothing is added by a call that fails; its error (kUsage) is one line that names the cell or portal.
///
///     CellSpaceBuilder rooms;
///     const uint32_t hall = *rooms.addCell("hall", Box3d{{0, 0, 0}, {6, 3, 4}});
///     const uint32_t kitchen = *rooms.addCell("kitchen", Box3d{{6, 0, 0}, {10, 3, 4}});
///     const uint32_t door = *rooms.addDoor("kitchen door", door_key);
///     rooms.addPortal("to the kitchen", hall, kitchen, outline, door);
///     const CellSpace space = rooms.take();
///
/// It takes the word of its caller that a sight line leaves a cell by its portals alone; cellsOfScene() looks at the walls.
class CellSpaceBuilder {
public:
    /// @param planes  inward; normals of any length but zero. The region is bounded, and is no thinner than rounding
    Result<uint32_t> addCell(std::string name, std::span<const glm::dvec4> planes);
    Result<uint32_t> addCell(std::string name, const Box3d& box);
    /// The hull of points.  [size: 4 to 64, not in one plane]
    Result<uint32_t> addHull(std::string name, std::span<const glm::dvec3> points);
    /// CellSpace::outside: the same cell each time.
    uint32_t outside();

    /// @param slide  CellDoor::slide
    Result<uint32_t> addDoor(std::string name, uint64_t key = CellDoor::kNoKey, const glm::dvec3& slide = {});

    /// @param outline  of a convex polygon between the cells, either way round: they tell which side is whose
    ///                 [size: 3 or more]
    /// @param door     of addDoor(); CellPortal::kNone: nothing shuts it
    Status addPortal(std::string_view name, uint32_t a, uint32_t b, std::span<const glm::dvec3> outline,
                     uint32_t door = CellPortal::kNone);

    const CellSpace& space() const { return space_; }
    /// Gives the space away, and begins a new one.
    /// @param tolerance  CellSpace::tolerance; negative: 2^-30 of the largest coordinate
    CellSpace take(double tolerance = -1);

private:
    double rise(uint32_t a, uint32_t b, const glm::dvec4& plane) const;

    CellSpace space_;
    std::vector<glm::dvec3> middles_;  ///< per cell a point inside; of the outside any
};

}  // namespace sightline
