// Pictures show what is there; heat maps count what was drawn.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/pictures/picture.h"

#include <cmath>

#include <gtest/gtest.h>

#include "sightline/tools/report/pictures/plan.h"
#include "tests/tools/report/run/made_run.h"

namespace sightline {
using namespace tools;
namespace {

View madeView(const CullRun& run, bool parallel = false) {
    CameraFrame camera = run.frames[0].camera;
    if (parallel) camera.orthographic_height = 6;
    return makeView(camera, run.width, run.height);
}

float sum(const Image<float>& image) {
    float total = 0;
    for (const float value : image.pixels) total += value;
    return total;
}

TEST(Picture, CountsHiddenSurfacesOnlyWithoutCulling) {
    const Scene scene = madeScene();
    const CullRun run = madeRun(scene);
    for (const bool parallel : {false, true}) {
        const PictureMaker::Frame frame = PictureMaker(scene).draw(madeView(run, parallel), run.frames[0].reasons);
        const uint32_t x = run.width / 2, y = run.height / 2;
        EXPECT_EQ(frame.all.at(x, y), 2.0f) << parallel;   // the wall and what stands behind it
        EXPECT_EQ(frame.kept.at(x, y), 1.0f) << parallel;  // the wall
        EXPECT_EQ(frame.all.at(0, 0), 0.0f) << parallel;
        EXPECT_GT(sum(frame.all), sum(frame.kept)) << parallel;
        EXPECT_TRUE(frame.same) << parallel;
    }
}

TEST(Picture, NoticesAVisibleObjectThatWasCulled) {
    const Scene scene = madeScene();
    const CullRun run = madeRun(scene);
    const std::vector<uint8_t> reasons = {2, 0, 0, 0};  // the wall itself
    EXPECT_FALSE(PictureMaker(scene).draw(madeView(run), reasons).same);
}

TEST(Picture, ShadesSurfacesApartFromTheSky) {
    const Scene scene = madeScene();
    const CullRun run = madeRun(scene);
    const PictureMaker::Frame frame = PictureMaker(scene).draw(madeView(run), run.frames[0].reasons);
    EXPECT_NE(frame.shaded.at(run.width / 2, run.height / 2), frame.shaded.at(0, run.height / 2));
}

TEST(Picture, KeepsColoursHoweverFarTheEyeStandsOutside) {
    const Scene scene = madeScene();
    const CullRun run = madeRun(scene);
    const auto middle = [&](double distance) {
        CameraFrame camera = run.frames[0].camera;
        camera.eye = camera.target + distance * glm::normalize(camera.eye - camera.target);
        camera.fov_y_degrees = glm::degrees(2 * std::atan(1 / distance));
        const View view = makeView(camera, run.width, run.height);
        return PictureMaker(scene).draw(view, run.frames[0].reasons).shaded.at(run.width / 2, run.height / 2);
    };
    const Rgb near = middle(20), far = middle(400);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(near[c], far[c], 2) << c;
}

TEST(Picture, HeatIsBrightestAtItsFullValue) {
    Image<float> counts(3, 1);
    counts.pixels = {0, 4, 99};
    const Image<Rgb> heat = heatMap(counts, 4);
    EXPECT_EQ(heat.pixels[0], heatColour(0));
    EXPECT_EQ(heat.pixels[1], heatColour(1));
    EXPECT_EQ(heat.pixels[2], heatColour(1));
    int last = -1;
    for (int i = 0; i <= 20; ++i) {  // lightness rises, for eyes that see no hue
        const Rgb c = heatColour(i / 20.0);
        const int light = 299 * c.x + 587 * c.y + 114 * c.z;
        EXPECT_GT(light, last) << i;
        last = light;
    }
}

TEST(Picture, DrawsCulledObjectsThroughWhatHidesThem) {
    const Scene scene = madeScene();
    const CullRun run = madeRun(scene);
    const PictureMaker::Frame frame = PictureMaker(scene).draw(madeView(run), run.frames[0].reasons);
    const glm::u8vec4 middle = frame.culled.at(run.width / 2, run.height / 2);
    EXPECT_EQ(glm::u8vec3(middle),
              glm::u8vec3(kPlanPalette[1 + static_cast<int>(Stage::kOcclusion)]));  // what stands behind the wall
    EXPECT_GT(middle.w, 0);
    EXPECT_EQ(frame.culled.at(0, 0).w, 0);
}

TEST(Picture, ColoursObjectsApart) {
    const Scene scene = madeScene();
    const CullRun run = madeRun(scene);
    const PictureMaker::Frame frame = PictureMaker(scene).draw(madeView(run), run.frames[0].reasons);
    ASSERT_EQ(frame.objects.pixels.size(), frame.shaded.pixels.size());
    EXPECT_NE(frame.objects.at(run.width / 2, run.height / 2), frame.objects.at(0, 0));
}

TEST(Picture, HeatScalesHaveWholeTicks) {
    EXPECT_EQ(heatScaleAbove(0), 8);
    EXPECT_EQ(heatScaleAbove(8), 8);
    EXPECT_EQ(heatScaleAbove(8.5), 16);
    EXPECT_EQ(heatScaleAbove(19), 40);
    EXPECT_EQ(heatScaleAbove(300), 400);
}

TEST(Picture, ReducesCountsByTheirMeans) {
    Image<float> counts(3, 2);
    counts.pixels = {1, 3, 5, 1, 3, 7};
    const Image<float> small = reducedCounts(counts, 2);
    ASSERT_EQ(small.width, 2u);
    ASSERT_EQ(small.height, 1u);
    EXPECT_EQ(small.pixels[0], 2);
    EXPECT_EQ(small.pixels[1], 6);
    EXPECT_EQ(reducedCounts(counts, 1).pixels, counts.pixels);
}

}  // namespace
}  // namespace sightline
