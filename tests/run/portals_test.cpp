// Worlds in cells: what is seen through holes is kept, what is culled cannot be seen, and it does not matter how the world
// came about, who walks it, or what else is on.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <limits>
#include <memory_resource>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "sightline/base/thread_pool.h"
#include "sightline/prepare/occluder.h"
#include "sightline/run/world_state.h"
#include "sightline/visfile/visibility_file.h"
#include "tests/run/explain_laws.h"
#include "tests/run/made_rooms.h"

namespace sightline::test {
namespace {

constexpr uint32_t kCells = kCellStages, kFrustum = stageBit(Stage::kFrustum);
constexpr uint8_t kByPvs = 1 + static_cast<uint8_t>(Stage::kPvs),
                  kByPortals = 1 + static_cast<uint8_t>(Stage::kPortals);

uint64_t culledBy(const QueryStats& stats, Stage stage) { return stats.stages[static_cast<int>(stage)].culled; }

std::set<uint64_t> keysOf(const VisibleSet& set) {
    std::set<uint64_t> keys;
    for (const Visible& v : set.objects) keys.insert(v.key);
    EXPECT_EQ(keys.size(), set.objects.size());
    return keys;
}

std::vector<uint8_t> reasonsOf(const Query& query, const Snapshot& now) {
    std::vector<uint8_t> reasons(now.objectCount());
    query.reasons(reasons);
    return reasons;
}

/// Random eyes in the rooms, some of them in holes and right at walls.
glm::dvec3 randomEye(const MadeRooms& rooms, Random& random) {
    glm::dvec3 eye = rooms.pointInside(random);
    if (!rooms.holes.empty() && random.below(3) == 0) {
        const MadeRooms::Hole& hole = rooms.holes[random.below(static_cast<uint32_t>(rooms.holes.size()))];
        eye[hole.axis] = hole.at + (random.below(2) ? 0.0 : random.uniform(-0.02, 0.02));
        eye[2 - hole.axis] = random.uniform(hole.low, hole.high);
        eye.y = random.uniform(hole.bottom + 0.05, hole.top - 0.05);
    }
    return eye;
}

void furnish(MadeRooms& rooms, Random& random, int count, OccluderId occluder = {}) {
    for (int i = 0; i < count; ++i)
        rooms.add(MadeRooms::boxAround(rooms.pointInside(random), random.uniform(0.05, i % 10 ? 0.6 : 3.0)), 1,
                  occluder);
}

glm::dvec3 pointIn(const Box3d& box, Random& random) {
    return {random.uniform(box.min.x, box.max.x), random.uniform(box.min.y, box.max.y),
            random.uniform(box.min.z, box.max.z)};
}

bool isInImage(const View& view, const glm::dvec3& p) {
    const glm::dvec4 clip = view.projection * view.view * glm::dvec4(p, 1.0);
    return std::abs(clip.x) <= clip.w && std::abs(clip.y) <= clip.w && clip.z >= -clip.w;
}

TEST(CellStages, KeepWhatASightLineReaches) {
    uint64_t seen = 0, by_portals = 0;
    for (uint64_t seed = 1; seed <= 6; ++seed) {
        Random random(seed);
        MadeRooms rooms(seed, 5, 4);
        furnish(rooms, random, 300);
        ASSERT_TRUE(rooms.world.attach(rooms.space));
        const Snapshot now = rooms.world.commit();
        Query query;
        for (int frame = 0; frame < 40; ++frame) {
            const glm::dvec3 eye = randomEye(rooms, random);
            View view = viewFrom(eye, rooms.pointInside(random));
            view.stages = frame % 4 == 0 ? stageBit(Stage::kPortals) : kCells | kFrustum;
            view.windows = static_cast<PortalWindows>(frame % 3);
            const VisibleSet set = query.visible(now, view);
            by_portals += culledBy(set.stats, Stage::kPortals);
            EXPECT_EQ(set.stats.stages[static_cast<int>(Stage::kPortals)].doubt, 0u) << "seed " << seed << " " << frame;
            const std::set<uint64_t> kept = keysOf(set);
            for (size_t i = 0; i < rooms.boxes.size(); ++i)
                for (int sample = 0; sample < 12; ++sample) {
                    const glm::dvec3 p = pointIn(rooms.boxes[i], random);
                    if (!rooms.isInside(p) || !isInImage(view, p) || !rooms.sees(eye, p)) continue;
                    ++seen;
                    EXPECT_TRUE(kept.count(i)) << "seed " << seed << " frame " << frame << " object " << i;
                    break;
                }
        }
    }
    EXPECT_GT(seen, 500u);
    EXPECT_GT(by_portals, 10000u);
}

/// Which rooms hang together by open holes.
std::vector<uint32_t> partsOf(const MadeRooms& rooms) {
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
        const uint32_t cells = rooms.space.graph.cells;
        BitMatrix visible(cells, cells);
        for (uint32_t a = 0; a < cells; ++a)
            for (uint32_t b = 0; b < cells; ++b)
                if (parts[a] == parts[b]) visible.set(a, b);
        bytes = *tiledRows(visible);
        rows = *VisibleRows::open(bytes, "rows");
        rooms.space.row_of_cell.resize(cells);
        for (uint32_t i = 0; i < cells; ++i) rooms.space.row_of_cell[i] = i;
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

TEST(CellStages, OfThePvsCullWhatNoRowShows) {
    RoomsWithRows made(3);
    Random random(3);
    furnish(made.rooms, random, 400);
    ASSERT_TRUE(made.rooms.world.attach(made.rooms.space, &made.rows));
    const Snapshot now = made.rooms.world.commit();
    Query query;
    uint64_t culled = 0;
    for (int frame = 0; frame < 60; ++frame) {
        const glm::dvec3 eye = randomEye(made.rooms, random);
        View view = viewFrom(eye, made.rooms.pointInside(random));
        view.stages = stageBit(Stage::kPvs) | (frame % 2 ? kCells | kFrustum : 0);
        const VisibleSet set = query.visible(now, view);
        const std::vector<uint8_t> reasons = reasonsOf(query, now);
        std::set<uint32_t> start;
        for (uint32_t room : made.roomsOf(MadeRooms::boxAround(eye, 1e-9))) start.insert(made.parts[room]);
        for (size_t i = 0; i < reasons.size(); ++i) {
            bool shown = false;
            for (const uint32_t room : made.roomsOf(made.rooms.boxes[i])) shown |= start.count(made.parts[room]) > 0;
            EXPECT_EQ(reasons[i] == kByPvs, !shown) << "frame " << frame << " object " << i;
        }
        for (const Stage stage : {Stage::kPvs, Stage::kPortals})
            EXPECT_EQ(culledBy(set.stats, stage),
                      static_cast<uint64_t>(std::count(reasons.begin(), reasons.end(), 1 + static_cast<int>(stage))));
        EXPECT_EQ(set.stats.visible, static_cast<uint64_t>(std::count(reasons.begin(), reasons.end(), 0)));
        culled += culledBy(set.stats, Stage::kPvs);
    }
    EXPECT_GT(culled, 5000u);
}

TEST(CellStages, CullNothingThatOthersKeepAndMoreThanThey) {
    RoomsWithRows made(5);
    Random random(5);
    furnish(made.rooms, random, 300);
    ASSERT_TRUE(made.rooms.world.attach(made.rooms.space, &made.rows));
    const Snapshot now = made.rooms.world.commit();
    Query query;
    uint64_t fewer = 0;
    for (int frame = 0; frame < 40; ++frame) {
        View view = viewFrom(randomEye(made.rooms, random), made.rooms.pointInside(random));
        const auto ask = [&](uint32_t stages) {
            view.stages = stages;
            return keysOf(query.visible(now, view));
        };
        const auto all = ask(0), frustum = ask(kFrustum), pvs = ask(stageBit(Stage::kPvs)),
                   portals = ask(stageBit(Stage::kPortals)), both = ask(kCells), together = ask(kCells | kFrustum);
        EXPECT_EQ(all.size(), made.rooms.boxes.size());
        EXPECT_EQ(both, portals) << "rows show more than windows do, and no less";
        EXPECT_TRUE(std::includes(pvs.begin(), pvs.end(), portals.begin(), portals.end()));
        std::set<uint64_t> meet;
        std::set_intersection(both.begin(), both.end(), frustum.begin(), frustum.end(),
                              std::inserter(meet, meet.end()));
        EXPECT_EQ(together, meet);
        fewer += frustum.size() - together.size();
    }
    EXPECT_GT(fewer, 500u);
}

/// Furniture that comes, goes and moves from room to room each frame.
TEST(CellStages, OfAWorldThatHasLivedAreThoseOfANewOne) {
    for (uint64_t seed = 1; seed <= 3; ++seed) {
        RoomsWithRows made(seed);
        Random random(seed);
        MadeRooms& rooms = made.rooms;
        furnish(rooms, random, 200);
        ASSERT_TRUE(rooms.world.attach(rooms.space, &made.rows));
        std::vector<uint8_t> gone(rooms.boxes.size(), 0);
        Query query;
        Snapshot before;
        std::vector<uint64_t> before_keys;
        View before_view;
        for (int frame = 0; frame < 60; ++frame) {
            const int changes = frame % 7 == 0 ? 150 : 6;
            for (int i = 0; i < changes; ++i) {
                const auto which = random.below(static_cast<uint32_t>(rooms.boxes.size()));
                if (random.below(4) == 0) {
                    furnish(rooms, random, 1);
                    gone.push_back(0);
                } else if (random.below(5) == 0 && !gone[which]) {
                    rooms.world.remove(rooms.ids[which]);
                    gone[which] = 1;
                } else if (!gone[which]) {
                    Box3d box = MadeRooms::boxAround(rooms.pointInside(random), random.uniform(0.05, 1.0));
                    if (random.below(10) == 0) box.min.y = box.max.y = 50;  // in no room
                    if (random.below(10) == 0) box.max.x = std::numeric_limits<double>::infinity();
                    rooms.move(which, box);
                }
            }
            if (frame == 30) rooms.world.detach();
            if (frame == 40) { ASSERT_TRUE(rooms.world.attach(rooms.space, &made.rows)); }
            const Snapshot now = rooms.world.commit();
            World other;
            if (frame < 30 || frame >= 40) { ASSERT_TRUE(other.attach(rooms.space, &made.rows)); }
            for (size_t i = 0; i < rooms.boxes.size(); ++i) {
                if (gone[i]) continue;
                ObjectDef def;
                def.bounds = {glm::dvec3(0.0), glm::dvec3(1.0)};
                def.transform = MadeRooms::placed(rooms.boxes[i]);
                def.key = i;
                other.add(def);
            }
            const Snapshot fresh = other.commit();
            View view = viewFrom(randomEye(rooms, random), rooms.pointInside(random));
            view.stages = kCells | kFrustum;
            const VisibleSet set = query.visible(now, view);
            Query anew;
            const VisibleSet wanted = anew.visible(fresh, view);
            EXPECT_EQ(keysOf(set), keysOf(wanted)) << "seed " << seed << " frame " << frame;
            for (int stage = 0; stage < kStageCount; ++stage)
                EXPECT_EQ(set.stats.stages[stage].culled, wanted.stats.stages[stage].culled) << frame << " " << stage;
            EXPECT_EQ(reasonsOf(query, now), reasonsOf(anew, fresh));
            // The snapshot before stays what it was.
            if (before) {
                std::vector<uint64_t> again;
                for (const Visible& v : query.visible(before, before_view).objects) again.push_back(v.key);
                EXPECT_EQ(again, before_keys);
            }
            before = now;
            before_view = view;
            before_keys.clear();
            for (const Visible& v : query.visible(before, view).objects) before_keys.push_back(v.key);
        }
    }
}

TEST(CellStages, GoByDoorsAsTheSnapshotHasThem) {
    MadeRooms rooms(8, 5, 4, true);
    Random random(8);
    furnish(rooms, random, 300);
    ASSERT_TRUE(rooms.world.attach(rooms.space));
    EXPECT_EQ(rooms.world.findPortal("no such door"), PortalId());
    EXPECT_FALSE(rooms.world.setPortal({}, 0));
    EXPECT_FALSE(rooms.world.setPortal({static_cast<uint32_t>(rooms.holes.size() + 1)}, 0));
    Snapshot open = rooms.world.commit();
    Query query;
    uint64_t seen = 0, shut_away = 0;
    for (int frame = 0; frame < 60; ++frame) {
        for (size_t i = 0; i < rooms.holes.size(); ++i) {
            rooms.holes[i].open = random.below(2);
            const PortalId door = rooms.world.findPortal("door " + std::to_string(i));
            ASSERT_NE(door, PortalId());
            ASSERT_TRUE(rooms.world.setPortal(door, rooms.holes[i].open));
        }
        const Snapshot now = rooms.world.commit();
        const glm::dvec3 eye = rooms.pointInside(random);
        View view = viewFrom(eye, rooms.pointInside(random));
        view.stages = kCells | kFrustum;
        const std::set<uint64_t> all = keysOf(query.visible(open, view)), kept = keysOf(query.visible(now, view));
        EXPECT_TRUE(std::includes(all.begin(), all.end(), kept.begin(), kept.end()));
        shut_away += all.size() - kept.size();
        for (size_t i = 0; i < rooms.boxes.size(); ++i)
            for (int sample = 0; sample < 12; ++sample) {
                const glm::dvec3 p = pointIn(rooms.boxes[i], random);
                if (!rooms.isInside(p) || !isInImage(view, p) || !rooms.sees(eye, p)) continue;
                ++seen;
                EXPECT_TRUE(kept.count(i)) << "frame " << frame << " object " << i;
                break;
            }
    }
    EXPECT_GT(seen, 200u);
    EXPECT_GT(shut_away, 100u);
}

TEST(CellStages, KeepWhatStandsInNoCellAndWhatHasNoBounds) {
    MadeRooms rooms(2, 3, 3);
    rooms.add(MadeRooms::boxAround({6, 40, 6}, 1));  // above the house
    rooms.add({{5, 1, 5}, {5, 1, std::numeric_limits<double>::infinity()}});
    rooms.add(MadeRooms::boxAround({10, 1, 10}, 1));  // in another room
    ASSERT_TRUE(rooms.world.attach(rooms.space));
    const Snapshot now = rooms.world.commit();
    Query query;
    View view = viewFrom({2, 1.5, 2}, {2, 1.5, -10});
    view.stages = kCells;
    EXPECT_EQ(keysOf(query.visible(now, view)), (std::set<uint64_t>{0, 1}));
    EXPECT_EQ(reasonsOf(query, now), (std::vector<uint8_t>{0, 0, kByPortals}));
    // Once it moves out of the house it is kept, and no longer when it is back.
    rooms.move(2, MadeRooms::boxAround({10, 20, 10}, 1));
    EXPECT_EQ(query.visible(rooms.world.commit(), view).objects.size(), 3u);
    rooms.move(2, MadeRooms::boxAround({10, 1, 10}, 1));
    EXPECT_EQ(query.visible(rooms.world.commit(), view).objects.size(), 2u);
    // An eye that is in no cell sees all.
    View above = viewFrom({2, 30, 2}, {2, 0, 2.1});
    above.stages = kCells;
    const VisibleSet all = query.visible(now, above);
    EXPECT_EQ(all.objects.size(), 3u);
    EXPECT_EQ(all.stats.stages[static_cast<int>(Stage::kPortals)].doubt, 2u);
}

TEST(CellStages, KeepAllWhereTheirLimitsOrTheViewForbidTheirWord) {
    MadeRooms rooms(4, 5, 5);
    Random random(4);
    furnish(rooms, random, 100);
    ASSERT_TRUE(rooms.world.attach(rooms.space));
    const Snapshot now = rooms.world.commit();
    Query query;
    View view = viewFrom({2, 1.5, 2}, {18, 1.5, 17});
    view.stages = kCells;
    const size_t some = query.visible(now, view).objects.size();
    EXPECT_LT(some, 100u);
    view.portal_work = 1;
    const VisibleSet spent = query.visible(now, view);
    EXPECT_EQ(spent.objects.size(), 100u);
    EXPECT_EQ(spent.stats.stages[static_cast<int>(Stage::kPortals)].doubt, 100u);
    view.portal_work = View().portal_work;
    view.sections.add({0, -1, 0, 2});  // cuts the walls open, too
    EXPECT_EQ(query.visible(now, view).objects.size(), 100u);
    view.sections = {};
    view.eye_radius = 1;  // there are no rows
    EXPECT_EQ(query.visible(now, view).objects.size(), 100u);
    view.eye_radius = 0;
    EXPECT_EQ(query.visible(now, view).objects.size(), some);
    rooms.world.detach();
    EXPECT_EQ(query.visible(rooms.world.commit(), view).objects.size(), 100u);
}

TEST(CellStages, OfEyesWithinARadiusHoldForEachOfThem) {
    RoomsWithRows made(7);
    Random random(7);
    furnish(made.rooms, random, 300);
    ASSERT_TRUE(made.rooms.world.attach(made.rooms.space, &made.rows));
    const Snapshot now = made.rooms.world.commit();
    Query query;
    uint64_t culled = 0;
    for (int frame = 0; frame < 30; ++frame) {
        const glm::dvec3 eye = made.rooms.pointInside(random);
        View view = viewFrom(eye, made.rooms.pointInside(random));
        view.eye_radius = random.uniform(0.01, 0.5);
        view.stages = kAllStages;
        const std::set<uint64_t> all = keysOf(query.visible(now, view));
        culled += made.rooms.boxes.size() - all.size();
        for (int other = 0; other < 10; ++other) {
            glm::dvec3 way(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
            const glm::dvec3 near = eye + view.eye_radius * random.uniform(0, 1) * glm::normalize(way);
            View one = viewFrom(near, made.rooms.pointInside(random));
            one.stages = stageBit(Stage::kPvs);
            const VisibleSet set = query.visible(now, one);
            if (set.stats.stages[0].doubt > 0) continue;  // it left the house
            const std::set<uint64_t> seen = keysOf(set);
            EXPECT_TRUE(std::includes(all.begin(), all.end(), seen.begin(), seen.end()));
        }
    }
    EXPECT_GT(culled, 1000u);
}

/// Everything of an answer that may not hang on who makes it.
struct Told {
    std::vector<uint64_t> keys, counts;
    std::vector<uint8_t> reasons;

    Told(Query& query, const Snapshot& now, const View& view) {
        const VisibleSet set = query.visible(now, view);
        for (const Visible& v : set.objects) keys.push_back(v.key);
        for (const StageStats& stage : set.stats.stages)
            counts.insert(counts.end(), {stage.tested, stage.culled, stage.doubt});
        counts.push_back(set.stats.nodes_visited);
        reasons = reasonsOf(query, now);
    }
    bool operator==(const Told&) const = default;
};

OccluderId addCube(World& world) {
    std::vector<glm::vec3> positions;
    for (int i = 0; i < 8; ++i) positions.push_back({float(i & 1), float(i >> 1 & 1), float(i >> 2)});
    const uint32_t faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    std::vector<uint32_t> indices;
    for (const auto& f : faces)
        for (int k : {0, 1, 2, 0, 2, 3}) indices.push_back(f[k]);
    return world.addOccluder(prepareOccluder({positions, indices}));
}

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
        WorldDef def;
        def.volumes = true;
        rooms.world = World::create(def);
        furnish(rooms, random, 250, addCube(rooms.world));
        ASSERT_TRUE(rooms.world.attach(rooms.space, &made.rows));
        const Snapshot now = rooms.world.commit();
        ThreadPool pool(3);
        Query query, threaded(defaultMemory(), &pool);
        for (int frame = 0; frame < 24; ++frame) {
            const glm::dvec3 eye = randomEye(rooms, random), target = rooms.pointInside(random);
            View view = viewFrom(eye, target);
            view.stages = frame % 2 ? kAllStages : kDefaultStages;
            view.bins = frame % 3 == 0 ? 1 : 4;
            view.last_visible_first = frame % 4 == 0;
            view.windows = static_cast<PortalWindows>(frame % 3);
            const Told told(query, now, view), other(threaded, now, view);
            EXPECT_EQ(told, other) << "seed " << seed << " frame " << frame;
            by_portals += static_cast<uint64_t>(std::count(told.reasons.begin(), told.reasons.end(), kByPortals));
            occluded += static_cast<uint64_t>(
                std::count(told.reasons.begin(), told.reasons.end(), 1 + static_cast<int>(Stage::kOcclusion)));
            const std::set<uint64_t> kept(told.keys.begin(), told.keys.end());
            for (size_t i = 0; i < rooms.boxes.size(); ++i) {
                EXPECT_EQ(kept.count(i) > 0, told.reasons[i] == 0);
                for (int sample = 0; sample < 6; ++sample) {
                    const glm::dvec3 p = pointIn(rooms.boxes[i], random);
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
            if (view.last_visible_first) continue;
            const View right = shiftedEye(view, 0.06);
            Query alone;
            const std::set<uint64_t> left_keys = keysOf(alone.visible(now, view)),
                                     right_keys = keysOf(alone.visible(now, right));
            const StereoSet pair = threaded.visibleStereo(now, view, right);
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
            View view = viewFrom(eye, rooms.pointInside(random));
            view.jitter = frame % 4 == 0 ? 3.0 : 0.5;
            view.windows = static_cast<PortalWindows>(frame % 3);
            view.bins = frame % 5 == 0 ? 3 : 1;
            const VisibleSet set = query.visible(now, view);
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
                    const glm::dvec3 p = pointIn(box, random);
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
        furnish(rooms, random, 240, addCube(rooms.world));
        ASSERT_TRUE(rooms.world.attach(rooms.space, &made.rows));
        const Snapshot now = rooms.world.commit();
        Query query;
        for (int frame = 0; frame < 24; ++frame) {
            View view = viewFrom(randomEye(rooms, random), rooms.pointInside(random));
            view.bins = frame % 4 == 3 ? 2 : 1;
            query.visible(now, view);
            const std::vector<uint8_t> reasons = reasonsOf(query, now);
            Explainer explainer(now, view);
            for (uint32_t i = 0; i < reasons.size(); ++i) {
                const Explanation why = explainer.explain(rooms.ids[i]);
                const std::string place =
                    "seed " + std::to_string(seed) + " frame " + std::to_string(frame) + " object " + std::to_string(i);
                EXPECT_EQ(why.verdict == Verdict::kVisible, reasons[i] == 0) << place;
                if (view.bins == 1) {
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
                    return reasonOf(copy.world.commit(), view, static_cast<uint32_t>(at));
                };
                std::vector<uint32_t> alone{i}, without;
                for (const Hider& hider : why.occlusion.hiders) alone.push_back(static_cast<uint32_t>(hider.key));
                std::sort(alone.begin(), alone.end());
                if (why.occlusion.sufficient) { EXPECT_NE(reasonIn(alone), 0) << place; }
                for (uint32_t k = 0; k < reasons.size(); ++k)
                    if (k == i || !std::binary_search(alone.begin(), alone.end(), k)) without.push_back(k);
                if (view.bins > 1) continue;
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

TEST(CellStages, CountObjectsOfTheLayersAlone) {
    RoomsWithRows made(9);
    Random random(9);
    for (int i = 0; i < 200; ++i)
        made.rooms.add(MadeRooms::boxAround(made.rooms.pointInside(random), 0.3), 1u << random.below(3));
    made.rooms.add(MadeRooms::boxAround({6, 40, 6}, 1), 2);
    ASSERT_TRUE(made.rooms.world.attach(made.rooms.space, &made.rows));
    const Snapshot now = made.rooms.world.commit();
    Query query;
    for (int frame = 0; frame < 30; ++frame) {
        View view = viewFrom(randomEye(made.rooms, random), made.rooms.pointInside(random));
        view.stages = frame % 2 ? kCells | kFrustum : stageBit(Stage::kPvs);
        view.layers = 1 + random.below(7);
        const VisibleSet set = query.visible(now, view);
        const std::vector<uint8_t> reasons = reasonsOf(query, now);
        uint64_t by[256] = {};
        for (size_t i = 0; i < reasons.size(); ++i) {
            ++by[reasons[i]];
            EXPECT_EQ(reasons[i] == 255, !(now.state().object(static_cast<uint32_t>(i)).layers & view.layers));
        }
        EXPECT_EQ(set.stats.visible, by[0]);
        EXPECT_EQ(set.stats.objects, reasons.size() - by[255]);
        for (int stage = 0; stage < kStageCount; ++stage) EXPECT_EQ(set.stats.stages[stage].culled, by[1 + stage]);
    }
}

/// Objects that stand where they were baked are in the cells that the file says, others where their bounds are.
TEST(CellStages, TakeTheCellsOfWhatWasBakedFromTheFile) {
    RoomsWithRows made(11);
    MadeRooms& rooms = made.rooms;
    Random random(11);
    furnish(rooms, random, 150);
    const uint32_t count = 150, twin = 149, everywhere = 7, elsewhere = 9;
    const auto boundsOf = [](const Box3d& box) {
        return transformBox({glm::dvec3(0.0), glm::dvec3(1.0)}, MadeRooms::placed(box));
    };
    ObjectPlaces places;
    for (uint32_t i = 0; i < count; ++i) {
        const std::set<uint32_t> in = made.roomsOf(rooms.boxes[i]);
        // One is said to be in a room where its bounds are not: the file's word counts.
        const std::vector<uint32_t> cells =
            i == elsewhere ? std::vector<uint32_t>{35} : std::vector(in.begin(), in.end());
        places.add(i, boundsOf(rooms.boxes[i]), cells, i == everywhere);
    }
    const uint32_t cells = rooms.space.graph.cells;
    BitMatrix visible(cells, cells);
    for (uint32_t a = 0; a < cells; ++a)
        for (uint32_t b = 0; b < cells; ++b)
            if (made.parts[a] == made.parts[b]) visible.set(a, b);
    VisibilityContent content{visible, {}, "rooms"};
    content.space = &rooms.space;
    content.objects = &places;
    const Result<Array<char>> bytes = visibilityFile(content, VisibilityForm::kInPlace);
    ASSERT_TRUE(bytes.ok()) << bytes.error().message;
    const Result<VisibilityFile> file = VisibilityFile::open(*bytes, "rooms.vis");
    ASSERT_TRUE(file.ok()) << file.error().message;
    ASSERT_TRUE(rooms.world.attach(*file));
    const auto cellsOf = [&](const Snapshot& now, uint32_t key) {
        View view = viewFrom({2, 1.5, 2}, {3, 1.5, 3});
        view.stages = kCells;
        const Explanation why = Explainer(now, view).explain(rooms.ids[key]);
        return std::set<uint32_t>(why.cells.object.begin(), why.cells.object.end());
    };
    Snapshot now = rooms.world.commit();
    for (uint32_t i = 0; i < count; ++i) {
        const std::set<uint32_t> wanted = i == elsewhere    ? std::set<uint32_t>{35}
                                          : i == everywhere ? std::set<uint32_t>{}
                                                            : made.roomsOf(rooms.boxes[i]);
        EXPECT_EQ(cellsOf(now, i), wanted) << i;
    }
    Query query;
    for (int frame = 0; frame < 10; ++frame) {
        View view = viewFrom(randomEye(rooms, random), rooms.pointInside(random));
        view.stages = kCells;
        EXPECT_TRUE(keysOf(query.visible(now, view)).count(everywhere));
    }
    // What has moved goes by its bounds, also when it is back; so does one of two that look the same.
    const Box3d stood = rooms.boxes[elsewhere], there = rooms.boxes[twin];
    for (const Box3d& box : {MadeRooms::boxAround({2, 1, 2}, 0.5), stood}) {
        rooms.move(elsewhere, box);
        now = rooms.world.commit();
        EXPECT_EQ(cellsOf(now, elsewhere), made.roomsOf(box));
    }
    rooms.move(everywhere, MadeRooms::boxAround({2, 1, 2}, 0.5));
    now = rooms.world.commit();
    EXPECT_EQ(cellsOf(now, everywhere), (std::set<uint32_t>{0}));
    ObjectDef def;
    def.bounds = {glm::dvec3(0.0), glm::dvec3(1.0)};
    def.transform = MadeRooms::placed(there);
    def.key = twin;
    rooms.ids.push_back(rooms.world.add(def));
    now = rooms.world.commit();
    for (const uint32_t i : {twin, count}) EXPECT_EQ(cellsOf(now, i), made.roomsOf(there));
    rooms.world.remove(rooms.ids[twin]);
    now = rooms.world.commit();
    EXPECT_EQ(cellsOf(now, count), made.roomsOf(there));
}

TEST(CellStages, SayNothingOnceAWallIsGone) {
    RoomsWithRows made(12);
    MadeRooms& rooms = made.rooms;
    Random random(12);
    furnish(rooms, random, 60);
    const uint32_t wall = 3;
    ObjectPlaces places;
    for (uint32_t i = 0; i < 60; ++i) {
        const std::set<uint32_t> in = made.roomsOf(rooms.boxes[i]);
        const Box3d bounds = transformBox({glm::dvec3(0.0), glm::dvec3(1.0)}, MadeRooms::placed(rooms.boxes[i]));
        places.add(i, bounds, std::vector(in.begin(), in.end()), false, i == wall);
    }
    const uint32_t cells = rooms.space.graph.cells;
    BitMatrix visible(cells, cells);
    for (uint32_t a = 0; a < cells; ++a) visible.set(a, a);
    VisibilityContent content{visible, {}, "rooms"};
    content.space = &rooms.space;
    content.objects = &places;
    const Result<Array<char>> bytes = visibilityFile(content, VisibilityForm::kInPlace);
    ASSERT_TRUE(bytes.ok()) << bytes.error().message;
    const Result<VisibilityFile> file = VisibilityFile::open(*bytes, "rooms.vis");
    ASSERT_TRUE(file.ok()) << file.error().message;
    ASSERT_TRUE(rooms.world.attach(*file));
    View view = viewFrom(randomEye(rooms, random), rooms.pointInside(random));
    view.stages = kCells;
    Query query;
    const auto culled = [&] {
        const VisibleSet set = query.visible(rooms.world.commit(), view);
        const uint64_t doubt = set.stats.stages[static_cast<int>(Stage::kPvs)].doubt;
        EXPECT_TRUE(doubt == 0 || set.objects.size() == set.stats.objects);
        return set.stats.objects - set.objects.size();
    };
    for (int i = 0; i < 50 && culled() == 0; ++i)
        view = viewFrom(randomEye(rooms, random), rooms.pointInside(random)), view.stages = kCells;
    ASSERT_GT(culled(), 0u);
    rooms.move(wall, MadeRooms::boxAround({2, 1, 2}, 0.5));
    EXPECT_EQ(culled(), 0u);
    ASSERT_TRUE(rooms.world.attach(*file));
    EXPECT_EQ(culled(), 0u);
    rooms.world.remove(rooms.ids[wall]);
    EXPECT_EQ(culled(), 0u);
}

TEST(CellStages, RefuseSpacesThatAreNone) {
    MadeRooms rooms(1, 3, 3);
    Random random(1);
    furnish(rooms, random, 10);
    const auto refused = [&](auto change) {
        CellSpace space = rooms.space;
        change(space);
        const Status status = rooms.world.attach(space);
        ASSERT_FALSE(status);
        EXPECT_EQ(status.error().message.find("the cells cannot be attached: "), 0u);
    };
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    refused([](CellSpace& s) { s = {}; });
    refused([](CellSpace& s) { s.regions.pop_back(); });
    refused([](CellSpace& s) { s.graph.points[0].x = kNaN; });
    refused([](CellSpace& s) { s.graph.portals[0].cells[1] = s.graph.cells; });
    refused([](CellSpace& s) { s.graph.portals[0].count = 1u << 31; });
    refused([](CellSpace& s) { s.graph.portals[0].door = 0; });
    refused([](CellSpace& s) { s.planes[3].w = kNaN; });
    refused([](CellSpace& s) { s.regions[1].first_plane = 4000; });
    refused([](CellSpace& s) { s.outside = s.graph.cells; });
    refused([](CellSpace& s) { s.tolerance = -1; });
    refused([](CellSpace& s) { s.row_of_cell = {0}; });
    // Nothing has changed.
    Query query;
    View view = viewFrom({2, 1.5, 2}, {10, 1.5, 10});
    view.stages = kCells;
    EXPECT_EQ(query.visible(rooms.world.commit(), view).objects.size(), 10u);
}

class Counting final : public std::pmr::memory_resource {
public:
    uint64_t allocations = 0;

private:
    void* do_allocate(size_t bytes, size_t alignment) override {
        ++allocations;
        return std::pmr::new_delete_resource()->allocate(bytes, alignment);
    }
    void do_deallocate(void* at, size_t bytes, size_t alignment) override {
        std::pmr::new_delete_resource()->deallocate(at, bytes, alignment);
    }
    bool do_is_equal(const memory_resource& other) const noexcept override { return this == &other; }
};

TEST(CellStages, AllocateNothingOnceWarm) {
    RoomsWithRows made(6);
    Random random(6);
    furnish(made.rooms, random, 200);
    ASSERT_TRUE(made.rooms.world.attach(made.rooms.space, &made.rows));
    const Snapshot now = made.rooms.world.commit();
    Counting memory;
    Query query(&memory);
    std::vector<View> views;
    for (int frame = 0; frame < 30; ++frame) {
        views.push_back(viewFrom(randomEye(made.rooms, random), made.rooms.pointInside(random)));
        views.back().windows = static_cast<PortalWindows>(frame % 3);
    }
    for (const View& view : views) query.visible(now, view);
    const uint64_t warm = memory.allocations;
    for (const View& view : views) query.visible(now, view);
    EXPECT_EQ(memory.allocations, warm);
}

}  // namespace
}  // namespace sightline::test
