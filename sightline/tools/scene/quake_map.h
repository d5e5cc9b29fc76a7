// The source of a map of the Quake family: entities, and brushes as the planes that bound them.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/glm.hpp>

namespace sightline::tools {

/// A side of a brush: three points of its plane. The normal, cross(points[0] - points[1], points[2] - points[1]), points out.
struct QuakeMapSide {
    glm::dvec3 points[3];
    uint32_t texture = 0;                ///< index into QuakeMap::textures
    uint32_t contents = 0, surface = 0;  ///< flags of Quake 2 and 3; 0 where the file has none
    bool has_flags = false;              ///< the file has them
};

/// Convex: what lies behind all its sides. May be empty, or without end: nothing of this has been looked at.
struct QuakeMapBrush {
    uint32_t first_side = 0, side_count = 0;
    uint32_t line = 0;  ///< of the file, where it begins
};

struct QuakeMapEntity {
    uint32_t first_pair = 0, pair_count = 0;
    uint32_t first_brush = 0, brush_count = 0;
    uint32_t line = 0;
};

struct QuakeMapPair {
    std::string key, value;
};

/// A `.map`, turned from z up to y up: (x, y, z) became (x, z, -y); units stay. Values are as they were written: an origin
/// has its z last.
struct QuakeMap {
    std::vector<QuakeMapEntity> entities;
    std::vector<QuakeMapPair> pairs;
    std::vector<QuakeMapBrush> brushes;
    std::vector<QuakeMapSide> sides;
    std::vector<std::string> textures;  ///< each name once, as it was written
    uint64_t patches = 0;               ///< curved surfaces, left out
    bool primitives = false;            ///< some sides are brush primitives
    std::string game;                   ///< as an editor names it in a comment, `// Game: Quake 2`; or empty

    std::span<const QuakeMapSide> sidesOf(const QuakeMapBrush& brush) const {
        return {sides.data() + brush.first_side, brush.side_count};
    }
    std::span<const QuakeMapBrush> brushesOf(const QuakeMapEntity& entity) const {
        return {brushes.data() + entity.first_brush, entity.brush_count};
    }
    /// The last value of a key, as the games take it; empty if there is none.
    std::string_view valueOf(const QuakeMapEntity& entity, std::string_view key) const {
        for (uint32_t i = entity.pair_count; i-- > 0;)
            if (pairs[entity.first_pair + i].key == key) return pairs[entity.first_pair + i].value;
        return {};
    }
};

}  // namespace sightline::tools
