// The laws of worlds: ids are never mistaken for one another, and all memory comes through the hook.
// SPDX-License-Identifier: MIT
#include "sightline/world/world.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <limits>
#include <map>
#include <new>
#include <vector>

#include "sightline/base/random.h"
#include "sightline/prepare/occluder/occluder.h"
#include "sightline/query/explain/credits.h"
#include "sightline/query/explain/explain.h"
#include "sightline/query/query.h"
#include "tests/support/answers.h"
#include "tests/support/meshes.h"
#include "tests/support/views.h"

namespace {
std::atomic<uint64_t> global_allocations{0};

/// From the C library; null if there is none.
void* allocateAligned(size_t size, size_t alignment) {
#ifdef _WIN32
    return _aligned_malloc(size, alignment);
#else
    void* place = nullptr;
    return posix_memalign(&place, std::max(alignment, sizeof(void*)), size) == 0 ? place : nullptr;
#endif
}

void freeAligned(void* place) {
#ifdef _WIN32
    _aligned_free(place);
#else
    std::free(place);
#endif
}

void* allocateGlobally(size_t size, size_t alignment) {
    ++global_allocations;
    void* const place = allocateAligned(size, alignment);
    if (!place) throw std::bad_alloc();
    return place;
}
}  // namespace

// Replaced for the whole test binary, to count what does not go through the hook.
void* operator new(size_t size) { return allocateGlobally(size, alignof(std::max_align_t)); }
void* operator new(size_t size, std::align_val_t align) { return allocateGlobally(size, static_cast<size_t>(align)); }
void* operator new(size_t size, const std::nothrow_t&) noexcept {
    ++global_allocations;
    return allocateAligned(size, alignof(std::max_align_t));
}
// Hardly optimised, GCC does not see that all of these take from malloc.
#ifdef __GNUC__
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"
#endif
void operator delete(void* place) noexcept { freeAligned(place); }
void operator delete(void* place, const std::nothrow_t&) noexcept { freeAligned(place); }
void operator delete(void* place, size_t) noexcept { freeAligned(place); }
void operator delete(void* place, std::align_val_t) noexcept { freeAligned(place); }
void operator delete(void* place, size_t, std::align_val_t) noexcept { freeAligned(place); }

namespace sightline::test {
namespace {

/// Counts what is in use; takes from the C library.
class CountingMemory final : public Memory {
public:
    uint64_t allocations = 0, bytes = 0;

    void* allocate(size_t size, size_t alignment) override {
        ++allocations;
        bytes += size;
        return allocateAligned(size, alignment);
    }
    void deallocate(void* place, size_t size, size_t) override {
        bytes -= size;
        freeAligned(place);
    }
};

ObjectDef boxAt(const glm::dvec3& p, double size, OccluderId occluder = {}) {
    ObjectDef def;
    def.bounds = {glm::dvec3(0.0), glm::dvec3(1.0)};
    for (int axis = 0; axis < 3; ++axis) def.transform[axis][axis] = size;
    def.transform[3] = glm::dvec4(p, 1.0);
    def.occluder = occluder;
    return def;
}

TEST(World, StaleIdsDoNothingEvenAfterTheirIndexIsUsedAgain) {
    World world;
    std::vector<ObjectId> old;
    for (int i = 0; i < 5000; ++i) old.push_back(world.add(boxAt({i, 0, 0}, 1)));
    world.commit();
    for (int i = 1; i < 5000; ++i) EXPECT_TRUE(world.remove(old[static_cast<size_t>(i)]));
    world.commit();  // closes the gaps: places are fewer now than the stale ids remember
    EXPECT_EQ(world.objectCount(), 1u);
    for (int i = 1; i < 5000; ++i) {
        EXPECT_FALSE(world.remove(old[static_cast<size_t>(i)]));
        EXPECT_FALSE(world.move(old[static_cast<size_t>(i)], glm::dmat4(1.0)));
    }
    std::vector<ObjectId> fresh;
    for (int i = 0; i < 100; ++i) fresh.push_back(world.add(boxAt({i, 0, 0}, 1)));
    for (const ObjectId& id : fresh) {
        EXPECT_LE(id.index, 5000u) << "indices of removed objects are used again";
        for (const ObjectId& other : old) EXPECT_FALSE(other == id);
    }
    for (int i = 1; i < 5000; ++i) EXPECT_FALSE(world.remove(old[static_cast<size_t>(i)]));
    EXPECT_TRUE(world.remove(old[0]));
    EXPECT_FALSE(world.remove(ObjectId{}));
    EXPECT_FALSE(world.remove(ObjectId{999999, 1}));
    EXPECT_EQ(world.objectCount(), 100u);
}

/// A world that changes, and a list of what is in it.
struct Lived {
    World world;
    std::map<uint64_t, std::pair<ObjectId, ObjectDef>> there;  ///< by key
    uint64_t next = 1;

    void add(Random& random) {
        ObjectDef def =
            boxAt({random.uniform(-50, 50), random.uniform(-5, 5), random.uniform(-50, 50)}, random.uniform(0.5, 3));
        def.key = next++;
        def.layers = random.below(5) ? 1 : 2;
        if (random.below(200) == 0) def.bounds.max.x = std::numeric_limits<double>::quiet_NaN();
        if (random.below(300) == 0) def.limits.always = true;
        if (random.below(300) == 0) def.limits.max_distance = random.uniform(5, 90);
        there[def.key] = {world.add(def), def};
    }
    std::pair<ObjectId, ObjectDef>& any(Random& random) {
        const auto at = there.lower_bound(random.below(next));
        return at == there.end() ? there.begin()->second : at->second;
    }
    void change(Random& random) {
        const uint64_t kind = random.below(10);
        if (there.empty() || kind == 0) return add(random);
        auto& [id, def] = any(random);
        if (kind == 1) {
            ASSERT_TRUE(world.remove(id));
            there.erase(def.key);
            return;
        }
        const double way = kind == 2 ? 60 : 0.5;
        def.transform[3] += glm::dvec4(random.uniform(-way, way), 0, random.uniform(-way, way), 0);
        if (random.below(100) == 0) def.transform[3].y = std::numeric_limits<double>::infinity();
        if (!(std::abs(def.transform[3].y) < 10)) def.transform[3].y = random.below(2) ? 1.0 : def.transform[3].y;
        ASSERT_TRUE(world.move(id, def.transform));
    }
};

std::vector<uint8_t> reasonsIn(Query& query, const Snapshot& now, const View& view,
                               const QuerySettings& settings = {}) {
    query.visible(now, view, settings);
    const std::vector<uint8_t> reasons = reasonsOf(query, now);
    return reasons;
}

TEST(World, ThatHasLivedAnswersAsOneThatIsMadeAnew) {
    for (uint64_t seed = 1; seed <= 8; ++seed) {
        Random random(seed);
        Lived lived;
        const int begin = seed % 3 == 0 ? 0 : 600;
        for (int i = 0; i < begin; ++i) lived.add(random);
        Query query;
        for (int step = 0; step < 60; ++step) {
            const uint64_t changes = random.below(step % 10 == 9 ? 400 : 30);
            for (uint64_t i = 0; i < changes; ++i) lived.change(random);
            const Snapshot now = lived.world.commit();
            ASSERT_EQ(now.objectCount(), lived.there.size());
            World anew;
            for (const auto& [key, object] : lived.there) anew.add(object.second);
            const Snapshot fresh = anew.commit();
            View view = viewAt({random.uniform(-50, 50), 1, random.uniform(-50, 50)}, {0, 1, 0});
            QuerySettings settings;
            view.layers = 1 + static_cast<uint32_t>(random.below(3));
            settings.stages = stageBit(Stage::kFrustum) | kLossyStages;
            settings.max_distance = step % 3 ? 40 : 0;
            settings.contribution = step % 4 ? 1.5 : 0;
            settings.hysteresis = 0;
            const auto reasons = reasonsIn(query, now, view, settings);
            // Which of the stages names an object hangs on the nodes; whether it is kept does not.
            const auto others = reasonsIn(query, fresh, view, settings);
            size_t item = 0;
            for (const auto& [key, object] : lived.there) {
                EXPECT_EQ(reasons[item] == 0, others[item] == 0)
                    << "seed " << seed << " step " << step << " key " << key;
                EXPECT_EQ(reasons[item] == 255, others[item] == 255);
                ++item;
            }
            EXPECT_EQ(lived.world.commit().objectCount(), now.objectCount());
        }
    }
}

TEST(World, WhoseMoversCreepRestAndJumpAnswersAsOneThatIsMadeAnew) {
    for (uint64_t seed = 1; seed <= 6; ++seed) {
        Random random(seed);
        Lived lived;
        for (int i = 0; i < 1500; ++i) lived.add(random);
        const uint64_t movers = seed % 3 ? 200 : 20;
        Query query;
        for (int step = 0; step < 40; ++step) {
            const bool jump = step % 8 >= 6;
            for (uint64_t key = 1; key <= movers && step % 10 < 8; ++key) {
                auto& [id, def] = lived.there[key];
                const double way = jump && random.below(3) ? 50 : 0.3;
                def.transform[3] += glm::dvec4(random.uniform(-way, way), 0, 0, 0);
                if (std::abs(def.transform[3].x) > 60) def.transform[3].x = random.uniform(-50, 50);
                ASSERT_TRUE(lived.world.move(id, def.transform));
                if (key % 7 == 0) { ASSERT_TRUE(lived.world.move(id, def.transform)); }
            }
            if (step % 5 == 0) lived.add(random);
            const Snapshot now = lived.world.commit();
            World anew;
            for (const auto& [key, object] : lived.there) anew.add(object.second);
            const View view = viewAt({random.uniform(-50, 50), 1, random.uniform(-50, 50)}, {0, 1, 0});
            const QuerySettings settings{.stages = stageBit(Stage::kFrustum)};
            const auto reasons = reasonsIn(query, now, view, settings);
            EXPECT_EQ(reasons, reasonsIn(query, anew.commit(), view, settings)) << "seed " << seed << " step " << step;
        }
    }
}

TEST(World, WhatMovesAgainAndAgainCopiesLittle) {
    CountingMemory memory;
    WorldDef def{.memory = &memory};
    World world = World::create(def);
    Random random(13);
    std::vector<ObjectId> ids;
    for (int i = 0; i < 40000; ++i) {
        const double x = random.uniform(-500, 500), z = random.uniform(-500, 500);
        ids.push_back(world.add(boxAt({x, 0, z}, 1)));
    }
    Snapshot held = world.commit();
    std::vector<uint64_t> grown;
    for (int frame = 0; frame < 12; ++frame) {
        const uint64_t before = memory.bytes;
        for (size_t i = 0; i < ids.size(); i += 100) {
            glm::dmat4 transform(1.0);
            transform[3].y = 0.01 * (frame + 1);
            world.move(ids[i], transform);
        }
        const Snapshot next = world.commit();
        grown.push_back(memory.bytes - before);
        held = next;
    }
    EXPECT_LT(grown.back(), grown.front() / 2) << "nodes of movers are few";
}

TEST(World, ACommitCopiesNoMoreThanWhatChanged) {
    CountingMemory memory;
    WorldDef def{.memory = &memory};
    World world = World::create(def);
    Random random(12);
    std::vector<ObjectId> ids;
    for (int i = 0; i < 40000; ++i)
        ids.push_back(world.add(boxAt({random.uniform(-500, 500), 0, random.uniform(-500, 500)}, 1)));
    Snapshot held = world.commit();
    const uint64_t whole = memory.bytes;
    for (int frame = 0; frame < 40; ++frame) {
        const uint64_t before = memory.bytes;
        for (int i = 0; i < 3; ++i) {
            const size_t which = random.below(ids.size());
            if (frame % 2) {
                world.remove(ids[which]);
                ids[which] = world.add(boxAt({random.uniform(-500, 500), 0, random.uniform(-500, 500)}, 1));
            } else {
                world.move(ids[which], boxAt({random.uniform(-500, 500), 0, random.uniform(-500, 500)}, 1).transform);
            }
        }
        const Snapshot next = world.commit();
        EXPECT_LT(memory.bytes - before, whole / 20) << "beside a snapshot that is held";
        held = next;
    }
}

TEST(World, AllMemoryComesThroughTheHookAndGoesBack) {
    CountingMemory memory;
    {
        const Occluder shape = prepareOccluder(boxMesh().view());
        Random random(7);
        const uint64_t before = global_allocations;
        WorldDef def{.objects = 2000, .memory = &memory};
        World world = World::create(def);
        const OccluderId occluder = world.addOccluder(shape);
        ObjectId last;
        for (int i = 0; i < 2000; ++i)
            last = world.add(
                boxAt({random.uniform(-50, 50), 0, random.uniform(-50, 50)}, random.uniform(0.5, 3), occluder));
        Query query(&memory);
        Snapshot now = world.commit();
        query.visible(now, viewAt({0, 1, 0}, {10, 1, 3}));
        world.move(last, glm::dmat4(1.0));
        now = world.commit();
        query.visible(now, viewAt({0, 1, 0}, {10, 1, 3}));
        world.remove(last);
        now = world.commit();
        query.visible(now, viewAt({0, 1, 0}, {10, 1, 3}));
        query.changes();
        query.depthImage();
        const View view = viewAt({0, 1, 0}, {10, 1, 3});
        EXPECT_FALSE(CreditBook(now, {}, &memory).credits(view).empty());
        Explainer explainer(now, view, {}, &memory);
        uint32_t hidden = 0;
        for (uint32_t index = last.index; index > last.index - 100; --index)
            hidden += explainer.explain({index, 1}).occlusion.hiders.empty() ? 0 : 1;
        EXPECT_GT(hidden, 0u);
        EXPECT_EQ(global_allocations, before);
        EXPECT_GT(memory.bytes, 0u);
    }
    EXPECT_EQ(memory.bytes, 0u);
}

TEST(Query, AllocatesNothingOnceItHasSeenItsViews) {
    CountingMemory memory;
    World world;
    const OccluderId occluder = world.addOccluder(prepareOccluder(boxMesh().view()));
    Random random(8);
    for (int i = 0; i < 3000; ++i)
        world.add(boxAt({random.uniform(-50, 50), 0, random.uniform(-50, 50)}, random.uniform(0.5, 3), occluder));
    const Snapshot now = world.commit();
    Query query(&memory);
    for (int round = 0; round < 40; ++round) {
        const uint64_t before = memory.allocations;
        for (int frame = 0; frame < 12; ++frame) {
            query.visible(now, viewAt({0, 1, 0}, {std::cos(frame), 1, std::sin(frame)}));
            query.changes();
        }
        if (round >= 30) { EXPECT_EQ(memory.allocations, before) << round; }
    }
}

TEST(Query, SaysWhatAppearedAndWhatDisappeared) {
    World world;
    std::vector<ObjectId> ids;
    Random random(9);
    for (int i = 0; i < 400; ++i) {
        ObjectDef def = boxAt({random.uniform(-50, 50), 0, random.uniform(-50, 50)}, random.uniform(0.5, 3));
        def.key = static_cast<uint64_t>(i);
        ids.push_back(world.add(def));
    }
    Query query;
    std::vector<Visible> before;
    uint64_t seen_changes = 0;
    for (int frame = 0; frame < 60; ++frame) {
        if (frame % 7 == 3) {  // a removed object's index goes to a new one
            const size_t victim = static_cast<size_t>(frame);
            world.remove(ids[victim]);
            ids[victim] = world.add(boxAt({random.uniform(-50, 50), 0, random.uniform(-50, 50)}, 2));
        }
        const double angle = 0.13 * frame;
        const VisibleSet set = query.visible(world.commit(), viewAt({0, 1, 0}, {std::cos(angle), 1, std::sin(angle)}));
        const std::vector<Visible> after(set.objects.begin(), set.objects.end());
        const auto in = [](const std::vector<Visible>& list, ObjectId id) {
            return std::any_of(list.begin(), list.end(), [&](const Visible& v) { return v.id == id; });
        };
        const VisibleChanges changes = query.changes();
        size_t appeared = 0, disappeared = 0;
        for (const Visible& v : after) appeared += !in(before, v.id);
        for (const Visible& v : before) disappeared += !in(after, v.id);
        EXPECT_EQ(changes.appeared.size(), appeared);
        EXPECT_EQ(changes.disappeared.size(), disappeared);
        for (const Visible& v : changes.appeared) EXPECT_TRUE(in(after, v.id) && !in(before, v.id));
        for (const Visible& v : changes.disappeared) EXPECT_TRUE(in(before, v.id) && !in(after, v.id));
        seen_changes += appeared + disappeared;
        before = after;
    }
    EXPECT_GT(seen_changes, 100u);
}

}  // namespace
}  // namespace sightline::test
