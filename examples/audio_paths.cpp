// Which way a sound comes, and how far: the cells and portals that hide what is not seen also part what is not heard.
// SPDX-License-Identifier: MIT
//
// A sound goes around corners, so that what counts is not sight but the way through open doors.
#include <cstdio>
#include <vector>

#include <sightline/sightline.h>

namespace {
using namespace sightline;

void tell(const char* what, const Way& way) {
    if (!way.connected) return void(std::printf("%s: not heard\n", what));
    // Whoever hears it takes it to come from the last bend.
    const glm::dvec3 from = way.points[way.points.size() - 2];
    std::printf("%s: %.1f m by %zu bends and %zu doors, as if from %.1f, %.1f, %.1f\n", what, way.distance,
                way.points.size() - 2, way.cells.size() - 1, from.x, from.y, from.z);
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
    for (uint32_t i = 0; i < 4; ++i) {
        const auto door = rooms.addDoor("door " + std::to_string(i));
        if (!door || !rooms.addPortal("doorway", i, (i + 1) % 4, outlines[i], *door)) return 1;
    }
    World world = World::create({});
    if (!world.attach(rooms.take())) return 1;

    // One bell, and whoever may hear it.
    const glm::dvec3 bell(1, 1, 1);
    const glm::dvec3 listeners[] = {{4, 1.5, 4}, {9, 1.5, 4}, {1, 1.5, 9}};
    const char* const places[] = {"in the hall", "in the kitchen", "in the library"};
    ConnectivityQuery ways;  // a thread's own, kept from frame to frame
    ways.begin(world.commit(), bell);
    double open[3];
    for (int i = 0; i < 3; ++i) {
        const Way way = ways.to(listeners[i]);
        open[i] = way.distance;
        tell(places[i], way);
    }

    // The door from the hall to the library is shut: there the bell is heard around by kitchen and study.
    world.setPortal(world.findPortal("door 3"), 0);
    ways.begin(world.commit(), bell, {.farthest = 50});
    const Way around = ways.to(listeners[2]);
    tell("in the library, its door shut", around);
    return around.connected && around.cells.size() == 4 && around.distance > open[2] + 5 ? 0 : 1;
}
