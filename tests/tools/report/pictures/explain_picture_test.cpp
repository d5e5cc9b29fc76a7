// Pictures that explain: the object in outline, and an arrow towards one that lies beyond the border.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/pictures/explain_picture.h"

#include <gtest/gtest.h>

#include "sightline/tools/report/pictures/shadow_picture.h"
#include "sightline/tools/scene/solids.h"

namespace sightline {
using namespace tools;
namespace {

/// Where the colour of outlines is, on average, from the middle of the picture, y up; and in how many pixels.
struct Marks {
    glm::dvec2 middle{0.0};
    int pixels = 0;
};

Marks marksOf(const Image<Rgb>& image) {
    Marks marks;
    for (uint32_t y = 0; y < image.height; ++y)
        for (uint32_t x = 0; x < image.width; ++x) {
            if (image.at(x, y) != Rgb(196, 18, 110)) continue;
            marks.middle += glm::dvec2(x + 0.5 - 0.5 * image.width, 0.5 * image.height - (y + 0.5));
            ++marks.pixels;
        }
    if (marks.pixels > 0) marks.middle /= marks.pixels;
    return marks;
}

Marks pictureFrom(const glm::dvec3& eye, const glm::dvec3& target, double size = 1) {
    Scene scene;
    scene.materials.resize(1);
    city::MeshBuilder mesh;
    city::addBox(mesh, 0, glm::dvec3(-size), glm::dvec3(size));
    scene.meshes.push_back(mesh.finish("box"));
    scene.objects.emplace_back();
    View view;
    view.view = lookAt(eye, target, {0, 1, 0});
    view.projection = perspective(1.0, 1.5, 0.1);
    view.width = 150;
    view.height = 100;
    return marksOf(explainPicture(scene, view, {}));
}

TEST(ExplainPicture, OutlinesTheBoxOrPointsToIt) {
    const Marks seen = pictureFrom({0, 0, 10}, {0, 0, 0});
    EXPECT_GT(seen.pixels, 100);
    EXPECT_LT(glm::length(seen.middle), 2.0);
    // It lies to the right of what one looks at, to its left, above, below, and behind and to the right.
    const Marks right = pictureFrom({0, 0, 10}, {-20, 0, 0}), left = pictureFrom({0, 0, 10}, {20, 0, 0});
    const Marks above = pictureFrom({0, 0, 10}, {0, -20, 0}), below = pictureFrom({0, 0, 10}, {0, 20, 0});
    const Marks behind = pictureFrom({0, 0, 10}, {-2, 0, 20});
    for (const Marks& marks : {right, left, above, below, behind}) {
        EXPECT_GT(marks.pixels, 20);
        EXPECT_LT(marks.pixels, 200);
    }
    EXPECT_GT(right.middle.x, 50);
    EXPECT_LT(left.middle.x, -50);
    EXPECT_GT(above.middle.y, 30);
    EXPECT_LT(below.middle.y, -30);
    EXPECT_GT(behind.middle.x, 50);
    // Straight behind there is no side: any will do. Around the eye there is nothing to point to.
    EXPECT_GT(pictureFrom({0, 0, 10}, {0, 0, 20}).pixels, 20);
    EXPECT_EQ(pictureFrom({0, 0, 0}, {0, 0, -1}, 1e5).pixels, 0);
}

/// How many pixels are nearer to the colour of shadows than to grey.
int shadowPixels(const Image<Rgb>& image) {
    int count = 0;
    for (uint32_t y = 0; y < image.height; ++y)
        for (uint32_t x = 0; x < image.width; ++x) {
            const Rgb pixel = image.at(x, y);
            count += pixel.r > pixel.b + 100;
        }
    return count;
}

TEST(ExplainPicture, ShowsOutlinesAndTheirShadows) {
    Scene scene;
    scene.materials.resize(1);
    city::MeshBuilder mesh;
    city::addBox(mesh, 0, glm::dvec3(-1), glm::dvec3(1));
    scene.meshes.push_back(mesh.finish("box"));
    for (const double z : {0.0, -6.0}) {  // the nearer one hides the other
        scene.objects.emplace_back();
        scene.objects.back().transform[3] = glm::dvec4(0, 0, z, 1);
    }
    View view;
    view.view = lookAt({0, 0, 10}, {0, 0, 0}, {0, 1, 0});
    view.projection = perspective(1.0, 1.5, 0.1);
    view.width = 300;
    view.height = 200;
    const std::vector<std::vector<glm::dvec3>> outlines = {{{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}}};
    const std::vector<uint32_t> occluders = {0};
    Emphasis emphasis;
    emphasis.object = 1;
    emphasis.occluders = occluders;
    const Image<Rgb> plain = explainPicture(scene, view, emphasis);
    emphasis.outlines = outlines;
    const Image<Rgb> marked = explainPicture(scene, view, emphasis);
    // The near face is 2 units wide, 9 away, where the image is 9.83 high: 41 pixels on each side, three wide.
    int changed = 0;
    for (size_t i = 0; i < plain.pixels.size(); ++i) changed += plain.pixels[i] != marked.pixels[i];
    EXPECT_GT(changed, 300);
    EXPECT_LT(changed, 600);
    const PictureMaker maker(scene);
    const Image<Rgb> side = shadowPicture(maker, view, emphasis);
    EXPECT_EQ(side.width, 300u);
    EXPECT_GT(marksOf(side).pixels, 100) << "the object's box";
    EXPECT_GT(shadowPixels(side), 300);
    // Its end is behind the object, wherever that is, and as far from the eye all around.
    const glm::dvec3 eye(0, 0, 10);
    const double reach = shadowReach(eye, maker.bounds()[1], outlines[0]);
    EXPECT_GT(reach, glm::length(glm::dvec3(1, 1, -7) - eye));
    for (const glm::dvec3& end : shadowEnd(eye, outlines[0], reach)) EXPECT_NEAR(glm::length(end - eye), reach, 1e-9);
    emphasis.outlines = {};
    EXPECT_LT(shadowPixels(shadowPicture(maker, view, emphasis)), shadowPixels(side) / 4);
}

}  // namespace
}  // namespace sightline
