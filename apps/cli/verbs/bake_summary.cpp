// What `bake` and `vis` tell of a bake: the figures that both have, and those of each.
// SPDX-License-Identifier: MIT
#include "apps/cli/verbs/bake_summary.h"

#include <algorithm>
#include <bit>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "apps/cli/shell/session.h"
#include "apps/cli/verbs/common.h"
#include "apps/cli/verbs/explain_object.h"
#include "sightline/tools/report/readable.h"
#include "sightline/tools/report/run/cull_run.h"
#include "sightline/tools/scene/json_text.h"
#include "sightline/tools/scene/one_line.h"

namespace sightline::cli {
using namespace bake;
using namespace tools;
namespace {

double ratio(uint64_t part, uint64_t whole) {
    return whole ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
}

std::string percentText(uint64_t part, uint64_t whole) { return fmt::format("{:.2f} %", 100 * ratio(part, whole)); }

/// What ends sight, or ended the bake, early.
void printLimits(std::FILE* out, const VisSummary& s) {
    if (s.farthest > 0) tell(out, fmt::format("  sight ends at {} units\n", readable(s.farthest, 6)));
    if (s.over_budget)
        tell(out,
             fmt::format("  portals over budget {}: what they may see counts as visible\n", grouped(s.over_budget)));
    if (s.stopped) tell(out, "  stopped by the time limit: what was not settled counts as visible\n");
}

void printFindings(std::FILE* out, const SceneCellReport& report) {
    constexpr size_t kMost = 8;
    if (report.holes)
        tell(out, fmt::format("holes that nobody marked: {}, of {} square units; they are portals\n",
                              grouped(report.holes), readable(report.hole_area)));
    for (size_t i = 0; i < std::min(report.findings.size(), kMost); ++i)
        tell(out, fmt::format("  {}\n", oneLine(report.findings[i].text)));
    if (report.findings.size() > kMost)
        tell(out, fmt::format("  and {} more (--json lists them)\n", grouped(report.findings.size() - kMost)));
}

std::string pointText(const glm::dvec3& point) {
    return fmt::format("({}, {}, {})", readable(point.x, 6), readable(point.y, 6), readable(point.z, 6));
}

/// The objects whose surfaces bound a gap.
std::string boundsText(const WallGap& gap, const Scene& scene) {
    const std::string first = callOf(scene, gap.objects[0]);
    return gap.objects[0] == gap.objects[1] ? first : first + " and " + callOf(scene, gap.objects[1]);
}

void printGaps(std::FILE* out, const SoupCellReport& report, const Scene& scene) {
    constexpr size_t kMost = 8;
    if (report.gaps.empty()) return;
    tell(out, fmt::format("gaps between walls, up to {} wide: {}; they are seen through\n",
                          readable(report.widest_gap, 2), grouped(report.gaps.size())));
    for (size_t i = 0; i < std::min(report.gaps.size(), kMost); ++i) {
        const WallGap& gap = report.gaps[i];
        tell(out, fmt::format("  {} wide from {} to {}: {}\n", readable(gap.width, 2), pointText(gap.from),
                              pointText(gap.to), oneLine(boundsText(gap, scene))));
    }
    if (report.gaps.size() > kMost)
        tell(out, fmt::format("  and {} smaller ones (--json lists them)\n", grouped(report.gaps.size() - kMost)));
}

void printWalls(std::FILE* out, const SoupCellReport& report) {
    tell(out,
         fmt::format("walls: {} of {} faces between cells are shut, {} portals are seen through from one side alone\n",
                     grouped(report.closed), grouped(report.faces), grouped(report.one_way)));
    tell(out, fmt::format("  {} planes with surfaces from {} x {} on; holes narrower than {} are shut; the "
                          "tree is {} deep\n",
                          grouped(report.sheets), readable(report.smallest_occluder, 3),
                          readable(report.smallest_occluder, 3), readable(report.smallest_hole, 2), report.depth));
    if (!report.trials.empty()) tell(out, "  smallest occluder      cells    portals  objects seen from a place\n");
    for (const SoupTrial& trial : report.trials)
        tell(out, fmt::format("  {:>17} {:>10} {:>10} {:>10.1f} of {}{}\n", readable(trial.smallest_occluder, 3),
                              grouped(trial.cells), grouped(trial.portals), trial.objects_seen, grouped(report.objects),
                              trial.smallest_occluder == report.smallest_occluder ? ", taken" : ""));
    if (report.hardlyAnInside())
        tell(out, "  it has hardly an inside: portals would cost a query more than they save\n");
    if (report.full) tell(out, "  there are too many cells: what is left undivided is looser\n");
}

void printViews(std::FILE* out, const Baked& baked) {
    if (!baked.cells.views) return;
    const ViewCells& views = *baked.cells.views;
    if (views.tree.contents.empty())
        return tell(out,
                    fmt::format("view cells: none, for flat parts hide {} % of the objects from a cell in the mean\n",
                                readable(100 * views.hidden, 2)));
    tell(out,
         fmt::format("view cells: {}; of {} flat parts from {} x {} on {} hide something from a cell\n",
                     grouped(views.tree.contents.size()), grouped(views.hiders), readable(views.smallest_occluder, 3),
                     readable(views.smallest_occluder, 3), grouped(views.used)));
    tell(out,
         fmt::format("  a cell sees {:.1f} of {} objects in the mean\n",
                     ratio(baked.view_rows.count(), baked.view_rows.rows()), grouped(baked.objects.places.size())));
    if (baked.view_counts.hidden)
        tell(out, fmt::format("  of those that flat parts leave, portals hide {} %\n",
                              readable(100 * ratio(baked.view_counts.hidden,
                                                   baked.view_rows.count() + baked.view_counts.hidden),
                                       3)));
    if (views.over_budget)
        tell(out,
             fmt::format("  cells over budget {}: what was not asked counts as visible\n", grouped(views.over_budget)));
}

void printRays(std::FILE* out, const RowsByRays& by_rays, const BitMatrix& rows) {
    tell(out, fmt::format("  rays have seen {} of these pairs; in the median a row holds {:.2f} of what {} rays see\n",
                          percentText(by_rays.seen.count(), rows.count()), by_rays.median, grouped(by_rays.rays)));
}

}  // namespace

RowsByRays rowsByRays(uint32_t rays, BitMatrix seen, const BitMatrix& rows) {
    const auto countOf = [](std::span<const uint64_t> words) {
        double ones = 0;
        for (const uint64_t word : words) ones += std::popcount(word);
        return ones;
    };
    RowsByRays out;
    out.rays = rays;
    std::vector<double> ratios;
    for (size_t row = 0; row < rows.rows(); ++row)
        if (const double witnessed = countOf(seen.row(row)); witnessed > 0)
            ratios.push_back(countOf(rows.row(row)) / witnessed);
    out.median = medianOf(std::move(ratios));
    out.seen = std::move(seen);
    return out;
}

VisSummary rowFigures(const CellGraph& rows, const CellVisibility& visibility) {
    VisSummary out;
    out.leafs = out.clusters = rows.cells;
    out.portals = rows.portals.size();
    out.visible_leaf_pairs = out.visible_cluster_pairs = visibility.visible.count();
    out.witnessed_pairs = out.witnessed_cluster_pairs = visibility.witnessed.count();
    out.unresolved_pairs = out.visible_leaf_pairs - out.witnessed_pairs;
    out.steps = visibility.steps;
    out.over_budget = visibility.over_budget;
    out.stopped = visibility.stopped;
    return out;
}

VisSummary::Objects objectFigures(const BoxVisibility& objects) {
    return {objects.visible.columns(), objects.visible.count(), objects.by_cells, 0};
}

BakeSummary bakeSummary(const BakeSource& source, const Baked& baked, VisibilityForm form) {
    BakeSummary out;
    out.rows = rowFigures(baked.cells.rows, baked.rows);
    out.rows.cells_are = source.rows_are;
    if (baked.object_rows) out.rows.objects = objectFigures(*baked.object_rows);
    out.rows.pvs_bytes = baked.file.bytes(form).size();
    out.rows.resident_bytes = baked.file.resident_bytes;
    out.in_place_bytes = baked.file.in_place.size();
    out.rows_seconds = baked.rows_seconds;
    out.objects_seconds = baked.objects_seconds;
    return out;
}

void printVisSummary(std::FILE* out, const VisSummary& s) {
    tell(out, fmt::format("{}: {} leaves in {} cells ({}), {} portals\n", s.map, grouped(s.leafs), grouped(s.clusters),
                          s.cells_are, grouped(s.portals)));
    const double mean = s.leafs ? static_cast<double>(s.visible_leaf_pairs) / static_cast<double>(s.leafs) : 0;
    tell(out, fmt::format("visible pairs of leaves {} (a leaf sees {:.1f} of them, {})\n",
                          grouped(s.visible_leaf_pairs), mean, percentText(s.visible_leaf_pairs, s.leafs * s.leafs)));
    tell(out, fmt::format("  witnessed by rays     {}\n  unresolved            {} ({} of the visible)\n",
                          grouped(s.witnessed_pairs), grouped(s.unresolved_pairs),
                          percentText(s.unresolved_pairs, s.visible_leaf_pairs)));
    if (s.before)
        tell(out, fmt::format("in pairs of rows, as the lump that it came with counts: {} then, less {} that are gone, "
                              "and {} new, are {} now{}\n",
                              grouped(s.before->visible_pairs), grouped(s.before->removed), grouped(s.before->added),
                              grouped(s.before->visible_pairs - s.before->removed + s.before->added),
                              s.before->added > s.before->removed ? ", so that this one is looser" : ""));
    printLimits(out, s);
    for (const VisSummary::Leak& leak : s.leaks)
        tell(out, fmt::format("leaks: from {} at {} {} {} there is a way of {} points to the outside, which stays in "
                              "the rows (--leak FILE.pts writes it, as dots)\n",
                              leak.from, readable(leak.path.front().x + 0.0, 6), readable(0.0 - leak.path.front().z, 6),
                              readable(leak.path.front().y + 0.0, 6), leak.path.size()));
    if (s.objects)
        tell(out,
             fmt::format("faces: {} pairs of cells and faces, {} of those in visible cells, in {:.2f} s of CPU\n",
                         grouped(s.objects->visible_pairs),
                         percentText(s.objects->visible_pairs, s.objects->pairs_by_cells), s.objects->cpu_seconds));
    if (s.pvs_bytes)
        tell(out, fmt::format("bytes: {} packed, {} resident{}\n", grouped(s.pvs_bytes), grouped(s.resident_bytes),
                              s.lump_bytes ? "; run-length lump " + grouped(s.lump_bytes) : ""));
    tell(out, fmt::format("{:.2f} s of CPU, {:.2f} s\n", s.cpu_seconds, s.wall_seconds));
    if (s.verification)
        tell(out, fmt::format("verified: {} segments, {} false negatives\n", grouped(s.verification->segments),
                              grouped(s.verification->false_negatives)));
    if (s.verification && s.verification->brushes)
        tell(out, fmt::format(
                      "verified by the brushes: {} segments, {} false negatives, {} leaves solid where no brush is\n",
                      grouped(s.verification->brushes->segments), grouped(s.verification->brushes->false_negatives),
                      grouped(s.verification->brushes->solid_leaves)));
}

void printBakeSummary(std::FILE* out, const BakeSource& source, const Baked& baked, const BakeSummary& summary) {
    const CellSpace& space = baked.cells.space;
    const ObjectCells& objects = baked.objects;
    const VisSummary& s = summary.rows;
    tell(out, fmt::format("{}: {} cells ({}), {} portals, {} doors\n", oneLine(s.map), grouped(space.graph.cells),
                          source.cells_are, grouped(space.graph.portals.size()), grouped(space.doors.size())));
    if (baked.cells.report) printFindings(out, *baked.cells.report);
    if (source.leaks) tell(out, "leaks: the outside is a place like any other (vis --leak writes the way)\n");
    if (source.walls) {
        printWalls(out, *source.walls);
        printGaps(out, *source.walls, source.scene);
    } else {
        tell(out, fmt::format("rows: {} ({}); a row sees {:.1f} of them ({}), {} unresolved\n", grouped(s.clusters),
                              s.cells_are, ratio(s.visible_cluster_pairs, s.clusters),
                              percentText(s.visible_cluster_pairs, s.clusters * s.clusters),
                              percentText(s.unresolved_pairs, s.visible_cluster_pairs)));
    }
    printLimits(out, s);
    printViews(out, baked);
    if (summary.by_rays) printRays(out, *summary.by_rays, baked.view_rows);
    tell(out,
         fmt::format("objects: {}, each in {:.2f} cells; {} seen from everywhere, {} outside, {} moving and not in "
                     "the file\n",
                     grouped(objects.places.size()), ratio(objects.places.cells.size(), objects.places.size()),
                     grouped(objects.everywhere), grouped(objects.outside), grouped(objects.moving)));
    if (source.movable > 0) tell(out, fmt::format("  {} may move, and hide nothing\n", grouped(source.movable)));
    if (s.objects)
        tell(out,
             fmt::format("rows of objects: {} pairs, {} of those in visible cells\n", grouped(s.objects->visible_pairs),
                         percentText(s.objects->visible_pairs, s.objects->pairs_by_cells)));
    tell(out, fmt::format("bytes: {}, {} resident\n", grouped(s.pvs_bytes), grouped(s.resident_bytes)));
    tell(out, fmt::format("{:.2f} s: cells {:.2f}, rows {:.2f}, objects {:.2f}\n", s.wall_seconds,
                          summary.cells_seconds, summary.rows_seconds, summary.objects_seconds));
}

std::string bakeJson(const BakeSource& source, const Baked& baked, const BakeSummary& summary) {
    const CellSpace& space = baked.cells.space;
    const ObjectCells& objects = baked.objects;
    const VisSummary& s = summary.rows;
    using Json = nlohmann::ordered_json;
    Json out = {{"schema", "sightline.bake/1"},
                {"scene", s.map},
                {"hash", fmt::format("{:016x}", baked.cells.hash)},
                {"cells_are", source.cells_are},
                {"cells", space.graph.cells},
                {"portals", space.graph.portals.size()},
                {"doors", space.doors.size()},
                {"outside", space.outside != CellGraph::kNoCell},
                {"rows_are", s.cells_are},
                {"rows", s.clusters},
                {"visible_pairs", s.visible_cluster_pairs},
                {"witnessed_pairs", s.witnessed_cluster_pairs},
                {"over_budget", s.over_budget},
                {"stopped", s.stopped},
                {"leaks", source.leaks},
                {"unknown_brushes", {{"count", source.roles.unknown}, {"textures", source.roles.unknown_textures}}},
                {"objects",
                 {{"count", objects.places.size()},
                  {"places", objects.places.cells.size()},
                  {"everywhere", objects.everywhere},
                  {"outside", objects.outside},
                  {"by_box", objects.by_box},
                  {"moving", objects.moving},
                  {"movable", source.movable},
                  {"unbounded", objects.unbounded}}}};
    if (s.objects)
        out["object_rows"] = {{"visible_pairs", s.objects->visible_pairs},
                              {"pairs_by_cells", s.objects->pairs_by_cells}};
    if (baked.cells.report) {
        Json findings = Json::array();
        for (const CellFinding& finding : baked.cells.report->findings)
            findings.push_back({{"kind", kCellFindingNames[static_cast<size_t>(finding.kind)]},
                                {"place", {finding.place.x, finding.place.y, finding.place.z}},
                                {"size", finding.size},
                                {"text", finding.text}});
        out["holes"] = baked.cells.report->holes;
        out["hole_area"] = baked.cells.report->hole_area;
        out["findings"] = findings;
    }
    if (source.walls) {
        const SoupCellReport& walls = *source.walls;
        out["walls"] = {{"smallest_occluder", walls.smallest_occluder},
                        {"smallest_hole", walls.smallest_hole},
                        {"triangles", walls.triangles},
                        {"planes", walls.sheets},
                        {"faces", walls.faces},
                        {"shut", walls.closed},
                        {"one_way", walls.one_way},
                        {"merged", walls.merged},
                        {"depth", walls.depth},
                        {"full", walls.full},
                        {"trials", Json::array()},
                        {"objects", walls.walls.size()}};
        for (const SoupTrial& trial : walls.trials)
            out["walls"]["trials"].push_back({{"smallest_occluder", trial.smallest_occluder},
                                              {"cells", trial.cells},
                                              {"portals", trial.portals},
                                              {"objects_seen", trial.objects_seen},
                                              {"portals_tried", trial.portals_tried}});
        out["walls"]["widest_gap"] = walls.widest_gap;
        out["walls"]["gaps"] = Json::array();
        for (const WallGap& gap : walls.gaps) {
            Json bounds = Json::array();
            for (const uint32_t object : gap.objects)
                bounds.push_back({{"key", source.scene.objects[object].key},
                                  {"name", objectPath(source.scene, source.scene.objects[object])}});
            out["walls"]["gaps"].push_back({{"from", {gap.from.x, gap.from.y, gap.from.z}},
                                            {"to", {gap.to.x, gap.to.y, gap.to.z}},
                                            {"width", gap.width},
                                            {"objects", bounds}});
        }
    }
    if (baked.cells.views)
        out["view_cells"] = {{"count", baked.cells.views->tree.contents.size()},
                             {"hiders", baked.cells.views->hiders},
                             {"used", baked.cells.views->used},
                             {"smallest_occluder", baked.cells.views->smallest_occluder},
                             {"smallest_cell", baked.cells.views->smallest_cell},
                             {"hidden", baked.cells.views->hidden},
                             {"over_budget", baked.cells.views->over_budget},
                             {"visible_pairs", baked.view_rows.count()},
                             {"hidden_by_portals", baked.view_counts.hidden},
                             {"flows_over_budget", baked.view_counts.over_budget},
                             {"flows_out_of_bounds", baked.view_counts.out_of_bounds}};
    if (summary.by_rays) {
        out["view_cells"]["rays"] = summary.by_rays->rays;
        out["view_cells"]["witnessed_pairs"] = summary.by_rays->seen.count();
        out["view_cells"]["median_looseness"] = summary.by_rays->median;
    }
    out["bytes"] = s.pvs_bytes;
    out["resident_bytes"] = s.resident_bytes;
    out["in_place_bytes"] = summary.in_place_bytes;
    out["threads"] = s.threads;
    out["cells_seconds"] = summary.cells_seconds;
    out["rows_seconds"] = summary.rows_seconds;
    out["objects_seconds"] = summary.objects_seconds;
    out["wall_seconds"] = s.wall_seconds;
    return jsonText(out, 2) + "\n";
}

}  // namespace sightline::cli
