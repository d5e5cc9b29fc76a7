// The same questions through C and through C++: what the C interface costs.
// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <vector>

#include <fmt/core.h>

#include "bench/cases.h"
#include "bench/stopwatch.h"
#include "sightline/base/random.h"
#include "sightline/c/sightline.h"
#include "sightline/prepare/occluder/occluder.h"
#include "sightline/query/query.h"

namespace sightline::bench {
namespace {

constexpr float kCube[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1, 1, 1, 1};
constexpr uint32_t kCorners[] = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};

/// Boxes that hide, made in both worlds.
struct Twins {
    World world;
    slWorld* c_world = nullptr;
    Snapshot now;
    slSnapshot* c_now = nullptr;

    explicit Twins(uint32_t count) {
        std::vector<glm::vec3> corners;
        for (size_t i = 0; i < std::size(kCube); i += 3) corners.emplace_back(kCube[i], kCube[i + 1], kCube[i + 2]);
        const OccluderId cube = world.addOccluder(prepareOccluder({corners, kCorners}));
        const slWorldDef world_def = slDefaultWorldDef();
        slOccluderDef mesh = slDefaultOccluderDef();
        mesh.mesh = {kCube, std::size(kCube) / 3, 0, kCorners, std::size(kCorners), 0};
        slOccluder* occluder = nullptr;
        slOccluderId c_cube{};
        slPrepareOccluder(&mesh, &occluder);
        slCreateWorld(&world_def, &c_world);
        slAddOccluder(c_world, occluder, &c_cube);
        slDestroyOccluder(occluder);
        Random random(count);
        const double reach = 2 * std::sqrt(count);
        for (uint32_t i = 0; i < count; ++i) {
            ObjectDef def;
            def.bounds = {glm::dvec3(0), glm::dvec3(1)};
            for (int axis = 0; axis < 3; ++axis) def.transform[axis][axis] = random.uniform(0.2, 3);
            def.transform[3] = {random.uniform(-reach, reach), 0, random.uniform(-reach, reach), 1};
            def.key = i;
            def.occluder = cube;
            world.add(def);
            slObjectDef c_def = slDefaultObjectDef();
            c_def.bounds = {{0, 0, 0}, {1, 1, 1}};
            std::memcpy(c_def.transform, &def.transform[0][0], sizeof c_def.transform);
            c_def.key = i;
            c_def.occluder = c_cube;
            slAddObject(c_world, &c_def, nullptr);
        }
        now = world.commit();
        slCommit(c_world, &c_now);
    }
    ~Twins() {
        slReleaseSnapshot(c_now);
        slDestroyWorld(c_world);
    }
    Twins(const Twins&) = delete;
    Twins& operator=(const Twins&) = delete;
};

}  // namespace

Table benchC(const Options&) {
    constexpr int kFrames = 2000, kRounds = 5;
    Table table{"c", {}};
    for (const uint32_t count : {1u, 100u, 10000u}) {
        const Twins twins(count);
        Query query;
        slQuery* c_query = nullptr;
        slCreateQuery(nullptr, &c_query);
        double plain = 0, through_c = 0;
        uint64_t kept = 0, c_kept = 0;
        for (int round = 0; round < kRounds; ++round)
            for (int frame = 0; frame < kFrames; ++frame) {
                const double angle = 2 * std::numbers::pi * frame / kFrames;
                const glm::dvec3 eye(0.3 * std::sqrt(count) * std::cos(angle), 1.5,
                                     0.3 * std::sqrt(count) * std::sin(angle));
                View view;
                view.view = lookAt(eye, eye + glm::dvec3(std::sin(3 * angle), 0, std::cos(3 * angle)), {0, 1, 0});
                view.projection = perspective(1, 16.0 / 9, 0.1);
                slView c_view = slDefaultView();
                std::memcpy(c_view.view, &view.view[0][0], sizeof c_view.view);
                std::memcpy(c_view.projection, &view.projection[0][0], sizeof c_view.projection);
                // Who comes second finds its code less warm: they take turns.
                for (int turn = 0; turn < 2; ++turn) {
                    const double start = threadTime();
                    if ((frame + turn) % 2) {
                        kept += query.visible(twins.now, view).objects.size();
                        plain += threadTime() - start;
                    } else {
                        slVisibleSet set;
                        slQueryVisible(c_query, twins.c_now, &c_view, nullptr, &set);
                        c_kept += set.count;
                        through_c += threadTime() - start;
                    }
                }
            }
        slDestroyQuery(c_query);
        Rows{table, fmt::format("{} objects", count)}("query through C", through_c / (kRounds * kFrames), "us",
                                                      "through C++", plain / (kRounds * kFrames),
                                                      kept == c_kept ? "the same answers" : "answers differ");
    }
    return table;
}

}  // namespace sightline::bench
