// The knobs and budgets of a query.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sightline/geom/lod.h"
#include "sightline/geom/stage.h"

namespace sightline {

/// How the part of the image that a cell is seen through is known.
enum class PortalWindows : uint8_t {
    kBoxes,     ///< a rectangle: the least work
    kOctagons,  ///< a rectangle with its corners cut
    kPolygons,  ///< convex polygons, one for each way through portals that leads there; tightest
};
inline constexpr const char* kWindowNames[] = {"boxes", "octagons", "polygons"};

/// What a query does for a view, how finely, and how much work it may take. The view says what is seen from where; these
/// say how. kQuerySettings (geom/setting_rows.h) has a row for each: its meaning stands there.
struct QuerySettings {
    uint32_t stages = kDefaultStages;
    PortalWindows windows = PortalWindows::kOctagons;
    uint32_t portal_depth = 0;
    uint32_t portal_work = 1u << 16;
    double max_distance = 0;
    double max_distance_fov = 0;
    double contribution = 0;
    double hysteresis = 0.1;
    uint32_t occluder_volumes = 8;
    uint32_t occluder_triangles = 1u << 17;
    uint32_t occlusion_size = 384;
    bool masked = false;
    double occluder_error = 2.0;
    double close_gaps = 0;
    bool faces = true;
    bool second_look = true;
    uint32_t second_look_polygons = 1u << 16;
    uint32_t cluster_gap = 0;
    double lod_error = 0;
    uint32_t lod_fade = 12;
    double budget = 0;
    bool hard_budget = false;
    double cost_object = 0;
    double cost_triangle = 0;
    double cost_vertex = 0;
    double cost_pixel = 0;
    uint32_t bins = 1;
    uint32_t unasked_answers = 15;
    bool proofs = true;
    bool stateless = false;
    bool time_stages = false;
};

/// What drawing costs, as the settings count it.
inline DrawCost drawCost(const QuerySettings& settings) {
    return {settings.cost_object, settings.cost_triangle, settings.cost_vertex, settings.cost_pixel};
}

/// Steps of QuerySettings::close_gaps in a pixel.
inline constexpr double kGapSteps = 0x1p20;

/// QuerySettings::close_gaps as it is used: between 0 and 1/16, and whole steps.
double closedGap(const QuerySettings& settings);

}  // namespace sightline
