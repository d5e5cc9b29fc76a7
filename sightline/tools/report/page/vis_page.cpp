// The page of a bake of visibility: its JSON, and pictures of the cells, the matrix, and a sight line.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/page/vis_page.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "sightline/base/random.h"
#include "sightline/tools/report/page/page_pictures.h"
#include "sightline/tools/report/pictures/png.h"
#include "sightline/tools/report/pictures/pvs_picture.h"
#include "sightline/tools/truth/graph_rays.h"
#include "sightline/visfile/row_order.h"

namespace sightline::tools {
namespace {

constexpr uint32_t kPlanWidth = 1200;       // [pixels]
constexpr uint32_t kMostAskedCells = 2048;  // their rows are in the page: a megabyte and a half
constexpr uint32_t kRaysForPicture = 4096;  // of which the one through most cells is drawn

/// A line and what it passes.
struct DrawnLine {
    glm::dvec3 from{0.0}, to{0.0};
    std::vector<uint32_t> portals;
    size_t cells = 0;
};

/// The portals between the cells that a line passes, where it is inside of them.
std::vector<uint32_t> portalsBetween(const CellGraph& graph, const std::vector<GraphStep>& steps, size_t last) {
    std::vector<uint32_t> portals;
    for (size_t at = last; steps[at].before != GraphStep::kStart; at = steps[at].before) {
        const uint32_t a = steps[steps[at].before].cell, b = steps[at].cell;
        for (uint32_t i = 0; i < graph.portals.size(); ++i) {
            const uint32_t* cells = graph.portals[i].cells;
            if ((cells[0] == a && cells[1] == b) || (cells[0] == b && cells[1] == a)) portals.push_back(i);
        }
    }
    return portals;
}

/// Of many lines from portal to portal the one that passes most cells.
DrawnLine longestLine(const CellGraph& graph) {
    DrawnLine best;
    if (graph.portals.empty()) return best;
    const GraphRays rays(graph, 1e-6);
    Random random(1);
    std::vector<GraphStep> steps;
    const auto middleOf = [&](const CellPortal& portal) {
        glm::dvec3 sum(0);
        for (const glm::dvec3& point : graph.outline(portal)) sum += point;
        return sum / static_cast<double>(portal.count);
    };
    for (uint32_t i = 0; i < kRaysForPicture; ++i) {
        const CellPortal& first = graph.portals[random.below(graph.portals.size())];
        const CellPortal& other = graph.portals[random.below(graph.portals.size())];
        const glm::dvec3 from = middleOf(first), direction = middleOf(other) - from;
        if (!(glm::length(direction) > 0)) continue;
        // Into the cell that the line goes to.
        const bool against = glm::dot(glm::dvec3(first.plane), direction) < 0;
        rays.follow(first.cells[against], from, direction, steps);
        if (steps.size() <= best.cells) continue;
        size_t last = 0;
        for (size_t k = 0; k < steps.size(); ++k)
            if (steps[k].at > steps[last].at) last = k;
        best = {from, from + steps[last].at * direction, portalsBetween(graph, steps, last), steps.size()};
    }
    return best;
}

std::vector<uint32_t> cellsBySight(const BitMatrix& visible) {
    std::vector<uint32_t> seen(visible.rows()), order(visible.rows());
    std::iota(order.begin(), order.end(), 0u);
    for (size_t r = 0; r < visible.rows(); ++r)
        for (const uint64_t word : visible.row(r)) seen[r] += static_cast<uint32_t>(std::popcount(word));
    std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return seen[a] > seen[b]; });
    return order;
}

/// The plan whose cells a reader may ask: outlines in pixels, and the rows as bits, each row in whole words.
nlohmann::ordered_json askedPlan(const CellPlan& plan, const BitMatrix& visible, const BitMatrix& witnessed,
                                 uint32_t first) {
    nlohmann::ordered_json cells = nlohmann::ordered_json::array();
    for (const std::vector<glm::dvec2>& outline : plan.outlines()) cells.push_back(svgPoints(outline));
    return {{"width", plan.width()},
            {"height", plan.height()},
            {"first", first},
            {"cells", std::move(cells)},
            {"visible", base64Rows(visible)},
            {"witnessed", base64Rows(witnessed)},
            {"row_bytes", visible.wordsPerRow() * 8}};
}

}  // namespace

Status writeVisPage(const CellGraph& graph, const BitMatrix& visible, const BitMatrix& witnessed,
                    const VisSummary& summary, const std::string& directory) {
    PagePictures page(directory);
    if (visible.rows() > 0)
        page.add("matrix", pvsMatrixPicture(visible, witnessed),
                 "Who sees whom: a row and a column a cell. Blue: a ray proves it. Orange: not proved hidden. Pale: "
                 "proved hidden.");
    if (visible.rows() > 0 && visible.rows() <= kMostOrderedRows) {
        const RowOrder alike = orderRows(visible);
        const std::vector<uint32_t> order(alike.cell_at.begin(), alike.cell_at.end());
        page.add("matrix-alike", pvsMatrixPicture(visible, witnessed, order),
                 "The same, cells that see alike side by side: in this order the visibility file stores it.");
    }
    if (!graph.portals.empty()) {
        const CellPlan plan(graph, cellPlanArea(graph), kPlanWidth);
        page.add("graph", plan.graph(), "From above: cells, and the portals between them.");
        const std::vector<uint32_t> order = cellsBySight(visible);
        if (visible.rows() <= kMostAskedCells) page.ask(askedPlan(plan, visible, witnessed, order.front()));
        page.add("most", plan.seenFrom(order.front(), visible, witnessed),
                 fmt::format("What cell {} sees, which sees most.", order.front()));
        const uint32_t middle = order[order.size() / 2];
        page.add("middle", plan.seenFrom(middle, visible, witnessed),
                 fmt::format("What cell {} sees: half of all cells see more, half less.", middle));
        const DrawnLine line = longestLine(graph);
        if (line.cells > 1) {
            const glm::dvec3 ends[] = {line.from, line.to};
            page.add("sightline", plan.sightline(ends, line.portals),
                     fmt::format("A sight line through {} cells, and the portals between them.", line.cells));
        }
    }
    return page.finish("vis", visJson(summary));
}

}  // namespace sightline::tools
