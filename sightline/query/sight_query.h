// Questions without an image: whether something stands between two points, and what may be seen from a region.
// SPDX-License-Identifier: MIT
//
// John Airey, John Rohlf, Frederick Brooks. Towards Image Realism with Interactive Update Rates in Complex Virtual
// Building Environments. 1990.
#pragma once

#include <cstdint>
#include <span>

#include "sightline/base/memory.h"
#include "sightline/math/box.h"
#include "sightline/world/world.h"

namespace sightline {

struct SightSettings {
    uint32_t layers = ~0u;              ///< objects outside of these do not count
    std::span<const ObjectId> ignored;  ///< nor do these: whoever looks, and what he looks at
};

/// Whether one point sees another.
struct SightLine {
    bool blocked = false;  ///< something surely stands between them; false: the points may see each other
    Visible by;            ///< what does; not always the nearest
};

/// What may be seen from a region.
struct RegionSet {
    std::span<const Visible> objects;  ///< in the order of World::add; valid until the next call
    bool known = false;                ///< false: nothing is known of what is seen from there, and all objects are here
};

/// Scratch of one thread, as Query.
class SightQuery {
public:
    explicit SightQuery(Memory* memory = defaultMemory());
    ~SightQuery();
    SightQuery(SightQuery&&) noexcept;
    SightQuery& operator=(SightQuery&&) noexcept;

    /// Whether the front of an occluder stands between two points, by its own triangles where they are now.
    ///
    /// Conservative: `blocked` means that `to` cannot be seen from `from`, in exact arithmetic on the positions given.
    /// What was left out of occluders, and a line that meets an edge of one of its polygons to within rounding, block
    /// nothing. A double-sided occluder blocks both ways; else whoever looks at a wall's back sees through it, as in a
    /// picture. O(log objects) where few boxes lie on the line. Points that are not finite see all.
    SightLine look(const Snapshot& now, const glm::dvec3& from, const glm::dvec3& to,
                   const SightSettings& settings = {});

    /// The objects that may be seen from anywhere in a box, whichever way one looks: what a server must tell a player
    /// who may be there by the time he hears of it, and what is worth loading ahead.
    ///
    /// Conservative: by rows of visibility of the cells that the box meets (Stage::kPvs; of view cells where the file
    /// has them), without a frustum and without occlusion. All objects of the layers, and not `known`: the world has no
    /// rows, the box is not finite or reaches out of all cells, or a wall of the file does not stand as it did or may
    /// be outside of the layers. O(cells that the box meets * objects / 64 + objects found).
    /// @param region  where sight lines begin: it should hold the near rectangles of the eyes, too  [world units]
    RegionSet seenFrom(const Snapshot& now, const Box3d& region, uint32_t layers = ~0u);

private:
    struct Impl;
    Owned<Impl> impl_;
};

}  // namespace sightline
