// The holes of a graph of cells that are open from both sides: what a sound, or a body, comes through.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include <glm/glm.hpp>

#include "sightline/base/array.h"
#include "sightline/base/assert.h"
#include "sightline/cells/portal_graph.h"

namespace sightline {

/// A convex hole between two cells.
struct Passage {
    uint32_t cells[2] = {0, 0};
    uint32_t first = 0, count = 0;  ///< of Passages::points: its outline, counter-clockwise around the plane's normal
    glm::dvec4 plane{0.0};          ///< through a corner; the normal has length 1
    uint32_t door = CellPortal::kNone;
    double width = 0;  ///< between the two parallel lines in the plane that are the nearest and hold it  [world units]

    uint32_t beyond(uint32_t cell) const {
        SIGHTLINE_DEBUG_ASSERT(cells[0] == cell || cells[1] == cell);
        return cells[cells[0] == cell ? 1 : 0];
    }
};

/// Made once of a graph; immutable. What a wall closes from one side alone is closed: of the portals that lead one way and
/// those that lead back between the same two cells a passage is what they share.
class Passages {
public:
    /// O(portals), and for each pair of cells the portals that lead one way times those that lead back.
    Passages(const PortalGraph& graph, Memory* memory);

    uint32_t size() const { return static_cast<uint32_t>(all_.size()); }
    const Passage& operator[](uint32_t passage) const {
        SIGHTLINE_DEBUG_ASSERT(passage < all_.size());
        return all_[passage];
    }
    /// The passages of a cell.
    std::span<const uint32_t> of(uint32_t cell) const {
        SIGHTLINE_DEBUG_ASSERT(size_t{cell} + 1 < first_.size());
        return {of_cell_.data() + first_[cell], first_[cell + 1] - first_[cell]};
    }
    /// The point of a passage that is the nearest to a point.
    glm::dvec3 nearestTo(uint32_t passage, const glm::dvec3& point) const;
    /// The point of a passage by which the way from one point to another is the shortest.
    glm::dvec3 between(uint32_t passage, const glm::dvec3& from, const glm::dvec3& to) const;
    /// Where a segment comes through a passage, as close as rounding; false if it does not.
    bool passes(uint32_t passage, const glm::dvec3& from, const glm::dvec3& to, glm::dvec3& at) const;

private:
    void add(const DirectedPortal& portal, uint32_t from, std::span<const glm::dvec3> outline);
    void addShared(const PortalGraph& graph, uint32_t from, const DirectedPortal& there, const DirectedPortal& back);
    std::span<const glm::dvec3> outlineOf(const Passage& passage) const {
        return {points_.data() + passage.first, passage.count};
    }
    bool isInside(const Passage& passage, const glm::dvec3& foot) const;

    double slack_ = 0;
    Array<Passage> all_;
    Array<glm::dvec3> points_;
    Array<uint32_t> first_, of_cell_;
};

}  // namespace sightline
