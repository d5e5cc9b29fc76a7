// The scene of a recorded frame: objects as they stood, what hides and what may be seen of each, and the camera.
// SPDX-License-Identifier: MIT
#include "sightline/tools/load/recorded_scene.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sightline/tools/scene/camera_path.h"
#include "tests/query/made_recording.h"

namespace sightline::tools {
namespace {

TEST(RecordedScene, HasTheObjectsAsTheyStood) {
    for (uint64_t seed = 1; seed <= 6; ++seed) {
        const FrameRecording recording = test::recordOf(seed);
        const Scene scene = recordedScene(recording);
        ASSERT_EQ(scene.objects.size(), recording.objects.size());
        size_t hiding = 0, shaped = 0;
        for (size_t i = 0; i < scene.objects.size(); ++i) {
            const ObjectDef& from = recording.objects[i];
            const Mesh& mesh = scene.meshes[scene.objects[i].mesh];
            EXPECT_EQ(scene.objects[i].key, from.key);
            EXPECT_EQ(scene.objects[i].transform, from.transform);
            size_t hides = 0;
            for (const Primitive& primitive : mesh.primitives)
                if (scene.materials[primitive.material].hides()) hides += primitive.triangle_count;
            hiding += hides > 0;
            const bool is_box = from.shape.index == 0;
            shaped += !is_box;
            const uint32_t form = from.occluder.index;
            EXPECT_EQ(hides, form ? recording.forms[form - 1].occluder.triangleCount() : 0u);
            EXPECT_EQ(mesh.triangles(), hides + (is_box ? 12
                                                 : from.shape == from.occluder
                                                     ? 0
                                                     : recording.forms[from.shape.index - 1].occluder.triangleCount()));
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_GE(mesh.bounds.min[axis], from.bounds.min[axis]);
                EXPECT_LE(mesh.bounds.max[axis], from.bounds.max[axis]);
            }
        }
        EXPECT_GT(hiding, 20u);
        EXPECT_EQ(shaped > 20, seed % 2 == 0);
        EXPECT_LT(scene.meshes.size(), 10u) << "objects of one form share a mesh";
    }
}

// A box whose corners are no floats is drawn within itself: else a corner that no query need keep would be seen.
TEST(RecordedScene, DrawsBoxesWithinTheirBounds) {
    World world;
    ObjectDef def;
    def.bounds = {glm::dvec3(-1.1, 1.0 + 1e-9, 0.1), glm::dvec3(-0.9, 1.0 + 1e-9, 1e300)};
    world.add(def);
    def.bounds = {glm::dvec3(-0.1, -1.1, -7.3), glm::dvec3(0.3, 0.7, -5.1)};
    world.add(def);
    const Result<FrameRecording> recording = recordFrame(world.commit(), View());
    ASSERT_TRUE(recording.ok());
    const Scene scene = recordedScene(*recording);
    const Box3d &bounds = scene.meshes.back().bounds, &asked = recording->objects.back().bounds;
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GE(bounds.min[axis], asked.min[axis]);
        EXPECT_LE(bounds.max[axis], asked.max[axis]);
        EXPECT_NEAR(bounds.min[axis], asked.min[axis], 1e-6);
        EXPECT_NEAR(bounds.max[axis], asked.max[axis], 1e-6);
    }
}

TEST(RecordedScene, LooksAsTheRecordedCameraDid) {
    FrameRecording recording;
    recording.view.view = lookAt({3, 4, 5}, {0, 1, -2}, {0, 1, 0});
    for (const double far : {100.0, double(INFINITY)})
        for (const bool parallel : {false, true}) {
            recording.view.projection =
                parallel ? orthographic(7, 16.0 / 9, 0.25, far) : perspective(1.1, 16.0 / 9, 0.25, far);
            const SceneCamera camera = recordedScene(recording).cameras.at(0);
            EXPECT_NEAR(camera.z_near, 0.25, 1e-9);
            EXPECT_NEAR(camera.orthographic_height, parallel ? 7 : 0, 1e-9);
            EXPECT_NEAR(camera.fov_y, parallel ? 0 : 1.1, 1e-9);
            if (std::isfinite(far)) { EXPECT_NEAR(camera.z_far.value_or(0), far, 1e-6); }
            EXPECT_LT(glm::length(glm::dvec3(camera.transform[3]) - glm::dvec3(3, 4, 5)), 1e-9);
        }
}

}  // namespace
}  // namespace sightline::tools
