// Groups of near objects: each object is in one, none is too wide for its objects, and what is far off stands apart.
// SPDX-License-Identifier: MIT
#include "sightline/tools/truth/near_groups.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "sightline/base/random.h"
#include "test_scenes.h"

namespace sightline::test {
using namespace tools;
namespace {

std::vector<NearGroup> groupsOf(const Scene& scene) {
    std::vector<glm::dvec3> middles;
    for (const Mesh& mesh : scene.meshes) middles.push_back(medianCorner(mesh));
    return nearGroups(SceneFacts(scene), middles);
}

double widthIn(const glm::dvec3& size) { return std::max({size.x, size.y, size.z}); }

glm::dmat4 scaled(double by, const glm::dvec3& at) {
    glm::dmat4 transform = moved(at);
    for (int axis = 0; axis < 3; ++axis) transform[axis][axis] = by;
    return transform;
}

TEST(NearGroups, HoldEachObjectOnceAndAreNoWiderThanTheyMay) {
    for (uint64_t seed = 0; seed < 40; ++seed) {
        Random random(seed);
        Scene scene = emptyScene();
        const uint32_t box = addBox(scene, glm::vec3(0.5f)), nothing = addMesh(scene, {}, {});
        for (uint64_t i = random.below(120); i-- > 0;) {
            const double far = std::exp2(random.uniform(0, 24)), width = std::exp2(random.uniform(-6, 8));
            const auto place = [&] { return random.uniform(-far, far); };
            const double x = place(), y = place();
            addObject(scene, random.below(9) ? box : nothing, scaled(width, {x, y, place()}));
        }
        const SceneFacts facts(scene);
        const std::vector<NearGroup> groups = groupsOf(scene);
        std::vector<int> times(scene.objects.size(), 0);
        for (const NearGroup& group : groups) {
            std::vector<double> widths;
            Box3d held;
            for (const uint32_t object : group.objects) {
                ++times[object];
                held.grow(facts.box(object));
                widths.push_back(widthIn(facts.box(object).size()));
            }
            std::sort(widths.begin(), widths.end());
            ASSERT_FALSE(widths.empty()) << "seed " << seed;
            EXPECT_TRUE(held.holds(group.box) && group.box.holds(held)) << "seed " << seed;
            EXPECT_TRUE(group.box.holds({group.middle, group.middle})) << "seed " << seed;
            EXPECT_LE(widthIn(held.size()), 1024 * widths[(widths.size() - 1) / 2]) << "seed " << seed;
        }
        for (size_t i = 0; i < times.size(); ++i)
            EXPECT_EQ(times[i], facts.box(static_cast<uint32_t>(i)).empty() ? 0 : 1) << "seed " << seed;
    }
}

TEST(NearGroups, ASceneIsOneGroupAndWhatIsFarOffIsAnother) {
    for (const double far : {0.0, 1e5, 1e6, 1e7})
        for (int what = 0; what < 3; ++what) {
            Scene scene = emptyScene();
            const uint32_t box = addBox(scene, glm::vec3(0.5f));
            for (int i = 0; i < 20; ++i) addObject(scene, box, moved({i % 5, i / 5, 7}));
            if (far > 0 && what == 0) addObject(scene, box, moved({far, 0, 0}));
            if (far > 0 && what == 1) addObject(scene, box, scaled(2 * far, {0.3 * far, 0, 0}));
            for (int i = 0; i < 20 && far > 0 && what == 2; ++i) addObject(scene, box, moved({far + i, 0, 0}));
            const std::vector<NearGroup> groups = groupsOf(scene);
            ASSERT_EQ(groups.size(), far > 0 ? 2u : 1u) << far << " " << what;
            const NearGroup& near = groups[groups[0].objects[0] == 0 ? 0 : groups.size() - 1];
            EXPECT_EQ(near.objects.size(), 20u) << far << " " << what;
            EXPECT_LT(glm::distance(near.middle, {2, 2, 7}), 3) << far << " " << what;
        }
}

TEST(NearGroups, AStrayTriangleOfAMeshMovesNoMiddle) {
    for (const double far : {1e3, 1e6, 1e7}) {
        Scene scene = emptyScene();
        const uint32_t box = addBox(scene, glm::vec3(0.5f));
        Mesh& mesh = scene.meshes[box];
        const auto first = static_cast<uint32_t>(mesh.positions.size());
        for (const glm::vec3& corner : {glm::vec3(0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)}) {
            mesh.positions.push_back(corner + glm::vec3(static_cast<float>(far), 0, 0));
            mesh.bounds.grow(glm::dvec3(mesh.positions.back()));
        }
        mesh.indices.insert(mesh.indices.end(), {first, first + 1, first + 2});
        ++mesh.primitives[0].triangle_count;
        addObject(scene, box, moved({5, 0, 0}));
        const std::vector<NearGroup> groups = groupsOf(scene);
        ASSERT_EQ(groups.size(), 1u);
        EXPECT_LT(glm::distance(groups[0].middle, {5, 0, 0}), 1) << far;
    }
}

}  // namespace
}  // namespace sightline::test
