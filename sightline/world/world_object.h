// Objects of a world as plain data: their ids, their limits, and what they are when they enter it.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "sightline/math/box.h"

namespace sightline {

/// Ids are plain values; zero is null. A removed object's id is never given out again: its index is, with the next
/// generation.
struct ObjectId {
    uint32_t index = 0;
    uint32_t generation = 0;
    bool operator==(const ObjectId&) const = default;
};
struct OccluderId {
    uint32_t index = 0;
    bool operator==(const OccluderId&) const = default;
};
struct ClustersId {
    uint32_t index = 0;
    bool operator==(const ClustersId&) const = default;
};

struct LodsId {
    uint32_t index = 0;
    bool operator==(const LodsId&) const = default;
};

/// What may shut portals of the attached cells: a door.
struct PortalId {
    uint32_t index = 0;
    bool operator==(const PortalId&) const = default;
};

/// What the stages of distance and contribution, which are not conservative, may do with an object.
struct ObjectLimits {
    bool always = false;      ///< neither of them culls it
    double max_distance = 0;  ///< its own, in place of QuerySettings::max_distance; 0: that one  [world units]
    double factor = 1;  ///< the object counts as so many times as large, and QuerySettings::max_distance as so many
                        ///< times as far. A factor that is not a positive number counts as `always`
    bool operator==(const ObjectLimits&) const = default;
};

/// What an object is when it enters a world.
struct ObjectDef {
    Box3d bounds;               ///< object space, of everything that may be drawn: all LODs, all poses
    glm::dmat4 transform{1.0};  ///< object to world, affine
    uint64_t key = 0;           ///< yours; reported back
    OccluderId occluder;        ///< what it hides with, or null
    uint32_t layers = 1;        ///< bit mask; View::layers selects
    /// Its own triangles, for QuerySettings::second_look; or null. They must be all triangles that may be drawn of the
    /// object, in every level of detail, also those that hide nothing; a shader must not move any. May be `occluder`.
    OccluderId shape;
    ObjectLimits limits;  ///< for QuerySettings::max_distance and QuerySettings::contribution
    /// The clusters that it is drawn by, for VisibleSet::ranges; or null. They must hold every triangle that may be
    /// drawn of the object's finest level, and lie within `bounds`.
    ClustersId clusters;
    LodsId lods;  ///< its levels of detail; null: it has one
    /// True if `occluder` lies inside of every level, and `shape` holds the triangles of all. Else both are of the finest
    /// level, and are used only in views that surely draw that one.
    bool hides_in_lods = false;
};

/// What a query says of an object.
struct Visible {
    uint64_t key = 0;  ///< ObjectDef::key
    ObjectId id;
};

}  // namespace sightline
