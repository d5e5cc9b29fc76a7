// Rooms at random: walls of some thickness, doors, holes, boards, and cells that are drawn carelessly.
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "sightline/base/random.h"
#include "tests/bake/marked/made_rooms.h"

namespace sightline::test {

inline FlatRect randomRect(Random& random, const FlatRect& within) {
    const double size = std::pow(10, random.uniform(-3, 0));
    const glm::dvec2 room = within.max - within.min,
                     low = within.min + glm::dvec2(random.uniform(0.05, 0.5), random.uniform(0.05, 0.5)) * room;
    return {low, glm::min(low + size * glm::dvec2(random.uniform(0.5, 1), random.uniform(0.5, 1)),
                          within.max - 0.02 * room)};
}

/// A row of rooms with walls of some thickness between them, with doors, some of them marked, holes, things in the
/// walls' planes, and cells drawn carelessly.
inline MarkedRooms randomRooms(Random& random, int round) {
    MarkedRooms made;
    made.place = round % 3 == 0 ? glm::dmat4(1.0) : randomPlace(random, round % 3 == 1 ? 0 : 1000);
    const double care = round % 2 ? 0 : 0.1;
    double x = 0;
    struct Way {
        double from, to;
        FlatRect rect;
        bool marked;
    };
    std::vector<Way> ways;
    const FlatRect section{{0, 0}, {3, 4}};
    for (int i = 0; i < 4; ++i) {
        const double end = x + 0.25 * double(8 + random.below(16));
        const bool first = i == 0, last = i == 3;
        const double thick = random.below(3) == 0 ? 0 : 0.25;
        made.room({{x, 0, 0}, {end, 3, 4}}, 3 | (random.below(4) == 0 ? 12 : 0));
        if (first) made.wall(0, x, section, 1);
        else made.wall(0, x, section, 1, {ways.back().rect});
        if (last) {
            made.wall(0, end, section, -1, {randomRect(random, section)});
        } else {
            ways.push_back({end, end + thick, randomRect(random, section), random.below(3) != 0});
            made.wall(0, end, section, -1, {ways.back().rect});
            const FlatRect& rect = ways.back().rect;
            if (thick > 0 && random.below(4) != 0)
                made.room({{end, rect.min.x, rect.min.y}, {end + thick, rect.max.x, rect.max.y}}, 3);
        }
        // Shelves, and boards on the walls.
        for (int k = 0; k < 3; ++k)
            made.wall(0, x + random.uniform(0, 0.1), randomRect(random, section), random.below(2) ? 1 : -1);
        Box3d drawn{{x, 0, 0}, {end, 3, 4}};
        for (int axis = 0; axis < 3; ++axis) {
            drawn.min[axis] += random.uniform(-care, care);
            drawn.max[axis] += random.uniform(-care, care);
        }
        made.cell("room " + std::to_string(i), drawn);
        x = end + thick;
    }
    for (uint32_t i = 0; i < ways.size(); ++i)
        if (ways[i].marked)
            made.portal(i, i + 1, 0, random.uniform(ways[i].from - care / 2, ways[i].to + care / 2), ways[i].rect);
    return made;
}

}  // namespace sightline::test
