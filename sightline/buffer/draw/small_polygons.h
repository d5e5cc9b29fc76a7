// What the classification of many small polygons at once reads and writes; small_classify-inl.h does it.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>

#include "sightline/geom/occluder.h"

namespace sightline {

/// A projected vertex on a grid of 1/256 pixel; of a size that is moved at once.
struct alignas(16) SnappedVertex {
    static constexpr int32_t kNone = std::numeric_limits<int32_t>::min();  ///< x of a vertex before the near plane
    static constexpr int32_t kFarthest = 1 << 29;  ///< places beyond are moved here, which is outside every buffer

    int32_t x, y;  ///< [pixels / 256], to the nearest
    float d;       ///< nearness, to the nearest
    int32_t unused;
};

/// A run of polygons to classify, and the buffer.
struct SmallPolygonsTask {
    const OccluderPolygon* polygons = nullptr;
    uint32_t count = 0;                          ///< [limit: <= 64]
    const SnappedVertex* vertices = nullptr;     ///< the cluster's
    uint32_t columns = 0, rows = 0, stride = 0;  ///< the buffer  [tiles]; stride from one row to the next
    bool reverse = false;                        ///< front faces come out clockwise
    float slack = 0;        ///< bound on the error of both coordinates of a vertex before it was snapped
                            ///< [pixels] [limit: <= 1/4]
    float depth_error = 0;  ///< bound on the error of a vertex's nearness before it was snapped
};

/// What small polygons are to the tiles that they meet: one record per polygon and tile, field by field.
///
/// For any true corners within the task's slack of the given ones, the polygon covers every point of the inner
/// pixels and touches none but the outer ones.
struct SmallPolygons {
    static constexpr int kColumns = 4;  ///< tiles that a small polygon meets at most, side by side
    static constexpr int kRows = 16;    ///< pixels that it meets at most, one above the other
    static constexpr uint32_t kMost = 64 * kColumns * 3;

    uint32_t count = 0;                      ///< records; their order is the same on every machine
    alignas(64) uint64_t inner[kMost + 16];  ///< pixels wholly inside the polygon: bit 8 * row + column
    alignas(64) uint64_t outer[kMost + 16];  ///< pixels that it may touch; only if asked for
    alignas(64) uint64_t place[kMost + 16];  ///< tile and polygon

    alignas(64) float farthest[64], nearest[64];  ///< per polygon that has a record: bounds of its nearness

    uint32_t large_count = 0;
    uint8_t large[64];  ///< polygons that have to be drawn otherwise: large, before the near plane, or not convex

    uint32_t tile(uint32_t record) const { return static_cast<uint32_t>(place[record] >> 32); }
    uint32_t polygon(uint32_t record) const { return static_cast<uint32_t>(place[record]); }
};

}  // namespace sightline
