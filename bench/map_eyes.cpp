// Eyes in maps, and what they see.
// SPDX-License-Identifier: MIT
#include "bench/map_eyes.h"

#include <cmath>

#include "sightline/bsp/tree_portals.h"
#include "sightline/geom/convex_region.h"
#include "sightline/tools/import/quake/map_source.h"

namespace sightline::bench {
using namespace tools;
namespace {

constexpr double kEyeHeight = 46, kRoom = 16, kNear = 4;  // of a player [units of the maps]

/// The region of each leaf, or the map's bounds where it has none.
void boundLeaves(const LeafTree& tree, MapOfLeaves& cells) {
    std::vector<glm::dvec4> planes = planesOfBox(tree.bounds);
    const auto descend = [&](const auto& self, uint32_t child) -> void {
        if ((child & LeafTreeNode::kLeaf) != 0) {
            const uint32_t leaf = child & ~LeafTreeNode::kLeaf, cell = cells.space.graph.cell_of_leaf[leaf];
            if (cell == CellGraph::kNoCell) return;
            const ConvexRegion region = convexRegion(planes);
            cells.bounds[cell] = region.kind == ConvexRegion::Kind::kSolid ? region.bounds : tree.bounds;
            cells.leaf_of_cell[cell] = leaf;
            return;
        }
        const LeafTreeNode& node = tree.nodes[child];
        for (uint32_t side = 0; side < 2; ++side) {
            const glm::dvec4 plane = side == 1 ? node.plane : -node.plane;
            planes.push_back(plane / glm::length(glm::dvec3(plane)));
            self(self, node.child[side]);
            planes.pop_back();
        }
    };
    descend(descend, 0);
}

}  // namespace

bool readMapOfLeaves(const std::string& path, MapOfLeaves& cells) {
    Result<QuakeMapFile> map = readQuakeMap(path);
    if (!map) return false;
    cells.map = std::move(*map);
    TreePortalCounts counts;
    cells.space.graph = cellsOfTree(cells.map.tree, {.contents_stop = true}, &counts);
    cells.space.tree = cells.map.tree;
    cells.space.tolerance = counts.tolerance;
    cells.bounds.assign(cells.space.graph.cells, {});
    cells.leaf_of_cell.assign(cells.space.graph.cells, 0);
    boundLeaves(cells.map.tree, cells);
    return true;
}

std::vector<View> playerViews(const MapOfLeaves& cells, const TreeRays& rays, uint32_t count, uint64_t seed) {
    Random random(seed);
    const Box3d& box = cells.map.tree.bounds;
    const double far = glm::length(box.size());
    TreeWalk walk;
    std::vector<View> views;
    const auto isClear = [&](const glm::dvec3& a, const glm::dvec3& b) {
        rays.follow(a, b, walk);
        return walk.arrived;
    };
    for (uint64_t tries = 0; views.size() < count && tries < uint64_t{1000000}; ++tries) {
        const double x = random.uniform(), y = random.uniform(), z = random.uniform();
        const glm::dvec3 place = box.min + glm::dvec3(x, y, z) * box.size();
        if (cells.map.tree.contents[rays.leafAt(place)] != LeafContents::kEmpty) continue;
        rays.follow(place, place - glm::dvec3(0, far, 0), walk);
        if (walk.stretches.empty()) continue;
        const glm::dvec3 floor = place - glm::dvec3(0, walk.stretches.back().to * far, 0);
        const glm::dvec3 eye = floor + glm::dvec3(0, kEyeHeight, 0);
        bool clear = isClear(floor + glm::dvec3(0, 1, 0), eye + glm::dvec3(0, 10, 0));
        for (int i = 0; i < 8 && clear; ++i) {
            const double angle = i * 0.7853981633974483;
            clear = isClear(eye, eye + kRoom * glm::dvec3(std::cos(angle), 0, std::sin(angle)));
        }
        if (!clear) continue;
        const double yaw = random.uniform(0, 6.283185307179586), pitch = random.uniform(-0.2, 0.2);
        View view;
        view.view = lookAt(
            eye, eye + glm::dvec3(std::cos(yaw) * std::cos(pitch), std::sin(pitch), std::sin(yaw) * std::cos(pitch)),
            {0, 1, 0});
        view.projection = perspective(2 * std::atan(9.0 / 16.0), 16.0 / 9.0, kNear);
        views.push_back(view);
    }
    return views;
}

std::vector<bool> trulySeen(const MapOfLeaves& cells, const TreeRays& rays, const View& view, const PortalFlood& may,
                            uint32_t segments, Random& random) {
    std::vector<bool> seen(cells.space.graph.cells, false);
    const glm::dvec3 eye = eyePosition(view);
    const glm::dmat3 back = glm::transpose(glm::dmat3(view.view));
    const double scale_x = 1 / view.projection[0][0], scale_y = 1 / view.projection[1][1];
    const double far = 2 * glm::length(cells.map.tree.bounds.size());
    TreeWalk walk;
    const auto look = [&](double x, double y) {
        const glm::dvec3 ahead = back * glm::dvec3(x * scale_x, y * scale_y, -1);
        rays.follow(eye + kNear * ahead, eye + far * ahead, walk);
        bool found = false;
        for (const TreeStretch& stretch : walk.stretches) {
            const uint32_t cell = cells.space.graph.cell_of_leaf[stretch.leaf];
            if (cell == CellGraph::kNoCell || seen[cell]) continue;
            seen[cell] = true;
            found = true;
        }
        return found;
    };
    for (uint32_t i = 0; i < segments; ++i) {
        const double x = random.uniform(-1, 1);
        look(x, random.uniform(-1, 1));
    }
    for (int round = 0; round < 3; ++round)
        for (const SeenCell& cell : may.cells()) {
            const uint32_t tries = std::max(64u, segments / 256);
            for (uint32_t i = 0; i < tries && !seen[cell.cell]; ++i) {
                const double x = random.uniform(std::max(cell.left, -1.0), std::min(cell.right, 1.0));
                look(x, random.uniform(std::max(cell.bottom, -1.0), std::min(cell.top, 1.0)));
            }
        }
    return seen;
}

}  // namespace sightline::bench
