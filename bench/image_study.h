// Measures portal images on a scene: pictures shown for doorways beside the geometry that they stand for.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/base/random.h"
#include "sightline/images/portal_images.h"
#include "sightline/images/psnr.h"
#include "sightline/tools/report/pictures/render_list.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::bench {
using namespace tools;

/// A scene as it is drawn here: flat, without haze and without shadows.
class DrawnScene {
public:
    explicit DrawnScene(const Scene& scene);

    const Scene& scene() const { return scene_; }
    std::span<const DrawItem> items() const { return all_.list().items(); }
    const Box3d& boxOf(size_t item) const { return boxes_[item]; }
    images::TakeSettings take() const;

    /// Indices of the items whose boxes may be in a view.
    std::vector<uint32_t> inView(const View& view) const;
    uint64_t triangles(const std::vector<uint32_t>& items) const;
    images::DepthImage draw(const std::vector<uint32_t>& items, const View& view) const;
    /// As images without depth are drawn.
    std::vector<glm::u8vec3> drawSmooth(const std::vector<uint32_t>& items, const View& view) const;

private:
    std::vector<DrawItem> itemsOf(const std::vector<uint32_t>& chosen) const;
    images::TakeSettings takeOf(const std::vector<uint32_t>& chosen) const;

    const Scene& scene_;
    RenderList all_;
    std::vector<Box3d> boxes_;
};

/// A doorway and the place that it is seen from.
struct StudiedDoorway {
    std::string name;
    images::PortalFrame frame;
    Box3d place;                         ///< where eyes may stand
    double height = 1.6;                 ///< of eyes above the frame's lower edge  [world units]
    double nearest = 1.5, farthest = 4;  ///< distances of eyes from the middle of the doorway  [world units]
    bool in_cell = true;  ///< what touches `place` is near; false: all but what is wholly seen through it
};

/// Doorways of a scene's own portals, spread over it: such as an eye can stand before.
std::vector<StudiedDoorway> doorwaysOf(const Scene& scene, uint64_t seed, size_t count);

/// One that cuts through a scene: all that is beyond stands for its far part.
StudiedDoorway cutThrough(const Scene& scene);

/// Rectangles of five by 2.6 units across the way of a walk, two and a half ahead of it: where it sees farthest. For scenes
/// without portals.
std::vector<StudiedDoorway> aheadIn(const DrawnScene& scene, uint64_t seed, size_t count);

/// What was measured in one place, over its eyes.
struct ModeFigures {
    images::PictureError on_screen, on_raster;
    double worst = 1e9;         ///< of an eye, on the screen  [dB]
    std::vector<double> times;  ///< to show  [microseconds of the thread]
    uint64_t holes = 0, texels = 0;
};

/// Predicted and measured displacement of one eye's nearest image.
struct DisplacementPoint {
    double predicted = 0, measured = 0;  ///< [pixels]
    double psnr = 0;                     ///< on the raster, of the nearest image  [dB]
};

struct StudyFigures {
    ModeFigures at_samples[images::kShowModes], on_arc[images::kShowModes], anywhere[images::kShowModes];
    std::vector<DisplacementPoint> points;
    images::PortalBakeReport bake;          ///< sums over the doorways
    double in_frustum = 0, with_image = 0;  ///< triangles, sums over the eyes
    std::vector<double> geometry_times;     ///< to draw what is beyond, instead  [microseconds of the thread]
    uint64_t reused = 0, frames = 0;        ///< of short walks, within a pixel
    double reuse_error = 0;                 ///< most that was predicted of them  [pixels]
    size_t doorways = 0, eyes = 0;
};

/// Bakes a doorway and adds what its pictures are like.
void studyDoorway(const DrawnScene& scene, const StudiedDoorway& doorway, uint64_t seed, StudyFigures& figures);

}  // namespace sightline::bench
