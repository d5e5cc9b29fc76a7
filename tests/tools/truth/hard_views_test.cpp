// Views chosen to hurt, on real scenes and the city: whatever the query culls, no witness sees, and is proved to be hidden.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include "sightline/base/random.h"
#include "sightline/base/sanitized.h"
#include "sightline/query/query.h"
#include "sightline/tools/load/load_world.h"
#include "sightline/tools/load/seeded_cameras.h"
#include "sightline/tools/scene/city/city.h"
#include "sightline/tools/truth/verify.h"
#include "tests/support/answers.h"
#include "tests/support/shared_scenes.h"
#include "tests/support/views.h"
#include "tests/tools/truth/scene_views.h"

namespace sightline {
using namespace tools;
namespace {

struct NamedView {
    std::string name;
    View view;
};

std::vector<NamedView> hardViews(const Scene& scene, uint64_t seed) {
    Random random(seed);
    const double diagonal = glm::length(worldBounds(scene).size()), z_near = 5e-4 * diagonal;
    const SceneObject& object = scene.objects[random.below(scene.objects.size())];
    const glm::dvec3 inside = transformBox(scene.meshes[object.mesh].bounds, object.transform).center();
    const CameraFrame camera = seededCameras(scene, 1, seed).frames[0];
    const glm::dvec3 eye = camera.eye, ahead = glm::normalize(camera.target - camera.eye);
    std::vector<NamedView> views;
    views.push_back({"inside a bound", test::viewFrom(inside, ahead, {60, 320, 180, z_near})});
    views.push_back({"1 degree", test::viewFrom(eye, ahead, {1, 320, 180, z_near})});
    views.push_back({"150 degrees", test::viewFrom(eye, ahead, {150, 320, 180, z_near})});
    views.push_back({"near plane through objects", test::viewFrom(eye, ahead, {60, 320, 180, 0.05 * diagonal})});
    views.push_back({"1x1", test::viewFrom(eye, ahead, {60, 1, 1, z_near})});
    views.push_back({"4096x2160", test::viewFrom(eye, ahead, {60, 4096, 2160, z_near})});
    // Against the surface that the camera stands off: a vertex of the object, a thousandth of the diagonal away.
    const Mesh& mesh = scene.meshes[object.mesh];
    const glm::dvec3 vertex(object.transform *
                            glm::dvec4(glm::dvec3(mesh.positions[random.below(mesh.positions.size())]), 1));
    views.push_back(
        {"against a wall", test::viewFrom(vertex - 1e-3 * diagonal * ahead, ahead, {60, 320, 180, 1e-5 * diagonal})});
    views.push_back(
        {"along a silhouette", test::viewFrom(vertex - 0.05 * diagonal * ahead, ahead, {20, 320, 180, z_near})});
    for (const double z_far : {2.0 * diagonal, std::numeric_limits<double>::infinity()}) {
        View parallel = test::viewFrom(eye, ahead, {60, 320, 180, z_near});
        parallel.projection = orthographic(0.2 * diagonal, 16.0 / 9.0, z_near, z_far);
        views.push_back({"orthographic", parallel});
    }
    View shifted = test::viewFrom(eye, ahead, {60, 320, 180, z_near});
    shifted.projection[2][0] = 0.6;
    shifted.projection[2][1] = -0.3;
    views.push_back({"off-centre", shifted});
    return views;
}

void expectNothingSeenIsCulled(const Scene& scene, uint64_t rounds) {
    ASSERT_FALSE(scene.objects.empty());
    const bool full = std::getenv("SIGHTLINE_FULL") != nullptr;
    LoadedWorld loaded = loadWorld(scene);
    const Snapshot now = loaded.world.commit();
    const Witness witness(scene);
    Query query;
    for (uint64_t seed = 1; seed <= (full ? 4 * rounds : rounds); ++seed)
        for (const NamedView& named : hardViews(scene, seed)) {
            query.visible(now, named.view);
            WitnessSettings settings{.rays = full ? 1000000u : 20000u};
            settings.prove = true;
            settings.aimed_rays = settings.rays / 2;
            settings.supersampling = named.view.width > 1000 && !full ? 0 : named.view.width == 1 ? 32 : 2;
            test::expectNoFalseCulls(witness, named.view, test::reasonsOf(query, now), settings,
                                     scene.name + ", " + named.name + ", seed " + std::to_string(seed));
        }
}

/// The whole scene elsewhere: what floats around the origin would blur.
Scene movedBy(Scene scene, double distance) {
    for (SceneObject& object : scene.objects) object.transform[3] += glm::dvec4(distance, -distance, distance, 0);
    scene.name += " moved";
    return scene;
}

TEST(HardViews, OfTheCityHideNothingThatIsSeen) {
    const Scene city = makeCity(1, 3000);
    expectNothingSeenIsCulled(city, 1);
    expectNothingSeenIsCulled(movedBy(city, 1e6), 1);
}

using HardViews = test::SceneTest;

TEST_P(HardViews, OfARealSceneHideNothingThatIsSeen) {
    expectNothingSeenIsCulled(*scene, 1);
    // Far off other numbers run through the same code: sanitizers would see it twice.
    if (!kSanitized) expectNothingSeenIsCulled(movedBy(*scene, 1e6), 1);
}

INSTANTIATE_TEST_SUITE_P(Scenes, HardViews,
                         testing::Values("bimwhale-tall-building", "dense-spot", "aws-small-house", "bsi-duplex",
                                         "gazebo-willowgarage", "sauer-pandora", "2CylinderEngine", "gazebo-pr2",
                                         "cityjson-vienna", "redeclipse-auster", "polyhaven-dutch-ship",
                                         "playcanvas-cave", "nibs-clinic-mep"));

}  // namespace
}  // namespace sightline
