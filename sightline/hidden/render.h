// Hidden-surface removal: every classical method, one signature, one image.
// SPDX-License-Identifier: MIT
//
// Ivan Sutherland, Robert Sproull, Robert Schumacker. A Characterization of Ten Hidden-Surface Algorithms. 1974.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "sightline/geom/view.h"
#include "sightline/hidden/depth_settings.h"
#include "sightline/hidden/draw_item.h"
#include "sightline/hidden/image.h"

namespace sightline {

struct ZBufferMemory;

enum class HiddenMethod : uint8_t {
    kPainter,         ///< far to near by one depth a polygon: wrong where that is not enough
    kNewell,          ///< far to near, put in order by Newell, Newell and Sancha's tests, splitting what has no order
    kBspBackToFront,  ///< far to near in the order of a BSP tree
    kBspFrontToBack,  ///< near to far in the same, each sample written once
    kWarnock,         ///< area subdivision
    kZBuffer,
    kRaycast,  ///< a ray a sample
};
inline constexpr int kHiddenMethods = 7;
/// As the command line says them.
inline constexpr std::string_view kHiddenMethodNames[kHiddenMethods] = {
    "painter", "newell", "bsp-back-to-front", "bsp-front-to-back", "warnock", "zbuffer", "raycast"};

/// The depth that the painter's algorithm sorts by.
enum class PainterKey : uint8_t { kCentre, kFarthest };

/// How front-to-back drawing knows which samples are still free.
enum class FreeSamples : uint8_t {
    kCheck,     ///< each fragment looks: the naive way
    kSegments,  ///< a list of free segments a row (Gordon and Chen's dynamic screen)
    kBits,      ///< a bit a sample, sixty-four at a time
};

enum class RayTracer : uint8_t { kBvh, kEmbree };

struct RenderSettings {
    HiddenMethod method = HiddenMethod::kZBuffer;
    PainterKey painter_key = PainterKey::kFarthest;
    FreeSamples free_samples = FreeSamples::kBits;
    RayTracer ray_tracer = RayTracer::kBvh;
    uint32_t threads = 1;         ///< at most so many; methods that cannot share their work use one
    bool want_counts = false;     ///< fill the per-sample counts of HiddenImage
    ProjectorSettings projector;  ///< clipping and facing
    DepthSettings depth;          ///< of the z-buffer
    /// What the z-buffer keeps for the next frame, zbuffer_method.h; null: nothing.
    ZBufferMemory* zbuffer_memory = nullptr;
};

/// What a method is given.
struct HiddenInput {
    const DrawList& list;
    const View& view;
    const RenderSettings& settings;

    SampleGrid grid() const { return {view.width, view.height, 0, 1, {}}; }
    Projector projector() const { return Projector(view, grid(), settings.projector); }
};

/// Draws one image, one sample a pixel, by the method chosen.
///
/// All methods show the same polygons: triangles that are not dropped as back faces, clipped and projected by one
/// Projector, a sample on a shared edge belonging to one of them. An exact method (all but the painter's) shows at each
/// sample the nearest; of surfaces at the same nearness (up to rounding) any of them. Surfaces that write no depth are
/// not drawn.
HiddenImage render(const DrawList& list, const View& view, const RenderSettings& settings);

}  // namespace sightline
