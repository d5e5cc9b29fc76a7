// Holds rows against rays through the portals, and through the tree of the map.
// SPDX-License-Identifier: MIT
#include "apps/cli/verbs/vis_verify.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "sightline/tools/truth/graph_rays.h"
#include "sightline/tools/truth/tree_rays.h"

namespace sightline::cli {
using namespace tools;
namespace {

void addReport(const RowReport& report, VisSummary::Verification& out, const std::vector<uint32_t>& leaf_of_row) {
    out.segments += report.segments;
    out.false_negatives += report.misses;
    out.doubtful += report.doubtful;
    for (const RowMiss& miss : report.examples)
        out.examples.push_back({leaf_of_row[miss.row], leaf_of_row[miss.column], miss.from, miss.to});
}

}  // namespace

VisSummary::Verification verifyVis(const VisMap& map, const BitMatrix& visible, uint64_t rays, Jobs& jobs) {
    const CellGraph& graph = map.graph;
    VisSummary::Verification out;
    std::vector<uint32_t> leaf_of_cell(graph.cells, 0);
    for (size_t leaf = graph.cell_of_leaf.size(); leaf-- > 0;)
        if (graph.cell_of_leaf[leaf] != CellGraph::kNoCell)
            leaf_of_cell[graph.cell_of_leaf[leaf]] = static_cast<uint32_t>(leaf);
    RowCheckSettings settings;
    settings.jobs = &jobs;
    settings.segments = map.tree ? std::max<uint64_t>(1, rays / 2) : rays;
    double largest = 1;
    for (const glm::dvec3& p : graph.points) largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    addReport(checkCellRows(GraphRays(graph, largest * 0x1p-36), visible, settings), out, leaf_of_cell);
    if (map.tree) {
        AimedHoles holes;
        for (const CellPortal& portal : graph.portals) holes.add(graph.outline(portal));
        TreeRaySettings through;
        through.contents_stop = map.contents_stop;
        addReport(checkLeafRows(TreeRays(*map.tree, through), visible, graph.cell_of_leaf, holes, settings), out,
                  leaf_of_cell);
    }
    return out;
}

}  // namespace sightline::cli
