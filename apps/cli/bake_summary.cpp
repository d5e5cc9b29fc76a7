// SPDX-License-Identifier: MIT
#include "apps/cli/bake_summary.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "apps/cli/common.h"
#include "apps/cli/session.h"
#include "sightline/scene/one_line.h"

namespace sightline::cli {
namespace {

double ratio(uint64_t part, uint64_t whole) {
    return whole ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
}

std::string share(uint64_t part, uint64_t whole) { return fmt::format("{:.2f} %", 100 * ratio(part, whole)); }

void printFindings(std::FILE* out, const SceneCellReport& report) {
    constexpr size_t kMost = 8;
    if (report.holes)
        tell(out, fmt::format("holes that nobody marked: {}, of {:.4g} square units; they are portals\n",
                              grouped(report.holes), report.hole_area));
    for (size_t i = 0; i < std::min(report.findings.size(), kMost); ++i)
        tell(out, fmt::format("  {}\n", oneLine(report.findings[i].text)));
    if (report.findings.size() > kMost)
        tell(out, fmt::format("  and {} more (--json lists them)\n", grouped(report.findings.size() - kMost)));
}

}  // namespace

void printBakeSummary(std::FILE* out, const BakeSource& source, const CellVisibility& visibility,
                      const ObjectCells& objects, const BakeSummary& summary) {
    const CellSpace& space = source.space;
    const uint64_t rows = visibility.visible.rows();
    tell(out,
         fmt::format("{}: {} cells ({}), {} portals, {} doors\n", oneLine(summary.scene), grouped(space.graph.cells),
                     source.cells_are, grouped(space.graph.portals.size()), grouped(space.doors.size())));
    if (source.report) printFindings(out, *source.report);
    if (source.leaks) tell(out, "leaks: the outside is a place like any other (vis --leak writes the way)\n");
    tell(out,
         fmt::format("rows: {} ({}); a row sees {:.1f} of them ({}), {} unresolved\n", grouped(rows), source.rows_are,
                     ratio(summary.visible_pairs, rows), share(summary.visible_pairs, rows * rows),
                     share(summary.visible_pairs - summary.witnessed_pairs, summary.visible_pairs)));
    if (visibility.over_budget)
        tell(out, fmt::format("  portals over budget {}: what they may see counts as visible\n",
                              grouped(visibility.over_budget)));
    if (visibility.stopped) tell(out, "  stopped by the time limit: what was not settled counts as visible\n");
    tell(out,
         fmt::format("objects: {}, each in {:.2f} cells; {} seen from everywhere, {} outside, {} moving and not in "
                     "the file\n",
                     grouped(objects.places.size()), ratio(objects.places.cells.size(), objects.places.size()),
                     grouped(objects.everywhere), grouped(objects.outside), grouped(objects.moving)));
    if (summary.object_rows)
        tell(out, fmt::format("rows of objects: {} pairs, {} of those in visible cells\n",
                              grouped(summary.object_rows->visible_pairs),
                              share(summary.object_rows->visible_pairs, summary.object_rows->pairs_by_cells)));
    tell(out, fmt::format("bytes: {}, {} resident\n", grouped(summary.bytes), grouped(summary.resident_bytes)));
    tell(out, fmt::format("{:.2f} s: cells {:.2f}, rows {:.2f}, objects {:.2f}\n", summary.seconds,
                          summary.cells_seconds, summary.rows_seconds, summary.objects_seconds));
}

std::string bakeJson(const BakeSource& source, const CellVisibility& visibility, const ObjectCells& objects,
                     const BakeSummary& summary) {
    using Json = nlohmann::ordered_json;
    Json out = {{"schema", "sightline.bake/1"},
                {"scene", summary.scene},
                {"hash", fmt::format("{:016x}", source.hash)},
                {"cells_are", source.cells_are},
                {"cells", source.space.graph.cells},
                {"portals", source.space.graph.portals.size()},
                {"doors", source.space.doors.size()},
                {"outside", source.space.outside != CellGraph::kNoCell},
                {"rows_are", source.rows_are},
                {"rows", visibility.visible.rows()},
                {"visible_pairs", summary.visible_pairs},
                {"witnessed_pairs", summary.witnessed_pairs},
                {"over_budget", visibility.over_budget},
                {"stopped", visibility.stopped},
                {"leaks", source.leaks},
                {"objects",
                 {{"count", objects.places.size()},
                  {"places", objects.places.cells.size()},
                  {"everywhere", objects.everywhere},
                  {"outside", objects.outside},
                  {"by_box", objects.by_box},
                  {"moving", objects.moving},
                  {"unbounded", objects.unbounded}}}};
    if (summary.object_rows)
        out["object_rows"] = {{"visible_pairs", summary.object_rows->visible_pairs},
                              {"pairs_by_cells", summary.object_rows->pairs_by_cells}};
    if (source.report) {
        Json findings = Json::array();
        for (const CellFinding& finding : source.report->findings)
            findings.push_back({{"kind", kCellFindingNames[static_cast<size_t>(finding.kind)]},
                                {"place", {finding.place.x, finding.place.y, finding.place.z}},
                                {"size", finding.size},
                                {"text", finding.text}});
        out["holes"] = source.report->holes;
        out["hole_area"] = source.report->hole_area;
        out["findings"] = findings;
    }
    out["bytes"] = summary.bytes;
    out["resident_bytes"] = summary.resident_bytes;
    out["in_place_bytes"] = summary.in_place_bytes;
    out["threads"] = summary.threads;
    out["cells_seconds"] = summary.cells_seconds;
    out["rows_seconds"] = summary.rows_seconds;
    out["objects_seconds"] = summary.objects_seconds;
    out["wall_seconds"] = summary.seconds;
    return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace sightline::cli
