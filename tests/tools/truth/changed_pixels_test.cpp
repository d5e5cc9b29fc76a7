// The pixels that change where objects are left out: counted on scenes of which they are known.
// SPDX-License-Identifier: MIT
#include "sightline/tools/truth/changed_pixels.h"

#include <gtest/gtest.h>

#include "tests/tools/truth/test_scenes.h"

namespace sightline::test {
using namespace tools;
namespace {

/// Looks along -z at the square from (-8, -8) to (8, 8), a unit a pixel.
View sixteenPixels() {
    View view;
    view.width = view.height = 16;
    view.projection = orthographic(16, 1.0, 0.1, 100);
    return view;
}

TEST(ChangedPixels, AreThoseOfWhatIsLeftOutAndSeen) {
    Scene scene = emptyScene();
    const uint32_t small = addSquare(scene, 2), large = addSquare(scene, 6);
    addObject(scene, large, moved({0, 0, -50}));
    addObject(scene, small, moved({0, 0, -10}));  // before the large one
    addObject(scene, small, moved({0, 0, -60}));  // behind it
    addObject(scene, small, moved({7, 7, -60}));  // half of it beside it, and half of that out of the view
    const SceneFacts facts(scene);
    const View view = sixteenPixels();
    using enum Drawn;
    const auto count = [&](std::vector<Drawn> drawn) { return countChangedPixels(facts, view, drawn); };
    EXPECT_EQ(count({kAlways, kAlways, kAlways, kAlways}), 0u);
    EXPECT_EQ(count({kAlways, kFullOnly, kAlways, kAlways}), 16u);
    EXPECT_EQ(count({kAlways, kAlways, kFullOnly, kAlways}), 0u) << "it is hidden";
    EXPECT_EQ(count({kFullOnly, kAlways, kNever, kAlways}), 144u - 16u);
    EXPECT_EQ(count({kAlways, kAlways, kAlways, kFullOnly}), 9u - 1u) << "it is cut and partly hidden";
    EXPECT_EQ(count({kNever, kFullOnly, kNever, kNever}), 16u);
}

TEST(ChangedPixels, ShowWhatChangesBehindGlassAndTheGlassItself) {
    Scene scene = emptyScene();
    const uint32_t pane = addSquare(scene, 6, 3), wall = addSquare(scene, 2);
    addObject(scene, pane, moved({0, 0, -10}));
    addObject(scene, wall, moved({0, 0, -50}));
    const SceneFacts facts(scene);
    const View view = sixteenPixels();
    using enum Drawn;
    EXPECT_EQ(countChangedPixels(facts, view, std::vector{kAlways, kFullOnly}), 16u);
    EXPECT_EQ(countChangedPixels(facts, view, std::vector{kFullOnly, kAlways}), 144u);
}

// A coarse level may be seen where the finest one is out of view.
TEST(ChangedPixels, CountLevelsThatReachFartherThanTheFinest) {
    Scene scene = emptyScene();
    const uint32_t small = addSquare(scene, 2);
    Mesh& mesh = scene.meshes[small];
    MeshLod& wide = mesh.lods.emplace_back();
    for (const uint32_t index : mesh.indices)
        wide.indices.push_back(index + static_cast<uint32_t>(mesh.positions.size()));
    for (size_t i = 0, count = mesh.positions.size(); i < count; ++i)
        mesh.positions.push_back(mesh.positions[i] * 3.0f);
    wide.primitives = mesh.primitives;
    addObject(scene, small, moved({-13, 0, -10}));
    const SceneFacts facts(scene);
    const std::vector<uint8_t> finest{0}, coarse{1};
    EXPECT_EQ(countChangedPixels(facts, sixteenPixels(), std::vector{Drawn::kAlways}, finest), 0u);
    EXPECT_EQ(countChangedPixels(facts, sixteenPixels(), std::vector{Drawn::kAlways}, coarse), 12u)
        << "1 of 12 columns";
}

}  // namespace
}  // namespace sightline::test
