// What a path tells of a scene, held to sums and sets made by hand and by brute force.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/run/insight.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "sightline/base/random.h"
#include "tests/tools/report/run/made_run.h"

namespace sightline {
using namespace tools;
namespace {

TEST(Insight, AddsAnOccludersCreditsUpAndPutsWhoHidesMostFirst) {
    CullRun run;
    run.frames.resize(3);
    run.frames[0].credits = {{4, 12, 1.5, 30}, {7, 2, 0, 0}};
    run.frames[1].credits = {{7, 2, 0.25, 5}};
    run.frames[2].credits = {{4, 10, 2.0, 11}, {7, 2, 0, 0}, {9, 1, 3.5, 1}};
    const std::vector<OccluderRow> rows = occluderRows(run);
    ASSERT_EQ(rows.size(), 3u);
    EXPECT_EQ(rows[0].object, 4u);  // as much as 9, and before it in the scene
    EXPECT_EQ(rows[0].frames, 2u);
    EXPECT_EQ(rows[0].triangles, 22u);
    EXPECT_DOUBLE_EQ(rows[0].hidden, 3.5);
    EXPECT_DOUBLE_EQ(rows[0].hidden_triangles, 41);
    EXPECT_EQ(rows[1].object, 9u);
    EXPECT_EQ(rows[2].object, 7u);
    EXPECT_EQ(rows[2].frames, 3u);
    EXPECT_DOUBLE_EQ(rows[2].hidden, 0.25);
    EXPECT_TRUE(occluderRows(CullRun()).empty());
}

TEST(Insight, TellsWhoPaysFromWhoHidNothing) {
    CullRun run;
    run.frames.resize(1);
    run.frames[0].credits = {{1, 100, 2.0, 50}, {2, 4, 1.0, 40}, {3, 6, 0.0, 0}, {4, 9, 1e-9, 1e-7}, {5, 0, 1.0, 3}};
    const std::vector<OccluderRow> rows = occluderRows(run);
    const auto objects = [](const std::vector<OccluderRow>& of) {
        std::vector<uint32_t> out;
        for (const OccluderRow& row : of) out.push_back(row.object);
        return out;
    };
    EXPECT_EQ(objects(payingRows(rows)), (std::vector<uint32_t>{2, 1, 5}));
    EXPECT_EQ(objects(idleRows(rows)), (std::vector<uint32_t>{4, 3}));  // rounding is nothing
    EXPECT_DOUBLE_EQ(worthOf(payingRows(rows)[0]), 10);
    EXPECT_DOUBLE_EQ(worthOf(payingRows(rows)[2]), 0);
}

/// Objects of a few meshes in two groups of the tree, with random answers of which many are the same.
struct RandomPath {
    Scene scene;
    CullRun run;

    explicit RandomPath(uint64_t seed) {
        Random random(seed);
        scene.materials.resize(1);
        scene.meshes = {quadMesh(0.5, 0), quadMesh(0.1, 0), quadMesh(0.1, 0), quadMesh(40, 0)};
        for (int i = 0; i < 3000; ++i)
            for (const uint32_t corner : {0u, 1u, 2u}) scene.meshes[2].indices.push_back(corner);
        scene.meshes[2].primitives[0].triangle_count = 3002;
        scene.nodes = {{"site", SceneNode::kNone}, {"east", 0}, {"west", 0}};
        for (uint32_t i = 0; i < 120; ++i) {
            SceneObject object;
            object.key = i;
            object.mesh = static_cast<uint32_t>(random.below(4));
            object.transform[3] = {random.uniform(-50, 50), random.below(2) ? 0.0 : 1.0, random.uniform(-2, 2), 1};
            object.node = static_cast<uint32_t>(scene.nodes.size());
            scene.nodes.push_back({std::to_string(i), static_cast<uint32_t>(1 + random.below(2))});
            scene.objects.push_back(object);
        }
        run.frames.resize(5);
        std::vector<uint32_t> kinds;
        for (size_t i = 0; i < scene.objects.size(); ++i) kinds.push_back(static_cast<uint32_t>(random.below(4)));
        for (size_t f = 0; f < run.frames.size(); ++f)
            for (const uint32_t kind : kinds)
                run.frames[f].reasons.push_back(static_cast<uint8_t>(kind == 0 ? 2 : mixSeed(kind + seed, f) % 3));
    }

    std::vector<bool> keptBy(uint32_t object) const {
        std::vector<bool> kept;
        for (const FrameResult& frame : run.frames) kept.push_back(frame.reasons[object] == 0);
        return kept;
    }
};

TEST(Insight, ListsWhatNoFrameKeeps) {
    for (uint64_t seed = 1; seed <= 20; ++seed) {
        const RandomPath path(seed);
        const std::vector<uint32_t> never = neverKept(path.run, path.scene);
        std::set<uint32_t> listed(never.begin(), never.end());
        EXPECT_EQ(listed.size(), never.size());
        for (uint32_t i = 0; i < path.scene.objects.size(); ++i) {
            const std::vector<bool> kept = path.keptBy(i);
            EXPECT_EQ(listed.count(i) == 1, std::count(kept.begin(), kept.end(), true) == 0) << "seed " << seed;
        }
        const auto triangles = [&](uint32_t i) { return path.scene.meshes[path.scene.objects[i].mesh].triangles(); };
        for (size_t i = 1; i < never.size(); ++i)
            EXPECT_GE(triangles(never[i - 1]), triangles(never[i])) << "seed " << seed;
    }
}

TEST(Insight, GroupsWhatComesAndGoesTogether) {
    size_t groups = 0, grouped = 0;
    for (uint64_t seed = 1; seed <= 40; ++seed) {
        const RandomPath path(seed);
        const double diagonal = glm::length(worldBounds(path.scene).size());
        std::set<uint32_t> taken;
        size_t last_size = ~size_t{0};
        for (const TogetherGroup& group : keptTogether(path.run, path.scene)) {
            ++groups;
            grouped += group.objects.size();
            EXPECT_GE(group.objects.size(), 2u);
            EXPECT_LE(group.objects.size(), last_size);
            last_size = group.objects.size();
            const std::vector<bool> kept = path.keptBy(group.objects.front());
            EXPECT_EQ(group.frames, static_cast<uint64_t>(std::count(kept.begin(), kept.end(), true)));
            EXPECT_GT(group.frames, 0u);
            Box3d box;
            uint64_t triangles = 0;
            const auto parent = [&](uint32_t i) { return path.scene.nodes[path.scene.objects[i].node].parent; };
            for (const uint32_t i : group.objects) {
                EXPECT_TRUE(taken.insert(i).second) << "seed " << seed << ": object " << i << " is in two groups";
                EXPECT_EQ(path.keptBy(i), kept) << "seed " << seed;
                EXPECT_EQ(parent(i), parent(group.objects.front()));
                const Mesh& mesh = path.scene.meshes[path.scene.objects[i].mesh];
                EXPECT_LE(mesh.triangles(), 2000u);
                triangles += mesh.triangles();
                box.grow(transformBox(mesh.bounds, path.scene.objects[i].transform));
            }
            EXPECT_EQ(group.triangles, triangles);
            EXPECT_LE(glm::length(box.size()), 0.05 * diagonal);
        }
    }
    EXPECT_GT(groups, 40u);
    EXPECT_GT(grouped, 100u);
}

}  // namespace
}  // namespace sightline
