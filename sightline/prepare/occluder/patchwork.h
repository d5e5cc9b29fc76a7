// The hiding triangles of one or several meshes on common vertices, and the sides by which they hang together.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sightline/prepare/occluder_source.h"

namespace sightline {

/// A triangle, or two triangles 0 1 2 and 0 2 3, by vertices of the patchwork.
struct PatchPolygon {
    uint32_t vertex[4];
    uint32_t mesh;  ///< which of the sources
    uint8_t corners;
    bool double_sided;
};

/// Polygons, mesh by mesh, whose vertices are the same exactly if their positions are.
struct Patchwork {
    std::vector<glm::vec3> positions;
    std::vector<PatchPolygon> polygons;
    std::vector<uint32_t> first_chain;  ///< per polygon and corner, of `chains`  [size: 4 * polygons + 1, or empty]
    std::vector<uint32_t> chains;       ///< vertices on sides, between their ends, in the polygon's order

    /// The vertices on a polygon's side from a corner to the next one.
    std::span<const uint32_t> chain(uint32_t polygon, int corner) const {
        if (first_chain.empty()) return {};
        const uint32_t* first = first_chain.data() + 4 * size_t{polygon} + static_cast<size_t>(corner);
        return std::span(chains).subspan(first[0], first[1] - first[0]);
    }

    /// Calls `each` with the polygon's corners and the vertices on its sides, once around.
    template <class Each>
    void forLoop(uint32_t polygon, Each each) const {
        for (int k = 0; k < polygons[polygon].corners; ++k) {
            each(polygons[polygon].vertex[k]);
            for (uint32_t vertex : chain(polygon, k)) each(vertex);
        }
    }
};

/// Takes the hiding triangles together, mesh by mesh. Leaves out those that name a vertex twice or one that is not
/// there, those whose positions are not finite, and those whose corners lie on a line. A negative zero becomes zero;
/// nothing is welded by tolerance. O(n).
Patchwork weld(std::span<const OccluderSource> sources);

/// A polygon's side from its corner to the next one, or a part of it between vertices that lie on it.
struct PatchSide {
    uint32_t low, high;  ///< the vertices it joins, low < high
    uint32_t polygon;
    uint8_t corner;
    bool forward;  ///< the polygon runs from low to high

    bool joins(const PatchSide& other) const { return low == other.low && high == other.high; }
};

/// All sides, in parts where there are chains, sorted by (low, high, polygon, corner): those that join the same
/// vertices stand together.
std::vector<PatchSide> sortedSides(const Patchwork& patchwork);

/// Calls `each` with every run of sides that join the same vertices.
template <class Each>
void forSharedSides(std::span<const PatchSide> sides, Each each) {
    for (size_t i = 0, end = 0; i < sides.size(); i = end) {
        while (end < sides.size() && sides[end].joins(sides[i])) ++end;
        each(sides.subspan(i, end - i));
    }
}

}  // namespace sightline
