// Two rooms with a door between them: what is seen through it, and what is left when it shuts.
// SPDX-License-Identifier: MIT
#include <cstdio>
#include <vector>

#include <sightline/sightline.h>

namespace {

enum Key : uint64_t { kLamp = 1, kTable, kCupboard, kCount };

sightline::ObjectDef object(Key key, glm::dvec3 low, glm::dvec3 high) {
    sightline::ObjectDef def;
    def.key = key;
    def.bounds = {low, high};
    return def;
}

/// A hall of 6 x 3 x 4 units and a kitchen of 4 x 3 x 4 beside it. A door joins them, one unit wide and two high.
sightline::Result<sightline::CellSpace> makeRooms() {
    sightline::CellSpaceBuilder rooms;
    const auto hall = rooms.addCell("hall", sightline::Box3d{{0, 0, 0}, {6, 3, 4}});
    const auto kitchen = rooms.addCell("kitchen", sightline::Box3d{{6, 0, 0}, {10, 3, 4}});
    if (!hall) return hall.error();
    if (!kitchen) return kitchen.error();
    // The door slides along z: half open it leaves half of its portal.
    const auto door = rooms.addDoor("kitchen door", sightline::CellDoor::kNoKey, {0, 0, 1});
    if (!door) return door.error();
    const std::vector<glm::dvec3> outline = {{6, 0, 1}, {6, 0, 2}, {6, 2, 2}, {6, 2, 1}};
    const auto added = rooms.addPortal("to the kitchen", *hall, *kitchen, outline, *door);
    if (!added) return added.error();
    return rooms.take();
}

}  // namespace

int main() {
    const sightline::Result<sightline::CellSpace> rooms = makeRooms();
    if (!rooms) {
        std::fprintf(stderr, "%s\n", rooms.error().message.c_str());
        return 1;
    }
    sightline::World world;
    world.add(object(kLamp, {3, 2, 1}, {3.4, 2.5, 1.4}));        // in the hall
    world.add(object(kTable, {8, 0, 1.2}, {9, 1, 1.8}));         // in the kitchen, in line with the door
    world.add(object(kCupboard, {9, 0, 3.5}, {9.9, 1.9, 3.9}));  // in the kitchen, in a corner
    if (!world.attach(*rooms)) return 1;

    // The eye stands in the hall and looks at the door.
    sightline::View view;
    view.view = sightline::lookAt({1, 1.5, 1.5}, {6, 1.2, 1.5}, {0, 1, 0});
    view.projection = sightline::perspective(1.4, 1280.0 / 720.0, 0.1);

    sightline::Query query;
    const sightline::PortalId door = world.findPortal("kitchen door");
    bool good = true;
    const auto look = [&](double open, bool table_expected) {
        world.setPortal(door, open);
        bool seen[kCount] = {};
        for (const sightline::Visible& one : query.visible(world.commit(), view).objects) seen[one.key] = true;
        std::printf("door open by %.1f: lamp %d, table %d, cupboard %d; seen through %zu windows\n", open, seen[kLamp],
                    seen[kTable], seen[kCupboard], query.windows().size());
        good &= seen[kLamp] && seen[kTable] == table_expected && !seen[kCupboard];
    };
    look(1, true);    // open: the table is seen through the door, the cupboard is beside it
    look(0.5, true);  // half open
    look(0, false);   // shut: nothing of the kitchen is seen
    return good ? 0 : 1;
}
