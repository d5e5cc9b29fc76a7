// From outside one sees the path in its scene, what was drawn as solid, and what was culled as wires.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/pictures/outside_picture.h"

#include <cmath>

#include <gtest/gtest.h>

#include "sightline/geom/stage.h"
#include "sightline/tools/scene/solids.h"
#include "tests/support/views.h"

namespace sightline {
using namespace tools;
using namespace test;
namespace {

constexpr Rgb kPath(196, 18, 110);

struct MadeBox {
    glm::dvec3 low, high;
    glm::vec4 colour{0.5f, 0.5f, 0.5f, 1};
};

Scene sceneOf(const std::vector<MadeBox>& boxes) {
    Scene scene;
    for (const MadeBox& box : boxes) {
        city::MeshBuilder mesh;
        const auto number = static_cast<uint32_t>(scene.objects.size());
        city::addBox(mesh, number, box.low, box.high);
        scene.materials.emplace_back().base_color = box.colour;
        scene.meshes.push_back(mesh.finish("box"));
        scene.objects.emplace_back().mesh = number;
        scene.objects.back().key = number;
    }
    return scene;
}

Rgb pixelAt(const Overview& overview, const glm::dvec2& place) {
    return overview.image.at(static_cast<uint32_t>(place.x * overview.image.width),
                             static_cast<uint32_t>(place.y * overview.image.height));
}

TEST(Overview, DrawsThePathInTheScene) {
    const Scene scene = sceneOf({{{-10, -1, -10}, {10, 0, 10}}});
    const PictureMaker maker(scene);
    std::vector<glm::dvec3> eyes;
    for (int i = 0; i <= 10; ++i) eyes.emplace_back(i - 5, 1, 0);
    const Overview overview = overviewPicture(maker, eyes, 320);
    EXPECT_EQ(overview.image.width, 320u);
    EXPECT_EQ(overview.image.height, 180u);
    ASSERT_EQ(overview.eyes.size(), eyes.size());
    for (const auto& place : overview.eyes) ASSERT_TRUE(place);
    EXPECT_EQ(pixelAt(overview, *overview.eyes[0]), kPath);
    EXPECT_EQ(pixelAt(overview, *overview.eyes[7]), kPath);
    EXPECT_EQ(pixelAt(overview, 0.5 * (*overview.eyes[7] + *overview.eyes[8])), kPath);
    const Overview without = overviewPicture(maker, {}, 320);
    EXPECT_NE(pixelAt(without, *overview.eyes[7]), kPath);
}

TEST(Overview, JoinsNoJumpsAndIsNotShrunkByThem) {
    const Scene scene = sceneOf({{{-10, -1, -10}, {10, 0, 10}}});
    const PictureMaker maker(scene);
    std::vector<glm::dvec3> eyes = {{700, 300, 400}};
    for (int i = 0; i <= 10; ++i) eyes.emplace_back(i - 5, 1, 0);
    const Overview overview = overviewPicture(maker, eyes, 320);
    EXPECT_FALSE(overview.eyes[0]);
    ASSERT_TRUE(overview.eyes[1] && overview.eyes[11]);
    EXPECT_GT(glm::length(*overview.eyes[11] - *overview.eyes[1]), 0.15);
    eyes[0] = {-4, 1, 9};  // within the picture, and as far as nine steps
    const Overview jump = overviewPicture(maker, eyes, 320);
    ASSERT_TRUE(jump.eyes[0]);
    EXPECT_NE(pixelAt(jump, 0.5 * (*jump.eyes[0] + *jump.eyes[1])), kPath);
}

TEST(Overview, ShowsARingOfEyesAroundItsScene) {
    const Scene scene = sceneOf({{{-1, -1, -1}, {1, 1, 1}}});
    const PictureMaker maker(scene);
    std::vector<glm::dvec3> eyes;
    for (int i = 0; i < 12; ++i) eyes.emplace_back(8 * std::sin(i / 2.0), 2, 8 * std::cos(i / 2.0));
    for (const auto& place : overviewPicture(maker, eyes, 160).eyes) EXPECT_TRUE(place);
}

TEST(Overview, BearsScenesOfNothingAndOfAPoint) {
    const Scene nothing;
    EXPECT_TRUE(overviewPicture(PictureMaker(nothing), std::vector<glm::dvec3>{{0, 0, 0}}, 64).image.pixels.empty());
    Scene point = sceneOf({{{0, 0, 0}, {1, 1, 1}}});
    for (glm::vec3& p : point.meshes[0].positions) p = glm::vec3(3);
    point.meshes[0].bounds = {glm::dvec3(3), glm::dvec3(3)};
    EXPECT_EQ(overviewPicture(PictureMaker(point), {}, 64).image.width, 64u);
}

/// A street: a ground, a wall across it, and what stands behind the wall.
class Outside : public testing::Test {
protected:
    static constexpr uint8_t kCulled = 1 + static_cast<uint8_t>(Stage::kOcclusion);

    Image<Rgb> drawn(const std::vector<MadeBox>& boxes, const std::vector<uint8_t>& reasons) const {
        const Scene scene = sceneOf(boxes);
        return outsidePicture(PictureMaker(scene), view_, reasons);
    }
    static size_t differing(const Image<Rgb>& a, const Image<Rgb>& b) {
        size_t count = 0;
        for (size_t i = 0; i < a.pixels.size(); ++i) count += a.pixels[i] != b.pixels[i];
        return count;
    }
    static size_t red(const Image<Rgb>& image) {
        size_t count = 0;
        for (const Rgb& pixel : image.pixels) count += pixel.x > pixel.y + 30 && pixel.x > pixel.z + 30;
        return count;
    }

    const MadeBox ground_{{-20, -1, -20}, {20, 0, 20}}, wall_{{-3, 0, 0}, {3, 3, 0.5}},
        hidden_{{-2, 0, -6}, {2, 2, -2}};
    View view_ = viewAt({0, 1.5, 12}, {0, 1.5, 0}, {.width = 300, .height = 200});
};

TEST_F(Outside, DrawsWhatWasKeptSolidAndWhatWasCulledAsWires) {
    const Image<Rgb> without = drawn({ground_, wall_}, {0, 0});
    // The camera hangs on what is kept: it is the same with and without the culled box.
    const Image<Rgb> culled = drawn({ground_, wall_, hidden_}, {0, 0, kCulled});
    const size_t wires = differing(without, culled);
    EXPECT_GT(wires, 100u);
    const Image<Rgb> solid = drawn({ground_, wall_, {hidden_.low, hidden_.high, {1, 0, 0, 1}}}, {0, 0, 0});
    EXPECT_GT(red(solid), wires);
    size_t orange = 0;
    for (size_t i = 0; i < culled.pixels.size(); ++i) {
        const glm::ivec3 change = glm::ivec3(culled.pixels[i]) - glm::ivec3(without.pixels[i]);
        orange += change.x > change.z + 20;
    }
    EXPECT_GT(orange, wires / 2);
}

TEST_F(Outside, DrawsTheFrustumFromTheEye) {
    const Image<Rgb> narrow = drawn({ground_, wall_}, {0, 0});
    view_.projection = perspective(0.3, 1.5, 0.1);
    EXPECT_GT(differing(narrow, drawn({ground_, wall_}, {0, 0})), 100u);
    view_.projection = orthographic(3, 1.5, 0.1, 50);
    EXPECT_GT(differing(narrow, drawn({ground_, wall_}, {0, 0})), 100u);
}

TEST_F(Outside, CutsTheRoofOverTheEyeAway) {
    const MadeBox red_box{{-2, 0, 2}, {2, 1, 5}, {1, 0, 0, 1}}, roof{{-20, 4, -20}, {20, 5, 20}};
    EXPECT_GT(red(drawn({ground_, wall_, red_box}, {0, 0, 0})), 100u);
    EXPECT_GT(red(drawn({ground_, wall_, red_box, roof}, {0, 0, 0, 0})), 100u);
    const MadeBox lamp{{-0.8, 2, 11.2}, {0.8, 2.2, 12.8}, {1, 0, 0, 1}};
    EXPECT_GT(red(drawn({ground_, wall_, lamp}, {0, 0, 0})), 20u) << "a lamp is no roof: it stays";
    const MadeBox above{{-2, 6, -2}, {2, 8, 2}, {1, 0, 0, 1}};
    EXPECT_EQ(red(drawn({ground_, wall_, roof, above}, {0, 0, 0, 0})), 0u) << "with all that lies above it";
}

TEST_F(Outside, BearsFramesThatKeepNothing) {
    EXPECT_EQ(drawn({ground_}, {1}).width, 300u);
    EXPECT_EQ(drawn({}, {}).height, 200u);
    view_.view = lookAt({0, 9, 0}, {0, 0, 0}, {0, 0, 1});
    EXPECT_EQ(drawn({ground_}, {0}).width, 300u) << "straight down";
}

}  // namespace
}  // namespace sightline
