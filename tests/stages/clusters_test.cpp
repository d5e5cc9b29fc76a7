// The law of the stage of clusters: what is left of every object draws the image that everything draws.
// SPDX-License-Identifier: MIT
#include "sightline/stages/stage_memory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "sightline/base/random.h"
#include "sightline/prepare/facing/draw_clusters.h"
#include "sightline/prepare/occluder/occluder.h"
#include "sightline/query/explain/explain.h"
#include "sightline/studies/hidden/zbuffer/zbuffer.h"
#include "tests/support/answers.h"
#include "tests/support/meshes.h"
#include "tests/support/targets.h"
#include "tests/support/views.h"

namespace sightline::test {
using namespace studies;
namespace {

struct Ball : TestMesh {
    std::vector<uint8_t> double_sided;  ///< per triangle
    std::vector<MeshPart> parts;
    DrawClusters clusters;
    OccluderId occluder;
    ClustersId id;
};

/// A ball with bumps, of two or three parts; the last one may be open and double-sided.
Ball makeBall(uint64_t seed, uint32_t rings, double rough, bool open, bool two_sides = false) {
    Random random(seed);
    Ball mesh;
    const uint32_t around = 2 * rings;
    for (uint32_t ring = 0; ring <= rings; ++ring)
        for (uint32_t k = 0; k < around; ++k) {
            const double theta = M_PI * ring / rings, phi = 2 * M_PI * k / around;
            const bool pole = ring == 0 || ring == rings;
            const double r = pole ? 1.0 : 1.0 + rough * random.uniform(-1, 1), across = pole ? 0.0 : std::sin(theta);
            mesh.positions.push_back(
                glm::vec3(r * glm::dvec3(across * std::cos(phi), std::cos(theta), across * std::sin(phi))));
        }
    const auto at = [&](uint32_t ring, uint32_t k) { return ring * around + k % around; };  // poles: welded by place
    for (uint32_t ring = 0; ring < rings; ++ring) {
        if (open && ring == 1) continue;
        for (uint32_t k = 0; k < around; ++k) {
            if (ring > 0) mesh.indices.insert(mesh.indices.end(), {at(ring, k), at(ring, k + 1), at(ring + 1, k)});
            if (ring + 1 < rings)
                mesh.indices.insert(mesh.indices.end(), {at(ring, k + 1), at(ring + 1, k + 1), at(ring + 1, k)});
        }
    }
    const auto count = static_cast<uint32_t>(mesh.indices.size() / 3);
    const uint32_t half = count / 2;
    mesh.parts = {{0, half / 2, false}, {half / 2, half - half / 2, open}, {half, count - half, false}};
    if (two_sides)
        for (MeshPart& part : mesh.parts) part.double_sided = true;
    mesh.double_sided.assign(count, 0);
    for (const MeshPart& part : mesh.parts)
        std::fill_n(mesh.double_sided.begin() + part.first, part.count, static_cast<uint8_t>(part.double_sided));
    DrawClusterSettings settings;
    settings.merge.triangles = 32;
    mesh.clusters = prepareDrawClusters(mesh.view(), mesh.parts, settings);
    return mesh;
}

struct MadeScene {
    World world;
    std::vector<Ball> meshes;
    std::vector<uint32_t> mesh;  ///< per object
    std::vector<glm::dmat4> transforms;
    std::vector<ObjectId> ids;

    explicit MadeScene(uint64_t seed, int count) {
        meshes.push_back(makeBall(1, 12, 0.15, false));
        meshes.push_back(makeBall(2, 9, 0.02, true));
        meshes.push_back(makeBall(3, 3, 0.0, false));
        meshes.push_back(makeBall(4, 8, 0.1, false, true));
        for (Ball& each : meshes) {
            each.occluder = world.addOccluder(prepareOccluder(each.view(), {}, each.double_sided));
            each.id = world.addClusters(each.clusters);
        }
        Random random(seed);
        for (int i = 0; i < count; ++i) {
            const uint32_t which = static_cast<uint32_t>(random.below(4));
            glm::dmat4 t(1.0);
            for (int axis = 0; axis < 3; ++axis) {
                t[axis][axis] = random.uniform(0.3, 2.5) * (random.below(5) ? 1 : -1);
                t[axis][(axis + 1) % 3] = random.uniform(-0.5, 0.5);
            }
            t[3] = {random.uniform(-12, 12), random.uniform(-3, 3), random.uniform(-12, 12), 1};
            add(which, t, i % 7 != 0);
        }
    }

    void add(uint32_t which, const glm::dmat4& transform, bool has_clusters) {
        ObjectDef def;
        def.bounds = {glm::dvec3(-1.2), glm::dvec3(1.2)};
        def.transform = transform;
        def.key = transforms.size();
        def.occluder = meshes[which].occluder;
        if (has_clusters) def.clusters = meshes[which].id;
        mesh.push_back(which);
        transforms.push_back(transform);
        ids.push_back(world.add(def));
    }

    DrawItem item(size_t object) const {
        const Ball& from = meshes[mesh[object]];
        DrawItem item;
        item.mesh = from.view();
        item.double_sided = from.double_sided;
        item.transform = transforms[object];
        item.id = static_cast<uint32_t>(object);
        return item;
    }
};

View someView(Random& random) {
    const glm::dvec3 eye = randomVector(random, {14, 3, 14});
    View view = viewAt(eye, randomVector(random, {8, 0, 8}), {.width = 160, .height = 100});
    if (random.below(3) == 0) view.projection = orthographic(random.uniform(2, 15), 1.6, 0.1, 60);
    else view.projection = perspective(random.uniform(0.3, 2.2), 1.6, random.below(2) ? 0.1 : 2.0);
    if (random.below(4) == 0) view.projection[2][0] += 0.3;
    return view;
}

/// What is to be drawn of an answer: indices of what is left, by object.
std::map<size_t, std::vector<uint32_t>> drawnOf(const MadeScene& scene, const VisibleSet& set) {
    std::map<size_t, std::vector<uint32_t>> drawn;
    size_t next = 0;
    for (size_t i = 0; i < set.objects.size(); ++i) {
        const size_t object = set.objects[i].key;
        const Ball& mesh = scene.meshes[scene.mesh[object]];
        std::vector<uint32_t>& indices = drawn[object];
        if (next == set.ranges.size() || set.ranges[next].object != i) {
            indices = mesh.indices;
            continue;
        }
        uint32_t end = 0;
        for (; next < set.ranges.size() && set.ranges[next].object == i; ++next) {
            const DrawRange& range = set.ranges[next];
            EXPECT_GE(range.first, end) << "in order";
            EXPECT_GT(range.count, 0u);
            end = range.first + range.count;
            EXPECT_LE(end, mesh.clusters.triangles.size());
            for (uint32_t t = range.first; t < end; ++t) {
                const uint32_t triangle = mesh.clusters.triangles[t];
                const MeshPart& part = mesh.parts[range.part];
                EXPECT_TRUE(triangle >= part.first && triangle < part.first + part.count);
                for (uint32_t corner = 0; corner < 3; ++corner) indices.push_back(mesh.indices[3 * triangle + corner]);
            }
        }
    }
    EXPECT_EQ(next, set.ranges.size());
    return drawn;
}

ZBufferImage imageOf(const MadeScene& scene, const std::map<size_t, std::vector<uint32_t>>* drawn, const View& view,
                     const glm::dvec2& offset) {
    std::vector<DrawItem> items;
    std::vector<std::vector<uint8_t>> sides;
    sides.reserve(scene.transforms.size());
    for (size_t object = 0; object < scene.transforms.size(); ++object) {
        DrawItem item = scene.item(object);
        if (drawn) {
            const auto at = drawn->find(object);
            if (at == drawn->end()) continue;
            item.mesh.indices = at->second;
            // By their corners: no two triangles have the same.
            const Ball& mesh = scene.meshes[scene.mesh[object]];
            std::map<std::array<uint32_t, 3>, uint8_t> side;
            for (size_t t = 0; t < mesh.double_sided.size(); ++t)
                side[{mesh.indices[3 * t], mesh.indices[3 * t + 1], mesh.indices[3 * t + 2]}] = mesh.double_sided[t];
            std::vector<uint8_t>& own = sides.emplace_back();
            for (size_t t = 0; 3 * t < at->second.size(); ++t)
                own.push_back(side.at({at->second[3 * t], at->second[3 * t + 1], at->second[3 * t + 2]}));
            item.double_sided = own;
        }
        items.push_back(item);
    }
    return renderZBuffer(items, view, {.samples = 2, .offset = offset, .want_generated = false});
}

TEST(ClusterStage, WhatIsLeftDrawsTheWholeImage) {
    QueryStats sum;
    uint64_t objects_culled = 0;
    for (uint64_t seed = 1; seed <= 6; ++seed) {
        MadeScene scene(seed, 70);
        const Snapshot now = scene.world.commit();
        Query query;
        Random random(seed);
        for (int frame = 0; frame < 12; ++frame) {
            SCOPED_TRACE("seed " + std::to_string(seed) + " frame " + std::to_string(frame));
            View view = someView(random);
            QuerySettings settings{.bins = frame % 6 == 5 ? 3u : 1u};
            settings.cluster_gap = frame % 3 == 2 ? 40 : 0;
            if (frame % 5 == 4) settings.stages &= ~stageBit(Stage::kOcclusion);
            const VisibleSet set = query.visible(now, view, settings);
            const auto drawn = drawnOf(scene, set);
            for (const glm::dvec2 offset : {glm::dvec2(0), glm::dvec2(0.4, -0.45)}) {
                const ZBufferImage all = imageOf(scene, nullptr, view, offset);
                const ZBufferImage part = imageOf(scene, &drawn, view, offset);
                ASSERT_EQ(all.id, part.id);
                ASSERT_EQ(all.depth, part.depth);
            }
            EXPECT_EQ(accountedFor(set.stats), now.objectCount());
            EXPECT_EQ(set.stats.visible, set.objects.size());
            const std::vector<uint8_t> reasons = reasonsOf(query, now);
            EXPECT_EQ(static_cast<uint64_t>(std::count(reasons.begin(), reasons.end(), 0)), set.objects.size());
            const StageStats& stage = set.stats.stages[static_cast<int>(Stage::kClusters)];
            EXPECT_EQ(static_cast<uint64_t>(
                          std::count(reasons.begin(), reasons.end(), 1 + static_cast<int>(Stage::kClusters))),
                      stage.culled);
            objects_culled += stage.culled;
            uint64_t triangles = 0;
            for (const DrawRange& range : set.ranges) triangles += range.count;
            EXPECT_EQ(triangles, set.stats.drawn_triangles);
            EXPECT_LE(set.stats.clusters_back + set.stats.clusters_outside + set.stats.clusters_hidden,
                      set.stats.clusters_tested);
            sum.clusters_tested += set.stats.clusters_tested;
            sum.clusters_back += set.stats.clusters_back;
            sum.clusters_outside += set.stats.clusters_outside;
            sum.clusters_hidden += set.stats.clusters_hidden;
        }
    }
    EXPECT_GT(sum.clusters_back, sum.clusters_tested / 6);
    EXPECT_GT(sum.clusters_outside, sum.clusters_tested / 50);
    EXPECT_GT(sum.clusters_hidden, sum.clusters_tested / 50);
    EXPECT_GT(objects_culled, 10u);
}

TEST(ClusterStage, TriangleWithoutAPlaceLoseNobodyElse) {
    Random random(12);
    const float bad[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 3e38f,
                         -3e38f};
    for (int i = 0; i < 40; ++i) {
        Ball ball = makeBall(4, 8, 0.1, i % 2 == 0, i % 3 == 0);
        for (int k = 0; k < 1 + i / 4; ++k)
            ball.positions[random.below(ball.positions.size())][static_cast<int>(random.below(3))] =
                bad[random.below(4)];
        const DrawClusters clusters = prepareDrawClusters(ball.view(), ball.parts);
        std::vector<uint32_t> triangles(clusters.triangles.begin(), clusters.triangles.end());
        std::sort(triangles.begin(), triangles.end());
        ASSERT_EQ(triangles.size(), ball.indices.size() / 3);
        for (uint32_t t = 0; t < triangles.size(); ++t) ASSERT_EQ(triangles[t], t);
        World world;
        ObjectDef def;
        def.bounds = {glm::dvec3(-1.2), glm::dvec3(1.2)};
        def.clusters = world.addClusters(clusters);
        world.add(def);
        Query query;
        View view;
        view.projection = perspective(1.0, 1.6, 0.1);
        view.view = lookAt({0, 0, 3}, glm::dvec3(0.0), {0, 1, 0});
        const VisibleSet set = query.visible(world.commit(), view);
        std::vector<uint8_t> drawn(triangles.size(), 0);
        for (const DrawRange& range : set.ranges)
            for (uint32_t t = range.first; t < range.first + range.count; ++t) drawn[clusters.triangles[t]] = 1;
        for (uint32_t t = 0; t < drawn.size(); ++t) {
            const glm::dvec3 a(ball.positions[ball.indices[3 * t]]), b(ball.positions[ball.indices[3 * t + 1]]),
                c(ball.positions[ball.indices[3 * t + 2]]);
            if (glm::dot(glm::cross(b - a, c - a), glm::dvec3(0, 0, 3) - a) > 1e-9 && glm::length(a) < 2 &&
                glm::length(b) < 2 && glm::length(c) < 2) {
                ASSERT_TRUE(drawn[t]) << "round " << i << " triangle " << t;
            }
        }
    }
}

TEST(ClusterStage, DoubleSidedSolidsHaveBacksFromOutside) {
    const Ball ball = makeBall(4, 8, 0.1, false, true), open = makeBall(2, 9, 0.02, true, true);
    EXPECT_EQ(ball.clusters.closed.size(), 1u);
    EXPECT_EQ(ball.clusters.facing.count(), ball.clusters.count());
    EXPECT_EQ(open.clusters.facing.count(), 0u);
    for (const bool turned : {false, true}) {
        Ball given = ball;
        if (turned)
            for (size_t i = 0; i < given.indices.size(); i += 3) std::swap(given.indices[i], given.indices[i + 1]);
        given.clusters = prepareDrawClusters(given.view(), given.parts);
        ASSERT_EQ(given.clusters.closed.size(), 1u);
        World world;
        ObjectDef def;
        def.bounds = {glm::dvec3(-1.2), glm::dvec3(1.2)};
        def.clusters = world.addClusters(given.clusters);
        world.add(def);
        const Snapshot now = world.commit();
        Query query;
        View view;
        view.projection = perspective(1.0, 1.6, 0.1);
        view.view = lookAt({0, 0, 5}, glm::dvec3(0.0), {0, 1, 0});
        const uint64_t all = given.indices.size() / 3;
        EXPECT_GT(query.visible(now, view).stats.clusters_back, 0u);
        EXPECT_LT(query.visible(now, view).stats.drawn_triangles, 9 * all / 10);
        View near = view;
        near.projection = perspective(1.0, 1.6, 4.5);
        EXPECT_EQ(query.visible(now, near).stats.clusters_back, 0u) << "the near plane cuts it open";
        View cut = view;
        cut.sections.add({0, 0, -1, 0.5});
        EXPECT_EQ(query.visible(now, cut).stats.clusters_back, 0u) << "a section cuts it open";
        View inside = view;
        inside.view = lookAt(glm::dvec3(0.0), {0, 0, -1}, {0, 1, 0});
        EXPECT_EQ(query.visible(now, inside).stats.clusters_back, 0u);
        if (std::any_of(given.parts.begin(), given.parts.end(), [](const MeshPart& part) { return part.hides; })) {
            for (MeshPart& part : given.parts) part.hides = false;
            EXPECT_EQ(prepareDrawClusters(given.view(), given.parts).closed.size(), 0u) << "glass shows its inside";
        }
    }
}

TEST(ClusterStage, IsTheSameOnEveryInstructionSet) {
    MadeScene scene(9, 60);
    const Snapshot now = scene.world.commit();
    const auto answer = [&] {
        Query query;
        Random random(9);
        std::vector<uint32_t> all;
        for (int frame = 0; frame < 6; ++frame) {
            const VisibleSet set = query.visible(now, someView(random));
            for (const DrawRange& range : set.ranges)
                all.insert(all.end(), {range.object, range.first, range.count, range.part});
        }
        return all;
    };
    const auto expected = answer();
    EXPECT_GT(expected.size(), 1000u);
    forEachTarget([&](const std::string& name) { EXPECT_EQ(answer(), expected) << name; });
}

TEST(ClusterStage, WithoutItObjectsAreWhole) {
    MadeScene scene(4, 40);
    const Snapshot now = scene.world.commit();
    Query query;
    Random random(4);
    for (int frame = 0; frame < 6; ++frame) {
        View view = someView(random);
        QuerySettings settings;
        const size_t with = query.visible(now, view, settings).objects.size();
        settings.stages &= ~stageBit(Stage::kClusters);
        const VisibleSet set = query.visible(now, view, settings);
        EXPECT_TRUE(set.ranges.empty());
        EXPECT_GE(set.objects.size(), with);
        EXPECT_EQ(set.stats.clusters_tested, 0u);
        settings.stages = kAllStages;
        view.view[0][0] = std::numeric_limits<double>::quiet_NaN();
        const VisibleSet unusable = query.visible(now, view, settings);
        EXPECT_TRUE(unusable.ranges.empty());
        EXPECT_EQ(unusable.objects.size(), now.objectCount());
    }
}

TEST(ClusterStage, ExplainsWhatItCulls) {
    MadeScene scene(5, 70);
    const Snapshot now = scene.world.commit();
    Query query;
    Random random(5);
    uint64_t found = 0;
    for (int frame = 0; frame < 12; ++frame) {
        const View view = someView(random);
        query.visible(now, view);
        const std::vector<uint8_t> reasons = reasonsOf(query, now);
        Explainer explainer(now, view);
        for (size_t i = 0; i < reasons.size(); ++i) {
            const bool by_clusters = reasons[i] == 1 + static_cast<int>(Stage::kClusters);
            EXPECT_EQ(explainer.explain(scene.ids[i], {false, false}).verdict == Verdict::kNoCluster, by_clusters);
            found += by_clusters;
        }
    }
    EXPECT_GT(found, 10u);
}

}  // namespace
}  // namespace sightline::test
