// On real scenes the two witnesses bear each other out.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdio>
#include <filesystem>

#include <gtest/gtest.h>

#include "sightline/tools/import/gltf/gltf.h"
#include "sightline/tools/truth/verify.h"
#include "tests/support/shared_scenes.h"
#include "tests/tools/truth/scene_views.h"

namespace sightline {
using namespace tools;
namespace {

TEST(RealScenes, WitnessesAgree) {
    const std::vector<std::filesystem::path> files = test::sharedFiles("scenes", ".glb");
    if (files.empty()) GTEST_SKIP() << "no scenes beside the repository";
    for (const std::filesystem::path& file : files) {
        const Result<Scene> scene = loadGltf(file.string());
        ASSERT_TRUE(scene.ok()) << scene.error().message;
        const Witness witness(*scene);
        for (const View& view : test::viewsOf(worldBounds(*scene), 1)) {
            WitnessSettings rays, ids;
            rays.rays = 100000;
            rays.supersampling = 0;
            ids.rays = 0;
            const std::vector<uint8_t> none(scene->objects.size(), 0), all(scene->objects.size(), 1);
            const FrameVerdict by_rays = witness.judge(view, none, rays), by_ids = witness.judge(view, none, ids);
            // Everything culled: each sighting must be borne out by the exact test.
            const FrameVerdict ray_alarms = witness.judge(view, all, rays), id_alarms = witness.judge(view, all, ids);
            uint64_t rays_alone = 0, ids_alone = 0, lost = 0;
            for (size_t i = 0; i < none.size(); ++i) {
                rays_alone += by_rays.seen[i] && !by_ids.seen[i];
                ids_alone += by_ids.seen[i] && !by_rays.seen[i];
                lost += by_ids.seen[i] && !id_alarms.seen[i];
            }
            std::printf(
                "%-28s %5zu objects, seen by rays %5zu, by ids %5zu, by rays alone %3zu, by ids alone %3zu, "
                "unconfirmed rays %zu, ids %zu\n",
                file.filename().c_str(), none.size(), size_t(by_rays.exactly_visible), size_t(by_ids.exactly_visible),
                size_t(rays_alone), size_t(ids_alone), size_t(ray_alarms.unconfirmed), size_t(id_alarms.unconfirmed));
            EXPECT_LE(lost, 1 + by_ids.exactly_visible / 100) << file;
            EXPECT_LE(rays_alone, 3 + by_ids.exactly_visible / 20) << file;
            EXPECT_GE(ray_alarms.exactly_visible + 3 + by_rays.exactly_visible / 20, by_rays.exactly_visible) << file;
        }
    }
}

}  // namespace
}  // namespace sightline
