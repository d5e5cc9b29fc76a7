// The viewer driven as a user drives it, without a window: keys, clicks and drags in, pictures and answers out.
// SPDX-License-Identifier: MIT
#include "apps/viewer/viewer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <unistd.h>

#include "apps/gl/context.h"
#include "sightline/bake/bake.h"
#include "sightline/tools/import/gltf/gltf.h"
#include "sightline/tools/load/mesh_lods.h"
#include "sightline/tools/load/seeded_cameras.h"
#include "sightline/tools/scene/camera_path.h"
#include "sightline/tools/scene/building/building.h"
#include "sightline/tools/scene/city/city.h"
#include "sightline/tools/scene/terrain/terrain.h"
#include "tests/support/random.h"
#include "tests/support/shared_scenes.h"

namespace sightline::viewer {
namespace {
using namespace test;
using namespace tools;

constexpr uint32_t kWidth = 640, kHeight = 1000;  // high enough for all panels

struct DrivenSettings {
    double lod_error = 0;  ///< levels of detail are chosen by it
    bool cells = false;    ///< those that the scene marks are attached, without rows
};

/// A viewer with a mouse and keys.
class Driven {
public:
    Driven(const GlContext& context, const Scene& scene, const CameraPath& path, const DrivenSettings& with = {}) {
        context.makeCurrent();
        ViewerSettings settings;
        settings.path = path;
        settings.path_file = path_file_.string();
        QuerySettings query;
        query.stages = stageBit(Stage::kFrustum) | stageBit(Stage::kOcclusion);
        if (with.lod_error > 0) query.stages |= stageBit(Stage::kLod);
        if (with.cells) query.stages |= stageBit(Stage::kPortals);
        query.lod_error = with.lod_error;
        LoadSettings load;
        load.volumes = true;
        load.lods = with.lod_error > 0;
        LoadedWorld world = loadWorld(scene, {}, load);
        if (with.cells) {
            bake::SceneCellSettings marks;
            marks.trusted = true;
            EXPECT_TRUE(world.world.attach(bake::sceneToBake(scene, "house", marks).space));
        }
        Result<std::unique_ptr<Viewer>> made = Viewer::create(scene, std::move(world), query, settings);
        EXPECT_TRUE(made.ok()) << made.error().message;
        if (made) viewer_ = std::move(*made);
        frames(2);
    }

    Viewer& operator*() { return *viewer_; }
    Viewer* operator->() { return viewer_.get(); }

    ~Driven() {
        std::error_code ignored;
        std::filesystem::remove(path_file_, ignored);
    }
    void frames(int count = 1) {
        for (int i = 0; i < count; ++i) {
            const Status drawn = viewer_->frame(input_, kWidth, kHeight);
            ASSERT_TRUE(drawn.ok()) << drawn.error().message;
        }
    }
    void press(uint16_t key) {
        input_.keys[key] = true;
        frames();
        input_.keys[key] = false;
        frames();
    }
    void hold(uint16_t key, int count) {
        input_.keys[key] = true;
        frames(count);
        input_.keys[key] = false;
        frames();
    }
    void clickAt(float x, float y) {
        input_.mouse_x = x;
        input_.mouse_y = y;
        frames();
        input_.buttons[0] = true;
        frames();
        input_.buttons[0] = false;
        frames(2);
    }
    /// Clicks a part of a panel; false if there is none with these words.
    bool click(const std::string& words) {
        const auto place = viewer_->places().find(words);
        if (place == viewer_->places().end()) return false;
        const PanelPlace at = place->second;
        clickAt(at.left + 8, 0.5f * (at.top + at.bottom));
        away();
        return true;
    }
    /// Types into a part of a panel, and ends with Enter.
    bool type(const std::string& words, const std::string& text) {
        if (!click(words)) return false;
        input_.text = text;
        frames();
        input_.text.clear();
        press(kEnter);
        return true;
    }
    /// Presses the left button at one place and lets go of it at another.
    void press(float x, float y, float to_x, float to_y) {
        input_.mouse_x = x;
        input_.mouse_y = y;
        frames();
        input_.buttons[0] = true;
        frames(2);
        input_.mouse_x = to_x;
        input_.mouse_y = to_y;
        frames(2);
        input_.buttons[0] = false;
        frames(2);
        away();
    }
    void drag(int button, float right, float down) {
        input_.mouse_x = 500;
        input_.mouse_y = 400;
        frames();
        input_.buttons[button] = true;
        frames();
        input_.mouse_x += right;
        input_.mouse_y += down;
        frames();
        input_.buttons[button] = false;
        frames();
        away();
    }
    void away() {
        input_.mouse_x = input_.mouse_y = -1;
        frames();
    }
    Image<Rgb> picture() {
        frames();
        const Result<Image<Rgb>> picture = viewer_->picture();
        EXPECT_TRUE(picture.ok());
        return picture ? *picture : Image<Rgb>();
    }
    std::string pathFile() const { return path_file_.string(); }

private:
    const std::filesystem::path path_file_ =
        std::filesystem::temp_directory_path() / ("sightline-viewer-" + std::to_string(getpid()) + ".json");
    std::unique_ptr<Viewer> viewer_;
    Input input_;
};

size_t differing(const Image<Rgb>& a, const Image<Rgb>& b) {
    size_t count = 0;
    for (size_t i = 0; i < a.pixels.size(); ++i) count += a.pixels[i] != b.pixels[i];
    return count;
}

class ViewerTest : public testing::Test {
protected:
    void SetUp() override {
        if (!context_) GTEST_SKIP() << context_.error().message;
    }
    Result<GlContext> context_ = GlContext::create(1);
    Scene city_ = makeCity(1, 400);
    CameraPath path_ = cityStreetPath(1, 12);
};

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

TEST_F(ViewerTest, EveryModeCanBeSeen) {
    Driven viewer(*context_, city_, path_);
    viewer->goTo(3);
    viewer.press('F');
    viewer.press(kHome);  // the whole city, with what was culled
    viewer->state.panels = false;
    viewer->state.culled_as = CulledAs::kNothing;
    viewer->state.frustum = false;
    const Image<Rgb> plain = viewer.picture();
    ViewerState& state = viewer->state;
    const auto shows = [&](const char* what, auto&& change) {
        const ViewerState before = state;
        change();
        EXPECT_GT(differing(plain, viewer.picture()), 20u) << what;
        state = before;
    };
    shows("boxes", [&] { state.culled_as = CulledAs::kBoxes; });
    shows("ghosts", [&] { state.culled_as = CulledAs::kGhosts; });
    shows("frustum", [&] { state.frustum = true; });
    shows("bounds", [&] { state.bounds = true; });
    shows("objects", [&] { state.colour_by = ColourBy::kObjects; });
    shows("answer", [&] { state.colour_by = ColourBy::kAnswer; });
    shows("x-ray", [&] { state.x_ray = true; });
    shows("shadow casters", [&] { state.casters = true; });
    shows("tree", [&] { state.tree_level = 1; });
    shows("section", [&] {
        state.section = true;
        state.section_at = 0.05f;
    });
    shows("section across", [&] {
        state.section = true;
        state.section_axis = 0;
        state.section_keeps_upper = true;
    });
    shows("chosen", [&] { state.chosen = viewer->culler().visible().front(); });
    shows("isolated", [&] {
        state.chosen = viewer->culler().visible().front();
        state.isolate = true;
    });
    const std::span<const uint8_t> reasons = viewer->culler().reasons();
    for (uint32_t object = 0; object < reasons.size() && state.outlines.empty(); ++object)
        if (reasons[object] == 1 + static_cast<int>(Stage::kOcclusion)) {
            state.chosen = object;
            viewer.frames(2);
        }
    EXPECT_FALSE(state.outlines.empty()) << "something hidden is in shadows";
    const Image<Rgb> with_shadows = viewer.picture();
    state.shadows = false;
    EXPECT_GT(differing(with_shadows, viewer.picture()), 20u);
    state.shadows = true;
    state.chosen.reset();
    state.outlines.clear();
    state.hiders.clear();
    state.why.clear();
    shows("clusters", [&] {
        state.chosen = viewer->culler().visible().front();
        state.clusters = true;
    });
    shows("a culling volume", [&] {
        state.chosen = viewer->culler().visible().front();
        state.clusters = true;
        state.cluster = 0;
    });
    shows("levels", [&] { state.colour_by = ColourBy::kLevels; });
    shows("half of a BSP tree", [&] {
        state.bsp = true;
        state.bsp_part = 0.5f;
    });
    shows("panels", [&] { state.panels = true; });
    shows("ways", [&] { state.panels = state.ways = true; });
    shows("buffer", [&] { state.panels = state.buffer = true; });
    EXPECT_EQ(differing(plain, viewer.picture()), 0u) << "all that was changed is as it was";
}

TEST_F(ViewerTest, PanelsDoWhatTheySay) {
    Driven viewer(*context_, city_, path_);
    const size_t kept = viewer->culler().visible().size();
    ASSERT_TRUE(viewer.click("occlusion"));
    EXPECT_GT(viewer->culler().visible().size(), kept);
    ASSERT_TRUE(viewer.click("occlusion"));
    EXPECT_EQ(viewer->culler().visible().size(), kept);
    ASSERT_TRUE(viewer.click("freeze the culling camera (F)"));
    EXPECT_TRUE(viewer->state.frozen);
    ASSERT_TRUE(viewer.click("ghosts"));
    EXPECT_EQ(viewer->state.culled_as, CulledAs::kGhosts);
    ASSERT_TRUE(viewer.click("cut open"));
    viewer.frames(2);
    ASSERT_TRUE(viewer.click("section"));
    EXPECT_TRUE(viewer->state.section);
    ASSERT_TRUE(viewer.click("record (R)"));
    EXPECT_TRUE(viewer->state.recording);
    viewer.hold('W', 30);
    ASSERT_TRUE(viewer.click("record (R)"));
    EXPECT_GE(viewer->path().frames.size(), 10u);
    ASSERT_TRUE(viewer.click("save path"));
    const Result<CameraPath> saved = readCameraPath(viewer.pathFile());
    ASSERT_TRUE(saved.ok()) << saved.error().message;
    EXPECT_EQ(saved->frames.size(), viewer->path().frames.size());
    ASSERT_TRUE(viewer.click("picture (F12)"));
    EXPECT_TRUE(viewer->state.wants_picture);
    EXPECT_FALSE(viewer.click("what no panel has"));
}

TEST_F(ViewerTest, SettingsAreTyped) {
    Driven viewer(*context_, city_, path_);
    ASSERT_TRUE(viewer.click("stages"));  // shut, so that all settings have room
    ASSERT_TRUE(viewer.click("settings"));
    QuerySettings& settings = viewer->culler().settings;
    EXPECT_EQ(settings.occlusion_size, QuerySettings().occlusion_size);
    ASSERT_TRUE(viewer.type("occlusion_size", "128"));
    EXPECT_EQ(settings.occlusion_size, 128u);
    const Query::DepthImage image = viewer->culler().depthImage();
    EXPECT_EQ(std::max(image.width, image.height), 128u);
    ASSERT_TRUE(viewer.type("occlusion_size", "999999"));
    EXPECT_EQ(settings.occlusion_size, 8192u) << "the most there is";
    ASSERT_TRUE(viewer.type("occlusion_size", "0"));
    EXPECT_EQ(settings.occlusion_size, 1u);
    ASSERT_TRUE(viewer.type("occlusion_size", "384"));
    ASSERT_TRUE(viewer.type("hysteresis", "0.25"));
    EXPECT_EQ(settings.hysteresis, 0.25);
    ASSERT_TRUE(viewer.click("masked"));
    EXPECT_TRUE(settings.masked);
    size_t rows = 0;
    forEachSetting([&](const auto& row) {
        rows += std::string(row.name) != "stages" && viewer->places().contains(row.name);  // a panel has that name
    });
    EXPECT_EQ(rows + 5, std::tuple_size_v<decltype(kQuerySettings)>) << "all but those that are elsewhere";
}

TEST_F(ViewerTest, CertificatesCanBeSwitchedOn) {
    Driven viewer(*context_, city_, path_);
    const std::vector<uint32_t> before(viewer->culler().visible().begin(), viewer->culler().visible().end());
    ASSERT_TRUE(viewer.click("certificates"));
    EXPECT_TRUE(viewer->culler().settings.proofs);
    viewer->state.panels = false;
    uint64_t proved = 0;
    for (size_t frame = 0; frame < path_.frames.size(); ++frame) {
        viewer->goTo(frame);
        viewer.hold('W', 12);  // views that follow one another
        proved += viewer->culler().stats().proved;
        const Image<Rgb> culled = viewer.picture();
        viewer->culler().settings.stages = 0;
        EXPECT_EQ(differing(culled, viewer.picture()), 0u) << "frame " << frame;
        viewer->culler().settings.stages = stageBit(Stage::kFrustum) | stageBit(Stage::kOcclusion);
        viewer.frames();
    }
    EXPECT_GT(proved, 0u);
    viewer->state.panels = true;
    viewer->goTo(0);
    viewer.frames(2);
    ASSERT_TRUE(viewer.click("certificates"));
    EXPECT_FALSE(viewer->culler().settings.proofs);
}

TEST_F(ViewerTest, AllWaysKeepWhatTheImageShows) {
    Driven viewer(*context_, city_, path_);
    viewer.click("ways of culling, side by side");
    ASSERT_NE(viewer->ways(), nullptr);
    const SideBySide& ways = *viewer->ways();
    size_t kept[kWays] = {}, seen = 0;
    for (size_t frame = 0; frame < path_.frames.size(); ++frame) {
        viewer->goTo(frame);
        viewer.frames(4);
        EXPECT_GT(ways.seen(), 0u);
        seen += ways.seen();
        for (int way = 0; way < kWays; ++way) {
            const WayAnswer& answer = ways.of(static_cast<Way>(way));
            EXPECT_EQ(answer.missed, 0u) << kWayNames[way] << " frame " << frame;
            EXPECT_GE(answer.kept.size(), ways.seen()) << kWayNames[way] << " frame " << frame;
            EXPECT_LT(answer.kept.size(), city_.objects.size() / 2) << kWayNames[way] << " frame " << frame;
            EXPECT_FALSE(answer.note.empty());
            kept[way] += answer.kept.size();
        }
    }
    EXPECT_LE(kept[static_cast<int>(Way::kProposals)], kept[static_cast<int>(Way::kCertificates)]);
    EXPECT_GE(kept[static_cast<int>(Way::kProposals)], seen);
}

/// How often two pictures differ in the proportion of red, green and blue, which light leaves as it is.
size_t differingHues(const Image<Rgb>& a, const Image<Rgb>& b) {
    const auto hue = [](const Rgb& pixel) {
        glm::dvec3 linear;
        for (int i = 0; i < 3; ++i) linear[i] = std::pow((double(pixel[size_t(i)]) + 0.5) / 256, 2.2);
        return linear / (linear.r + linear.g + linear.b);
    };
    size_t count = 0;
    for (size_t i = 0; i < a.pixels.size(); ++i) count += glm::length(hue(a.pixels[i]) - hue(b.pixels[i])) > 0.03;
    return count;
}

TEST_F(ViewerTest, ABspTreePaintsWhatADepthBufferShows) {
    Driven viewer(*context_, city_, path_);
    viewer->state.panels = false;
    for (const size_t frame : {size_t{0}, size_t{4}, size_t{9}}) {
        viewer->goTo(frame);
        viewer->state.bsp = false;
        const Image<Rgb> drawn = viewer.picture();
        viewer->state.bsp = true;
        viewer->state.bsp_part = 1;
        const Image<Rgb> painted = viewer.picture();
        ASSERT_NE(viewer->painter(), nullptr);
        EXPECT_EQ(viewer->painter()->drawn(), viewer->painter()->pieces());
        EXPECT_LT(differingHues(drawn, painted), drawn.pixels.size() / 100) << "frame " << frame;
        viewer->state.bsp_part = 0;
        const Image<Rgb> nothing = viewer.picture();
        EXPECT_EQ(std::count(nothing.pixels.begin(), nothing.pixels.end(), nothing.pixels[0]),
                  std::ptrdiff_t(nothing.pixels.size()));
        viewer->state.bsp_part = 0.5f;
        EXPECT_GT(differingHues(painted, viewer.picture()), drawn.pixels.size() / 100) << "frame " << frame;
    }
    viewer->state.panels = true;
    viewer.frames(2);
    ASSERT_TRUE(viewer.click("paint anew"));
    EXPECT_LT(viewer->state.bsp_part, 0.1f);
    viewer.frames(30);
    EXPECT_GT(viewer->state.bsp_part, 0.02f) << "it goes on by itself";
}

TEST_F(ViewerTest, LevelsOfDetailAreDrawn) {
    Scene scene = makeTerrain(1, 64);
    for (Mesh& mesh : scene.meshes) addMeshLods(mesh);
    CameraPath path;
    path.frames.resize(2);
    const Box3d box = worldBounds(scene);
    path.frames[0].target = path.frames[1].target = box.center();
    path.frames[0].eye = box.center() + glm::dvec3(0, 0.05, 0.05) * glm::length(box.size());
    path.frames[1].eye = box.center() + glm::dvec3(0, 20, 20) * glm::length(box.size());
    Driven viewer(*context_, scene, path, {.lod_error = 4});
    const auto coarsest = [&] {
        uint8_t level = 0;
        for (const uint32_t object : viewer->culler().visible())
            level = std::max(level, viewer->culler().levelOf(object));
        return level;
    };
    viewer->goTo(1);
    viewer.frames(2);
    EXPECT_GT(coarsest(), 0);
    const uint8_t far = coarsest();
    viewer->goTo(0);
    viewer.frames(2);
    EXPECT_LT(coarsest(), far);
    ASSERT_TRUE(viewer.click("lod"));
    viewer.frames(2);
    EXPECT_EQ(coarsest(), 0) << "its switch";
}

TEST_F(ViewerTest, WhoHidesMostIsFound) {
    Driven viewer(*context_, city_, path_);
    ASSERT_TRUE(viewer.click("who hides most"));
    EXPECT_FALSE(viewer->culler().knowsHidesMost()) << "it takes time";
    ASSERT_TRUE(viewer.click("find out"));
    ASSERT_TRUE(viewer->culler().knowsHidesMost());
    const std::span<const HidesMost> most = viewer->culler().hidesMost();
    ASSERT_GE(most.size(), 2u);
    double hidden = 0;
    for (size_t i = 0; i < most.size(); ++i) {
        hidden += most[i].hidden;
        EXPECT_LE(most[i].hidden, most[i > 0 ? i - 1 : 0].hidden);
    }
    EXPECT_NEAR(hidden, double(viewer->culler().stats().of(Stage::kOcclusion).culled), 1e-6 * hidden);
    const uint32_t first = most[0].object;
    ASSERT_TRUE(viewer.click("the one that hides most"));
    EXPECT_EQ(viewer->state.chosen, first);
    viewer->goTo(5);
    viewer.frames();
    EXPECT_FALSE(viewer->culler().knowsHidesMost()) << "of another view";
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

TEST_F(ViewerTest, AShutDoorIsSeen) {
    const Scene house = makeBuilding(1, 1);
    Driven viewer(*context_, house, seededCameras(house, 1, 5), {.cells = true});
    std::vector<ViewerDoor>& doors = viewer->culler().doors();
    ASSERT_FALSE(doors.empty());
    for (const ViewerDoor& door : doors) {
        EXPECT_TRUE(door.object.has_value()) << door.name;
        EXPECT_NE(door.label.find('/'), std::string::npos) << "it says where it is";
        EXPECT_FALSE(door.portals.empty());
    }
    viewer->state.panels = false;
    viewer->state.bsp = true;
    viewer->state.bsp_part = 0;
    const Rgb background = viewer.picture().pixels[0];
    viewer->state.bsp = false;
    size_t fewer = 0, changed = 0;
    for (const ViewerDoor& at : doors) {
        // Straight through a door whose leaf stands open.
        if (at.name.find("(open)") == std::string::npos || fewer == 4) continue;
        const std::vector<glm::dvec3>& portal = at.portals.front();
        const glm::dvec3 through = glm::normalize(glm::cross(portal[1] - portal[0], portal[2] - portal[0]));
        CameraFrame camera;
        camera.target = 0.5 * (portal[0] + portal[2]);
        camera.eye = camera.target + 1.5 * through;
        viewer->eye.take(camera);
        for (ViewerDoor& door : doors) door.open = 1;
        const Image<Rgb> open = viewer.picture();
        const size_t visible = viewer->culler().visible().size();
        for (ViewerDoor& door : doors) door.open = 0;
        const Image<Rgb> shut = viewer.picture();
        EXPECT_LE(viewer->culler().visible().size(), visible);
        fewer += viewer->culler().visible().size() < visible;
        changed += differing(open, shut) > 0;
        size_t holes = 0;
        for (size_t i = 0; i < shut.pixels.size(); ++i)
            holes += shut.pixels[i] == background && open.pixels[i] != background;
        EXPECT_EQ(holes, 0u) << at.label;
    }
    EXPECT_EQ(fewer, 4u);
    EXPECT_GE(changed, 4u);
    viewer->state.panels = true;
    viewer->state.chosen = doors[0].object;
    viewer.frames(2);
    EXPECT_TRUE(viewer->places().contains("this door"));
    viewer->state.chosen.reset();
    ASSERT_TRUE(viewer.click("stages"));
    ASSERT_TRUE(viewer.click("show"));
    ASSERT_TRUE(viewer.click("doors"));
    ASSERT_TRUE(viewer.click("open all"));
    for (const ViewerDoor& door : doors) EXPECT_EQ(door.open, 1);
    ASSERT_TRUE(viewer.click("shut all"));
    for (const ViewerDoor& door : doors) EXPECT_EQ(door.open, 0);
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
        Driven viewer(*context_, *scene, path);
        viewer->state.panels = false;
        for (size_t frame = 0; frame < path.frames.size(); ++frame) {
            viewer->goTo(frame);
            const Image<Rgb> culled = viewer.picture();
            viewer->culler().settings.stages = 0;
            const Image<Rgb> all = viewer.picture();
            viewer->culler().settings.stages = stageBit(Stage::kFrustum) | stageBit(Stage::kOcclusion);
            EXPECT_EQ(differing(culled, all), 0u) << name << " frame " << frame;
        }
    }
    if (!any) GTEST_SKIP() << "no scenes beside the repository";
}

}  // namespace
}  // namespace sightline::viewer
