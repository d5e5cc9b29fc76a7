// An object asked of the depth tiles by its own triangles: the second look.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/buffer/ask/occludee.h"
#include "sightline/cull/occludee_place.h"

namespace sightline {

/// A run of triangles that could not be decided by its box.
struct ClusterLook {
    uint32_t cluster = 0;
    float nearness = 0;  ///< no triangle of it is nearer
    double w = 0;        ///< no drawn point of it has less; 0: not known
};

/// Which polygon was found open.
struct OpenPolygon {
    static constexpr uint32_t kNone = ~0u;

    uint32_t cluster = 0;  ///< kNone: none
    uint32_t polygon = 0;  ///< of the cluster
};

/// The limit of one look, its cost, and where it ended.
struct TriangleLook {
    uint64_t most_polygons = ~0u;           ///< the limit; a look that needs more answers kVisible
    OpenPolygon first{OpenPolygon::kNone};  ///< to ask before the others; any, for it changes no answer
    uint32_t polygons = 0;                  ///< that were looked at
    bool spent = false;                     ///< it ran into the limit
    bool by_first = false;                  ///< `first` is open still
    bool in_doubt = false;                  ///< it ended where it could not be said what lies where
    /// Where the answer is not kVisible: nothing hides the object, but some of it lies in the view and is turned away.
    bool away = false;
    OpenPolygon open;  ///< where the answer is kVisible, unless the look was spent
};

/// The scratch memory of second looks.
struct TriangleScratch {
    Array<ClusterLook> clusters;
    Array<OccludeePolygon> undecided;  ///< by what the tiles hold without resolving seams
    Array<OpenPolygon> names;          ///< of these

    explicit TriangleScratch(Memory* memory) : clusters(memory), undecided(memory), names(memory) {}
};

/// Asks an object's triangles until one has an open pixel: first TriangleLook::first, then clusters by their boxes, then
/// their polygons, nearest clusters first. Triangles are clipped at the near plane. A single-sided triangle that is
/// turned away is not drawn, and so it shows nothing.
///
/// @param place  makeOccludeePlace() of the object and shape.bounds
/// @param shape  every triangle that may be drawn of the object, in its space
/// @returns kOutside if no triangle that would be drawn lies in the view
Sight askTriangles(DepthTiles& tiles, const OccludeePlace& place, const Occluder& shape, TriangleScratch& scratch,
                   TriangleLook& look);

/// The same question about one of its polygons: whether it is still open.
bool isOpen(DepthTiles& tiles, const OccludeePlace& place, const Occluder& shape, const OpenPolygon& polygon);

/// What receives polygons, one after another.
struct PolygonSink {
    virtual ~PolygonSink() = default;
    /// @returns false to end
    virtual bool take(const OccludeePolygon& polygon) = 0;
};

/// Gives all polygons of an object that would be drawn and lie in the view.
/// @returns false if one of them cannot be bounded, or the sink ended it
bool forTriangles(const OccludeePlace& place, const Occluder& shape, PolygonSink& sink);

}  // namespace sightline
