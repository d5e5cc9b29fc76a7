// The faces of convex cells, for pictures: what their planes leave of a box.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/cells/cell_space.h"

namespace sightline::viewer {

class CellFaces {
public:
    using Outline = std::vector<glm::dvec3>;

    static constexpr size_t kMostNodes = 100'000;  ///< of a tree; the cells of a larger one have no faces here

    /// O(nodes of a tree times the faces that they cut), or the sum over regions of planes^2.
    /// @param space  is not needed later
    /// @param box    that cells are cut off at  [finite]
    CellFaces(const CellSpace& space, const Box3d& box);

    /// Each counter-clockwise as seen from outside. A cell that several leaves of a tree make has the faces of each.
    std::span<const Outline> of(uint32_t cell) const { return faces_[cell]; }
    size_t cells() const { return faces_.size(); }

private:
    void cutTree(const CellSpace& space, const Box3d& box);
    void cutRegion(std::span<const glm::dvec4> planes, const Box3d& box, std::vector<Outline>& faces) const;

    std::vector<std::vector<Outline>> faces_;
};

}  // namespace sightline::viewer
