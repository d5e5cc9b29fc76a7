// Shadows of the city and of real scenes are where rays to the sun say.
// SPDX-License-Identifier: MIT
#include <filesystem>

#include <gtest/gtest.h>

#include "sightline/tools/import/gltf/gltf.h"
#include "sightline/tools/load/seeded_cameras.h"
#include "sightline/tools/report/pictures/render_list.h"
#include "sightline/tools/report/run/render_run.h"
#include "sightline/tools/scene/city/city.h"
#include "sightline/tools/scene/procedural.h"
#include "tests/studies/hidden/shade/shadow_rays.h"

namespace sightline {
using namespace studies;
using namespace tools;
namespace {

/// Asks every seventh pixel of a frame.
void expectSoundShadows(const Scene& scene, const CameraFrame& camera, size_t frame) {
    const View view = makeView(camera, 160, 90);
    const RenderList list(scene, view);
    const HiddenImage image = plainZBuffer(list.list(), view, {});
    const SurfacePoints points(list.list(), view);
    ShadowSettings settings;
    settings.sun = defaultSun();
    settings.size = 512;
    const ShadowMap map(list.casters(), points, image, settings);
    const test::SunRays rays(list.casters(), points.eye(), settings.sun);
    size_t asked = 0, lit = 0, verdicts[4] = {};
    for (uint32_t at = 0; at < image.surface.size(); at += 7) {
        if (image.surface[at] == HiddenImage::kNone) continue;
        const SurfacePoint point = points.at(at / view.width, at % view.width, image.surface[at]);
        const double facing = glm::dot(point.normal, settings.sun);
        if (facing < 0.1) continue;
        ++asked;
        lit += map.reach(point) == 1;
        ++verdicts[static_cast<int>(test::judgeShadow(map, rays, point, facing))];
    }
    const auto count = [&](test::ShadowVerdict verdict) { return verdicts[static_cast<int>(verdict)]; };
    std::printf("%s frame %zu: %zu points face the sun, %zu in the light; %zu as rays say, %zu at edges and contacts\n",
                scene.name.c_str(), frame, asked, lit, count(test::ShadowVerdict::kAgrees),
                count(test::ShadowVerdict::kExplained));
    EXPECT_EQ(count(test::ShadowVerdict::kDarkInTheLight), 0u) << scene.name << " frame " << frame;
    EXPECT_EQ(count(test::ShadowVerdict::kLightInTheShadow), 0u) << scene.name << " frame " << frame;
}

TEST(RenderShadows, OfACityAreWhereRaysSay) {
    const Result<Scene> scene = makeProcedural("city:1:2000");
    ASSERT_TRUE(scene.ok());
    const CameraPath path = cityStreetPath(1, 6);
    for (size_t i = 0; i < path.frames.size(); ++i) expectSoundShadows(*scene, path.frames[i], i);
}

TEST(RenderShadows, OfRealScenesAreWhereRaysSay) {
    size_t seen = 0;
    for (const char* name :
         {"bsi-duplex", "cityjson-vienna", "gazebo-willowgarage", "sauer-pandora", "polyhaven-dutch-ship"}) {
        const std::string file = SIGHTLINE_SHARED_DIR "/scenes/" + std::string(name) + ".glb";
        if (!std::filesystem::exists(file)) continue;
        const Result<Scene> scene = loadGltf(file);
        ASSERT_TRUE(scene.ok()) << scene.error().message;
        const CameraPath path = seededCameras(*scene, 4, 5);
        for (size_t i = 0; i < path.frames.size(); ++i) expectSoundShadows(*scene, path.frames[i], i);
        ++seen;
    }
    if (seen == 0) GTEST_SKIP() << "no scenes beside the repository";
}

}  // namespace
}  // namespace sightline
