// Takes the walls away from the faces of a tree's leaves: what is left are portals, each for the side that sees it open.
// SPDX-License-Identifier: MIT
#include "sightline/bake/soup/soup_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "sightline/bake/marked/checked_cells.h"
#include "sightline/bake/soup/flat_sheet.h"
#include "sightline/bake/soup/soup_scale.h"
#include "sightline/bake/soup/soup_tree.h"
#include "sightline/bake/soup/soup_trial.h"
#include "sightline/bake/soup/soup_walls.h"
#include "sightline/bake/soup/wall_gaps.h"
#include "sightline/bsp/tree_portals.h"

namespace sightline::bake {
using namespace tools;
namespace {

/// What is found of one face.
struct FaceAnswer {
    struct Hole {
        std::vector<glm::dvec3> outline;
        uint8_t ways;  // 1: from cells[0], 2: from cells[1]
    };
    std::vector<Hole> holes;
    std::vector<uint32_t> walls;  // triangles
    double smallest = 0;          // narrower holes are none
    bool merged = false;
};

class Faces {
public:
    Faces(const SoupWalls& walls, const SoupTree& tree, const CellGraph& graph,
          const std::vector<uint32_t>& node_of_portal, uint32_t most_holes)
        : walls_(walls),
          tree_(tree),
          graph_(graph),
          node_of_portal_(node_of_portal),
          most_holes_(most_holes),
          sheets_(walls.sheets.size()) {
        std::vector<bool> used(walls.sheets.size(), false);
        for (const uint32_t sheet : tree.sheet_of_node)
            if (sheet != SoupTree::kNoSheet) used[sheet] = true;
        for (size_t i = 0; i < sheets_.size(); ++i)
            if (used[i]) sheets_[i] = FlatSheet(walls, walls.sheets[i]);
    }

    FaceAnswer answer(uint32_t portal) const {
        FaceAnswer out;
        const CellPortal& face = graph_.portals[portal];
        const uint32_t sheet_number = tree_.sheet_of_node[node_of_portal_[portal]];
        const auto outline = graph_.outline(face);
        if (sheet_number == SoupTree::kNoSheet) {
            out.holes.push_back({{outline.begin(), outline.end()}, 3});
            return out;
        }
        const FlatSheet& sheet = sheets_[sheet_number];
        // The portal's plane is the sheet's, or its other side.
        const bool along = glm::dot(glm::dvec3(face.plane), glm::dvec3(walls_.sheets[sheet_number].plane)) > 0;
        const FlatPiece whole = sheet.frame().to(outline);
        const FlatPiece piece = areaOf(whole) < 0 ? FlatPiece(whole.rbegin(), whole.rend()) : whole;
        std::vector<const SheetTriangle*> near[2];
        sheet.gather(piece, near);
        out.smallest = std::numeric_limits<double>::infinity();
        for (const auto& side : near)
            for (const SheetTriangle* triangle : side) out.smallest = std::min(out.smallest, triangle->rounding);
        // A strip along another plane may belong to the wall in that.
        const FlatPiece inner = near[0].empty() && near[1].empty() ? FlatPiece() : shrunkBy(piece, out.smallest);
        if (!inner.empty()) {
            near[0].clear();
            near[1].clear();
            sheet.gather(inner, near);
        }
        if (near[0].empty() && near[1].empty()) {
            out.holes.push_back({{outline.begin(), outline.end()}, 3});
            return out;
        }
        if (inner.empty()) return out;
        const auto isOfBoth = [](const SheetTriangle* triangle) { return triangle->sides == 3; };
        const bool alike = std::all_of(near[0].begin(), near[0].end(), isOfBoth) &&
                           std::all_of(near[1].begin(), near[1].end(), isOfBoth);
        for (int side = 0; side < (alike ? 1 : 2); ++side) {
            // cells[0] is where the portal's normal points.
            const uint8_t way = alike ? 3 : (side == 0) == along ? 1 : 2;
            if (near[side].empty()) {
                out.holes.push_back({{outline.begin(), outline.end()}, way});
                continue;
            }
            FlatRest rest(inner);
            for (const SheetTriangle* triangle : near[side]) {
                if (rest.empty()) break;
                rest.take(triangle->piece);
                out.walls.push_back(triangle->triangle);
            }
            if (rest.empty()) continue;
            for (const FlatHole& hole : holesOf(rest.pieces(), out.smallest, most_holes_)) {
                out.merged |= hole.merged;
                for (const FlatPiece& part : hole.pieces)
                    out.holes.push_back({sheet.frame().from(widened(part, out.smallest)), way});
            }
        }
        return out;
    }

private:
    const SoupWalls& walls_;
    const SoupTree& tree_;
    const CellGraph& graph_;
    const std::vector<uint32_t>& node_of_portal_;
    uint32_t most_holes_;
    std::vector<FlatSheet> sheets_;
};

/// Adds what is left of a face to the graph.
void addHoles(const CellPortal& face, const FaceAnswer& answer, double hole, CellGraph& graph, SoupCellReport& report) {
    for (const FaceAnswer::Hole& part : answer.holes) {
        const bool turned = part.ways == 2;
        std::vector<glm::dvec3> outline = part.outline;
        const glm::dvec4 plane = turned ? -face.plane : face.plane;
        if (glm::dot(areaVector(outline), glm::dvec3(plane)) < 0) std::reverse(outline.begin(), outline.end());
        graph.addPortal(face.cells[turned ? 1 : 0], face.cells[turned ? 0 : 1], outline, plane);
        CellPortal& added = graph.portals.back();
        added.one_way = part.ways != 3;
        added.thickness = std::max(added.thickness, hole);
        report.one_way += added.one_way;
    }
}

/// The walls of a scene, as fine as the smallest that may divide.
struct Soup {
    SoupWalls walls;
    Box3d bounds;     // of the tree
    double hole = 0;  // the largest of the smallest
};

/// Divides by walls from a size on.
SoupCells divide(const Scene& scene, const Soup& soup, double smallest_occluder, const SoupCellSettings& settings) {
    SoupCells out;
    SoupCellReport& report = out.report;
    report.smallest_occluder = smallest_occluder;
    SoupTreeSettings dividing;
    dividing.bend = soup.hole;
    dividing.least_area = std::max(smallest_occluder * smallest_occluder, soup.hole * soup.hole);
    dividing.most_leaves = settings.most_cells;
    for (const WallSheet& sheet : soup.walls.sheets) report.sheets += sheet.largest >= dividing.least_area;
    if (report.sheets == 0) return out;
    SoupTree tree = treeOfSheets(soup.walls, soup.bounds, dividing);
    report.depth = tree.depth;
    report.full = tree.full;

    TreePortalCounts counts;
    std::vector<uint32_t> node_of_portal;
    const CellGraph faces = cellsOfTree(tree.tree, {}, &counts, &node_of_portal);
    report.faces = faces.portals.size();
    const Faces walls_of(soup.walls, tree, faces, node_of_portal, settings.most_holes);
    std::vector<FaceAnswer> answers(faces.portals.size());
    constexpr size_t kTask = 256, kBatch = 64;
    const size_t tasks = (answers.size() + kTask - 1) / kTask;
    for (size_t begin = 0; begin < tasks; begin += kBatch) {
        runJobs(settings.jobs, static_cast<uint32_t>(std::min(kBatch, tasks - begin)), [&](uint32_t task) {
            const size_t first = (begin + task) * kTask;
            for (size_t i = first; i < std::min(first + kTask, answers.size()); ++i)
                answers[i] = walls_of.answer(static_cast<uint32_t>(i));
        });
        if (const size_t done = (begin + kBatch) * kTask; settings.progress && done < answers.size())
            settings.progress(done, answers.size());
    }

    CellGraph& graph = out.space.graph;
    graph.cells = faces.cells;
    graph.cell_of_leaf = faces.cell_of_leaf;
    std::vector<bool> is_wall(scene.objects.size(), false);
    for (size_t i = 0; i < answers.size(); ++i) {
        addHoles(faces.portals[i], answers[i], soup.hole, graph, report);
        report.closed += answers[i].holes.empty();
        report.merged += answers[i].merged;
        for (const uint32_t t : answers[i].walls) is_wall[soup.walls.triangles[t].object] = true;
    }
    for (uint32_t object = 0; object < is_wall.size(); ++object)
        if (is_wall[object]) report.walls.push_back(object);
    out.space.tree = std::move(tree.tree);
    out.space.tolerance = std::max(2 * soup.hole, counts.tolerance);
    return out;
}

}  // namespace

SoupCells cellsOfSoup(const Scene& scene, const SoupCellSettings& settings) {
    const std::optional<SoupScale> scale = soupScaleOf(scene);
    if (!scale) return {};
    std::vector<WallTriangle> triangles = opaqueTriangles(scene, *scale, settings.smallest_hole, settings.movable);
    if (triangles.empty()) return {};
    const double diagonal = scale->diagonal;
    const uint64_t opaque = triangles.size();
    Soup soup;
    soup.bounds = scale->core.bounds;
    soup.hole = largestHole(triangles);
    const double finest = settings.smallest_occluder >= 0 ? settings.smallest_occluder : diagonal / 128;
    soup.walls = sheetsOf(std::move(triangles), std::max(finest * finest, soup.hole * soup.hole));
    // Eyes outside of the core are in cells, too; what is left aside is seen from everywhere.
    soup.bounds.min -= glm::dvec3(diagonal);
    soup.bounds.max += glm::dvec3(diagonal);

    SoupCells best = divide(scene, soup, finest, settings);
    std::vector<SoupTrial> trials;
    if (settings.smallest_occluder < 0 && !settings.eyes.empty() && best.space.graph.cells > 0) {
        constexpr double kMuchMore = 1.2;
        trials.push_back(trialOf(scene, best, settings, diagonal));
        for (const double times : {2.0, 4.0, 8.0}) {
            SoupCells coarser = divide(scene, soup, times * finest, settings);
            if (coarser.space.graph.cells == 0) break;
            trials.push_back(trialOf(scene, coarser, settings, diagonal));
            if (trials.back().objects_seen > kMuchMore * trials.front().objects_seen) break;
            best = std::move(coarser);
        }
    }
    best.report.trials = std::move(trials);
    best.report.objects = scene.objects.size();
    best.report.triangles = opaque;
    best.report.smallest_hole = soup.hole;
    best.report.aside = scale->core.aside;
    best.report.widest_gap = settings.widest_gap >= 0 ? settings.widest_gap : std::ldexp(diagonal, -12);
    if (best.report.widest_gap > 0)
        best.report.gaps = gapsOfWalls(soup.walls, best.space, soup.hole, best.report.widest_gap);
    return best;
}

}  // namespace sightline::bake
