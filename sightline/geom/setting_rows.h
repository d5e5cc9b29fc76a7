// The table of a query's settings: names, units and limits, for whoever reads, writes or shows them all.
// SPDX-License-Identifier: MIT
//
// Apart from query_settings.h, which every file of a query reads, because the tuple is slow to compile.
#pragma once

#include <cstdint>
#include <tuple>

#include "sightline/geom/query_settings.h"

namespace sightline {

/// One row of the table.
template <class Value>
struct SettingRow {
    const char* name;  ///< as JSON has it
    const char*
        option;  ///< on the command line, without the dashes; null: it has none. A setting that is on by default
                 ///< has an option that turns it off
    Value QuerySettings::*member;
    const char* unit;    ///< empty: it has none
    double least, most;  ///< what a user may ask for; enumerations and flags: 0 and their last value
    const char* help;

    Value standard() const { return QuerySettings{}.*member; }
};
template <class Value>
constexpr SettingRow<Value> settingRow(const char* name, const char* option, Value QuerySettings::*member,
                                       const char* unit, double least, double most, const char* help) {
    return {name, option, member, unit, least, most, help};
}

/// All settings. The command line, both directions of JSON, the command that repeats a run, and the pages read this
/// table: a new setting is its member, its row, and its use.
inline constexpr auto kQuerySettings = std::tuple{
    settingRow("stages", nullptr, &QuerySettings::stages, "bits of Stage", 0, kAllStages, "which stages may cull"),
    settingRow("windows", "windows", &QuerySettings::windows, "", 0, 2,
               "how the part of the image that a cell is seen through is known"),
    settingRow(
        "portal_depth", "portal-depth", &QuerySettings::portal_depth, "portals", 0, 4294967295.0,
        "look through so many portals one after the other at most; what is farther may be visible and is culled; "
        "0: no limit"),
    settingRow("portal_work", nullptr, &QuerySettings::portal_work, "cells", 0, 4294967295.0,
               "work limit: cells entered; beyond it the stage of portals keeps everything"),
    settingRow("max_distance", "distance", &QuerySettings::max_distance, "world units", 0, 1e300,
               "cull what is wholly farther away, although it may be visible; infinity: only objects with a limit of "
               "their own; 0: off"),
    settingRow(
        "max_distance_fov", nullptr, &QuerySettings::max_distance_fov, "radians", 0, 3.14159,
        "the full vertical angle that max_distance is meant for: a view that zooms in sees farther by as much as "
        "it enlarges; 0: the same distance in every view"),
    settingRow("contribution", "contribution", &QuerySettings::contribution, "pixels", 0, 16384,
               "cull what looks smaller than a disk of this radius, although it may be visible; 0: off"),
    settingRow("hysteresis", "hysteresis", &QuerySettings::hysteresis, "share", 0, 1,
               "keep what the last answer kept until it is so much farther or smaller than the limits of distance and "
               "contribution, and the same of levels of detail; 0: no memory"),
    settingRow("occluder_volumes", nullptr, &QuerySettings::occluder_volumes, "volumes", 0, 64,
               "that the stage of volumes chooses at most"),
    settingRow("occluder_triangles_limit", "occluder-triangles", &QuerySettings::occluder_triangles, "triangles", 0,
               4294967295.0, "that a query draws at most, the nearest first; further objects hide nothing"),
    settingRow("occlusion_size", "occlusion-size", &QuerySettings::occlusion_size, "pixels", 1, 8192,
               "longer side of the occlusion buffer; a smaller viewport gets its own"),
    settingRow("masked", "masked", &QuerySettings::masked, "", 0, 1,
               "let a tile of the occlusion buffer remember two depths and a mask, not a depth per pixel"),
    settingRow("occluder_error", "occluder-error", &QuerySettings::occluder_error, "pixels of the buffer", 0, 1024,
               "let simpler occluders inside of dense solids stand in where they err by so much at most; 0: none"),
    settingRow(
        "close_gaps", "close-gaps", &QuerySettings::close_gaps, "pixels of the buffer", 0, 1.0 / 16,
        "close gaps between occluders that are narrower than this; what is seen through them alone may be culled"),
    settingRow("faces", "no-faces", &QuerySettings::faces, "", 0, 1,
               "ask an object by the rectangle around its box alone, not by the box's faces"),
    settingRow("second_look", "no-second-look", &QuerySettings::second_look, "", 0, 1,
               "do not ask what its box keeps by its own triangles"),
    settingRow("second_look_polygons_limit", "second-look-polygons", &QuerySettings::second_look_polygons, "polygons",
               0, 4294967295.0, "that a query asks at most; further objects are kept by their boxes"),
    settingRow("cluster_gap", nullptr, &QuerySettings::cluster_gap, "triangles", 0, 4294967295.0,
               "runs of an object's triangles with so few culled ones between them count as one draw"),
    settingRow("lod_error", "lod-error", &QuerySettings::lod_error, "pixels", 0, 1024,
               "draw the coarsest level of detail that errs by no more in the middle of the image; 0: the finest, but "
               "for a budget"),
    settingRow("lod_fade", "lod-fade", &QuerySettings::lod_fade, "answers", 0, 255,
               "how many answers it takes to fade a level of detail into another; 0: it is exchanged at once"),
    settingRow(
        "budget", "budget", &QuerySettings::budget, "milliseconds", 0, 1e9,
        "draw the levels of detail that are worth most within so much time, as the costs count it; 0: no budget"),
    settingRow(
        "hard_budget", "hard-budget", &QuerySettings::hard_budget, "", 0, 1,
        "leave out what the budget has no time for, although it may be visible; else its coarsest level is drawn"),
    settingRow("cost_object", "cost-object", &QuerySettings::cost_object, "ns", 0, 1e9,
               "cost of drawing an object at all"),
    settingRow("cost_triangle", "cost-triangle", &QuerySettings::cost_triangle, "ns", 0, 1e9,
               "cost of a triangle of a level of detail"),
    settingRow("cost_vertex", "cost-vertex", &QuerySettings::cost_vertex, "ns", 0, 1e9,
               "cost of a vertex of a level of detail"),
    settingRow("cost_pixel", "cost-pixel", &QuerySettings::cost_pixel, "ns", 0, 1e9,
               "cost of a pixel that an object may cover; this or its triangles and vertices, whichever is more"),
    settingRow("bins", "bins", &QuerySettings::bins, "strips", 1, 16,
               "strips of the occlusion buffer, each with a walk of its own, that threads can share; an object is kept "
               "that one of them keeps"),
    settingRow(
        "unasked_answers", nullptr, &QuerySettings::unasked_answers, "answers", 0, 63,
        "for so many at most, keep what was kept before without asking whether it is hidden by now, while the eye "
        "moves little; 0: ask each time"),
    settingRow("proofs", nullptr, &QuerySettings::proofs, "", 0, 1,
               "cull by certificates, by what hid a node or an object before, without drawing, where that does"),
    settingRow("stateless", nullptr, &QuerySettings::stateless, "", 0, 1,
               "answer each view by itself: keep nothing unasked, and do not ask first what decided the last answer"),
    settingRow("time_stages", nullptr, &QuerySettings::time_stages, "", 0, 1,
               "measure each stage, which costs some time itself"),
};

/// Calls visit(row) for each row of the table, in its order.
template <class Visit>
constexpr void forEachSetting(Visit&& visit) {
    std::apply([&](const auto&... row) { (visit(row), ...); }, kQuerySettings);
}

}  // namespace sightline
