// Flat faces and convex bodies of an occluder that hide things by themselves, as plain data.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "sightline/base/array.h"
#include "sightline/base/assert.h"

namespace sightline {

/// Occluding polygons that lie nearly in one plane and fill a nearly convex outline. Object space.
struct VolumeFace {
    glm::dvec3 normal{0.0};    ///< of unit length, out of the front
    double low = 0, high = 0;  ///< bounds of dot(normal, v) over all vertices of its polygons
    glm::dvec3 center{0.0};
    double area = 0;
    double reach = 0;  ///< every vertex of its polygons lies within this of the convex hull of the outline's corners
    uint32_t first = 0, count = 0;  ///< its outline in VolumeParts::outline, counter-clockwise seen from the front
    bool double_sided = false;
};

/// A side of a face, as part of a body. Faces are counted from the part's first.
struct VolumeEdge {
    static constexpr uint8_t kNone = 255;
    uint32_t from = 0, to = 0;  ///< corners
    uint8_t left = kNone;       ///< the face whose outline runs from -> to
    uint8_t right = kNone;      ///< the one whose outline runs to -> from
};

/// One face, or several that make a convex body or a part of one.
struct VolumePart {
    static constexpr uint32_t kMaxFaces = 16;
    static constexpr uint32_t kNone = ~0u;
    uint32_t first_face = 0, face_count = 0;  ///< in VolumeParts::members
    uint32_t first_edge = 0, edge_count = 0;  ///< of a body
    uint32_t body = kNone;                    ///< of a single face: the part that has it too
    double area = 0;                          ///< of the face; of a body: half that of its faces
    glm::dvec3 center{0.0};
    double radius = 0;  ///< of a sphere around the center that holds all corners
};

/// The parts of one occluder: bodies first, by falling area of their largest face; then single faces, by falling area.
struct VolumeParts {
    static constexpr uint32_t kMaxParts = 64;
    static constexpr uint32_t kMaxCorners = 64;  ///< of an outline

    Array<glm::dvec3> corners;
    Array<uint32_t> outline;  ///< corners of faces, one face after the other
    Array<VolumeFace> faces;
    Array<uint32_t> members;  ///< faces of parts, one part after the other
    Array<VolumeEdge> edges;  ///< sides of bodies, one body after the other
    Array<VolumePart> parts;
    Array<VolumePart> more;  ///< single faces that `parts` has no room for, by falling area
    static constexpr uint32_t kMaxFaces = 1024;

    /// One of `parts` or, behind them, of `more`.
    const VolumePart& part(uint32_t i) const {
        SIGHTLINE_DEBUG_ASSERT(i < partCount());
        return i < parts.size() ? parts[i] : more[i - parts.size()];
    }
    /// The part that is a face alone.
    uint32_t partOf(uint32_t face) const {
        SIGHTLINE_DEBUG_ASSERT(face < faces.size() && faces.size() <= partCount());
        return partCount() - static_cast<uint32_t>(faces.size()) + face;
    }
    uint32_t partCount() const { return static_cast<uint32_t>(parts.size() + more.size()); }

    explicit VolumeParts(Memory* memory = defaultMemory())
        : corners(memory),
          outline(memory),
          faces(memory),
          members(memory),
          edges(memory),
          parts(memory),
          more(memory) {}
};

}  // namespace sightline
