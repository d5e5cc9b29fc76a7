// Rooms with furniture, their eyes, and rows of visibility that say which rooms hang together.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <optional>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "sightline/base/bit_matrix.h"
#include "sightline/visfile/visible_rows.h"
#include "tests/support/made_rooms.h"
#include "tests/support/answers.h"
#include "tests/support/views.h"

namespace sightline::test {

inline constexpr uint32_t kCells = kCellStages, kFrustum = stageBit(Stage::kFrustum);
inline constexpr uint8_t kByPvs = 1 + static_cast<uint8_t>(Stage::kPvs),
                         kByPortals = 1 + static_cast<uint8_t>(Stage::kPortals);
inline constexpr Camera kRoomCamera{70, 320, 180, 0.01};

/// Random eyes in the rooms, some of them in holes and right at walls.
inline glm::dvec3 randomEye(const MadeRooms& rooms, Random& random) {
    glm::dvec3 eye = rooms.pointInside(random);
    if (!rooms.holes.empty() && random.below(3) == 0) {
        const MadeRooms::Hole& hole = rooms.holes[random.below(static_cast<uint32_t>(rooms.holes.size()))];
        eye[hole.axis] = hole.at + (random.below(2) ? 0.0 : random.uniform(-0.02, 0.02));
        eye[2 - hole.axis] = random.uniform(hole.low, hole.high);
        eye.y = random.uniform(hole.bottom + 0.05, hole.top - 0.05);
    }
    return eye;
}

inline void furnish(MadeRooms& rooms, Random& random, int count, OccluderId occluder = {}) {
    for (int i = 0; i < count; ++i)
        rooms.add(MadeRooms::boxAround(rooms.pointInside(random), random.uniform(0.05, i % 10 ? 0.6 : 3.0)), 1,
                  occluder);
}

inline bool isInImage(const View& view, const glm::dvec3& p) {
    const glm::dvec4 clip = view.projection * view.view * glm::dvec4(p, 1.0);
    return std::abs(clip.x) <= clip.w && std::abs(clip.y) <= clip.w && clip.z >= -clip.w;
}

/// A place in an object that the eye sees by the holes, in the image, if one of so many random ones is such a place.
inline std::optional<glm::dvec3> seenPlace(const MadeRooms& rooms, size_t object, const glm::dvec3& eye,
                                           const View& view, Random& random, int samples = 12) {
    for (int sample = 0; sample < samples; ++sample) {
        const glm::dvec3 p = randomIn(random, rooms.boxes[object]);
        if (rooms.isInside(p) && isInImage(view, p) && rooms.sees(eye, p)) return p;
    }
    return std::nullopt;
}

/// Which rooms hang together by open holes.
inline std::vector<uint32_t> partsOf(const MadeRooms& rooms) {
    std::vector<uint32_t> part(rooms.space.graph.cells);
    for (uint32_t i = 0; i < part.size(); ++i) part[i] = i;
    for (size_t round = 0; round < part.size(); ++round)
        for (const MadeRooms::Hole& hole : rooms.holes)
            part[hole.a] = part[hole.b] = std::min(part[hole.a], part[hole.b]);
    return part;
}

/// Rooms of several parts, with rows of visibility that say no more than that.
struct RoomsWithRows {
    MadeRooms rooms;
    std::vector<uint32_t> parts;
    Array<char> bytes;
    VisibleRows rows;

    explicit RoomsWithRows(uint64_t seed) : rooms(seed, 6, 6) {
        // Walls without holes through the middle.
        std::erase_if(rooms.holes, [](const MadeRooms::Hole& hole) { return hole.axis == 2 && hole.at == 12; });
        std::erase_if(rooms.space.graph.portals,
                      [](const CellPortal& p) { return p.cells[0] / 6 == 2 && p.cells[1] / 6 == 3; });
        parts = partsOf(rooms);
        bytes = *tiledRows(visible());
        rows = *VisibleRows::open(bytes, "rows");
        for (uint32_t i = 0; i < rooms.space.graph.cells; ++i) rooms.space.row_of_cell.push_back(i);
    }

    /// Rooms of a part see one another.
    BitMatrix visible() const {
        const uint32_t cells = rooms.space.graph.cells;
        BitMatrix matrix(cells, cells);
        for (uint32_t a = 0; a < cells; ++a)
            for (uint32_t b = 0; b < cells; ++b)
                if (parts[a] == parts[b]) matrix.set(a, b);
        return matrix;
    }

    /// With so many things in the rooms.
    Snapshot furnished(Random& random, int count) {
        furnish(rooms, random, count);
        EXPECT_TRUE(rooms.world.attach(rooms.space, &rows));
        return rooms.world.commit();
    }

    /// The rooms that a box touches, by arithmetic alone.
    std::set<uint32_t> roomsOf(const Box3d& box) const {
        std::set<uint32_t> out;
        for (uint32_t room = 0; room < parts.size(); ++room) {
            const double x = MadeRooms::kSize * (room % 6), z = MadeRooms::kSize * (room / 6);
            if (box.max.x >= x && box.min.x <= x + MadeRooms::kSize && box.max.z >= z &&
                box.min.z <= z + MadeRooms::kSize && box.max.y >= 0 && box.min.y <= MadeRooms::kHeight)
                out.insert(room);
        }
        return out;
    }
};

}  // namespace sightline::test
