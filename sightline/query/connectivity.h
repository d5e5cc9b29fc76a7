// Ways from one place to others through the cells of a world: for sound, and for whoever walks.
// SPDX-License-Identifier: MIT
//
// Edsger Dijkstra. A Note on Two Problems in Connexion with Graphs. 1959.
// Thomas Funkhouser, Ingrid Carlbom, Gary Elko, Gopal Pingali, Mohan Sondhi, Jim West. A Beam Tracing Approach to
// Acoustic Modeling for Interactive Virtual Environments. 1998.
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include <glm/glm.hpp>

#include "sightline/base/memory.h"
#include "sightline/world/world.h"

namespace sightline {

struct WaySettings {
    /// Holes whose width is less are no way. A hole that is made of several convex portals counts by the widest of them,
    /// so that a large one in many narrow pieces may be missed.  [world units]
    double narrowest = 0;
    /// Where the search found a longer way alone, there is none.  [world units]
    double farthest = std::numeric_limits<double>::infinity();
};

/// A way through open portals.
struct Way {
    bool known = false;     ///< false: nothing is known of one of the two places; `connected` is true
    bool connected = true;  ///< false: there is none
    /// Along `points`. Not always the shortest: which portals it takes is chosen by a search that looks for one bend after
    /// the other; through these it is pulled tight.  [world units]
    double distance = 0;
    /// The width of the narrowest hole that it passes; infinite: it passes none.  [world units]
    double narrowest = std::numeric_limits<double>::infinity();
    /// From the first place to the second, and between them where it bends: from each to the next it is straight.
    std::span<const glm::dvec3> points;
    std::span<const uint32_t> cells;  ///< that it passes, in order  [size: portals passed + 1]
};

/// Finds ways from one place to many. Scratch of one thread, as Query; what it returns is valid until it is asked again.
class ConnectivityQuery {
public:
    explicit ConnectivityQuery(Memory* memory = defaultMemory());
    ~ConnectivityQuery();
    ConnectivityQuery(ConnectivityQuery&&) noexcept;
    ConnectivityQuery& operator=(ConnectivityQuery&&) noexcept;

    /// Says where ways begin, and keeps the cells and the doors of a snapshot. O(cells at the place); O(portals) the first
    /// time, and when the world has other cells.
    /// @returns false if nothing is known of the place: there are no cells, it is in none or as close to solid as
    ///          their tolerance, it is not finite, or a wall of the file does not stand as it did
    bool begin(const Snapshot& now, const glm::dvec3& place, const WaySettings& settings = {});

    /// A way to a place.
    ///
    /// What `connected` denies holds: each way through the air passes an opaque wall of the cells, a shut door or, if
    /// `narrowest` and `farthest` say so, a narrow hole, or is longer by this search. Walls that are drawn from one side
    /// alone stop both ways. What is no wall of the cells, such as furniture, stops nothing; a door that is not shut is
    /// open. A cell that is not convex, as the outside of marked cells, is crossed straight.
    ///
    /// The search goes as far as the place asked for and goes on from there when it is asked again: O(portals nearer
    /// than the place * portals of a cell), and O(portals passed) for the way.
    Way to(const glm::dvec3& place);

private:
    struct Impl;
    Owned<Impl> impl_;
};

}  // namespace sightline
