// Rooms in a row and a column with holes in their walls, what stands in them, and what is truly seen of it.
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "sightline/base/random.h"
#include "sightline/cells/cell_space_build.h"
#include "sightline/query/query.h"

namespace sightline::test {

/// A grid of rooms of 4 x 3 x 4 units whose walls have no thickness. Rooms beside one another share a wall with a hole or
/// without. Nothing is drawn of the walls: the cells alone tell of them.
struct MadeRooms {
    static constexpr double kSize = 4, kHeight = 3;

    /// In the wall at x = kSize * (i + 1) or z = ..., in the wall's own coordinates: along it, and up.
    struct Hole {
        uint32_t a = 0, b = 0;
        int axis = 0;   ///< of the wall's normal: 0 or 2
        double at = 0;  ///< on that axis
        double low = 0, high = 0, bottom = 0, top = 0;
        uint32_t door = CellPortal::kNone;
        double open = 1;  ///< of the door: 0 or 1

        bool holds(const glm::dvec3& p) const {
            const double along = axis == 0 ? p.z : p.x;
            return open > 0 && along >= low && along <= high && p.y >= bottom && p.y <= top;
        }
    };

    uint32_t columns, rows;
    std::vector<Hole> holes;
    CellSpace space;
    World world;
    std::vector<ObjectId> ids;
    std::vector<Box3d> boxes;  ///< by key

    /// @param doors  every hole can be shut: "door 0" and so on
    MadeRooms(uint64_t seed, uint32_t columns_, uint32_t rows_, bool doors = false) : columns(columns_), rows(rows_) {
        Random random(seed);
        CellSpaceBuilder build;
        for (uint32_t r = 0; r < rows; ++r)
            for (uint32_t c = 0; c < columns; ++c)
                (void)build.addCell("room",
                                    Box3d{{kSize * c, 0, kSize * r}, {kSize * (c + 1), kHeight, kSize * (r + 1)}});
        const auto addHole = [&](uint32_t c, uint32_t r, int axis) {
            if (random.below(5) == 0) return;
            Hole hole{.a = r * columns + c};
            hole.b = axis == 0 ? hole.a + 1 : hole.a + columns;
            hole.axis = axis;
            hole.at = kSize * ((axis == 0 ? c : r) + 1);
            const double side = kSize * (axis == 0 ? r : c);
            hole.low = side + random.uniform(0.2, 2.4);
            hole.high = hole.low + random.uniform(0.4, 1.4);
            hole.bottom = random.below(2) ? 0.0 : 0.8;
            hole.top = random.uniform(1.6, 2.6);
            if (doors) hole.door = *build.addDoor("door " + std::to_string(holes.size()));
            const auto corner = [&](double along, double up) {
                return axis == 0 ? glm::dvec3(hole.at, up, along) : glm::dvec3(along, up, hole.at);
            };
            std::vector<glm::dvec3> outline = {corner(hole.low, hole.bottom), corner(hole.high, hole.bottom),
                                               corner(hole.high, hole.top), corner(hole.low, hole.top)};
            // Counter-clockwise as seen from the room before the wall, which looks along the axis.
            const glm::dvec3 turn = glm::cross(outline[1] - outline[0], outline[2] - outline[0]);
            if (turn[axis] > 0) std::swap(outline[1], outline[3]);
            (void)build.addPortal("hole", hole.a, hole.b, outline, hole.door);
            holes.push_back(hole);
        };
        for (uint32_t r = 0; r < rows; ++r)
            for (uint32_t c = 0; c < columns; ++c) {
                if (c + 1 < columns) addHole(c, r, 0);
                if (r + 1 < rows) addHole(c, r, 2);
            }
        space = build.take();
    }

    glm::dvec3 pointInside(Random& random) const {
        return {random.uniform(0.05, kSize * columns - 0.05), random.uniform(0.05, kHeight - 0.05),
                random.uniform(0.05, kSize * rows - 0.05)};
    }

    static Box3d boxAround(const glm::dvec3& center, double size) {
        return {center - glm::dvec3(0.5 * size), center + glm::dvec3(0.5 * size)};
    }
    static glm::dmat4 placed(const Box3d& box) {
        glm::dmat4 transform(1.0);
        for (int axis = 0; axis < 3; ++axis) transform[axis][axis] = box.size()[axis];
        transform[3] = glm::dvec4(box.min, 1.0);
        return transform;
    }
    static ObjectDef objectOf(const Box3d& box, uint64_t key) {
        ObjectDef def;
        def.bounds = {glm::dvec3(0.0), glm::dvec3(1.0)};
        def.transform = placed(box);
        def.key = key;
        return def;
    }
    void add(const Box3d& box, uint32_t layers = 1, OccluderId occluder = {}) {
        ObjectDef def = objectOf(box, boxes.size());
        def.layers = layers;
        def.occluder = occluder;
        boxes.push_back(box);
        ids.push_back(world.add(def));
    }
    void move(size_t i, const Box3d& box) {
        boxes[i] = box;
        world.move(ids[i], placed(box));
    }

    /// Which room a point is in, by its place alone.
    uint32_t roomOf(const glm::dvec3& p) const {
        return static_cast<uint32_t>(std::floor(p.z / kSize)) * columns +
               static_cast<uint32_t>(std::floor(p.x / kSize));
    }
    bool isInside(const glm::dvec3& p) const {
        return p.x > 0 && p.y > 0 && p.z > 0 && p.x < kSize * columns && p.y < kHeight && p.z < kSize * rows;
    }
    /// Whether a segment between two points that are inside passes walls by their holes alone.
    bool sees(const glm::dvec3& from, const glm::dvec3& to) const {
        for (const int axis : {0, 2}) {
            const uint32_t count = axis == 0 ? columns : rows;
            for (uint32_t i = 1; i < count; ++i) {
                const double at = kSize * i, a = from[axis] - at, b = to[axis] - at;
                if (a * b > 0 || a == b) continue;
                const glm::dvec3 p = from + a / (a - b) * (to - from);
                bool through = false;
                for (const Hole& hole : holes) through |= hole.axis == axis && hole.at == at && hole.holds(p);
                if (!through) return false;
            }
        }
        return true;
    }
};

}  // namespace sightline::test
