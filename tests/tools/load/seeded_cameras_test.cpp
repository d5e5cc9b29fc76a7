// Seeded cameras are the same everywhere, stand where a visitor could, and look at something.
// SPDX-License-Identifier: MIT
#include "sightline/tools/load/seeded_cameras.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>

#include <gtest/gtest.h>

#include "sightline/base/random.h"
#include "sightline/tools/scene/city/city.h"

namespace sightline {
using namespace tools;
namespace {

bool same(const CameraPath& a, const CameraPath& b) {
    return std::equal(a.frames.begin(), a.frames.end(), b.frames.begin(), b.frames.end(),
                      [](const CameraFrame& p, const CameraFrame& q) {
                          return p.eye == q.eye && p.target == q.target && p.z_near == q.z_near;
                      });
}

/// The share of an image's rays that meet a front, or either side of what is double-sided.
double frontShare(const Scene& scene, const RayProbe& probe, const CameraFrame& frame) {
    constexpr int kWide = 32, kHigh = 18;
    const View view = makeView(frame, kWide, kHigh);
    const glm::dmat4 inverse = glm::inverse(view.projection * view.view);
    int good = 0;
    for (int i = 0; i < kWide * kHigh; ++i) {
        const int column = i % kWide, row = i / kWide;
        const glm::dvec4 p = inverse * glm::dvec4((column + 0.5) / kWide * 2 - 1, (row + 0.5) / kHigh * 2 - 1, -1, 1);
        const auto hit = probe.nearest({frame.eye, glm::dvec3(p) / p.w - frame.eye});
        if (!hit) continue;
        bool drawn = hit->front;
        for (const Primitive& primitive : scene.meshes[scene.objects[hit->object].mesh].primitives)
            if (hit->triangle - primitive.first_triangle < primitive.triangle_count)
                drawn = drawn || scene.materials[primitive.material].double_sided;
        good += drawn;
    }
    return static_cast<double>(good) / (kWide * kHigh);
}

Scene oneTriangle() {
    Scene scene;
    scene.materials.resize(1);
    Mesh& mesh = scene.meshes.emplace_back();
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.indices = {0, 1, 2};
    mesh.primitives = {{0, 1, 0}};
    for (const glm::vec3& p : mesh.positions) mesh.bounds.grow(glm::dvec3(p));
    scene.objects.resize(1);
    return scene;
}

TEST(SeededCameras, AreDeterministicAndFinite) {
    for (const uint32_t objects : {200u, 3000u}) {
        const Scene scene = makeCity(1, objects);
        const CameraPath path = seededCameras(scene, 24, 5);
        ASSERT_EQ(path.frames.size(), 24u);
        EXPECT_TRUE(same(path, seededCameras(scene, 24, 5)));
        EXPECT_FALSE(same(path, seededCameras(scene, 24, 6)));
        for (size_t i = 0; i < path.frames.size(); ++i) {
            const CameraFrame& frame = path.frames[i];
            EXPECT_TRUE(isUsable(makeView(frame, 1280, 720))) << "frame " << i;
            EXPECT_EQ(frame.fov_y_degrees, 60);
            EXPECT_FALSE(frame.z_far.has_value());
            EXPECT_LE(frame.z_near, 0.1);
            const glm::dvec3 look = glm::normalize(frame.target - frame.eye);
            EXPECT_LE(std::abs(look.y), 0.5 + 1e-9) << "frame " << i;
        }
        CameraPath start = seededCameras(scene, 7, 5);
        EXPECT_TRUE(std::equal(start.frames.begin(), start.frames.end(), path.frames.begin(),
                               [](const CameraFrame& a, const CameraFrame& b) { return a.eye == b.eye; }))
            << "fewer frames are the beginning of more";
    }
}

TEST(SeededCameras, ArePinned) {
    const CameraPath path = seededCameras(makeCity(1, 3000), 4, 1);
    EXPECT_EQ(path.frames[3].eye, glm::dvec3(-84.286976304046, 10.340037004472514, -153.6678964774425));
    EXPECT_EQ(path.frames[3].target, glm::dvec3(-94.06088790770703, 9.403009569680549, -155.56332032193413));
}

TEST(SeededCameras, MostRaysMeetFrontFaces) {
    const Scene scene = makeCity(2, 5000);
    const RayProbe probe(scene);
    const CameraPath path = seededCameras(scene, 32, 3);
    double sum = 0;
    for (size_t i = 0; i < path.frames.size(); ++i) {
        const double share = frontShare(scene, probe, path.frames[i]);
        EXPECT_GT(share, 0.35) << "city:2:5000, seed 3, frame " << i;
        sum += share;
    }
    EXPECT_GT(sum / static_cast<double>(path.frames.size()), 0.5);
}

TEST(SeededCameras, FollowTheSceneFarFromTheOrigin) {
    Scene scene = makeCity(2, 1000);
    const CameraPath near = seededCameras(scene, 8, 1);
    const glm::dvec3 shift(1e6, -2e6, 3e6);
    for (SceneObject& object : scene.objects) object.transform[3] += glm::dvec4(shift, 0);
    const CameraPath far = seededCameras(scene, 8, 1);
    for (size_t i = 0; i < near.frames.size(); ++i)
        EXPECT_LT(glm::length(far.frames[i].eye - near.frames[i].eye - shift), 1e-3) << "frame " << i;
}

TEST(SeededCameras, ChooseSurfacesByArea) {
    // Two squares that face each other's half space; the larger, by its transform alone, has nine tenths of the area.
    Scene scene;
    scene.materials.resize(1);
    Mesh& mesh = scene.meshes.emplace_back();
    mesh.positions = {{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}};
    mesh.indices = {0, 1, 2, 0, 2, 3};
    mesh.primitives = {{0, 2, 0}};
    for (const glm::vec3& p : mesh.positions) mesh.bounds.grow(glm::dvec3(p));
    scene.objects.resize(2);
    scene.objects[0].transform[0] *= 9.0;
    scene.objects[1].transform[3] = {100, 0, 0, 1};
    const CameraPath path = seededCameras(scene, 400, 1);
    int at_large = 0;
    for (const CameraFrame& frame : path.frames) at_large += frame.eye.x < 50;
    EXPECT_NEAR(at_large, 360, 30);
}

TEST(SeededCameras, TheWishFadesWhereItCannotBeMet) {
    const CameraPath path = seededCameras(oneTriangle(), 5, 1);
    ASSERT_EQ(path.frames.size(), 5u);
    for (const CameraFrame& frame : path.frames) {
        EXPECT_TRUE(isUsable(makeView(frame, 10, 10)));
        EXPECT_GT(frame.eye.z, 0.003 * std::sqrt(2) * 0.999);
        EXPECT_LT(frame.eye.z, 0.06 * std::sqrt(2) * 1.001);
        EXPECT_NEAR(frame.z_near, 0.0005 * std::sqrt(2), 1e-12);
    }
}

TEST(SeededCameras, MirroredSurfacesAreSeenFromTheirFront) {
    Scene scene = oneTriangle();
    scene.objects[0].transform[0] *= -1.0;  // mirrored, the front still faces +z
    for (const CameraFrame& frame : seededCameras(scene, 5, 1).frames) EXPECT_GT(frame.eye.z, 0);
    scene.objects[0].transform[2] *= -1.0;  // turned about y, it faces -z
    for (const CameraFrame& frame : seededCameras(scene, 5, 1).frames) EXPECT_LT(frame.eye.z, 0);
}

TEST(SeededCameras, SceneWithoutTrianglesIsSeenFromTheOrigin) {
    Scene scene;
    const CameraPath empty = seededCameras(scene, 3, 1);
    ASSERT_EQ(empty.frames.size(), 3u);
    for (const CameraFrame& frame : empty.frames) {
        EXPECT_TRUE(isUsable(makeView(frame, 10, 10)));
        EXPECT_NEAR(glm::length(frame.eye), 1, 1e-9);
    }
    scene = oneTriangle();
    scene.objects[0].transform = glm::dmat4(0);  // flattened to a point
    for (const CameraFrame& frame : seededCameras(scene, 3, 1).frames) EXPECT_TRUE(isUsable(makeView(frame, 10, 10)));
}

}  // namespace
}  // namespace sightline
