// A snapshot that is damaged on purpose is reported.
// SPDX-License-Identifier: MIT
#include "sightline/world/validate_world.h"

#include <gtest/gtest.h>

#include <vector>

#include "sightline/cells/cell_space_build.h"
#include "sightline/world/world.h"
#include "tests/support/debug_asserts.h"

namespace sightline::test {
namespace {

using detail::SnapshotState;

/// Two rooms side by side with a door, and objects in them.
World makeRooms() {
    World world;
    CellSpaceBuilder rooms;
    const uint32_t hall = *rooms.addCell("hall", Box3d{{0, 0, 0}, {40, 3, 4}});
    const uint32_t kitchen = *rooms.addCell("kitchen", Box3d{{40, 0, 0}, {50, 3, 4}});
    const uint32_t door = *rooms.addDoor("door");
    const glm::dvec3 outline[] = {{40, 0, 1}, {40, 0, 2}, {40, 2, 2}, {40, 2, 1}};
    EXPECT_TRUE(rooms.addPortal("portal", hall, kitchen, outline, door).ok());
    EXPECT_TRUE(world.attach(rooms.take()).ok());
    std::vector<ObjectId> ids;
    for (int i = 0; i < 48; ++i) {
        ObjectDef object;
        object.bounds = {glm::dvec3(i, 1, 1), glm::dvec3(i + 0.5, 2, 2)};
        object.limits.factor = i == 7 ? 2 : 1;
        ids.push_back(world.add(object));
    }
    world.add({});  // without bounds
    world.remove(ids[5]);
    return world;
}

TEST(ValidateWorldDeathTest, ReportsEachKindOfDamage) {
    World world = makeRooms();
    const Snapshot snapshot = world.commit();
    SnapshotState& state = const_cast<SnapshotState&>(snapshot.state());
    Memory* const memory = defaultMemory();
    detail::validateWorld(state);
    const auto expectReport = [&](const char* text, const auto& damage) {
        expectDebugAssert(text, [&] {
            damage();
            detail::validateWorld(state);
        });
    };
    expectReport("count", [&] { ++state.count; });
    expectReport("index != 0", [&] { state.living = nullptr; });
    expectReport("common_layers", [&] { state.common_layers = 2; });
    expectReport("unbounded", [&] { state.unbounded.push_back(state.unbounded[0]); });
    expectReport("lods.index", [&] { state.lods = detail::LodTable(memory); });
    expectReport("placed.size", [&] { state.placed = detail::PlacedObjectTable(memory); });
    expectReport("limits", [&] { state.limits.nodes.clear(); });
    expectReport("free == ", [&] { ++state.cell_state.free_count; });
    expectReport("doors", [&] { state.cell_state.doors = nullptr; });
    expectReport("stands", [&] { ++state.cell_state.lists.stands; });
}

TEST(ValidateWorldDeathTest, ReportsAHierarchyOfAnotherWorld) {
    World world = makeRooms(), other = makeRooms();
    for (int i = 0; i < 3; ++i) {
        ObjectDef object;
        object.bounds = {glm::dvec3(i, 1, 1), glm::dvec3(i + 0.25, 1.5, 1.5)};
        (i < 2 ? world : other).add(object);
    }
    const Snapshot one = world.commit(), another = other.commit();
    SnapshotState& state = const_cast<SnapshotState&>(one.state());
    expectDebugAssert("", [&] {
        state.bvh = std::move(const_cast<SnapshotState&>(another.state()).bvh);
        detail::validateWorld(state);
    });
}

}  // namespace
}  // namespace sightline::test
