// The bodies that a node or an object is proved by: all of it, its clusters, their polygons.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/base/assert.h"
#include "sightline/frame/proof_memory.h"

namespace sightline::detail {

/// Asks for bodies that together hold all that can be seen of a node or an object, the largest first: what is not hidden
/// as one may be so piece by piece.
/// @param closely  polygon by polygon, too
/// @param hides    bool(const Body&)
/// @returns false if one is not hidden
template <class Try>
bool ProofMemory::forEachBody(const Frame& frame, Pending::Kind kind, uint32_t index, bool closely, Try hides) const {
    SIGHTLINE_DEBUG_ASSERT(kind != Pending::Kind::kCluster);
    const Occluder* const shape = kind == Pending::Kind::kObject ? shapeAt(frame, index) : nullptr;
    const uint32_t parts = clustersOf(frame, kind, index);
    if (shape && hides({.form = Body::kWhole})) return true;
    for (uint32_t part = 0; part < parts; ++part) {
        Body body;
        body.first = part;
        body.end = parts > 1 || !shape ? part + 1 : static_cast<uint32_t>(shape->clusters.size());
        body.form = Body::kBox;
        if (parts > 1 && hides(body)) continue;
        body.form = Body::kHull;
        if (hides(body)) continue;
        if (!closely || !shape || shape->polygons.size() > kMostPolygons) return false;
        body.form = Body::kPolygon;
        for (uint32_t i = body.first; i < body.end; ++i) {
            const OccluderCluster& cluster = shape->clusters[i];
            Body one = body;
            one.first = i;
            one.end = i + 1;
            for (uint32_t p = 0; p < cluster.polygon_count; ++p) {
                one.polygon = cluster.first_polygon + p;
                if (!hides(one)) return false;
            }
        }
    }
    return true;
}

}  // namespace sightline::detail
