// What a query did, counted: one table that names each counter, and how the counts of eyes and strips add up.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sightline/geom/off.h"
#include "sightline/geom/stage.h"

namespace sightline {

/// Counts objects; a culled tree node counts all its objects.
struct StageStats {
    uint64_t tested = 0;
    uint64_t culled = 0;
    uint64_t doubt = 0;        ///< kept because the stage could not decide
    uint64_t nanoseconds = 0;  ///< only with QuerySettings::time_stages
};

/// What a query did. kQueryCounters has a row for each counter that says what it means. If the image is in strips, work
/// is that of all strips together, and objects are those of the answer; only what faces and triangles cull in several
/// strips counts once in each.
struct QueryStats {
    StageStats stages[kStageCount];
    uint64_t objects = 0;
    uint64_t visible = 0;
    uint64_t nodes_visited = 0;
    uint64_t occluder_triangles = 0;
    uint64_t unasked = 0;
    uint64_t proved = 0;
    uint64_t proofs_sought = 0;
    uint64_t proofs_found = 0;
    uint64_t proof_rays = 0;
    uint64_t proof_cuts = 0;
    uint64_t seam_pixels = 0;
    uint64_t closed_gaps = 0;
    uint64_t faces_tested = 0;
    uint64_t faces_culled = 0;
    uint64_t second_looks = 0;
    uint64_t second_look_culled = 0;
    uint64_t second_look_polygons = 0;
    uint64_t clusters_tested = 0;
    uint64_t clusters_back = 0;
    uint64_t clusters_outside = 0;
    uint64_t clusters_hidden = 0;
    uint64_t cluster_triangles = 0;
    uint64_t drawn_triangles = 0;
    uint64_t draw_ranges = 0;
    uint64_t lod_finest = 0;
    uint64_t lod_triangles = 0;
    uint64_t lod_fading = 0;
    uint64_t lod_cost = 0;
    uint64_t nanoseconds = 0;
    bool budget_spent = false;
    bool second_look_spent = false;
    bool lod_exceeded = false;
    uint32_t off = 0;  ///< bits of Off: what the settings and the view asked for, and was switched off all the same

    StageStats& of(Stage stage) { return stages[static_cast<int>(stage)]; }
    const StageStats& of(Stage stage) const { return stages[static_cast<int>(stage)]; }
    /// Adds the work and the doubt of another strip or eye. The counts of the answer's objects do not change:
    /// `objects`, `visible`, and the stages' `tested` and `culled`.
    void addWork(const QueryStats& other);
};

/// One row of the table.
struct CounterRow {
    const char* name;  ///< as JSON has it
    uint64_t QueryStats::*member;
    const char* unit;
    enum Kind : uint8_t {
        kOfAnswer,  ///< counts objects of the answer, not work: addWork() leaves it alone
        kWork,
        kRare,       ///< work of which there is mostly none: JSON leaves zeros out
        kOfClusters  ///< work of the stage of clusters: JSON has it there
    } kind;
    const char* help;
};

/// All counters: the sums, JSON and the pages read this table.
inline constexpr CounterRow kQueryCounters[] = {
    {"objects", &QueryStats::objects, "objects", CounterRow::kOfAnswer, "in the snapshot, within the view's layers"},
    {"visible", &QueryStats::visible, "objects", CounterRow::kOfAnswer, "objects less the sum of culled"},
    {"nodes_visited", &QueryStats::nodes_visited, "nodes", CounterRow::kWork, "of the hierarchy that were opened"},
    {"occluder_triangles", &QueryStats::occluder_triangles, "triangles", CounterRow::kWork,
     "offered to the rasterizer"},
    {"unasked", &QueryStats::unasked, "nodes and objects", CounterRow::kRare,
     "kept without a question, because the answers before had kept them"},
    {"proved", &QueryStats::proved, "nodes and objects", CounterRow::kRare,
     "culled by certificates: by what hid them in an answer before"},
    {"proofs_sought", &QueryStats::proofs_sought, "nodes and objects", CounterRow::kRare,
     "for which a certificate was looked for"},
    {"proofs_found", &QueryStats::proofs_found, "nodes and objects", CounterRow::kRare, "of these, with success"},
    {"proof_rays", &QueryStats::proof_rays, "rays", CounterRow::kRare, "that were shot for it"},
    {"proof_cuts", &QueryStats::proof_cuts, "polygons", CounterRow::kRare,
     "outlines that were made, and pieces of them that shadows were taken from"},
    {"seam_pixels", &QueryStats::seam_pixels, "pixels", CounterRow::kWork,
     "resolved by the union of the polygons that share them"},
    {"closed_gaps", &QueryStats::closed_gaps, "pixels", CounterRow::kRare,
     "of those, covered because close_gaps closed gaps there"},
    {"faces_tested", &QueryStats::faces_tested, "objects", CounterRow::kWork, "asked by the faces of their boxes"},
    {"faces_culled", &QueryStats::faces_culled, "objects", CounterRow::kWork, "of these, culled"},
    {"second_looks", &QueryStats::second_looks, "objects", CounterRow::kWork, "asked by their own triangles"},
    {"second_look_culled", &QueryStats::second_look_culled, "objects", CounterRow::kWork, "of these, culled"},
    {"second_look_polygons", &QueryStats::second_look_polygons, "polygons", CounterRow::kWork,
     "that these were asked by"},
    {"clusters_tested", &QueryStats::clusters_tested, "clusters", CounterRow::kOfClusters,
     "of objects that were kept until then"},
    {"clusters_back", &QueryStats::clusters_back, "clusters", CounterRow::kOfClusters,
     "of these, seen from their backs"},
    {"clusters_outside", &QueryStats::clusters_outside, "clusters", CounterRow::kOfClusters,
     "of the others, outside of the view"},
    {"clusters_hidden", &QueryStats::clusters_hidden, "clusters", CounterRow::kOfClusters, "of the rest, hidden"},
    {"cluster_triangles", &QueryStats::cluster_triangles, "triangles", CounterRow::kOfClusters,
     "of the objects of which some are left"},
    {"drawn_triangles", &QueryStats::drawn_triangles, "triangles", CounterRow::kOfClusters, "of VisibleSet::ranges"},
    {"draw_ranges", &QueryStats::draw_ranges, "ranges", CounterRow::kOfClusters, "VisibleSet::ranges"},
    {"lod_finest", &QueryStats::lod_finest, "triangles", CounterRow::kRare,
     "of the finest levels of the objects that have several"},
    {"lod_triangles", &QueryStats::lod_triangles, "triangles", CounterRow::kRare,
     "of the levels that are drawn instead; while two are blended, of both"},
    {"lod_fading", &QueryStats::lod_fading, "objects", CounterRow::kRare, "of which two levels are blended"},
    {"lod_cost", &QueryStats::lod_cost, "ns", CounterRow::kRare, "of the levels that were chosen under a budget"},
    {"nanoseconds", &QueryStats::nanoseconds, "ns", CounterRow::kWork, "the whole query"},
};

/// One row of the table of flags.
struct CounterFlagRow {
    const char* name;
    bool QueryStats::*member;
    const char* help;
};
inline constexpr CounterFlagRow kQueryFlags[] = {
    {"budget_spent", &QueryStats::budget_spent, "some visible occluders were not rasterized"},
    {"second_look_spent", &QueryStats::second_look_spent,
     "second_look_polygons kept an object from being asked to the end"},
    {"lod_exceeded", &QueryStats::lod_exceeded, "what must be drawn costs more than the budget"},
};

inline void QueryStats::addWork(const QueryStats& other) {
    for (int stage = 0; stage < kStageCount; ++stage) {
        stages[stage].doubt += other.stages[stage].doubt;
        stages[stage].nanoseconds += other.stages[stage].nanoseconds;
    }
    for (const CounterRow& row : kQueryCounters)
        if (row.kind != CounterRow::kOfAnswer) this->*row.member += other.*row.member;
    for (const CounterFlagRow& row : kQueryFlags) this->*row.member |= other.*row.member;
    off |= other.off;
}

}  // namespace sightline
