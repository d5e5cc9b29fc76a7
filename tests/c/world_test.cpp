// Worlds through C: what is refused and in which words, hooks and lifetimes, baked visibility, and the buffer alone.
// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>

#include "sightline/query/connectivity.h"
#include "sightline/visfile/visibility_file.h"
#include "tests/c/c_twin.h"
#include "tests/support/made_rooms.h"
#include "tests/support/memory.h"

namespace sightline::test {
namespace {

TEST(CWorld, RefusesWhatDidNotBeginAsDefaults) {
    Heard heard;
    const CWorld world(heard.hooks());
    slWorldDef world_def{};
    world_def.hooks = heard.hooks();
    slWorld* none = nullptr;
    EXPECT_EQ(slCreateWorld(&world_def, &none), SL_NO_DEFAULTS);
    EXPECT_TRUE(heard.said("slCreateWorld: the def did not begin as slDefaultWorldDef()"));
    slObjectDef object{};
    slObjectId id{7, 7};
    EXPECT_EQ(slAddObject(world.world, &object, &id), SL_NO_DEFAULTS);
    EXPECT_EQ(id.index, 7u) << "outputs are as they were";
    slOccluderDef occluder{};
    occluder.log = heard.log();
    slOccluder* made = nullptr;
    EXPECT_EQ(slPrepareOccluder(&occluder, &made), SL_NO_DEFAULTS);
    slClustersDef clusters{};
    clusters.log = heard.log();
    slClusters* cut = nullptr;
    EXPECT_EQ(slPrepareClusters(&clusters, &cut), SL_NO_DEFAULTS);
    const CQuery query(world, heard.hooks());
    const slView view{};
    const slView good = slDefaultView();
    const slQuerySettings settings{};
    slVisibleSet set;
    EXPECT_EQ(slQueryVisible(query.query, query.now, &view, nullptr, &set), SL_NO_DEFAULTS);
    EXPECT_TRUE(heard.said("slDefaultView()"));
    EXPECT_EQ(slQueryVisible(query.query, query.now, &good, &settings, &set), SL_NO_DEFAULTS);
    EXPECT_TRUE(heard.said("slDefaultQuerySettings()"));
    EXPECT_NE(slViewProblem(&view), nullptr);
    EXPECT_EQ(slViewProblem(&good), nullptr);
}

TEST(CWorld, RefusesMeshesThatAreNone) {
    Heard heard;
    const TestMesh mesh = boxMesh();
    const auto refused = [&](auto change, const char* words) {
        slOccluderDef def = slDefaultOccluderDef();
        def.mesh = meshOf(mesh);
        def.log = heard.log();
        change(def.mesh);
        slOccluder* occluder = nullptr;
        EXPECT_EQ(slPrepareOccluder(&def, &occluder), SL_BAD_ARGUMENT) << words;
        EXPECT_EQ(occluder, nullptr);
        EXPECT_TRUE(heard.said(words)) << heard.sentences.back();
    };
    refused([](slMesh& m) { m.positions = nullptr; }, "mesh.positions is null");
    refused([](slMesh& m) { m.stride = 8; }, "mesh.stride");
    refused([](slMesh& m) { m.index_size = 3; }, "mesh.index_size must be 2 or 4");
    refused([](slMesh& m) { m.index_count = 7; }, "not three a triangle");
    refused([](slMesh& m) { m.vertex_count = 6; }, "and there are 6 vertices");
    slMesh empty{};
    slOccluderDef def = slDefaultOccluderDef();
    def.mesh = empty;
    slOccluder* occluder = nullptr;
    ASSERT_EQ(slPrepareOccluder(&def, &occluder), SL_OK);
    EXPECT_EQ(slOccluderTriangles(occluder), 0u);
    slDestroyOccluder(occluder);
}

TEST(CWorld, ReadsMeshesAsTheyLie) {
    const TestMesh mesh = boxMesh();
    slOccluder* const plain = prepared(mesh);
    EXPECT_EQ(slOccluderTriangles(plain), 12u);
    EXPECT_EQ(slOccluderBounds(plain).high[1], 1.0);
    // Vertices with something between them, indices of two bytes; then no indices at all.
    struct Vertex {
        float normal[3];
        glm::vec3 position;
    };
    std::vector<Vertex> vertices(mesh.positions.size());
    for (size_t i = 0; i < vertices.size(); ++i) vertices[i].position = mesh.positions[i];
    const std::vector<uint16_t> indices(mesh.indices.begin(), mesh.indices.end());
    slOccluderDef def = slDefaultOccluderDef();
    def.mesh = {&vertices[0].position.x, vertices.size(), sizeof(Vertex), indices.data(), indices.size(), 2};
    slOccluder* strided = nullptr;
    ASSERT_EQ(slPrepareOccluder(&def, &strided), SL_OK);
    EXPECT_EQ(slOccluderTriangles(strided), 12u);
    EXPECT_EQ(slOccluderBounds(strided).high[2], 1.0);
    std::vector<glm::vec3> soup;
    for (const uint32_t i : mesh.indices) soup.push_back(mesh.positions[i]);
    def.mesh = {&soup[0].x, soup.size(), 0, nullptr, 0, 0};
    slOccluder* unindexed = nullptr;
    ASSERT_EQ(slPrepareOccluder(&def, &unindexed), SL_OK);
    EXPECT_EQ(slOccluderTriangles(unindexed), 12u);
    // From places that no compiler would choose.
    std::vector<char> bytes(1 + soup.size() * sizeof(glm::vec3));
    std::memcpy(bytes.data() + 1, soup.data(), bytes.size() - 1);
    def.mesh.positions = reinterpret_cast<const float*>(bytes.data() + 1);
    slOccluder* misaligned = nullptr;
    ASSERT_EQ(slPrepareOccluder(&def, &misaligned), SL_OK);
    EXPECT_EQ(slOccluderTriangles(misaligned), 12u);
    slDestroyOccluder(misaligned);
    def.mesh.positions = &soup[0].x;
    const std::vector<uint8_t> hides(12, 0);
    def.hides = hides.data();
    slOccluder* glass = nullptr;
    ASSERT_EQ(slPrepareOccluder(&def, &glass), SL_OK);
    EXPECT_EQ(slOccluderTriangles(glass), 0u);
    for (slOccluder* one : {plain, strided, unindexed, glass}) slDestroyOccluder(one);
}

TEST(CWorld, RefusesWhatIsNotItsOwn) {
    Heard heard;
    const CWorld world(heard.hooks());
    const auto refused = [&](auto change, const char* words) {
        slObjectDef def = slDefaultObjectDef();
        change(def);
        EXPECT_EQ(slAddObject(world.world, &def, nullptr), SL_BAD_ARGUMENT) << words;
        EXPECT_TRUE(heard.said(words)) << heard.sentences.back();
    };
    refused([](slObjectDef& d) { d.occluder = {9}; }, "def.occluder is none of this world's");
    refused([](slObjectDef& d) { d.shape = {9}; }, "def.shape is none of this world's");
    refused([](slObjectDef& d) { d.clusters = {1}; }, "def.clusters are none of this world's");
    refused([](slObjectDef& d) { d.lods = {1}; }, "def.lods are none of this world's");
    refused([](slObjectDef& d) { d.transform[3] = 5; }, "column-major: is it transposed?");
    EXPECT_EQ(slObjectCount(world.world), 0u);
    slObjectDef defs[3] = {slDefaultObjectDef(), slDefaultObjectDef(), {}};
    EXPECT_EQ(slAddObjects(world.world, defs, 3, nullptr), SL_NO_DEFAULTS);
    EXPECT_EQ(slObjectCount(world.world), 0u) << "all or none";

    slObjectId id;
    ASSERT_EQ(slAddObject(world.world, defs, &id), SL_OK);
    EXPECT_EQ(slMoveObject(world.world, id, defs[0].transform), SL_OK);
    const double transposed[16] = {1, 0, 0, 5, 0, 1, 0, 5, 0, 0, 1, 5, 0, 0, 0, 1};
    EXPECT_EQ(slMoveObject(world.world, id, transposed), SL_BAD_ARGUMENT);
    EXPECT_EQ(slRemoveObject(world.world, id), SL_OK);
    EXPECT_EQ(slRemoveObject(world.world, id), SL_STALE_ID);
    EXPECT_EQ(slMoveObject(world.world, id, defs[0].transform), SL_STALE_ID);
    EXPECT_EQ(slRemoveObject(world.world, {}), SL_STALE_ID);
    EXPECT_EQ(slSetDoor(world.world, {1}, 1), SL_STALE_ID);
    EXPECT_EQ(slSetDoor(world.world, {1}, 2), SL_BAD_ARGUMENT);
    EXPECT_EQ(slFindDoor(world.world, "door").index, 0u);

    slLodsId lods{};
    const slLod levels[] = {{0, 100, 80}, {0.5, 40, 30}, {0.2, 10, 8}};
    EXPECT_EQ(slAddLods(world.world, levels, 3, &lods), SL_BAD_ARGUMENT);
    EXPECT_TRUE(heard.said("do not rise"));
    EXPECT_EQ(slAddLods(world.world, levels, 0, &lods), SL_BAD_ARGUMENT);
    EXPECT_EQ(slAddLods(world.world, levels, 2, &lods), SL_OK);
    EXPECT_EQ(lods.index, 1u);
}

TEST(CWorld, NullPointersAreAnsweredEverywhere) {
    Heard heard;
    const CWorld world(heard.hooks());
    const CQuery query(world, heard.hooks());
    const slView view = slDefaultView();
    const slHooks hooks = heard.hooks();
    slHooks half = heard.hooks();
    half.allocator.allocate = [](void*, size_t, size_t) -> void* { return nullptr; };
    slQuery* made = nullptr;
    EXPECT_EQ(slCreateQuery(&half, &made), SL_BAD_ARGUMENT);
    EXPECT_TRUE(heard.said("both functions or neither"));
    const slSnapshot* const now = query.now;
    slVisibleSet set;
    slExplanation why;
    size_t count;
    slBuffer* buffer = nullptr;
    slSight* sight = nullptr;
    slShadows* shadows = nullptr;
    slWays* ways = nullptr;
    slWay way;
    bool known = false;
    slVisibility* file = nullptr;
    const double point[3] = {0, 0, 0};
    slSightLine line;
    slVisibleSet none_there{};
    none_there.count = 3;
    const slLight sun = slDefaultLight();
    slCasterSet casters;
    slLookAt(nullptr, nullptr, nullptr, nullptr);
    slPerspective(nullptr, 1, 1, 1, 2);
    ASSERT_EQ(slCreateBuffer(64, &hooks, &buffer), SL_OK);
    ASSERT_EQ(slCreateSight(&hooks, &sight), SL_OK);
    ASSERT_EQ(slCreateShadows(&hooks, &shadows), SL_OK);
    ASSERT_EQ(slCreateWays(&hooks, &ways), SL_OK);
    const slStatus statuses[] = {
        slCreateQuery(&hooks, nullptr),
        slCreateBuffer(64, &hooks, nullptr),
        slCreateBuffer(0, &hooks, &buffer),
        slCreateSight(&hooks, nullptr),
        slCreateShadows(&hooks, nullptr),
        slCreateWays(&hooks, nullptr),
        slAddOccluder(world.world, nullptr, nullptr),
        slAddClusters(world.world, nullptr, nullptr),
        slAddLods(world.world, nullptr, 1, nullptr),
        slAddObject(world.world, nullptr, nullptr),
        slMoveObjects(world.world, nullptr, nullptr, 1),
        slCommit(world.world, nullptr),
        slAttach(world.world, nullptr),
        slOpenVisibility(nullptr, 0, nullptr, &hooks, &file),
        slQueryVisible(query.query, nullptr, &view, nullptr, &set),
        slQueryVisible(query.query, now, nullptr, nullptr, &set),
        slQueryVisible(query.query, now, &view, nullptr, nullptr),
        slQueryVisibleKeys(query.query, now, &view, nullptr, nullptr, 3, &count),
        slQueryKeys(query.query, nullptr, 3, &count),
        slQueryStereo(query.query, now, &view, nullptr, nullptr, &set, nullptr),
        slQueryPropose(query.query, nullptr, 1),
        slQueryLearn(query.query, nullptr),
        slQueryChanges(query.query, nullptr),
        slQueryGetStats(query.query, nullptr),
        slQueryReasons(query.query, nullptr, 3, &count),
        slQueryDepthImage(query.query, nullptr),
        slQueryRecord(query.query, nullptr, &count),
        slQueryExplain(query.query, now, &view, nullptr, {}, nullptr),
        slDrawAnswer(query.query, now, &view, 7, nullptr),
        slFindCasters(shadows, now, &view, nullptr, nullptr, nullptr, nullptr),
        slFindCasters(shadows, now, &view, &none_there, &sun, nullptr, &casters),
        slSightLook(sight, now, point, nullptr, nullptr, &line),
        slSightFrom(sight, now, nullptr, 1, nullptr),
        slBeginWays(ways, now, point, nullptr, nullptr),
        slBeginWays(ways, nullptr, point, nullptr, &known),
        slWayTo(ways, nullptr, &way),
        slBufferBegin(buffer, nullptr),
        slBufferDraw(buffer, nullptr, nullptr, nullptr),
        slBufferAsk(buffer, nullptr, 1, nullptr),
        slBufferAskOriented(buffer, nullptr, nullptr, nullptr),
        slBufferImage(buffer, nullptr),
    };
    for (const slStatus status : statuses) EXPECT_EQ(status, SL_BAD_ARGUMENT) << &status - statuses;
    EXPECT_EQ(heard.sentences.size(), std::size(statuses) + 1) << "each is heard of";
    EXPECT_EQ(slQueryExplain(query.query, now, &view, nullptr, {3, 1}, &why), SL_OK);
    EXPECT_EQ(why.verdict, SL_NO_SUCH_OBJECT);
    slDestroyBuffer(buffer);
    slDestroySight(sight);
    slDestroyShadows(shadows);
    const slWaySettings no_defaults{};
    EXPECT_EQ(slBeginWays(ways, now, point, &no_defaults, &known), SL_NO_DEFAULTS);
    slDestroyWays(ways);
    // What is null is gone already.
    slDestroyWorld(nullptr);
    slDestroyQuery(nullptr);
    slDestroyOccluder(nullptr);
    slDestroyClusters(nullptr);
    slReleaseSnapshot(nullptr);
    slCloseVisibility(nullptr);
    slDestroyThreadPool(nullptr);
    slDetach(nullptr);
    EXPECT_EQ(slObjectCount(nullptr), 0u);
    EXPECT_EQ(slSnapshotObjects(nullptr), 0u);
    EXPECT_EQ(slOccluderTriangles(nullptr), 0u);
    EXPECT_EQ(slClusterTriangles(nullptr, &count), nullptr);
    EXPECT_EQ(slJobsOf(nullptr).run, nullptr);
    slThreadPool* pool = nullptr;
    EXPECT_EQ(slCreateThreadPool(0, &pool), SL_BAD_ARGUMENT);
}

TEST(CWorld, EveryStatusHasItsWords) {
    for (int status = SL_OK; status <= SL_STOPPED; ++status)
        EXPECT_STRNE(slStatusWords(static_cast<slStatus>(status)), "there is no such status");
    EXPECT_STREQ(slStatusWords(static_cast<slStatus>(99)), "there is no such status");
    EXPECT_EQ(slVersion(), uint32_t(SL_VERSION));
}

TEST(CQuery, RefusesSettingsOutsideOfTheirLimits) {
    Heard heard;
    const CWorld world(heard.hooks());
    const CQuery query(world, heard.hooks());
    const slView view = slDefaultView();
    const auto refused = [&](auto change, const char* words) {
        slQuerySettings settings = slDefaultQuerySettings();
        change(settings);
        slVisibleSet set;
        EXPECT_EQ(slQueryVisible(query.query, query.now, &view, &settings, &set), SL_BAD_ARGUMENT) << words;
        EXPECT_TRUE(heard.said(words)) << heard.sentences.back();
    };
    refused([](slQuerySettings& s) { s.occlusion_size = 0; }, "occlusion_size is outside of its limits");
    refused([](slQuerySettings& s) { s.bins = 17; }, "bins");
    refused([](slQuerySettings& s) { s.contribution = -1; }, "contribution");
    refused([](slQuerySettings& s) { s.hysteresis = std::nan(""); }, "hysteresis");
    refused([](slQuerySettings& s) { s.windows = static_cast<slPortalWindows>(3); }, "windows");
    refused([](slQuerySettings& s) { s.stages = 1u << 20; }, "stages");
    slQuerySettings far = slDefaultQuerySettings();
    far.max_distance = std::numeric_limits<double>::infinity();
    slVisibleSet set;
    EXPECT_EQ(slQueryVisible(query.query, query.now, &view, &far, &set), SL_OK);
    slView other = view;
    other.clip_space = static_cast<slClipSpace>(7);
    EXPECT_EQ(slQueryVisible(query.query, query.now, &other, nullptr, &set), SL_BAD_ARGUMENT);
    other = view;
    other.section_count = SL_MOST_PLANES + 1;
    EXPECT_EQ(slQueryVisible(query.query, query.now, &other, nullptr, &set), SL_BAD_ARGUMENT);
}

TEST(CQuery, TellsOnceOfAViewThatCannotBeUsed) {
    Heard heard;
    const MadeWorld made(2, 50);
    const CWorld world(made);
    const CQuery query(world, heard.hooks());
    slView view = slDefaultView();
    for (double& number : view.view) number *= 2;
    const slVisibleSet set = query.ask(view);
    EXPECT_EQ(set.count, made.ids.size()) << "nothing is culled";
    ASSERT_NE(set.problem, nullptr);
    EXPECT_EQ(query.ask(view).count, made.ids.size());
    EXPECT_EQ(heard.sentences.size(), 1u);
    EXPECT_TRUE(heard.said("nothing is culled: "));
    EXPECT_EQ(query.ask(slDefaultView()).problem, nullptr);
}

/// Memory that is counted, through the hook.
struct HookedMemory {
    CountingMemory memory;
    slHooks hooks() {
        slHooks hooks{};
        hooks.allocator = {[](void* user, size_t bytes, size_t alignment) {
                               return static_cast<HookedMemory*>(user)->memory.allocate(bytes, alignment);
                           },
                           [](void* user, void* place, size_t bytes, size_t alignment) {
                               static_cast<HookedMemory*>(user)->memory.deallocate(place, bytes, alignment);
                           },
                           this};
        return hooks;
    }
};

TEST(CHooks, MemoryComesFromTheAllocatorAndGoesBack) {
    HookedMemory mine;
    {
        const MadeWorld made(3, 300);
        auto world = std::make_unique<CWorld>(made, mine.hooks());
        EXPECT_GT(mine.memory.bytes, 10000u);
        slSnapshot* const now = world->commit();
        slQuery* query = nullptr;
        const slHooks hooks = mine.hooks();
        ASSERT_EQ(slCreateQuery(&hooks, &query), SL_OK);
        Random random(3);
        std::vector<slView> views;
        for (int i = 0; i < 20; ++i) views.push_back(viewOf(randomView(random)));
        slVisibleSet set;
        for (int round = 0; round < 2; ++round)
            for (const slView& view : views) ASSERT_EQ(slQueryVisible(query, now, &view, nullptr, &set), SL_OK);
        const uint64_t before = mine.memory.allocations;
        for (const slView& view : views) ASSERT_EQ(slQueryVisible(query, now, &view, nullptr, &set), SL_OK);
        EXPECT_EQ(mine.memory.allocations, before) << "a query that has seen its like allocates nothing";
        // A snapshot outlives its world, and a query its snapshot.
        world.reset();
        slVisibleSet two;
        const uint8_t* eyes = nullptr;
        ASSERT_EQ(slQueryStereo(query, now, &views[0], &views[1], nullptr, &two, &eyes), SL_OK);
        EXPECT_EQ(slSnapshotObjects(now), made.ids.size());
        ASSERT_EQ(slQueryVisible(query, now, &views[0], nullptr, &set), SL_OK);
        slReleaseSnapshot(now);
        slDestroyQuery(query);
    }
    EXPECT_EQ(mine.memory.bytes, 0u);
}

/// A query that was asked about one world and then about another keeps nothing of the first one, of either eye.
TEST(CHooks, AWorldsMemoryCanGoOnceAQueryWasAskedAboutAnother) {
    const MadeWorld made(3, 100);
    const CWorld other(made);
    slSnapshot* const there = other.commit();
    slQuery* query = nullptr;
    slSight* sight = nullptr;
    slShadows* shadows = nullptr;
    ASSERT_EQ(slCreateQuery(nullptr, &query), SL_OK);
    ASSERT_EQ(slCreateSight(nullptr, &sight), SL_OK);
    ASSERT_EQ(slCreateShadows(nullptr, &shadows), SL_OK);
    const slView view = viewOf(viewAt({0, 0, 40}, {0, 0, 0}));
    const double from[3] = {0, 0, 0}, to[3] = {1, 2, 3};
    const slLight sun = slDefaultLight();
    slVisibleSet set;
    slCasterSet casters;
    slSightLine line;
    const auto askAll = [&](const slSnapshot* now, bool pair) {
        const uint8_t* eyes = nullptr;
        if (pair) ASSERT_EQ(slQueryStereo(query, now, &view, &view, nullptr, &set, &eyes), SL_OK);
        else ASSERT_EQ(slQueryVisible(query, now, &view, nullptr, &set), SL_OK);
        ASSERT_EQ(slSightLook(sight, now, from, to, nullptr, &line), SL_OK);
        ASSERT_EQ(slFindCasters(shadows, now, &view, &set, &sun, nullptr, &casters), SL_OK);
    };
    auto arena = std::make_unique<HookedMemory>();
    {
        const CWorld world(made, arena->hooks());
        slSnapshot* const here = world.commit();
        askAll(here, true);
        askAll(there, false);
        slReleaseSnapshot(here);
    }
    EXPECT_EQ(arena->memory.bytes, 0u);
    arena.reset();
    slDestroyQuery(query);
    slDestroySight(sight);
    slDestroyShadows(shadows);
    slReleaseSnapshot(there);
}

/// Rooms, as a visibility file of which every row sees all: portals and doors decide.
struct RoomsFile {
    MadeRooms rooms{5, 4, 3, true};
    Array<char> bytes;

    RoomsFile() {
        Random random(5);
        for (int i = 0; i < 120; ++i) rooms.add(MadeRooms::boxAround(rooms.pointInside(random), 0.2));
        const uint32_t cells = rooms.columns * rooms.rows;
        BitMatrix visible(cells, cells);
        for (uint32_t a = 0; a < cells; ++a)
            for (uint32_t b = 0; b < cells; ++b) visible.set(a, b);
        rooms.space.row_of_cell.resize(rooms.space.graph.cells);
        for (uint32_t cell = 0; cell < rooms.space.graph.cells; ++cell) rooms.space.row_of_cell[cell] = cell;
        bytes = *visibilityFile({visible, {}, "rooms", 1, &rooms.space}, VisibilityForm::kInPlace);
    }
};

TEST(CVisibility, AttachesBakedCellsWithDoors) {
    RoomsFile baked;
    slVisibility* file = nullptr;
    ASSERT_EQ(slOpenVisibility(baked.bytes.data(), baked.bytes.size(), "rooms", nullptr, &file), SL_OK);
    {
        const CWorld world;
        std::vector<slObjectDef> defs(baked.rooms.boxes.size(), slDefaultObjectDef());
        for (size_t i = 0; i < defs.size(); ++i) {
            const Box3d& box = baked.rooms.boxes[i];
            defs[i].bounds = {{box.min.x, box.min.y, box.min.z}, {box.max.x, box.max.y, box.max.z}};
            defs[i].key = i;
        }
        ASSERT_EQ(slAddObjects(world.world, defs.data(), defs.size(), nullptr), SL_OK);
        ASSERT_EQ(slAttach(world.world, file), SL_OK);
        ASSERT_TRUE(baked.rooms.world.attach(baked.rooms.space));
        const slDoorId door = slFindDoor(world.world, "door 0");
        ASSERT_NE(door.index, 0u);
        Random random(6);
        uint64_t by_portals = 0;
        int with_scissors = 0, bent = 0;
        for (const double open : {1.0, 0.0}) {
            ASSERT_EQ(slSetDoor(world.world, door, open), SL_OK);
            baked.rooms.world.setPortal(baked.rooms.world.findPortal("door 0"), open);
            const CQuery c(world);
            const Snapshot now = baked.rooms.world.commit();
            Query query;
            for (int i = 0; i < 30; ++i) {
                const View view = viewFrom(baked.rooms.pointInside(random), randomUnit(random));
                const slVisibleSet set = c.ask(viewOf(view));
                std::vector<uint64_t> keys = keysOf(set), expected = keysOf(query.visible(now, view));
                std::sort(keys.begin(), keys.end());
                std::sort(expected.begin(), expected.end());
                EXPECT_EQ(keys, expected);
                with_scissors += set.scissors != nullptr;
                slQueryStats stats;
                slQueryGetStats(c.query, &stats);
                by_portals += stats.stages[SL_STAGE_PORTALS].culled;
            }
            slSight* sight = nullptr;
            ASSERT_EQ(slCreateSight(nullptr, &sight), SL_OK);
            const slBox region = {{1, 1, 1}, {2, 2, 2}};
            slRegionSet seen;
            ASSERT_EQ(slSightFrom(sight, c.now, &region, ~0u, &seen), SL_OK);
            EXPECT_TRUE(seen.known);
            slDestroySight(sight);
            slWays* ways = nullptr;
            ASSERT_EQ(slCreateWays(nullptr, &ways), SL_OK);
            ConnectivityQuery same;
            slWaySettings settings = slDefaultWaySettings();
            settings.narrowest = 0.5;
            for (int i = 0; i < 30; ++i) {
                const glm::dvec3 from = baked.rooms.pointInside(random), to = baked.rooms.pointInside(random);
                bool known = false;
                ASSERT_EQ(slBeginWays(ways, c.now, &from.x, i % 2 ? &settings : nullptr, &known), SL_OK);
                EXPECT_EQ(known, same.begin(now, from, {.narrowest = i % 2 ? 0.5 : 0}));
                slWay way;
                ASSERT_EQ(slWayTo(ways, &to.x, &way), SL_OK);
                const Way expected = same.to(to);
                EXPECT_EQ(way.known, expected.known);
                EXPECT_EQ(way.connected, expected.connected);
                EXPECT_EQ(way.distance, expected.distance);
                EXPECT_EQ(way.narrowest, expected.narrowest);
                ASSERT_EQ(way.point_count, expected.points.size());
                ASSERT_EQ(way.cell_count, expected.cells.size());
                EXPECT_TRUE(way.cell_count == 0 || way.cells[way.cell_count - 1] == expected.cells.back());
                if (way.point_count > 0) { EXPECT_EQ(way.points[3 * way.point_count - 1], to.z); }
                bent += way.point_count > 2;
            }
            slDestroyWays(ways);
        }
        EXPECT_GT(bent, 10);
        EXPECT_GT(by_portals, 100u);
        EXPECT_GT(with_scissors, 20);
        slDetach(world.world);
        const CQuery c(world);
        c.ask(viewOf(viewFrom({1, 1, 1}, {1, 0, 0})));
        slQueryStats stats;
        slQueryGetStats(c.query, &stats);
        EXPECT_EQ(stats.stages[SL_STAGE_PORTALS].culled, 0u);
    }
    slCloseVisibility(file);
}

TEST(CVisibility, RefusesBytesThatAreNoFile) {
    RoomsFile baked;
    Heard heard;
    const slHooks hooks = heard.hooks();
    slVisibility* file = nullptr;
    EXPECT_EQ(slOpenVisibility("no file", 7, "mine.vis", &hooks, &file), SL_BAD_FILE);
    EXPECT_TRUE(heard.said("mine.vis")) << heard.sentences.back();
    baked.bytes[baked.bytes.size() / 2] = static_cast<char>(baked.bytes[baked.bytes.size() / 2] ^ 1);
    EXPECT_EQ(slOpenVisibility(baked.bytes.data(), baked.bytes.size(), nullptr, &hooks, &file), SL_BAD_FILE);
    EXPECT_TRUE(heard.said("the visibility file")) << heard.sentences.back();
    EXPECT_EQ(file, nullptr);
    BitMatrix none(1, 1);
    none.set(0, 0);
    const Array<char> rows = *visibilityFile({none, {}, "rows"}, VisibilityForm::kInPlace);
    ASSERT_EQ(slOpenVisibility(rows.data(), rows.size(), "rows", &hooks, &file), SL_OK);
    const CWorld world(heard.hooks());
    EXPECT_EQ(slAttach(world.world, file), SL_BAD_FILE);
    slCloseVisibility(file);
}

}  // namespace
}  // namespace sightline::test
