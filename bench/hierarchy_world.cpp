// What a world's commits cost while its objects come, move and go, and what queries of it cost then.
// SPDX-License-Identifier: MIT
#include "bench/cases.h"

#include <algorithm>

#include "bench/stopwatch.h"
#include "bench/swarm.h"
#include "sightline/query/query.h"

namespace sightline::bench {
namespace {

constexpr int kWorldFrames = 20;

ObjectDef objectOf(const Box3d& box) {
    ObjectDef def;
    def.bounds = box;
    return def;
}

/// A world of a swarm's boxes, and a snapshot that a reader holds.
struct Living {
    Swarm swarm;
    World world;
    std::vector<ObjectId> ids;
    std::vector<Box3d> begun;  ///< as they entered
    Snapshot held;

    Living(uint32_t count, uint64_t seed) : swarm(count, seed), begun(swarm.boxes) {
        for (const Box3d& box : swarm.boxes) ids.push_back(world.add(objectOf(box)));
    }
    void move(uint32_t i) {
        glm::dmat4 transform(1.0);
        transform[3] = glm::dvec4(swarm.boxes[i].min - begun[i].min, 1.0);
        world.move(ids[i], transform);
    }
    void replace(uint32_t i, const Box3d& box) {
        world.remove(ids[i]);
        swarm.boxes[i] = begun[i] = box;
        ids[i] = world.add(objectOf(box));
    }
    void commit() { held = world.commit(); }
};

/// A frustum query of what has become of the world, beside one of a world that is made of the same boxes.
void addQueries(Table& table, const Living& living, const std::string& where, int repeat) {
    World anew;
    for (const Box3d& box : living.swarm.boxes) anew.add(objectOf(box));
    const Snapshot fresh = anew.commit();
    Query query;
    for (const bool near : {false, true}) {
        const View view = viewFrom(near ? 0.2 * kWorld : std::numeric_limits<double>::infinity());
        QuerySettings settings{.stages = stageBit(Stage::kFrustum)};
        size_t kept = 0;
        const std::vector<double> times =
            threadTimes({[&] { kept = query.visible(living.held, view, settings).objects.size(); },
                         [&] { query.visible(fresh, view, settings); }},
                        repeat ? repeat : 15);
        const double share = 100.0 * static_cast<double>(kept) / static_cast<double>(living.swarm.boxes.size());
        table.rows.push_back({where, near ? "frustum query, short view" : "frustum query, far view", times[0], "us",
                              "of a world made anew", times[1], std::to_string(share) + " % kept"});
    }
}

}  // namespace

void addWorld(Table& table, const std::string& world, uint32_t count, int repeat) {
    Living living(count, 4);
    const double first = millisecondsOf([&] { living.commit(); });
    const auto frames = [&](const std::string& what, const std::function<void()>& change) {
        std::vector<double> times, commits;
        for (int frame = 0; frame < kWorldFrames; ++frame) {
            const double changes = millisecondsOf(change);
            commits.push_back(millisecondsOf([&] { living.commit(); }));
            times.push_back(changes + commits.back());
        }
        const double worst = *std::max_element(times.begin(), times.end());
        table.rows.push_back(
            {world + ", " + what, "changes and commit", medianOf(times), "ms/frame", "first commit", first,
             "the commit alone " + std::to_string(medianOf(commits)) + ", longest " + std::to_string(worst)});
    };
    Random random(5);
    const auto any = [&] { return static_cast<uint32_t>(random.below(count)); };
    const auto nudge = [&](uint32_t i) {
        living.swarm.boxes[i] = {living.swarm.boxes[i].min + 0.3, living.swarm.boxes[i].max + 0.3};
        living.move(i);
    };
    frames("one moves", [&] { nudge(any()); });
    frames("1,000 move", [&] {
        for (int i = 0; i < 1000; ++i) nudge(any());
    });
    frames("every hundredth moves", [&] {
        for (uint32_t i = 0; i < count; i += 100) nudge(i);
    });
    frames("every hundredth goes anywhere", [&] {
        for (uint32_t i = 0; i < count; i += 100) {
            const Box3d box = living.swarm.boxes[i];
            const glm::dvec3 to = living.begun[any()].min;
            living.swarm.boxes[i] = {to, to + box.size()};
            living.move(i);
        }
    });
    frames("every tenth moves", [&] {
        living.swarm.step();
        for (uint32_t i = 0; i < living.swarm.movers(); ++i) living.move(living.swarm.mover(i));
    });
    addQueries(table, living, world + ", then", repeat);
    frames("100 go and 100 come", [&] {
        for (int i = 0; i < 100; ++i) living.replace(any(), living.swarm.boxes[any()]);
    });
    addQueries(table, living, world + ", then", repeat);
}

}  // namespace sightline::bench
