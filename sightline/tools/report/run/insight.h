// What a whole path tells of a scene: who hides most, what is never seen, what comes and goes together.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "sightline/tools/report/run/cull_run.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

/// An occluder over all frames: sums of its credits.
struct OccluderRow {
    uint32_t object = 0;          ///< index into Scene::objects
    uint64_t frames = 0;          ///< in which it was rasterized
    uint64_t triangles = 0;       ///< rasterized
    double hidden = 0;            ///< object-frames
    double hidden_triangles = 0;  ///< triangle-frames
};

/// All objects that were rasterized as occluders, those that hide most first.
std::vector<OccluderRow> occluderRows(const CullRun& run);

/// Triangles hidden for each one that was rasterized for it.
double worthOf(const OccluderRow& row);
/// Those that hide anything, but for rounding, those with the most worth first.
std::vector<OccluderRow> payingRows(const std::vector<OccluderRow>& rows);
/// Those that hid nothing, those with the most triangles first.
std::vector<OccluderRow> idleRows(const std::vector<OccluderRow>& rows);

/// Objects that no frame kept, those with most triangles first: candidates for removal, as far as the path goes.
std::vector<uint32_t> neverKept(const CullRun& run, const Scene& scene);

/// Objects that every frame either keeps all of or culls all of, that some frame keeps, hang at the same node of the
/// file's tree, and are small: at most 2000 triangles each, and all within a box of 5 % of the scene's diagonal.
/// Candidates for merging into one draw.
struct TogetherGroup {
    std::vector<uint32_t> objects;  ///< indices into Scene::objects, ascending
    uint64_t triangles = 0;
    uint64_t frames = 0;  ///< that kept them
};

/// The largest groups first.
std::vector<TogetherGroup> keptTogether(const CullRun& run, const Scene& scene);

}  // namespace sightline::tools
