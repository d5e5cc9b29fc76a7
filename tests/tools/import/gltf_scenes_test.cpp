// Real scenes load, with the objects and triangles that their list says.
// SPDX-License-Identifier: MIT
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "sightline/tools/import/gltf/gltf.h"
#include "tests/support/shared_scenes.h"

namespace sightline {
using namespace tools;
namespace {

struct Listed {
    const char* file;
    size_t objects;
    double thousand_triangles;  // as the list rounds them
};

constexpr Listed kListed[] = {
    {"bimwhale-tall-building", 164, 5}, {"dense-spot", 1, 6},
    {"aws-small-house", 85, 146},       {"bsi-duplex", 692, 27},
    {"gazebo-willowgarage", 248, 14},   {"sauer-pandora", 206, 61},
    {"2CylinderEngine", 67, 121},       {"gazebo-pr2", 51, 70},
    {"cityjson-vienna", 490, 40},       {"redeclipse-auster", 375, 47},
    {"polyhaven-dutch-ship", 3, 69},    {"playcanvas-cave", 1, 595},
    {"nibs-clinic-mep", 15861, 1350},
};

TEST(GltfScenes, LoadWithTheListedObjects) {
    for (const Listed& listed : kListed) {
        const char* file = listed.file;
        const auto scene = test::sharedScene(file);
        if (!scene) GTEST_SKIP() << "no scenes beside the repository";
        EXPECT_EQ(scene->objects.size(), listed.objects) << file;
        EXPECT_NEAR(static_cast<double>(drawnTriangles(*scene)) / 1000, listed.thousand_triangles,
                    0.02 * listed.thousand_triangles + 0.5)
            << file;
        EXPECT_TRUE(worldBounds(*scene).finite()) << file;
    }
}

TEST(GltfScenes, TellTheirProgress) {
    const std::filesystem::path file = std::filesystem::path(SIGHTLINE_SHARED_DIR) / "scenes" / "bsi-duplex.glb";
    if (!std::filesystem::is_regular_file(file)) GTEST_SKIP() << "no scenes in ../shared";
    std::vector<std::pair<size_t, size_t>> told;
    const Result<Scene> scene =
        loadGltf(file.string(), [&](size_t done, size_t total) { told.emplace_back(done, total); });
    ASSERT_TRUE(scene.ok()) << scene.error().message;
    ASSERT_GE(told.size(), 10u);
    for (size_t i = 1; i < told.size(); ++i) {
        EXPECT_LT(told[i - 1].first, told[i].first);
        EXPECT_EQ(told[i - 1].second, told[i].second);
    }
    EXPECT_EQ(told.back().first, told.back().second);
}

}  // namespace
}  // namespace sightline
