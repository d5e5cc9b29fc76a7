// The viewer's panels and modes: each does what it says, and what it shows holds.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include "sightline/geom/setting_rows.h"
#include "sightline/query/record/frame_recording.h"
#include "sightline/tools/load/mesh_lods.h"
#include "sightline/tools/load/seeded_cameras.h"
#include "sightline/tools/scene/building/building.h"
#include "sightline/tools/scene/terrain/terrain.h"
#include "tests/support/files.h"
#include "tests/viewer/driven_viewer.h"

namespace sightline::viewer {
namespace {

TEST_F(ViewerPanels, EveryModeCanBeSeen) {
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
    shows("section as I look", [&] {
        state.section = true;
        state.section_axis = 3;
        state.section_ahead = viewer->eye.forward();
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

TEST_F(ViewerPanels, PanelsDoWhatTheySay) {
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
    ASSERT_TRUE(viewer.click("save path"));  // beside the first
    for (const char* end : {".json", "-2.json"}) {
        const Result<CameraPath> saved = readCameraPath(viewer.pathStem() + end);
        ASSERT_TRUE(saved.ok()) << saved.error().message;
        EXPECT_EQ(saved->frames.size(), viewer->path().frames.size());
    }
    ASSERT_TRUE(viewer.click("picture (F12)"));
    EXPECT_TRUE(viewer->state.wants_picture);
    ASSERT_TRUE(viewer.click("record this frame"));
    const std::string frame = test::readBytes(viewer.pathStem() + ".frame");
    const Result<FrameRecording> recording = parseRecording(frame, "the frame");
    ASSERT_TRUE(recording.ok()) << recording.error().message;
    EXPECT_EQ(std::count(recording->reasons.begin(), recording->reasons.end(), 0),
              static_cast<long>(viewer->culler().visible().size()));
    EXPECT_FALSE(viewer.click("what no panel has"));
}

TEST_F(ViewerPanels, SettingsAreTyped) {
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
    ASSERT_TRUE(viewer.click("all as at the start"));
    EXPECT_FALSE(settings.masked);
    EXPECT_EQ(settings.hysteresis, QuerySettings().hysteresis);
    size_t rows = 0;
    forEachSetting([&](const auto& row) {
        rows += std::string(row.name) != "stages" && viewer->places().contains(row.name);  // a panel has that name
    });
    EXPECT_EQ(rows + 5, std::tuple_size_v<decltype(kQuerySettings)>) << "all but those that are elsewhere";
}

TEST_F(ViewerPanels, CertificatesCanBeSwitchedOn) {
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

TEST_F(ViewerPanels, AllWaysKeepWhatTheImageShows) {
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

TEST_F(ViewerPanels, ABspTreePaintsWhatADepthBufferShows) {
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

TEST_F(ViewerPanels, LevelsOfDetailAreDrawn) {
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

TEST_F(ViewerPanels, ClustersThatAreNotSeenAreNotDrawn) {
    const Scene scene = makeTerrain(1, 64);
    const CameraPath path = seededCameras(scene, 7, 6);
    Driven viewer(*context_, scene, path, {.clusters = true});
    uint64_t whole = 0, left = 0;
    for (size_t frame = 0; frame < path.frames.size(); ++frame) {
        viewer->goTo(frame);
        viewer.frames(2);
        const QueryStats with = viewer->culler().stats();
        const uint64_t drawn = viewer->triangles();
        EXPECT_GE(drawn, with.drawn_triangles) << "small meshes have no clusters";
        viewer->state.panels = false;
        const Image<Rgb> culled = viewer.picture();
        viewer->culler().settings.stages ^= stageBit(Stage::kClusters);
        EXPECT_LE(differing(culled, viewer.picture()), kByClusters) << "frame " << frame;
        EXPECT_EQ(viewer->triangles() - drawn, with.cluster_triangles - with.drawn_triangles);
        whole += viewer->triangles();
        left += drawn;
        viewer->state.panels = true;
        viewer.frames(2);
        ASSERT_TRUE(viewer.click("clusters")) << "its switch";
        EXPECT_NE(viewer->culler().settings.stages & stageBit(Stage::kClusters), 0u);
    }
    EXPECT_LT(left, whole * 9 / 10);

    // Its back is not there: whoever leaves the camera sees through.
    viewer->goTo(0);
    viewer->state.panels = false;
    viewer->state.culled_as = CulledAs::kNothing;
    viewer.press('F');
    viewer.press(kHome);
    const Image<Rgb> left_over = viewer.picture();
    viewer->culler().settings.stages ^= stageBit(Stage::kClusters);
    EXPECT_GT(differing(left_over, viewer.picture()), 20u);
}

TEST_F(ViewerPanels, WhoHidesMostIsFound) {
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

TEST_F(ViewerPanels, CellsAreSeenAndColoursAreNamed) {
    const Scene house = makeBuilding(1, 1);
    Driven viewer(*context_, house, seededCameras(house, 4, 2), {.cells = true});
    size_t in_cells = 0;
    for (size_t frame = 0; frame < 4; ++frame) {
        viewer->goTo(frame);
        viewer.frames(2);
        if (viewer->culler().windows().empty()) continue;
        ++in_cells;
        ASSERT_TRUE(viewer.click("what colours mean"));
        const Image<Rgb> named = viewer.picture();
        ASSERT_TRUE(viewer.click("cells"));
        EXPECT_GT(differing(named, viewer.picture()), 200u) << "frame " << frame;
        viewer->state.panels = false;
        const Image<Rgb> cells = viewer.picture();
        viewer->state.cells = false;
        EXPECT_GT(differing(cells, viewer.picture()), 100u) << "frame " << frame;
        viewer->state.panels = true;
        viewer.frames(2);
        ASSERT_TRUE(viewer.click("what colours mean"));
    }
    EXPECT_GT(in_cells, 0u);
    Driven without(*context_, house, seededCameras(house, 1, 2));
    EXPECT_FALSE(without.click("cells"));
}

TEST_F(ViewerPanels, AShutDoorIsSeen) {
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

}  // namespace
}  // namespace sightline::viewer
