// The probe's tree finds what trying every triangle finds.
// SPDX-License-Identifier: MIT
#include "sightline/tools/load/seeded_cameras.h"

#include <gtest/gtest.h>

#include "sightline/base/random.h"
#include "sightline/tools/scene/city/city.h"
#include "tests/support/random.h"

namespace sightline {
using namespace tools;
namespace {

/// Every triangle in world space, one after the other, by areas of the three sub-triangles.
std::optional<ProbeHit> nearestByTrying(const Scene& scene, const ProbeRay& ray) {
    std::optional<ProbeHit> best;
    for (uint32_t o = 0; o < scene.objects.size(); ++o) {
        const SceneObject& object = scene.objects[o];
        const Mesh& mesh = scene.meshes[object.mesh];
        const bool mirrored = glm::determinant(glm::dmat3(object.transform)) < 0;
        for (uint32_t t = 0; t < mesh.triangles(); ++t) {
            glm::dvec3 p[3];
            for (uint32_t k = 0; k < 3; ++k) {
                const glm::dvec3 local(mesh.positions[mesh.indices[3 * t + k]]);
                p[k] = glm::dvec3(object.transform * glm::dvec4(local, 1));
            }
            if (mirrored) std::swap(p[1], p[2]);
            const glm::dvec3 normal = glm::cross(p[1] - p[0], p[2] - p[0]);
            const double slope = glm::dot(normal, ray.direction);
            if (slope == 0) continue;
            const double along = glm::dot(normal, p[0] - ray.origin) / slope;
            const glm::dvec3 at = ray.origin + along * ray.direction;
            bool inside = along > 0;
            for (int k = 0; k < 3; ++k)
                inside = inside && glm::dot(normal, glm::cross(p[(k + 1) % 3] - p[k], at - p[k])) >= 0;
            if (inside && (!best || along < best->t)) best = ProbeHit{along, o, t, slope < 0};
        }
    }
    return best;
}

Scene soup(Random& random, int meshes, int objects) {
    Scene scene;
    scene.materials.resize(1);
    for (int m = 0; m < meshes; ++m) {
        Mesh& mesh = scene.meshes.emplace_back();
        const uint32_t triangles = 1 + static_cast<uint32_t>(random.below(40));
        for (uint32_t i = 0; i < 3 * triangles; ++i) {
            mesh.positions.push_back(glm::vec3(test::randomVector(random, 1)));
            mesh.indices.push_back(i);
            mesh.bounds.grow(glm::dvec3(mesh.positions.back()));
        }
        mesh.primitives.push_back({0, triangles, 0});
    }
    for (int i = 0; i < objects; ++i) {
        SceneObject& object = scene.objects.emplace_back();
        object.key = static_cast<uint64_t>(i);
        object.mesh = static_cast<uint32_t>(random.below(static_cast<uint64_t>(meshes)));
        for (int column = 0; column < 4; ++column)
            object.transform[column] = glm::dvec4(test::randomVector(random, column < 3 ? 1.5 : 6), column < 3 ? 0 : 1);
    }
    return scene;
}

TEST(RayProbe, FindsWhatTryingAllFinds) {
    int hits = 0;
    for (uint64_t seed = 0; seed < 30; ++seed) {
        Random random(seed);
        const Scene scene = soup(random, 5, 30);
        const RayProbe probe(scene);
        for (int i = 0; i < 60; ++i) {
            ProbeRay ray{test::randomVector(random, 8), test::randomVector(random, 1)};
            if (i % 10 == 0) ray.direction = {0, 0, 1};
            const std::optional<ProbeHit> truth = nearestByTrying(scene, ray), found = probe.nearest(ray);
            ASSERT_EQ(truth.has_value(), found.has_value()) << "seed " << seed << ", ray " << i;
            if (!truth) continue;
            ++hits;
            EXPECT_NEAR(truth->t, found->t, 1e-9 * (1 + truth->t)) << "seed " << seed << ", ray " << i;
            EXPECT_EQ(truth->object, found->object) << "seed " << seed << ", ray " << i;
            EXPECT_EQ(truth->triangle, found->triangle) << "seed " << seed << ", ray " << i;
            EXPECT_EQ(truth->front, found->front) << "seed " << seed << ", ray " << i;
        }
    }
    EXPECT_GT(hits, 200);
}

TEST(RayProbe, StopsAtWhatCounts) {
    // Two faces in one place, back to back, and a third one behind them.
    Scene scene;
    scene.materials.resize(1);
    for (const double z : {-1.0, -2.0}) {
        Mesh& mesh = scene.meshes.emplace_back();
        for (const glm::vec3& corner : {glm::vec3(-3, -3, 0), glm::vec3(3, -3, 0), glm::vec3(0, 3, 0)})
            mesh.positions.push_back(corner + glm::vec3(0, 0, z));
        mesh.indices = {0, 2, 1, 0, 1, 2};
        for (const glm::vec3& corner : mesh.positions) mesh.bounds.grow(glm::dvec3(corner));
        mesh.primitives.push_back({0, 2, 0});
        SceneObject& object = scene.objects.emplace_back();
        object.mesh = static_cast<uint32_t>(scene.meshes.size() - 1);
    }
    const RayProbe probe(scene);
    const ProbeRay ray{{0.1, 0.2, 0}, {0, 0, -1}};
    const auto isFront = [](const ProbeHit& hit) { return hit.front; };
    const std::optional<ProbeHit> front = probe.nearest(ray, 0, isFront);
    ASSERT_TRUE(front && front->front);
    EXPECT_DOUBLE_EQ(front->t, 1);
    EXPECT_EQ(front->object, 0u);
    const std::optional<ProbeHit> next = probe.nearest(ray, front->t, isFront);
    ASSERT_TRUE(next && next->front);
    EXPECT_EQ(next->object, 1u);
    EXPECT_FALSE(probe.nearest(ray, 0, [](const ProbeHit&) { return false; }));
}

TEST(RayProbe, SeesFrontsOfMirroredInstances) {
    const Scene scene = makeCity(4, 2000);
    const RayProbe probe(scene);
    Random random(5);
    int mirrored = 0;
    for (int i = 0; i < 20000; ++i) {
        const ProbeRay ray{{random.uniform(-150, 150), 300, random.uniform(-150, 150)}, {0, -1, 0}};
        const std::optional<ProbeHit> hit = probe.nearest(ray);
        if (!hit || glm::determinant(glm::dmat3(scene.objects[hit->object].transform)) > 0) continue;
        const Mesh& mesh = scene.meshes[scene.objects[hit->object].mesh];
        bool both = false;
        for (const Primitive& primitive : mesh.primitives)
            if (hit->triangle - primitive.first_triangle < primitive.triangle_count)
                both = scene.materials[primitive.material].double_sided;
        if (both) continue;
        ++mirrored;
        EXPECT_TRUE(hit->front) << "ray " << i << ", object " << hit->object << " (" << mesh.name << ")";
    }
    EXPECT_GT(mirrored, 100);
}

TEST(RayProbe, StandsEmptyAndFlatScenes) {
    Scene scene;
    EXPECT_FALSE(RayProbe(scene).nearest({{0, 0, 0}, {0, 0, 1}}));
    scene.meshes.resize(2);
    scene.objects.resize(3);
    EXPECT_FALSE(RayProbe(scene).nearest({{0, 0, -5}, {0, 0, 1}}));
    Random random(1);
    scene = soup(random, 1, 2);
    scene.objects[0].transform[2] = glm::dvec4(0);
    scene.objects[1].transform = glm::dmat4(0);
    const RayProbe probe(scene);
    for (int i = 0; i < 50; ++i) (void)probe.nearest({test::randomVector(random, 3), test::randomVector(random, 1)});
}

}  // namespace
}  // namespace sightline
