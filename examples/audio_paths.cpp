// Which rooms a sound reaches, and by which doors: the same cells and portals that hide what is not seen.
// SPDX-License-Identifier: MIT
//
// A sound goes around corners, so that what counts is not sight but the way through open doors.
#include <cstdio>
#include <limits>
#include <queue>
#include <vector>

#include <sightline/sightline.h>

namespace {
using namespace sightline;

/// The middle of a portal's outline.
glm::dvec3 middleOf(const CellGraph& graph, const CellPortal& portal) {
    glm::dvec3 sum(0.0);
    for (uint32_t i = 0; i < portal.count; ++i) sum += graph.points[portal.first + i];
    return sum / static_cast<double>(portal.count);
}

struct Heard {
    double distance = std::numeric_limits<double>::infinity();  ///< along the way, through the middles of doors
    uint32_t door = ~0u;                                        ///< the portal that it comes in by
};

/// Dijkstra's way from a sound in a cell through portals that are open.
std::vector<Heard> soundFrom(const CellSpace& space, uint32_t cell, const glm::dvec3& at,
                             const std::vector<double>& open) {
    std::vector<Heard> heard(space.graph.cells);
    struct Front {
        double distance;
        uint32_t cell;
        glm::dvec3 at;
        bool operator<(const Front& other) const { return distance > other.distance; }
    };
    std::priority_queue<Front> fronts;
    heard[cell].distance = 0;
    fronts.push({0, cell, at});
    while (!fronts.empty()) {
        const Front front = fronts.top();
        fronts.pop();
        if (front.distance > heard[front.cell].distance) continue;
        for (uint32_t i = 0; i < space.graph.portals.size(); ++i) {
            const CellPortal& portal = space.graph.portals[i];
            if (portal.cells[0] != front.cell && portal.cells[1] != front.cell) continue;
            if (open[i] <= 0) continue;
            const uint32_t beyond = portal.cells[0] == front.cell ? portal.cells[1] : portal.cells[0];
            const glm::dvec3 middle = middleOf(space.graph, portal);
            const double distance = front.distance + glm::length(middle - front.at);
            if (distance >= heard[beyond].distance) continue;
            heard[beyond] = {distance, i};
            fronts.push({distance, beyond, middle});
        }
    }
    return heard;
}

}  // namespace

int main() {
    // Four rooms in a ring, with a door between each and the next.
    CellSpaceBuilder rooms;
    const char* const names[] = {"hall", "kitchen", "study", "library"};
    const Box3d boxes[] = {
        {{0, 0, 0}, {5, 3, 5}}, {{5, 0, 0}, {10, 3, 5}}, {{5, 0, 5}, {10, 3, 10}}, {{0, 0, 5}, {5, 3, 10}}};
    for (int i = 0; i < 4; ++i)
        if (!rooms.addCell(names[i], boxes[i])) return 1;
    const std::vector<std::vector<glm::dvec3>> outlines = {{{5, 0, 2}, {5, 2, 2}, {5, 2, 3}, {5, 0, 3}},
                                                           {{7, 0, 5}, {7, 2, 5}, {8, 2, 5}, {8, 0, 5}},
                                                           {{5, 0, 7}, {5, 2, 7}, {5, 2, 8}, {5, 0, 8}},
                                                           {{2, 0, 5}, {2, 2, 5}, {3, 2, 5}, {3, 0, 5}}};
    for (uint32_t i = 0; i < 4; ++i)
        if (!rooms.addPortal("door", i, (i + 1) % 4, outlines[i])) return 1;
    const CellSpace space = rooms.take();

    const auto tell = [&](const char* what, const std::vector<Heard>& heard) {
        std::printf("%s:", what);
        for (int i = 0; i < 4; ++i) std::printf(" %s %.1f", names[i], heard[static_cast<size_t>(i)].distance);
        std::printf("\n");
    };
    const std::vector<Heard> all = soundFrom(space, 0, {1, 1, 1}, {1, 1, 1, 1});
    const std::vector<Heard> shut = soundFrom(space, 0, {1, 1, 1}, {1, 1, 1, 0});
    tell("a bell in the hall, doors open", all);
    tell("the door from hall to library shut", shut);
    // Shut, the library hears it around by kitchen and study.
    return all[3].door == 3 && shut[3].door == 2 && shut[3].distance > 2 * all[3].distance ? 0 : 1;
}
