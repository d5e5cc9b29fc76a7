// Made scenes are what their names say: geometry that is hard in just one way.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/procedural.h"

#include <cmath>
#include <limits>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace sightline {
using namespace tools;
namespace {

Scene made(std::string_view name) {
    std::optional<Scene> scene = makeMadeScene(name);
    EXPECT_TRUE(scene.has_value()) << name;
    return scene ? std::move(*scene) : Scene();
}

/// The distance at which a ray from the origin meets the object, or infinity.
double distanceTo(const Mesh& mesh, const glm::dvec3& direction) {
    for (size_t t = 0; t < mesh.indices.size(); t += 3) {
        const glm::dvec3 a(mesh.positions[mesh.indices[t]]), b(mesh.positions[mesh.indices[t + 1]]),
            c(mesh.positions[mesh.indices[t + 2]]);
        const double u = glm::dot(direction, glm::cross(b, c)), v = glm::dot(direction, glm::cross(c, a)),
                     w = glm::dot(direction, glm::cross(a, b));
        if (!((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0)) || u + v + w == 0) continue;
        const double distance = glm::dot(a, glm::cross(b, c)) / (u + v + w);
        if (distance > 0) return distance;
    }
    return std::numeric_limits<double>::infinity();
}

/// Which of two objects is in front of the other anywhere, by rays over the image: bit 0 the first, bit 1 the second.
int whoIsInFront(const Scene& scene, size_t first, size_t second) {
    int seen = 0;
    for (int row = -120; row <= 120; ++row)
        for (int column = -160; column <= 160; ++column) {
            const glm::dvec3 direction(0.0045 * column + 1e-5, 0.0045 * row + 2e-5, -1);
            const double a = distanceTo(scene.meshes[first], direction),
                         b = distanceTo(scene.meshes[second], direction);
            if (std::isinf(a) || std::isinf(b)) continue;
            if (a < b) seen |= 1;
            if (b < a) seen |= 2;
        }
    return seen;
}

TEST(Made, HasScenesWithAnObjectAColourAndAKeyAShape) {
    EXPECT_EQ(madeScenes().size(), 6u);
    for (const MadeScene& entry : madeScenes()) {
        const Scene scene = made(entry.name);
        EXPECT_EQ(scene.name, "made:" + std::string(entry.name));
        EXPECT_GE(scene.objects.size(), 2u) << entry.name;
        EXPECT_EQ(scene.cameras.size(), 1u) << entry.name;
        EXPECT_FALSE(entry.shows.empty()) << entry.name;
        std::set<uint64_t> keys;
        std::set<std::string> colours;
        for (const SceneObject& object : scene.objects) {
            const Mesh& mesh = scene.meshes.at(object.mesh);
            ASSERT_EQ(mesh.primitives.size(), 1u) << entry.name;
            EXPECT_EQ(mesh.primitives[0].triangle_count, mesh.triangles()) << entry.name;
            for (const uint32_t index : mesh.indices) ASSERT_LT(index, mesh.positions.size()) << entry.name;
            for (const glm::vec3& p : mesh.positions)
                for (int axis = 0; axis < 3; ++axis) {
                    EXPECT_GE(double(p[axis]), mesh.bounds.min[axis]) << entry.name;
                    EXPECT_LE(double(p[axis]), mesh.bounds.max[axis]) << entry.name;
                }
            const Material& material = scene.materials.at(mesh.primitives[0].material);
            EXPECT_TRUE(material.double_sided) << entry.name;
            EXPECT_TRUE(material.hides()) << entry.name;
            keys.insert(object.key);
            colours.insert(material.name);
        }
        EXPECT_EQ(keys.size(), scene.objects.size()) << entry.name;
        EXPECT_EQ(colours.size(), scene.objects.size()) << entry.name;
    }
}

TEST(Made, KnowsNoOtherNames) {
    for (const char* name : {"", "circle", "cycle ", "Cycle", "cycle:1"})
        EXPECT_FALSE(makeMadeScene(name).has_value()) << name;
}

TEST(Made, CycleGoesRound) {
    const Scene scene = made("cycle");
    const int first = whoIsInFront(scene, 0, 1);
    EXPECT_TRUE(first == 1 || first == 2) << first;
    EXPECT_EQ(whoIsInFront(scene, 1, 2), first);
    EXPECT_EQ(whoIsInFront(scene, 2, 0), first);
}

TEST(Made, CrossingTrianglesAreEachInFrontOfEachSomewhere) {
    const Scene scene = made("crossing");
    for (size_t i = 0; i < 3; ++i) EXPECT_EQ(whoIsInFront(scene, i, (i + 1) % 3), 3) << i;
}

TEST(Made, CoplanarCornersLieInOnePlaneExactly) {
    for (const Mesh& mesh : made("coplanar").meshes)
        for (const glm::vec3& p : mesh.positions)
            EXPECT_EQ(double(p.z), 0.5 * double(p.x) + 0.25 * double(p.y) - 5) << mesh.name;
}

TEST(Made, NearHasASquareBeyondTheCentresOfItsFloor) {
    const Scene scene = made("near");
    const glm::dmat4 view = glm::inverse(scene.cameras[0].transform);
    const auto depth = [&](const glm::vec3& p) { return -(view * glm::dvec4(glm::dvec3(p), 1)).z; };
    const auto centre = [&](const Mesh& mesh, size_t t) {
        double sum = 0;
        for (size_t k = 0; k < 3; ++k) sum += depth(mesh.positions[mesh.indices[3 * t + k]]) / 3;
        return sum;
    };
    const auto farthest = [&](const Mesh& mesh, size_t t) {
        double most = 0;
        for (size_t k = 0; k < 3; ++k) most = std::max(most, depth(mesh.positions[mesh.indices[3 * t + k]]));
        return most;
    };
    for (size_t floor = 0; floor < 2; ++floor)
        for (size_t square = 0; square < 2; ++square) {
            EXPECT_LT(centre(scene.meshes[0], floor), centre(scene.meshes[1], square));
            EXPECT_GT(farthest(scene.meshes[0], floor), farthest(scene.meshes[1], square));
        }
}

TEST(Made, WallsFillWideImagesFarToNear) {
    const Scene scene = made("walls");
    ASSERT_EQ(scene.objects.size(), 8u);
    const double high = std::tan(0.5 * scene.cameras[0].fov_y), wide = 4 * high;
    for (const glm::dvec3& corner : {glm::dvec3(-wide, -high, -1), glm::dvec3(wide, -high, -1),
                                     glm::dvec3(wide, high, -1), glm::dvec3(-wide, high, -1)}) {
        double last = std::numeric_limits<double>::infinity();
        for (const Mesh& mesh : scene.meshes) {
            const double distance = distanceTo(mesh, corner);
            EXPECT_LT(distance, last) << mesh.name;
            last = distance;
        }
        EXPECT_GT(last, 0.1);
    }
}

TEST(Made, EyeHasCornersOnBothSidesOfTheEyesPlane) {
    for (const Mesh& mesh : made("eye").meshes) {
        EXPECT_GT(mesh.bounds.max.z, 1) << mesh.name;
        EXPECT_LT(mesh.bounds.min.z, -1) << mesh.name;
    }
}

}  // namespace
}  // namespace sightline
