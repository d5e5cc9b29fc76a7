// What closed surfaces encase is met by no ray from outside before a front that hides it.
// SPDX-License-Identifier: MIT
#include "sightline/tools/export/encased.h"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "sightline/base/random.h"
#include "sightline/tools/load/seeded_cameras.h"
#include "tests/support/random.h"
#include "tests/support/shared_scenes.h"

namespace sightline::test {
using namespace tools;
namespace {

constexpr uint32_t kStone = 0, kGlass = 1, kBothSides = 2;

Scene emptyScene() {
    Scene scene;
    scene.materials.resize(3);
    scene.materials[kGlass].alpha_mode = AlphaMode::kBlend;
    scene.materials[kBothSides].double_sided = true;
    return scene;
}

/// A box about the origin, its fronts outward; some triangles may be left out of it.
Mesh boxMesh(double half, uint32_t material, uint32_t triangles = 12) {
    Mesh mesh;
    for (int i = 0; i < 8; ++i)
        mesh.positions.emplace_back(i & 1 ? half : -half, i & 2 ? half : -half, i & 4 ? half : -half);
    mesh.indices = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                    2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
    mesh.indices.resize(3 * triangles);
    mesh.primitives = {{0, triangles, material}};
    for (const glm::vec3& p : mesh.positions) mesh.bounds.grow(glm::dvec3(p));
    return mesh;
}

void turnInsideOut(Mesh& mesh) {
    for (size_t i = 0; i < mesh.indices.size(); i += 3) std::swap(mesh.indices[i], mesh.indices[i + 1]);
}

SceneObject& addObject(Scene& scene, Mesh mesh, const glm::dmat4& transform = glm::dmat4(1.0)) {
    SceneObject& object = scene.objects.emplace_back();
    object.key = scene.objects.size() - 1;
    object.mesh = static_cast<uint32_t>(scene.meshes.size());
    object.transform = transform;
    scene.meshes.push_back(std::move(mesh));
    return object;
}

glm::dmat4 at(double x, double y = 0, double z = 0) {
    glm::dmat4 m(1.0);
    m[3] = {x, y, z, 1};
    return m;
}

/// Numbers of encased triangles, by object.
std::vector<size_t> countsOf(const Scene& scene) {
    std::vector<size_t> counts;
    for (const auto& triangles : encasedTriangles(scene).triangles) counts.push_back(triangles.size());
    return counts;
}

using Counts = std::vector<size_t>;

/// A small box within a larger one.
Counts boxInBox(Mesh outer, const glm::dmat4& of_outer = glm::dmat4(1.0),
                const glm::dmat4& of_inner = glm::dmat4(1.0)) {
    Scene scene = emptyScene();
    addObject(scene, std::move(outer), of_outer);
    addObject(scene, boxMesh(1, kStone), of_inner);
    return countsOf(scene);
}

TEST(Encased, ABoxInABoxIs) {
    EXPECT_EQ(boxInBox(boxMesh(2, kStone)), (Counts{0, 12}));
    EXPECT_EQ(boxInBox(boxMesh(2, kBothSides)), (Counts{0, 12}));
    Scene scene = emptyScene();
    for (const double half : {5, 3, 1}) addObject(scene, boxMesh(half, kStone));
    addObject(scene, boxMesh(0.5, kGlass), at(20));
    const Encased encased = encasedTriangles(scene);
    EXPECT_EQ(countsOf(scene), (Counts{0, 12, 12, 0}));
    EXPECT_EQ(encased.shells, 3u) << "glass shuts nothing";
    EXPECT_EQ(encased.triangles[2], (std::vector<uint32_t>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}));
}

TEST(Encased, NothingIsBehindAHole) {
    for (uint32_t triangles = 1; triangles < 12; ++triangles)
        EXPECT_EQ(boxInBox(boxMesh(2, kStone, triangles)), (Counts{0, 0})) << triangles;
    EXPECT_EQ(boxInBox(boxMesh(2, kGlass)), (Counts{0, 0})) << "glass";
    Mesh one_pane = boxMesh(2, kStone, 12);
    one_pane.primitives = {{0, 11, kStone}, {11, 1, kGlass}};
    EXPECT_EQ(boxInBox(one_pane), (Counts{0, 0})) << "a pane";
    Mesh moving = boxMesh(2, kStone);
    moving.deforms = true;
    EXPECT_EQ(boxInBox(moving), (Counts{0, 0})) << "it may open";
}

TEST(Encased, ADoorIsNoShell) {
    Scene scene = emptyScene();
    addObject(scene, boxMesh(2, kStone));
    addObject(scene, boxMesh(1, kStone));
    scene.portals.resize(1);
    scene.portals[0].door = 0;
    EXPECT_EQ(countsOf(scene), (Counts{0, 0}));
}

TEST(Encased, BacksHideNothing) {
    Mesh inside_out = boxMesh(2, kStone);
    turnInsideOut(inside_out);
    EXPECT_EQ(boxInBox(inside_out), (Counts{0, 0}));
    Mesh both = boxMesh(2, kBothSides);
    turnInsideOut(both);
    EXPECT_EQ(boxInBox(both), (Counts{0, 12})) << "drawn from both sides";
    Mesh one_turned = boxMesh(2, kBothSides);
    std::swap(one_turned.indices[0], one_turned.indices[1]);
    EXPECT_EQ(boxInBox(one_turned), (Counts{0, 0})) << "its edges do not agree";
    glm::dmat4 mirror(1.0);
    mirror[0][0] = -1;
    EXPECT_EQ(boxInBox(boxMesh(2, kStone), mirror), (Counts{0, 12})) << "a mirrored object's fronts stay fronts";
    EXPECT_EQ(boxInBox(inside_out, mirror), (Counts{0, 0}));
}

TEST(Encased, WhatTouchesOrSticksOutIsNot) {
    EXPECT_EQ(boxInBox(boxMesh(2, kStone), at(0), at(4))[1], 0u) << "beside it";
    EXPECT_EQ(boxInBox(boxMesh(2, kStone), at(0), at(1))[1], 2u)
        << "it touches: two triangles of the far side are within";
    EXPECT_EQ(boxInBox(boxMesh(2, kStone), at(0), at(1.5))[1], 2u) << "it sticks out";
    EXPECT_EQ(boxInBox(boxMesh(2, kStone), at(0), at(0.999))[1], 12u);
    EXPECT_EQ(boxInBox(boxMesh(1, kStone)), (Counts{0, 0})) << "one and the same box twice";
}

TEST(Encased, ACavityIsASurfaceOfItsOwn) {
    // A thick shell: a cavity's fronts look into it.
    Scene scene = emptyScene();
    Mesh shell = boxMesh(3, kStone), cavity = boxMesh(2, kStone);
    turnInsideOut(cavity);
    for (const uint32_t i : cavity.indices) shell.indices.push_back(i + 8);
    shell.positions.insert(shell.positions.end(), cavity.positions.begin(), cavity.positions.end());
    shell.primitives = {{0, 24, kStone}};
    addObject(scene, shell);
    addObject(scene, boxMesh(1, kStone));
    EXPECT_EQ(countsOf(scene), (Counts{12, 12})) << "the cavity's sides as well";
}

/// Where a ray from outside meets a triangle; its fronts alone, unless both sides are drawn.
std::optional<double> meet(const glm::dvec3& from, const glm::dvec3& along, const std::array<glm::dvec3, 3>& t,
                           bool both_sides) {
    const glm::dvec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]);
    const double slope = glm::dot(normal, along);
    if (slope == 0 || (slope > 0 && !both_sides)) return std::nullopt;
    const double s = glm::dot(normal, t[0] - from) / slope;
    const glm::dvec3 p = from + s * along;
    for (int k = 0; k < 3; ++k)
        if (glm::dot(glm::cross(t[(k + 1) % 3] - t[k], p - t[k]), normal) < 0) return std::nullopt;
    return s > 0 ? std::optional(s) : std::nullopt;
}

/// Every triangle of the world with what it hides.
struct Placed {
    std::array<glm::dvec3, 3> corners;
    bool hides = false, both_sides = false;
};

std::vector<std::vector<Placed>> placedTriangles(const Scene& scene) {
    std::vector<std::vector<Placed>> out;
    for (const SceneObject& object : scene.objects) {
        const Mesh& mesh = scene.meshes[object.mesh];
        const bool mirrored = glm::determinant(glm::dmat3(object.transform)) < 0;
        std::vector<Placed>& of_object = out.emplace_back();
        for (const Primitive& primitive : mesh.primitives)
            for (uint32_t t = primitive.first_triangle; t < primitive.first_triangle + primitive.triangle_count; ++t) {
                Placed placed;
                for (uint32_t k = 0; k < 3; ++k)
                    placed.corners[mirrored ? 2 - k : k] =
                        object.transform * glm::dvec4(glm::dvec3(mesh.positions[mesh.indices[3 * t + k]]), 1);
                placed.hides = scene.materials[primitive.material].hides() && !mesh.deforms;
                placed.both_sides = scene.materials[primitive.material].double_sided;
                of_object.push_back(placed);
            }
    }
    return out;
}

/// How many of so many rays from outside to each encased triangle arrive.
size_t raysThatArrive(const Scene& scene, Random& random, size_t rays, size_t& asked) {
    const Encased encased = encasedTriangles(scene);
    const std::vector<std::vector<Placed>> world = placedTriangles(scene);
    const Box3d box = worldBounds(scene);
    const double far = 2 * glm::length(box.size());
    size_t arrived = 0;
    for (size_t i = 0; i < encased.triangles.size(); ++i)
        for (const uint32_t t : encased.triangles[i])
            for (size_t r = 0; r < rays; ++r) {
                const auto& corners = world[i][t].corners;
                double a = random.uniform(), b = random.uniform();
                if (a + b > 1) a = 1 - a, b = 1 - b;
                const glm::dvec3 target = corners[0] + a * (corners[1] - corners[0]) + b * (corners[2] - corners[0]);
                const glm::dvec3 way = randomUnit(random);
                const glm::dvec3 eye = target + far * way;
                bool hidden = false;
                for (const auto& of_object : world)
                    for (const Placed& placed : of_object) {
                        if (!placed.hides) continue;
                        const std::optional<double> s = meet(eye, -way, placed.corners, placed.both_sides);
                        hidden |= s && *s < far * (1 - 1e-9);
                    }
                ++asked;
                arrived += !hidden;
            }
    return arrived;
}

glm::dmat4 anyTransform(Random& random) {
    glm::dmat4 m(1.0);
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row) m[column][row] = 2 * random.uniform() - 1;
    m[3] = {4 * random.uniform() - 2, 4 * random.uniform() - 2, 4 * random.uniform() - 2, 1};
    return m;
}

TEST(Encased, NoRayFromOutsideArrives) {
    size_t asked = 0, scenes = 0;
    for (uint64_t seed = 1; seed <= 300; ++seed) {
        Random random(seed);
        Scene scene = emptyScene();
        for (uint64_t left = 4 + random.below(12); left > 0; --left) {
            const bool whole = random.below(4) > 0;
            Mesh mesh = boxMesh(0.2 + 3 * random.uniform(), static_cast<uint32_t>(random.below(3)),
                                whole ? 12 : static_cast<uint32_t>(1 + random.below(11)));
            if (random.below(4) == 0) turnInsideOut(mesh);
            addObject(scene, mesh, anyTransform(random));
        }
        const size_t before = asked;
        EXPECT_EQ(raysThatArrive(scene, random, 40, asked), 0u) << "seed " << seed;
        scenes += asked > before;
    }
    EXPECT_GT(scenes, 100u) << "scenes with something within";
}

TEST(Encased, FarFromTheOriginAsNearIt) {
    EXPECT_EQ(boxInBox(boxMesh(2, kStone), at(1e5, -3e5, 0), at(1e5, -3e5, 0)), (Counts{0, 12}));
    EXPECT_EQ(boxInBox(boxMesh(2, kStone), at(1e7, 0, 0), at(1e7, 0, 0)), (Counts{0, 0}))
        << "a gap of a metre is less than floats can tell there";
}

TEST(Encased, ReportsAndStops) {
    Scene scene = emptyScene();
    for (const double half : {5, 3, 1}) addObject(scene, boxMesh(half, kStone));
    std::vector<size_t> told;
    encasedTriangles(scene, [&](size_t done, size_t total) {
        EXPECT_EQ(total, 3u);
        told.push_back(done);
        return done < 1;
    });
    EXPECT_EQ(told, (std::vector<size_t>{0, 1}));
    EXPECT_TRUE(encasedTriangles(emptyScene()).triangles.empty());
}

class EncasedScenes : public SceneTest {};

TEST_P(EncasedScenes, AreReachedByNoRayFromOutside) {
    const Encased encased = encasedTriangles(*scene);
    size_t total = 0;
    for (const auto& triangles : encased.triangles) total += triangles.size();
    // A robot's shells hold its works: that nothing is found there would be a fault, and no reason to skip.
    if (GetParam() == std::string("gazebo-pr2")) { EXPECT_GT(total, 1000u); }
    if (total == 0) GTEST_SKIP() << "no closed surface of this scene has anything within";
    const RayProbe probe(*scene);
    const Box3d box = worldBounds(*scene);
    const double reach = glm::length(box.size());
    Random random(5);
    size_t reached = 0, first = 0, met = 0;
    for (uint64_t ray = 0; ray < casesToMake(100'000); ++ray) {
        // From a sphere around all, half of the rays through points of what is encased.
        glm::dvec3 target = randomIn(random, box);
        if (ray % 2 == 0) {
            size_t pick = random.below(total), object = 0;
            while (pick >= encased.triangles[object].size()) pick -= encased.triangles[object++].size();
            const SceneObject& of = scene->objects[object];
            const Mesh& mesh = scene->meshes[of.mesh];
            const uint32_t triangle = encased.triangles[object][pick];
            glm::dvec3 sum(0);
            for (uint32_t k = 0; k < 3; ++k) sum += glm::dvec3(mesh.positions[mesh.indices[3 * triangle + k]]) / 3.0;
            target = of.transform * glm::dvec4(sum, 1);
        }
        const glm::dvec3 way = randomUnit(random);
        const ProbeRay line{target + reach * way, -way};
        for (double from = 0;;) {
            const std::optional<ProbeHit> hit = probe.nearest(line, from);
            if (!hit) break;
            const auto& triangles = encased.triangles[hit->object];
            reached += std::binary_search(triangles.begin(), triangles.end(), hit->triangle);
            const Mesh& mesh = scene->meshes[scene->objects[hit->object].mesh];
            const Material* material = nullptr;
            for (const Primitive& primitive : mesh.primitives)
                if (hit->triangle >= primitive.first_triangle) material = &scene->materials[primitive.material];
            ++met;
            if (material->hides() && (hit->front || material->double_sided)) {
                ++first;
                break;
            }
            from = hit->t;
        }
    }
    EXPECT_EQ(reached, 0u) << "of " << met << " hits";
    EXPECT_GT(first, 1000u);
}

INSTANTIATE_TEST_SUITE_P(Scenes, EncasedScenes, kSmallScenes, sceneLabel);

}  // namespace
}  // namespace sightline::test
