// Clips indexed triangles at planes of clip space: trivial reject and accept by outcodes, cuts that keep shared edges.
// SPDX-License-Identifier: MIT
//
// Ivan Sutherland, Gary Hodgman. Reentrant Polygon Clipping. 1974.
// Robert Sproull, Ivan Sutherland. A Clipping Divider. 1968 (outcodes).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace sightline::studies {

/// The inside of planes: dot(plane, v) >= 0 for all of them. Planes are applied in this order.
struct ClipVolume {
    static constexpr int kMaxPlanes = 16;

    glm::dvec4 planes[kMaxPlanes];
    int count = 0;

    ClipVolume& add(const glm::dvec4& plane) {
        planes[count++] = plane;
        return *this;
    }
};

/// -w <= x, y, z <= w: near, far, left, right, bottom, top.
ClipVolume frustumVolume();

/// Near and far as they are, and the sides so many half viewports from the centre.
/// @param width  [limit: >= 1]
ClipVolume guardBandVolume(double width);

/// What became of triangles. They add up: triangles = rejected + accepted + clipped.
struct ClipCounters {
    uint64_t triangles = 0;
    uint64_t rejected = 0;  ///< wholly outside of one plane, or not finite
    uint64_t accepted = 0;  ///< wholly inside, or spared
    uint64_t spared = 0;    ///< of the accepted: outside in part, but inside of the volume that clips
    uint64_t clipped = 0;   ///< cut
    uint64_t produced = 0;  ///< triangles that are left: the accepted, and the fans of the clipped
};

/// Triangles after clipping. Kept vertices keep their numbers and their bits; cuts come after them.
struct ClippedMesh {
    /// A new vertex lies at inside + t * (outside - inside); so do its attributes, being linear in clip space.
    struct Cut {
        uint32_t inside = 0, outside = 0;  ///< vertices, perhaps cuts themselves, with smaller numbers
        double t = 0;
    };

    std::vector<glm::dvec4> vertices;  ///< those given, then one a cut
    std::vector<Cut> cuts;             ///< cuts[i] made vertices[given + i]
    std::vector<uint32_t> indices;     ///< [size: 3 * counters.produced]
    std::vector<uint32_t> source;      ///< the triangle that each comes from  [size: counters.produced]
    ClipCounters counters;

    /// Lengthens per-vertex attributes by those of the cuts.
    /// @param values  [size: the given vertices]; T is added, subtracted and scaled by double
    template <class T>
    void interpolate(std::vector<T>& values) const {
        for (const Cut& cut : cuts)
            values.push_back(values[cut.inside] + cut.t * (values[cut.outside] - values[cut.inside]));
    }
};

/// Appends the triangles (p0, p1, p2), (p0, p2, p3), … of a convex polygon: n - 2, without new vertices.
void appendFan(std::span<const uint32_t> polygon, std::vector<uint32_t>& indices);

/// Clips each triangle at those planes of `clip` that one of its vertices lies outside of. Triangles wholly outside of
/// one plane of either volume are dropped first. With the frustum as `reject` and a guard band as `clip`, near and far
/// planes always cut, and the sides only what reaches beyond the band, at the band.
///
/// Which side of a plane a cut lies on follows from its ends where both are on the same side: two triangles with an edge
/// in common cut it in the same points, bit by bit, whatever else they are clipped at.
///
/// @param vertices  in clip space  [limit: |coordinates| <= 1e150]
/// @param indices   [size: 3 * triangles]
/// @param out       what it held is replaced; its memory is used again
void clipMesh(std::span<const glm::dvec4> vertices, std::span<const uint32_t> indices, const ClipVolume& reject,
              const ClipVolume& clip, ClippedMesh& out);

}  // namespace sightline::studies
