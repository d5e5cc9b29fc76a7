// The city and real scenes cut open: whatever the query culls, no witness sees; and the witnesses know of cuts.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "sightline/base/random.h"
#include "sightline/query/query.h"
#include "sightline/tools/load/load_world.h"
#include "sightline/tools/load/seeded_cameras.h"
#include "sightline/tools/scene/building/building.h"
#include "sightline/tools/scene/camera_path.h"
#include "sightline/tools/scene/city/city.h"
#include "sightline/tools/truth/sight.h"
#include "sightline/tools/truth/verify.h"
#include "test_scenes.h"
#include "tests/support/answers.h"
#include "tests/support/shared_scenes.h"
#include "tests/tools/truth/scene_views.h"

namespace sightline {
using namespace tools;
namespace {

using namespace test;

/// Through a point some way ahead of the eye: now across the view, now along it.
glm::dvec4 randomSection(const CameraFrame& camera, double diagonal, Random& random) {
    const glm::dvec3 ahead = glm::normalize(camera.target - camera.eye);
    const glm::dvec3 n(random.uniform(-1, 1), random.uniform(-0.5, 0.5), random.uniform(-1, 1));
    const glm::dvec3 p = camera.eye + random.uniform(0.01, 0.2) * diagonal * ahead;
    return {n, -glm::dot(n, p)};
}

void expectNothingSeenIsCulled(const Scene& scene, uint64_t frames) {
    LoadSettings settings;
    settings.inner = true;
    settings.volumes = true;
    LoadedWorld loaded = loadWorld(scene, {}, settings);
    const Snapshot now = loaded.world.commit();
    const Witness witness(scene);
    const double diagonal = glm::length(worldBounds(scene).size());
    Query query;
    Random random(3);
    uint64_t occluded = 0, wrong_without = 0;
    const CameraPath path = seededCameras(scene, static_cast<uint32_t>(frames), 3);
    for (uint64_t frame = 0; frame < frames; ++frame) {
        const CameraFrame& camera = path.frames[frame];
        View view = makeView(camera, 320, 180);
        QuerySettings settings;
        WitnessSettings looks{.rays = 20000, .aimed_rays = 10000, .supersampling = 2, .prove = true};
        query.visible(now, view, settings);
        const std::vector<uint8_t> whole = reasonsOf(query, now);
        for (uint64_t i = 0, planes = 1 + random.below(2); i < planes; ++i)
            view.sections.add(randomSection(camera, diagonal, random));
        settings.stages = frame % 3 == 0 ? kAllStages : kDefaultStages;
        settings.bins = frame % 4 == 1 ? 3 : 1;
        occluded += query.visible(now, view, settings).stats.stages[static_cast<int>(Stage::kOcclusion)].culled;
        expectNoFalseCulls(witness, view, reasonsOf(query, now), looks,
                           scene.name + ", frame " + std::to_string(frame));
        wrong_without += witness.judge(view, whole, looks).false_culls.size();
    }
    EXPECT_GT(occluded, 0u) << scene.name;
    EXPECT_GT(wrong_without, 0u) << scene.name << ": the answers of the world that is not cut must be wrong";
}

TEST(SectionScenes, OfTheCityHideNothingThatIsSeen) { expectNothingSeenIsCulled(makeCity(1, 3000), 8); }

TEST(SectionScenes, OfABuildingHideNothingThatIsSeen) { expectNothingSeenIsCulled(makeBuilding(1, 2), 8); }

using SectionScenes = test::SceneTest;

TEST_P(SectionScenes, HideNothingThatIsSeen) { expectNothingSeenIsCulled(*scene, 6); }

INSTANTIATE_TEST_SUITE_P(Scenes, SectionScenes,
                         testing::Values("bimwhale-tall-building", "bsi-duplex", "2CylinderEngine", "aws-small-house"));

/// A closed box with a square in it, and an eye outside.
TEST(WitnessSections, SeeWhatACutLaysOpenAndNothingBeyondIt) {
    Scene scene = emptyScene();
    addObject(scene, addBox(scene, glm::vec3(2)), moved({0, 0, -10}));
    addObject(scene, addSquare(scene, 0.5f), moved({0, 0, -10}));
    addObject(scene, addSquare(scene, 0.5f), moved({1, 0, -5}));
    View view;
    view.width = 320;
    view.height = 240;
    view.projection = perspective(1.0, 4.0 / 3, 0.1);
    const Witness witness(scene);
    const std::vector<uint8_t> all(3, 1);
    const auto seen = [&](uint64_t rays, uint32_t samples) {
        return witness.judge(view, all, {.rays = rays, .aimed_rays = rays / 2, .supersampling = samples}).seen;
    };
    for (const auto& [rays, samples] : {std::pair<uint64_t, uint32_t>{20000, 0}, {0, 2}}) {
        view.sections = {};
        EXPECT_EQ(seen(rays, samples), (std::vector<uint8_t>{1, 0, 1}));
        view.sections.add({0, 0, -1, -9});  // z <= -9: the front of the box is gone, and what stands before it
        EXPECT_EQ(seen(rays, samples), (std::vector<uint8_t>{0, 1, 0})) << "the box's other faces are seen from behind";
        view.sections = {};
        view.sections.add({0, 0, 2, 18});  // z >= -9
        EXPECT_EQ(seen(rays, samples), (std::vector<uint8_t>{1, 0, 1}));
        view.sections.add({0, 0, -1, -5.5});  // z <= -5.5
        EXPECT_EQ(seen(rays, samples), (std::vector<uint8_t>{1, 0, 0}));
        view.sections.add({0, 0, 0, -1});
        EXPECT_EQ(seen(rays, samples), (std::vector<uint8_t>{0, 0, 0}));
        view.sections = {};
        if (rays == 0) continue;  // the id-buffer tells of one place of each object, which may lie beside the window
        view.window.add({1, 0, 0, -0.75});  // x >= 0.75
        EXPECT_EQ(seen(rays, samples), (std::vector<uint8_t>{1, 0, 1}));
        view.window.add({0, 0, -1, -6});  // z <= -6
        EXPECT_EQ(seen(rays, samples), (std::vector<uint8_t>{1, 0, 0}));
        view.window = {};
    }
}

TEST(WitnessSections, EndLinesOfSight) {
    Random random(4);
    int shown = 0;
    for (int i = 0; i < 8000; ++i) {
        View view;
        view.projection = i % 2 ? perspective(1.0, 1.5, 0.1) : orthographic(20, 1.5, 1, 40);
        const glm::dvec3 eye(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9));
        view.view = lookAt(eye, eye + glm::dvec3(random.uniform(-1, 1), random.uniform(-1, 1), 2), {0, 1, 0});
        for (int k = 0; k < 3; ++k)
            view.sections.add(
                {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-9, 9)});
        View whole = view;
        whole.sections = {};
        const glm::dvec3 point(random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(-40, 40));
        glm::dvec2 place;
        if (!SightLines(whole).project(point, place)) continue;
        double inside = 1e9;
        for (const glm::dvec4& plane : view.sections.all())
            inside = std::min(inside, glm::dot(plane, glm::dvec4(eye + point, 1)));
        if (std::abs(inside) < 1e-9) continue;
        const SightRay ray = SightLines(view).rayThrough(place);
        const double t = glm::dot(point - ray.origin, ray.direction);
        ASSERT_EQ(inside > 0, t >= ray.t_near && t <= ray.t_far) << "case " << i;
        ASSERT_EQ(inside > 0, SightLines(view).project(point, place)) << "case " << i;
        shown += inside > 0;
        Box3d box;
        box.grow(eye + point);
        if (inside > 0) { ASSERT_TRUE(SightLines(view).touches(box)); }
    }
    EXPECT_GT(shown, 50);
}

}  // namespace
}  // namespace sightline
