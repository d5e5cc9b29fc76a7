// Simpler occluders inside of dense solids, drawn with a coarse hand: whatever the query culls, no witness sees.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "sightline/base/random.h"
#include "sightline/query/query.h"
#include "sightline/tools/load/load_world.h"
#include "sightline/tools/truth/verify.h"
#include "tests/prepare/occluder/patch_laws.h"
#include "tests/support/answers.h"
#include "tests/support/random.h"
#include "tests/support/views.h"
#include "tests/tools/truth/scene_views.h"

namespace sightline {
using namespace tools;
namespace {

Mesh meshOf(const Soup& soup) {
    Mesh mesh;
    mesh.positions = soup.positions;
    mesh.indices = soup.indices;
    mesh.primitives.push_back({0, static_cast<uint32_t>(soup.indices.size() / 3), 0});
    for (const glm::vec3& p : soup.positions) mesh.bounds.grow(glm::dvec3(p));
    return mesh;
}

/// Dense balls and bowls, turned, stretched and mirrored, some within one another; and many small boxes.
Scene makeStatues(uint64_t seed) {
    Random random(seed);
    Scene scene;
    scene.name = "statues";
    scene.materials.emplace_back();
    Soup bowl = makeBall(seed, 14), box;
    for (glm::vec3& p : bowl.positions) {
        p = glm::normalize(p);
        if (p.y > 0) p.y *= -0.7f;
    }
    box.addBox({-0.1f, -0.1f, -0.1f}, {0.1f, 0.1f, 0.1f});
    scene.meshes = {meshOf(makeBall(seed, 14)), meshOf(bowl), meshOf(box)};
    for (uint64_t i = 0; i < 460; ++i) {
        SceneObject object;
        object.key = i;
        object.mesh = i < 60 ? uint32_t(i % 2) : 2;
        for (int axis = 0; axis < 3; ++axis) {
            object.transform[axis][axis] = random.uniform(0.5, 1.5) * (random.below(4) ? 1 : -1);
            object.transform[axis][(axis + 1) % 3] = random.uniform(-0.3, 0.3);
        }
        object.transform[3] = {random.uniform(-12, 12), random.uniform(-2, 2), random.uniform(-12, 12), 1};
        scene.objects.push_back(object);
    }
    return scene;
}

TEST(InnerOccluders, HideNothingThatIsSeen) {
    uint64_t drawn = 0, drawn_exactly = 0, culled = 0;
    for (uint64_t seed = 1; seed <= test::rounds(3, 1); ++seed) {
        const Scene scene = makeStatues(seed);
        LoadedWorld loaded = loadWorld(scene, {}, loadSettings(false, 1));
        const Snapshot now = loaded.world.commit();
        const Witness witness(scene);
        Query query;
        Random random(seed);
        for (int i = 0; i < 10; ++i) {
            // From anywhere, within a statue and with the near plane through some, too.
            const glm::dvec3 eye =
                i % 3 ? glm::dvec3(random.uniform(-14, 14), random.uniform(-2, 2), random.uniform(-14, 14))
                      : glm::dvec3(scene.objects[random.below(60)].transform[3]);
            const double z_near = i % 2 ? 0.01 : 2.0;
            View view = test::viewAt(eye, test::randomVector(random, {3, 0, 3}), {63, 320, 180, z_near});
            QuerySettings settings;
            if (i == 5) view.projection = orthographic(8, 16.0 / 9.0, z_near, 100);
            settings.occluder_error = 0;
            query.visible(now, view, settings);
            drawn_exactly += query.visible(now, view, settings).stats.occluder_triangles;
            settings.occluder_error = 20;
            drawn += query.visible(now, view, settings).stats.occluder_triangles;
            const std::vector<uint8_t> reasons = test::reasonsOf(query, now);
            for (uint8_t reason : reasons) culled += reason == 1 + static_cast<int>(Stage::kOcclusion);
            test::expectNoFalseCulls(witness, view, reasons,
                                     {.rays = 20000, .aimed_rays = 10000, .supersampling = 2, .prove = true},
                                     "seed " + std::to_string(seed) + ", view " + std::to_string(i));
        }
    }
    EXPECT_LT(3 * drawn, 2 * drawn_exactly);  // they were drawn
    EXPECT_GT(culled, 1000u);                 // and hid something
}

}  // namespace
}  // namespace sightline
