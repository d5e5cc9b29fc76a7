// The viewer without its window: what the user did goes in, a picture comes out.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/viewer/bsp_painter.h"
#include "apps/viewer/cell_faces.h"
#include "apps/viewer/culler.h"
#include "apps/viewer/fly_camera.h"
#include "apps/viewer/gui.h"
#include "apps/viewer/line_drawer.h"
#include "apps/viewer/object_clusters.h"
#include "apps/viewer/panels.h"
#include "apps/viewer/scene_drawer.h"
#include "apps/viewer/side_by_side.h"
#include "sightline/tools/report/pictures/png.h"
#include "sightline/tools/scene/camera_path.h"

namespace sightline::viewer {

struct ViewerSettings {
    tools::CameraPath path;                    ///< to begin with: its first frame is where the eye stands
    std::string path_stem = "sightline-path";  ///< of the file that a recorded path is written to, ".json"
    std::string frame_stem = "sightline";      ///< of the file that a recorded frame is written to, ".frame"
    ViewPlanes sections;                       ///< that cut the scene open, beside the user's own
    double jitter = 0.5;                       ///< View::jitter of the culling camera
    bool times = true;               ///< are shown; else pictures are the same each time, but for the card's queries
    float scale = 1;                 ///< of the panels
    std::optional<CellSpace> cells;  ///< of the attached visibility file: where they are
};

class Viewer {
public:
    /// A context of OpenGL 3.3 or later must be current, here and in all that follows.
    /// @param scene  must outlive it
    /// Errors: of the GL.
    static Result<std::unique_ptr<Viewer>> create(const tools::Scene& scene, tools::LoadedWorld world,
                                                  const QuerySettings& settings, ViewerSettings viewer);
    ~Viewer();

    /// Draws a frame of that size. Errors: of the GL, no memory for an image so large.
    Status frame(const Input& input, uint32_t width, uint32_t height);
    /// Into the window.
    void show(uint32_t width, uint32_t height) const { image_.show(width, height); }
    /// The last frame.
    Result<tools::Image<tools::Rgb>> picture() const { return image_.picture(); }

    ViewerState state;
    FlyCamera eye, culling;
    Culler& culler() { return culler_; }
    /// Goes to a frame of the path.
    void goTo(size_t frame);
    const tools::CameraPath& path() const { return settings_.path; }
    size_t pathFrame() const { return path_frame_; }

    /// The last view by all ways; null: nobody wanted it, or the GL cannot.
    const SideBySide* ways() const { return ways_.get(); }
    /// Null: nobody wanted it, or the scene is too large.
    const BspPainter* painter() const { return painter_.get(); }

    uint64_t triangles() const { return triangles_; }  ///< in the last picture

    const PanelPlaces& places() const { return places_; }  ///< of the last frame
    /// Whether the next frame would be the same, were nothing done meanwhile.
    bool rests() const { return rests_; }

private:
    Viewer(const tools::Scene& scene, tools::LoadedWorld world, const QuerySettings& settings, ViewerSettings viewer);
    Status prepare();

    void steer(const Input& input);
    void playPath();
    void keepRecording();
    void pressed(const Input& input);
    ViewPlanes sections() const;
    View viewOf(const FlyCamera& camera, const ViewPlanes& sections) const;
    /// As the query is asked: what the section cuts after the camera was frozen, it cuts from the picture alone.
    View cullingView() const { return viewOf(culling, culling_sections_); }
    void askWays();
    bool paintBsp(const View& view, const GlView& gl_view);
    void drawObjects();
    void drawCulled(const GlView& view);
    void drawLines(const GlView& view);
    void drawPortals();
    void drawCells();
    void drawClusters();
    void drawDoors();
    void drawShadows(const Box3d& box);
    Status pick(const View& view, float x, float y);
    std::optional<uint32_t> nearestAt(std::span<const uint32_t> objects, int32_t column, int32_t row);
    void leave();
    void choose(std::optional<uint32_t> object);
    void explainChosen();
    void lookAtChosen();
    void saveFrame();
    void drawPanels();
    bool isShown(uint32_t object) const;
    bool isCulled(uint32_t object);
    void listGhosts();
    GlView glViewOf(const View& view) const;
    double aspect() const { return double(std::max(width_, 1u)) / std::max(height_, 1u); }

    const tools::Scene& scene_;
    Culler culler_;
    const QuerySettings begun_;  ///< as the viewer began
    ViewerSettings settings_;
    std::optional<SceneDrawer> drawer_;
    std::optional<LineDrawer> lines_, culled_lines_;
    std::unique_ptr<SideBySide> ways_;
    std::unique_ptr<BspPainter> painter_;
    std::optional<ObjectClusters> clusters_;  ///< of the chosen object
    std::optional<CellFaces> cell_faces_;     ///< once they were wanted
    std::string ways_problem_, bsp_problem_;
    uint32_t ways_asked_ = 0;  ///< times, about the view at hand
    Gui gui_;
    ScreenImage image_, pick_image_;
    Box3d bounds_;
    double size_ = 1;  ///< of the scene  [world units]
    uint32_t width_ = 0, height_ = 0;
    Input last_;
    ViewPlanes culling_sections_;
    std::vector<uint32_t> picked_;  ///< by clicks at one place, one after the other
    glm::vec2 picked_at_{-1.0f};
    glm::dmat4 picked_from_{0.0};
    bool may_end_ = false;  ///< Escape was pressed, and nothing since
    size_t path_frame_ = 0;
    double path_time_ = 0;
    bool dragged_ = false, pressed_in_world_ = false, culled_boxes_stale_ = true, answer_changed_ = false;
    bool path_works_ = false, rests_ = false;
    tools::CameraPath recorded_;
    std::vector<uint32_t> ghosts_;
    size_t ghosts_left_out_ = 0;
    size_t boxes_left_out_ = 0;
    std::vector<float> frame_milliseconds_, query_microseconds_;
    uint64_t triangles_ = 0;
    PanelPlaces places_;
};

}  // namespace sightline::viewer
