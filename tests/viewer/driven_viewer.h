// A viewer that is driven as a user drives it, without a window: keys, clicks and drags in, pictures and answers out.
// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <unistd.h>

#include "apps/gl/context.h"
#include "apps/viewer/viewer.h"
#include "sightline/bake/bake.h"
#include "sightline/tools/load/load_world.h"
#include "sightline/tools/scene/city/city.h"

namespace sightline::viewer {
using namespace tools;

inline constexpr uint32_t kWidth = 640, kHeight = 1000;  // high enough for all panels

/// Pixels of a picture that may differ by clusters: their order is another one where two triangles have one depth, and a GL
/// that rounds corners draws some triangles from the front that are seen from the back, edge-on.
inline constexpr size_t kByClusters = 3;

struct DrivenSettings {
    double lod_error = 0;   ///< levels of detail are chosen by it
    bool cells = false;     ///< those that the scene marks are attached, without rows
    bool clusters = false;  ///< are prepared, and left out of the picture where they are not seen
};

/// A viewer with a mouse and keys.
class Driven {
public:
    Driven(const GlContext& context, const Scene& scene, const CameraPath& path, const DrivenSettings& with = {}) {
        context.makeCurrent();
        ViewerSettings settings;
        settings.path = path;
        settings.path_stem = path_stem_.string();
        settings.frame_stem = path_stem_.string();
        QuerySettings query;
        query.stages = stageBit(Stage::kFrustum) | stageBit(Stage::kOcclusion);
        if (with.lod_error > 0) query.stages |= stageBit(Stage::kLod);
        if (with.cells) query.stages |= stageBit(Stage::kPortals);
        if (with.clusters) query.stages |= stageBit(Stage::kClusters);
        query.lod_error = with.lod_error;
        LoadSettings load;
        load.volumes = true;
        load.lods = with.lod_error > 0;
        load.clusters = with.clusters;
        LoadedWorld world = loadWorld(scene, {}, load);
        if (with.cells) {
            bake::SceneCellSettings marks;
            marks.trusted = true;
            settings.cells = bake::sceneToBake(scene, "house", marks).space;
            EXPECT_TRUE(world.world.attach(*settings.cells));
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
        for (const char* end : {".json", "-2.json", ".frame"})
            std::filesystem::remove(path_stem_.string() + end, ignored);
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
    std::string pathStem() const { return path_stem_.string(); }

private:
    const std::filesystem::path path_stem_ =
        std::filesystem::temp_directory_path() / ("sightline-viewer-" + std::to_string(getpid()));
    std::unique_ptr<Viewer> viewer_;
    Input input_;
};

inline size_t differing(const Image<Rgb>& a, const Image<Rgb>& b) {
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

class ViewerPanels : public ViewerTest {};

}  // namespace sightline::viewer
