// Baking through C: what comes out is attached and asked, what is wrong is told, and a caller can end it.
// SPDX-License-Identifier: MIT
#include <cmath>
#include <memory>

#include "sightline/c/bake/bake.h"
#include "sightline/visfile/visibility_file.h"
#include "tests/c/c_twin.h"

namespace sightline::test {
namespace {

/// Two rooms with a hole between them in a shell of boxes, and a thing in each; the door moves.
struct House {
    std::vector<TestMesh> made;
    std::vector<slBakeMesh> meshes;
    std::vector<slBakeObject> objects;
    std::vector<slBakeCell> cells = {{"hall", {{0, 0, 0}, {6, 3, 4}}}, {"kitchen", {{6, 0, 0}, {10, 3, 4}}}};
    double corners[4][3] = {{6, 0, 1}, {6, 0, 2}, {6, 2, 2}, {6, 2, 1}};
    std::vector<slBakePortal> portals = {{"way", {0, 1}, corners, 4, SL_NOTHING}};
    Heard heard;

    House() {
        add({-0.2f, -0.2f, -0.2f}, {10.2f, 0, 4.2f});  // floor
        add({-0.2f, 3, -0.2f}, {10.2f, 3.2f, 4.2f});   // ceiling
        add({-0.2f, -0.2f, -0.2f}, {0, 3.2f, 4.2f});   // walls
        add({10, -0.2f, -0.2f}, {10.2f, 3.2f, 4.2f});
        add({-0.2f, -0.2f, -0.2f}, {10.2f, 3.2f, 0});
        add({-0.2f, -0.2f, 4}, {10.2f, 3.2f, 4.2f});
        add({5.99f, 0, 0}, {6.01f, 3, 1});  // around the hole
        add({5.99f, 0, 2}, {6.01f, 3, 4});
        add({5.99f, 2, 1}, {6.01f, 3, 2});
        add({1, 0, 1}, {1.5f, 1, 1.5f});     // a table in the hall
        add({9, 0, 3.4f}, {9.5f, 1, 3.9f});  // a cupboard in the kitchen
        add({5.95f, 0, 1}, {6.05f, 2, 2});   // the door
        objects.back().moves = true;
        objects.back().name = "door";
        portals[0].door = static_cast<uint32_t>(objects.size() - 1);
        for (const TestMesh& mesh : made) meshes.push_back({meshOf(mesh), nullptr, nullptr, false});
    }
    void add(const glm::vec3& low, const glm::vec3& high) {
        made.push_back(boxMesh(low, high));
        slBakeObject object{};
        object.mesh = static_cast<uint32_t>(objects.size());
        object.key = 100 + objects.size();
        for (int i = 0; i < 16; i += 5) object.transform[i] = 1;
        objects.push_back(object);
    }
    slBakeDef def() {
        slBakeDef def = slDefaultBakeDef();
        def.meshes = meshes.data();
        def.mesh_count = meshes.size();
        def.objects = objects.data();
        def.object_count = objects.size();
        def.cells = cells.data();
        def.cell_count = cells.size();
        def.portals = portals.data();
        def.portal_count = portals.size();
        def.hooks.log = heard.log();
        return def;
    }
};

using Baked = std::unique_ptr<slBaked, void (*)(slBaked*)>;

Baked bakeOf(const slBakeDef& def) {
    slBaked* baked = nullptr;
    EXPECT_EQ(slBake(&def, &baked), SL_OK);
    return {baked, slDestroyBaked};
}

TEST(CBake, MakesAFileThatAWorldAttaches) {
    House house;
    const Baked baked = bakeOf(house.def());
    ASSERT_TRUE(baked);
    size_t size = 0;
    const void* const bytes = slBakedBytes(baked.get(), &size);
    EXPECT_GE(slBakedCells(baked.get()), 2u);
    slVisibility* file = nullptr;
    ASSERT_EQ(slOpenVisibility(bytes, size, "house", nullptr, &file), SL_OK);
    {
        const CWorld world;
        for (size_t i = 0; i < house.objects.size(); ++i) {
            slObjectDef def = slDefaultObjectDef();
            slOccluder* const occluder = prepared(house.made[i]);
            def.bounds = slOccluderBounds(occluder);
            slDestroyOccluder(occluder);
            def.key = house.objects[i].key;
            ASSERT_EQ(slAddObject(world.world, &def, nullptr), SL_OK);
        }
        ASSERT_EQ(slAttach(world.world, file), SL_OK);
        const slDoorId door = slFindDoor(world.world, "door");
        ASSERT_NE(door.index, 0u);
        const uint64_t cupboard = 110;
        for (const double open : {1.0, 0.0}) {
            ASSERT_EQ(slSetDoor(world.world, door, open), SL_OK);
            const CQuery query(world);
            const std::vector<uint64_t> keys = keysOf(query.ask(viewOf(viewAt({3.2, 1.2, 0.4}, {9.2, 0.5, 3.6}))));
            EXPECT_EQ(std::count(keys.begin(), keys.end(), cupboard), open > 0 ? 1 : 0);
        }
    }
    slCloseVisibility(file);
}

TEST(CBake, FindsCellsAndViewCellsWhereNoneAreTold) {
    House house;
    slBakeDef def = house.def();
    def.cells = nullptr;
    def.portals = nullptr;
    def.cell_count = def.portal_count = 0;
    def.view_cells = 64;
    const Baked alone = bakeOf(def);
    slThreadPool* pool = nullptr;
    ASSERT_EQ(slCreateThreadPool(3, &pool), SL_OK);
    def.hooks.jobs = slJobsOf(pool);
    const Baked shared = bakeOf(def);
    slDestroyThreadPool(pool);
    size_t size = 0, same = 0;
    const void *const a = slBakedBytes(alone.get(), &size), *const b = slBakedBytes(shared.get(), &same);
    ASSERT_EQ(size, same);
    EXPECT_EQ(std::memcmp(a, b, size), 0) << "the same for any number of threads";
    const Result<VisibilityFile> file = VisibilityFile::open({static_cast<const char*>(a), size}, "house");
    ASSERT_TRUE(file);
    EXPECT_TRUE(file->hasCells());
}

/// View cells whose middle lies in the far half of the hall.
int64_t viewCellsInTheFarHalf(const slBaked& baked) {
    size_t size = 0;
    const void* const bytes = slBakedBytes(&baked, &size);
    const Result<VisibilityFile> file = VisibilityFile::open({static_cast<const char*>(bytes), size}, "house");
    if (!file || !file->hasViewCells()) return -1;
    const std::vector<Box3d> boxes = leafBoxes(file->viewTree());
    return std::count_if(boxes.begin(), boxes.end(),
                         [](const Box3d& box) { return box.center().x > 0 && box.center().x < 3; });
}

TEST(CBake, ViewCellsAreFinerWhereEyesAre) {
    House house;
    for (int i = 0; i < 60; ++i)  // beside the wall between the rooms, in the kitchen
        house.add({6.2f, 0.04f * i, 3.5f}, {6.3f, 0.04f * i + 0.03f, 3.6f});
    for (size_t i = house.meshes.size(); i < house.made.size(); ++i)
        house.meshes.push_back({meshOf(house.made[i]), nullptr, nullptr, false});
    slBakeDef def = house.def();
    def.view_cells = 200;
    const int64_t anywhere = viewCellsInTheFarHalf(*bakeOf(def));
    ASSERT_GE(anywhere, 1);
    double eyes[64][3];
    for (int i = 0; i < 64; ++i) {
        eyes[i][0] = 0.3 + i % 4 * 0.8;
        eyes[i][1] = 0.3 + i / 4 % 4 * 0.8;
        eyes[i][2] = 0.5 + i / 16;
    }
    def.eyes = eyes;
    def.eye_count = 64;
    EXPECT_GT(viewCellsInTheFarHalf(*bakeOf(def)), anywhere);
}

TEST(CBake, TellsWhatIsWrong) {
    House house;
    const auto refused = [&](auto change, const char* words) {
        House other;
        slBakeDef def = other.def();
        change(other, def);
        slBaked* baked = nullptr;
        EXPECT_EQ(slBake(&def, &baked), SL_BAD_ARGUMENT) << words;
        EXPECT_EQ(baked, nullptr);
        EXPECT_TRUE(other.heard.said(words)) << words;
    };
    refused([](House&, slBakeDef& d) { d.meshes = nullptr; }, "an array of the def is null");
    refused([](House& h, slBakeDef&) { h.objects[0].mesh = 99; }, "an object's mesh is none of def.meshes");
    refused([](House& h, slBakeDef&) { h.objects[0].transform[3] = 1; }, "is it transposed?");
    refused([](House& h, slBakeDef&) { h.cells[0].box.high[0] = -1; }, "a cell's box is empty");
    refused([](House& h, slBakeDef&) { h.portals[0].cells[1] = 0; }, "does not join two of def.cells");
    refused([](House& h, slBakeDef&) { h.portals[0].corner_count = 2; }, "fewer than three corners");
    refused([](House& h, slBakeDef&) { h.portals[0].door = 0; }, "that moves");
    refused([](House& h, slBakeDef&) { h.meshes[0].mesh.index_count = 5; }, "not three a triangle");
    refused([](House& h, slBakeDef&) { h.made[0].positions[0].x = std::nanf(""); }, "not finite");
    refused([](House& h, slBakeDef&) { h.objects[0].transform[12] = std::nan(""); }, "transform is not finite");
    refused([](House&, slBakeDef& d) { d.eye_count = 1; }, "an array of the def is null");
    refused(
        [](House&, slBakeDef& d) {
            static const double eyes[2][3] = {{1, 1.6, 1}, {2, std::nan(""), 3}};
            d.eyes = eyes;
            d.eye_count = 2;
        },
        "an eye is not finite");
    refused([](House& h, slBakeDef&) { h.corners[1][2] = std::nan(""); }, "corner is not finite");
    refused(
        [](House& h, slBakeDef&) {
            for (auto& corner : h.corners) corner[1] = 1;
        },
        "a portal has no area");
    refused(
        [](House& h, slBakeDef&) {
            for (auto& corner : h.corners) corner[0] = 50;
        },
        "does not lie on both of its cells");
    slBakeDef none{};
    none.hooks.log = house.heard.log();
    slBaked* baked = nullptr;
    EXPECT_EQ(slBake(&none, &baked), SL_NO_DEFAULTS);
    EXPECT_EQ(slBake(nullptr, &baked), SL_BAD_ARGUMENT);
    EXPECT_EQ(slBakedBytes(nullptr, nullptr), nullptr);
    EXPECT_EQ(slBakedCells(nullptr), 0u);
    slDestroyBaked(nullptr);
}

TEST(CBake, EndsWhenItsCallerSaysSo) {
    House house;
    slBakeDef def = house.def();
    int calls = 0;
    def.user = &calls;
    def.progress = [](void* user, const char*, double done) {
        EXPECT_GE(done, 0);
        EXPECT_LE(done, 1);
        ++*static_cast<int*>(user);
        return false;
    };
    slBaked* baked = nullptr;
    EXPECT_EQ(slBake(&def, &baked), SL_STOPPED);
    EXPECT_EQ(baked, nullptr);
    EXPECT_GT(calls, 0);
    def.progress = [](void* user, const char*, double) { return ++*static_cast<int*>(user) > 0; };
    EXPECT_TRUE(bakeOf(def));
}

}  // namespace
}  // namespace sightline::test
