// What a hidden-surface method is given: a draw list, a view, and its settings.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string_view>

#include "sightline/geom/view.h"
#include "sightline/studies/hidden/draw_item.h"
#include "sightline/studies/hidden/image.h"
#include "sightline/studies/hidden/project/projector.h"
#include "sightline/studies/hidden/zbuffer/depth_settings.h"

namespace sightline::studies {

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

}  // namespace sightline::studies
