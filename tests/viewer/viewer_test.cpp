// Flying, freezing and choosing in the viewer, and that culling changes no picture.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "sightline/tools/import/gltf/gltf.h"
#include "sightline/tools/load/seeded_cameras.h"
#include "sightline/tools/scene/camera_path.h"
#include "tests/support/random.h"
#include "tests/support/shared_scenes.h"
#include "tests/viewer/driven_viewer.h"

namespace sightline::viewer {
namespace {
using namespace test;

TEST_F(ViewerTest, DrawsTheSameWithAndWithoutCulling) {
    Driven viewer(*context_, city_, path_);
    viewer->state.panels = false;
    for (size_t frame = 0; frame < path_.frames.size(); ++frame) {
        viewer->goTo(frame);
        const Image<Rgb> culled = viewer.picture();
        const size_t kept = viewer->culler().visible().size();
        viewer->culler().settings.stages = 0;
        const Image<Rgb> all = viewer.picture();
        EXPECT_GT(viewer->culler().visible().size(), 2 * kept) << "frame " << frame;
        EXPECT_EQ(differing(culled, all), 0u) << "frame " << frame;
        viewer->culler().settings.stages = stageBit(Stage::kFrustum) | stageBit(Stage::kOcclusion);
    }
}

TEST_F(ViewerTest, TheFrozenCameraStaysWhileTheEyeLeavesIt) {
    Driven viewer(*context_, city_, path_);
    const glm::dvec3 start = viewer->eye.eye();
    const std::vector<uint32_t> before(viewer->culler().visible().begin(), viewer->culler().visible().end());
    viewer.press('F');
    EXPECT_TRUE(viewer->state.frozen);
    viewer.hold('W', 20);
    viewer.hold('E', 20);
    viewer.drag(1, 200, 60);
    EXPECT_GT(glm::length(viewer->eye.eye() - start), 0.1);
    EXPECT_EQ(viewer->culling.eye(), start);
    EXPECT_TRUE(
        std::equal(before.begin(), before.end(), viewer->culler().visible().begin(), viewer->culler().visible().end()));
    viewer.press('F');
    EXPECT_FALSE(viewer->state.frozen);
    EXPECT_EQ(viewer->culling.eye(), viewer->eye.eye());
    EXPECT_FALSE(
        std::equal(before.begin(), before.end(), viewer->culler().visible().begin(), viewer->culler().visible().end()));
}

TEST_F(ViewerTest, FurtherClicksChooseWhatIsBehind) {
    Driven viewer(*context_, city_, path_);
    viewer.press('F');
    viewer->state.panels = false;
    viewer->state.culled_as = CulledAs::kGhosts;
    viewer.press(kHome);  // the whole city
    size_t deep = 0;
    std::optional<glm::vec2> with_ghosts;
    for (const uint32_t object : viewer->culler().visible()) {
        const View view = viewer->eye.view(kWidth, kHeight);
        const glm::dvec4 clip =
            view.projection * view.view * glm::dvec4(viewer->culler().boundsOf(object).center(), 1.0);
        if (clip.w <= 0 || std::abs(clip.x) > clip.w || std::abs(clip.y) > clip.w) continue;
        const glm::vec2 at(0.5 * kWidth * (1 + clip.x / clip.w), 0.5 * kHeight * (1 - clip.y / clip.w));
        viewer.clickAt(at.x, at.y);
        if (!viewer->state.chosen) continue;
        const uint32_t front = *viewer->state.chosen;
        if (viewer->culler().reasons()[front] != 0) continue;  // no solid thing is there
        std::set<uint32_t> here{front};
        for (int i = 0; i < 200 && (i == 0 || viewer->state.chosen != front); ++i) {
            viewer.clickAt(at.x, at.y);
            ASSERT_TRUE(viewer->state.chosen);
            here.insert(*viewer->state.chosen);
            if (viewer->culler().reasons()[*viewer->state.chosen] != 0) with_ghosts = at;
        }
        EXPECT_EQ(viewer->state.chosen, front) << "after the last comes the first";
        deep = std::max(deep, here.size());
        viewer.clickAt(at.x + 60, at.y);
        viewer.clickAt(at.x, at.y);
        EXPECT_EQ(viewer->state.chosen, front) << "another place begins anew";
        if (with_ghosts && deep > 2) break;
    }
    EXPECT_GT(deep, 2u);
    ASSERT_TRUE(with_ghosts);
    viewer->state.chosen.reset();
    viewer->state.x_ray = true;
    viewer.clickAt(with_ghosts->x + 60, with_ghosts->y);
    viewer.clickAt(with_ghosts->x, with_ghosts->y);
    ASSERT_TRUE(viewer->state.chosen);
    EXPECT_NE(viewer->culler().reasons()[*viewer->state.chosen], 0) << "through x-ray ghosts are";
}

TEST_F(ViewerTest, ASectionLeavesAFrozenAnswer) {
    Driven viewer(*context_, city_, path_);
    viewer->state.panels = false;
    viewer.press('F');
    const Image<Rgb> whole = viewer.picture();
    const std::vector<uint32_t> before(viewer->culler().visible().begin(), viewer->culler().visible().end());
    viewer->state.section = true;
    viewer->state.section_at = 0.05f;
    EXPECT_GT(differing(whole, viewer.picture()), 1000u);
    EXPECT_TRUE(
        std::equal(before.begin(), before.end(), viewer->culler().visible().begin(), viewer->culler().visible().end()));
    viewer.press('F');
    EXPECT_FALSE(
        std::equal(before.begin(), before.end(), viewer->culler().visible().begin(), viewer->culler().visible().end()));
}

TEST_F(ViewerTest, EscapeEndsOnceItIsPressedTwice) {
    Driven viewer(*context_, city_, path_);
    viewer->state.chosen = viewer->culler().visible().front();
    viewer.frames();
    viewer.hold(kEscape, 4);
    EXPECT_FALSE(viewer->state.chosen || viewer->state.wants_to_close);
    viewer.press(kEscape);
    EXPECT_FALSE(viewer->state.wants_to_close);
    viewer.press('V');
    viewer.press(kEscape);
    EXPECT_FALSE(viewer->state.wants_to_close) << "something came between";
    viewer.press(kEscape);
    EXPECT_TRUE(viewer->state.wants_to_close);
}

TEST_F(ViewerTest, NothingThatIsClickedDoesHarm) {
    Driven viewer(*context_, city_, path_);
    Random random(5);
    for (int i = 0; i < 120; ++i) {
        switch (random.below(6)) {
            case 0: {
                const auto& places = viewer->places();
                if (places.empty()) break;
                auto place = places.begin();
                std::advance(place, random.below(places.size()));
                viewer.click(std::string(place->first));
                break;
            }
            case 1:
                viewer.clickAt(float(random.uniform(0, kWidth)), float(random.uniform(0, kHeight)));
                break;
            case 2:
                viewer.drag(int(random.below(3)), float(random.uniform(-200, 200)), float(random.uniform(-200, 200)));
                break;
            case 3:
                viewer.press(uint16_t('A' + random.below(26)));
                break;
            case 4:
                viewer.press(uint16_t(kEscape + random.below(kKeys - kEscape)));
                break;
            default:
                viewer.hold(uint16_t("WASDQE"[random.below(6)]), 3);
        }
        if (HasFailure()) return;
    }
    EXPECT_TRUE(isUsable(viewer->eye.view(kWidth, kHeight)));
}

TEST_F(ViewerTest, AClickChoosesWhatIsThereAndExplainsIt) {
    const CameraPath path = seededCameras(city_, 12, 3);
    Driven viewer(*context_, city_, path);
    viewer->state.panels = false;
    const RayProbe probe(city_);
    size_t agreed = 0, asked = 0;
    for (size_t frame = 0; frame < path.frames.size(); ++frame) {
        viewer->goTo(frame);
        viewer.frames();
        for (const auto& [x, y] : {std::pair(320.0f, 400.0f), std::pair(100.0f, 500.0f), std::pair(550.0f, 420.0f)}) {
            viewer.clickAt(x, y);
            const View view = viewer->eye.view(kWidth, kHeight);
            const glm::dmat4 back = glm::inverse(view.projection * view.view);
            const glm::dvec4 near =
                back * glm::dvec4(2 * (double(x) + 0.5) / kWidth - 1, 1 - 2 * (double(y) + 0.5) / kHeight, -1, 1);
            const glm::dvec3 eye = eyePosition(view);
            const std::optional<ProbeHit> hit = probe.nearest({eye, glm::normalize(glm::dvec3(near) / near.w - eye)});
            ++asked;
            // A ray also meets backs of single-sided faces, which are not drawn.
            agreed += hit ? viewer->state.chosen == hit->object : !viewer->state.chosen;
            EXPECT_EQ(viewer->state.chosen.has_value(), !viewer->state.why.empty());
            if (viewer->state.chosen) {
                EXPECT_NE(viewer->state.why.find("kept"), std::string::npos) << viewer->state.why;
            }
        }
    }
    EXPECT_GE(agreed + 2, asked);
}

TEST_F(ViewerTest, WhatIsPressedInAPanelIsLetGoOfWithoutHarm) {
    Driven viewer(*context_, city_, path_);
    viewer->state.chosen = viewer->culler().visible().front();
    viewer.frames(2);
    const PanelPlace frame = viewer->places().at("frame");
    viewer.press(0.5f * (frame.left + frame.right), 0.5f * (frame.top + frame.bottom), 600, 600);
    EXPECT_TRUE(viewer->state.chosen.has_value());
    EXPECT_GT(viewer->pathFrame(), 0u) << "the slider was moved";
}

TEST_F(ViewerTest, WhatIsSaidOfTheChosenObjectIsOfThisView) {
    Driven viewer(*context_, city_, path_);
    viewer->state.chosen = viewer->culler().visible().front();
    viewer.frames(2);
    EXPECT_EQ(viewer->state.why.find("kept"), 0u) << viewer->state.why;
    viewer.hold(kRight, 100);  // away from it
    viewer.frames(3);
    const bool kept = viewer->culler().reasons()[*viewer->state.chosen] == 0;
    EXPECT_EQ(viewer->state.why.find("kept") == 0, kept) << viewer->state.why;
    EXPECT_FALSE(kept);
    EXPECT_FALSE(viewer->state.why_is_old);
}

TEST_F(ViewerTest, ShowsParallelViews) {
    CameraPath path;
    path.frames.emplace_back();
    path.frames[0].eye = {0, 400, 1};
    path.frames[0].target = {0, 0, 0};
    path.frames[0].orthographic_height = 300;
    Driven viewer(*context_, city_, path);
    viewer->state.panels = false;
    const Image<Rgb> picture = viewer.picture();
    size_t shown = 0;
    for (const Rgb& pixel : picture.pixels) shown += pixel != picture.pixels.front();
    EXPECT_GT(shown, picture.pixels.size() / 10);
    viewer.clickAt(320, 400);
    EXPECT_TRUE(viewer->state.chosen.has_value());
}

TEST_F(ViewerTest, ARecordingThatIsNotMadeLeavesThePath) {
    Driven viewer(*context_, city_, path_);
    viewer.press('R');
    viewer.press('R');
    EXPECT_EQ(viewer->path().frames.size(), path_.frames.size());
    viewer->goTo(path_.frames.size() - 1);
    viewer.press('P');
    EXPECT_TRUE(viewer->state.playing) << "from the beginning again";
    viewer.frames(60);
    EXPECT_FALSE(viewer->state.playing);
    EXPECT_EQ(viewer->pathFrame(), path_.frames.size() - 1);
}

TEST_F(ViewerTest, WhatIsHiddenNamesItsHiders) {
    Driven viewer(*context_, city_, path_);
    const std::span<const uint8_t> reasons = viewer->culler().reasons();
    size_t with_hiders = 0;
    for (uint32_t object = 0; object < reasons.size() && with_hiders < 5; ++object) {
        if (reasons[object] != 1 + static_cast<int>(Stage::kOcclusion)) continue;
        viewer->state.chosen = object;
        viewer->state.why.clear();
        viewer.frames();
        EXPECT_NE(viewer->state.why.find("behind"), std::string::npos) << viewer->state.why;
        with_hiders += !viewer->state.hiders.empty();
    }
    EXPECT_EQ(with_hiders, 5u);
}

TEST_F(ViewerTest, DrawsRealScenesTheSameWithAndWithoutCulling) {
    bool any = false;
    for (const char* name : {"bsi-duplex", "gazebo-willowgarage", "aws-small-house"}) {
        const std::optional<Scene> scene = sharedScene(name);
        if (!scene) continue;
        any = true;
        const CameraPath path = seededCameras(*scene, 6, 4);
        for (const bool clusters : {false, true}) {
            Driven viewer(*context_, *scene, path, {.clusters = clusters});
            viewer->state.panels = false;
            const uint32_t stages = viewer->culler().settings.stages;
            for (size_t frame = 0; frame < path.frames.size(); ++frame) {
                viewer->goTo(frame);
                const Image<Rgb> culled = viewer.picture();
                viewer->culler().settings.stages = 0;
                const Image<Rgb> all = viewer.picture();
                viewer->culler().settings.stages = stages;
                EXPECT_LE(differing(culled, all), clusters ? kByClusters : 0) << name << " frame " << frame;
            }
        }
    }
    if (!any) GTEST_SKIP() << "no scenes beside the repository";
}

}  // namespace
}  // namespace sightline::viewer
