// Worlds in cells with all else that a query does: occlusion, threads, two eyes, scissors and explanations.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <limits>

#include "sightline/base/thread_pool.h"
#include "sightline/prepare/occluder/occluder.h"
#include "tests/support/explain_laws.h"
#include "tests/support/furnished_rooms.h"
#include "tests/support/memory.h"
#include "tests/support/meshes.h"

namespace sightline::test {
namespace {

/// Everything of an answer that may not hang on who makes it.
struct Told {
    std::vector<uint64_t> keys, counts;
    std::vector<uint8_t> reasons;

    Told(Query& query, const Snapshot& now, const View& view, const QuerySettings& settings) {
        const VisibleSet set = query.visible(now, view, settings);
        for (const Visible& v : set.objects) keys.push_back(v.key);
        for (const StageStats& stage : set.stats.stages)
            counts.insert(counts.end(), {stage.tested, stage.culled, stage.doubt});
        counts.push_back(set.stats.nodes_visited);
        reasons = reasonsOf(query, now);
    }
    bool operator==(const Told&) const = default;
};

bool isBlocked(const glm::dvec3& a, const glm::dvec3& b, const Box3d& box) {
    double enter = 0, leave = 1;
    for (int axis = 0; axis < 3; ++axis) {
        const double d = b[axis] - a[axis];
        if (d == 0) {
            if (a[axis] < box.min[axis] || a[axis] > box.max[axis]) return false;
            continue;
        }
        const double t0 = (box.min[axis] - a[axis]) / d, t1 = (box.max[axis] - a[axis]) / d;
        enter = std::max(enter, std::min(t0, t1));
        leave = std::min(leave, std::max(t0, t1));
    }
    return enter < leave;
}

/// With all other stages, occluders, bins, threads and two eyes.
TEST(CellStages, GoTogetherWithAllOthers) {
    uint64_t seen = 0, occluded = 0, by_portals = 0;
    for (uint64_t seed = 1; seed <= 4; ++seed) {
        RoomsWithRows made(seed);
        MadeRooms& rooms = made.rooms;
        Random random(seed);
        WorldDef def{.volumes = true};
        rooms.world = World::create(def);
        furnish(rooms, random, 250, rooms.world.addOccluder(prepareOccluder(boxMesh().view())));
        ASSERT_TRUE(rooms.world.attach(rooms.space, &made.rows));
        const Snapshot now = rooms.world.commit();
        ThreadPool pool(3);
        Query query, threaded(defaultMemory(), &pool);
        for (int frame = 0; frame < 24; ++frame) {
            const glm::dvec3 eye = randomEye(rooms, random), target = rooms.pointInside(random);
            View view = viewAt(eye, target, kRoomCamera);
            QuerySettings settings{.stages = frame % 2 ? kAllStages : kDefaultStages, .bins = frame % 3 == 0 ? 1u : 4u};
            settings.windows = static_cast<PortalWindows>(frame % 3);
            const Told told(query, now, view, settings), other(threaded, now, view, settings);
            EXPECT_EQ(told, other) << "seed " << seed << " frame " << frame;
            by_portals += static_cast<uint64_t>(std::count(told.reasons.begin(), told.reasons.end(), kByPortals));
            occluded += static_cast<uint64_t>(
                std::count(told.reasons.begin(), told.reasons.end(), 1 + static_cast<int>(Stage::kOcclusion)));
            const std::set<uint64_t> kept(told.keys.begin(), told.keys.end());
            for (size_t i = 0; i < rooms.boxes.size(); ++i) {
                EXPECT_EQ(kept.count(i) > 0, told.reasons[i] == 0);
                for (int sample = 0; sample < 6; ++sample) {
                    const glm::dvec3 p = randomIn(random, rooms.boxes[i]);
                    if (!rooms.isInside(p) || !isInImage(view, p) || !rooms.sees(eye, p)) continue;
                    bool blocked = false;
                    for (size_t k = 0; k < rooms.boxes.size() && !blocked; ++k)
                        blocked = k != i && isBlocked(eye, p, rooms.boxes[k]);
                    if (blocked) continue;
                    ++seen;
                    EXPECT_TRUE(kept.count(i)) << "seed " << seed << " frame " << frame << " object " << i;
                    break;
                }
            }
            const View right = shiftedEye(view, 0.06);
            settings.proofs = false;  // answers would depend on those before
            const std::set<uint64_t> left_keys = keySetOf(Query().visible(now, view, settings)),
                                     right_keys = keySetOf(Query().visible(now, right, settings));
            const StereoSet pair = threaded.visibleStereo(now, view, right, settings);
            std::set<uint64_t> left_eye, right_eye;
            for (size_t i = 0; i < pair.objects.size(); ++i) {
                if (pair.eyes[i] & kLeftEye) left_eye.insert(pair.objects[i].key);
                if (pair.eyes[i] & kRightEye) right_eye.insert(pair.objects[i].key);
            }
            EXPECT_EQ(left_eye, left_keys);
            EXPECT_EQ(right_eye, right_keys);
        }
    }
    EXPECT_GT(seen, 200u);
    EXPECT_GT(occluded, 20u);
    EXPECT_GT(by_portals, 2000u);
}

TEST(CellStages, GiveScissorsThatHoldAllThatIsSeen) {
    uint64_t seen = 0, narrow = 0;
    for (uint64_t seed = 1; seed <= 4; ++seed) {
        Random random(seed);
        MadeRooms rooms(seed, 5, 4);
        furnish(rooms, random, 200);
        rooms.add({{5, 1, 5}, {5, 1, std::numeric_limits<double>::infinity()}});
        ASSERT_TRUE(rooms.world.attach(rooms.space));
        const Snapshot now = rooms.world.commit();
        Query query;
        for (int frame = 0; frame < 40; ++frame) {
            const glm::dvec3 eye = randomEye(rooms, random);
            View view = viewAt(eye, rooms.pointInside(random), kRoomCamera);
            QuerySettings settings;
            view.jitter = frame % 4 == 0 ? 3.0 : 0.5;
            settings.windows = static_cast<PortalWindows>(frame % 3);
            settings.bins = frame % 5 == 0 ? 3 : 1;
            const VisibleSet set = query.visible(now, view, settings);
            ASSERT_EQ(set.scissors.size(), set.objects.size());
            EXPECT_FALSE(query.windows().empty());
            EXPECT_TRUE(query.cellStats().known);
            EXPECT_GE(query.cellStats().cells, 1u);
            for (const SeenWindow& window : query.windows()) {
                ASSERT_LT(window.cell, rooms.space.graph.cells);
                if (window.from == SeenWindow::kNone) continue;
                ASSERT_LT(window.from, query.windows().size());
                const CellPortal& portal = rooms.space.graph.portals[window.portal];
                const uint32_t from = query.windows()[window.from].cell;
                EXPECT_TRUE((portal.cells[0] == from && portal.cells[1] == window.cell) ||
                            (portal.cells[1] == from && portal.cells[0] == window.cell));
            }
            for (size_t i = 0; i < set.objects.size(); ++i) {
                const ImageRect& scissor = set.scissors[i];
                narrow += scissor.right - scissor.left < 200;
                EXPECT_TRUE(scissor.left >= 0 && scissor.top >= 0 && scissor.right <= view.width &&
                            scissor.bottom <= view.height);
                const Box3d& box = rooms.boxes[set.objects[i].key];
                if (!box.finite()) {
                    EXPECT_EQ(scissor.right - scissor.left, view.width);
                    continue;
                }
                for (int sample = 0; sample < 20; ++sample) {
                    const glm::dvec3 p = randomIn(random, box);
                    if (!rooms.isInside(p) || !isInImage(view, p) || !rooms.sees(eye, p)) continue;
                    const glm::dvec4 clip = view.projection * view.view * glm::dvec4(p, 1.0);
                    // The frame's own shift, and the pixels that are there.
                    const double x = std::clamp(0.5 * view.width * (1 + clip.x / clip.w) +
                                                    random.uniform(-view.jitter, view.jitter),
                                                0.0, 320.0),
                                 y = std::clamp(0.5 * view.height * (1 - clip.y / clip.w) +
                                                    random.uniform(-view.jitter, view.jitter),
                                                0.0, 180.0);
                    ++seen;
                    EXPECT_TRUE(x >= scissor.left && x <= scissor.right && y >= scissor.top && y <= scissor.bottom)
                        << "seed " << seed << " frame " << frame << " object " << set.objects[i].key;
                }
            }
        }
    }
    EXPECT_GT(seen, 2000u);
    EXPECT_GT(narrow, 100u);
}

/// What explanations say is tried in worlds that are made accordingly.
TEST(CellStages, AreExplained) {
    uint64_t by_cells = 0, occluded = 0, tried = 0, ways = 0;
    for (uint64_t seed = 1; seed <= 3; ++seed) {
        RoomsWithRows made(seed);
        MadeRooms& rooms = made.rooms;
        Random random(seed);
        furnish(rooms, random, 240, rooms.world.addOccluder(prepareOccluder(boxMesh().view())));
        ASSERT_TRUE(rooms.world.attach(rooms.space, &made.rows));
        const Snapshot now = rooms.world.commit();
        Query query;
        for (int frame = 0; frame < 24; ++frame) {
            View view = viewAt(randomEye(rooms, random), rooms.pointInside(random), kRoomCamera);
            QuerySettings settings{.bins = frame % 4 == 3 ? 2u : 1u, .proofs = false};
            query.visible(now, view, settings);
            const std::vector<uint8_t> reasons = reasonsOf(query, now);
            Explainer explainer(now, view, settings);
            for (uint32_t i = 0; i < reasons.size(); ++i) {
                const Explanation why = explainer.explain(rooms.ids[i]);
                const std::string place =
                    "seed " + std::to_string(seed) + " frame " + std::to_string(frame) + " object " + std::to_string(i);
                EXPECT_EQ(why.verdict == Verdict::kVisible, reasons[i] == 0) << place;
                if (settings.bins == 1) {
                    EXPECT_EQ(why.verdict == Verdict::kNotInPvs, reasons[i] == kByPvs) << place;
                    EXPECT_EQ(why.verdict == Verdict::kNoWindow, reasons[i] == kByPortals) << place;
                }
                EXPECT_FALSE(why.cells.eye.empty());
                const std::set<uint32_t> in = made.roomsOf(rooms.boxes[i]);
                EXPECT_EQ(std::set<uint32_t>(why.cells.object.begin(), why.cells.object.end()), in) << place;
                by_cells += why.verdict == Verdict::kNotInPvs || why.verdict == Verdict::kNoWindow;
                if (why.cells.reached > 0) {
                    ++ways;
                    ASSERT_EQ(why.cells.portals.size() + 1, why.cells.way.size());
                    EXPECT_TRUE(in.count(why.cells.way.back()));
                    EXPECT_NE(std::find(why.cells.eye.begin(), why.cells.eye.end(), why.cells.way.front()),
                              why.cells.eye.end());
                } else {
                    EXPECT_NE(why.verdict, Verdict::kVisible) << place;
                }
                if (why.verdict != Verdict::kOccluded) continue;
                ++occluded;
                const auto reasonIn = [&](const std::vector<uint32_t>& items) {
                    Copy copy(now, items);
                    EXPECT_TRUE(copy.world.attach(rooms.space, &made.rows));
                    const auto at = std::find(items.begin(), items.end(), i) - items.begin();
                    return reasonOf(copy.world.commit(), view, settings, static_cast<uint32_t>(at));
                };
                std::vector<uint32_t> alone{i}, without;
                for (const Hider& hider : why.occlusion.hiders) alone.push_back(static_cast<uint32_t>(hider.key));
                std::sort(alone.begin(), alone.end());
                if (why.occlusion.sufficient) { EXPECT_NE(reasonIn(alone), 0) << place; }
                for (uint32_t k = 0; k < reasons.size(); ++k)
                    if (k == i || !std::binary_search(alone.begin(), alone.end(), k)) without.push_back(k);
                if (settings.bins > 1) continue;
                EXPECT_EQ(reasonIn(without) == 0, why.occlusion.without == Without::kVisible) << place;
                ++tried;
            }
        }
    }
    EXPECT_GT(by_cells, 1000u);
    EXPECT_GT(ways, 300u);
    EXPECT_GT(occluded, 5u);
    EXPECT_GT(tried, 5u);
}

TEST(CellStages, AllocateNothingOnceWarm) {
    RoomsWithRows made(6);
    Random random(6);
    const Snapshot now = made.furnished(random, 200);
    CountingMemory memory;
    Query query(&memory);
    std::vector<View> views;
    for (int frame = 0; frame < 30; ++frame)
        views.push_back(viewAt(randomEye(made.rooms, random), made.rooms.pointInside(random), kRoomCamera));
    const auto ask = [&] {
        for (size_t frame = 0; frame < views.size(); ++frame) {
            query.visible(now, views[frame], {.windows = static_cast<PortalWindows>(frame % 3)});
        }
    };
    for (int pass = 0; pass < 4; ++pass) ask();  // each finds a few certificates more, by what is remembered
    const uint64_t warm = memory.allocations;
    ask();
    EXPECT_EQ(memory.allocations, warm);
}

}  // namespace
}  // namespace sightline::test
