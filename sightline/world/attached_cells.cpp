// The cells that a world is divided by: their graph, what is seen from where, and where objects stand.
// SPDX-License-Identifier: MIT
#include "sightline/world/attached_cells.h"

#include "sightline/base/assert.h"
#include "sightline/math/finite.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sightline::detail {
namespace {

constexpr uint32_t kNoCell = CellGraph::kNoCell;

Error wrong(std::string what) { return {Error::Kind::kUsage, "the cells cannot be attached: " + std::move(what)}; }

Status checkPortals(const CellSpace& space) {
    const CellGraph& graph = space.graph;
    for (const glm::dvec3& point : graph.points)
        if (!isFinite(point)) return wrong("a portal's point is not finite");
    for (size_t i = 0; i < graph.portals.size(); ++i) {
        const CellPortal& portal = graph.portals[i];
        const std::string name = "portal " + std::to_string(i);
        if (portal.cells[0] >= graph.cells || portal.cells[1] >= graph.cells || portal.cells[0] == portal.cells[1])
            return wrong(name + " does not join two cells");
        if (portal.count < 3 || portal.first > graph.points.size() || graph.points.size() - portal.first < portal.count)
            return wrong(name + " has no outline");
        if (!isFinite(portal.plane) || !std::isfinite(portal.thickness)) return wrong(name + " is not finite");
        if (portal.door != CellPortal::kNone && portal.door >= space.doors.size())
            return wrong(name + " has a door that there is not");
    }
    return success();
}

Status checkTree(const LeafTree& tree) {
    if (!tree.bounds.finite() || tree.bounds.empty()) return wrong("the tree has no bounds");
    for (size_t i = 0; i < tree.nodes.size(); ++i) {
        if (!isFinite(tree.nodes[i].plane)) return wrong("a plane of the tree is not finite");
        for (const uint32_t child : tree.nodes[i].child)
            if (child < LeafTreeNode::kLeaf ? child <= i || child >= tree.nodes.size()
                                            : child - LeafTreeNode::kLeaf >= tree.contents.size())
                return wrong("the tree names a node that there is not");
    }
    return success();
}

/// The cell of each leaf: the graph names it, or the leaf itself is the cell.
Status checkLeaves(const CellSpace& space) {
    if (!space.ofTree()) return success();
    const std::vector<uint32_t>& cell_of_leaf = space.graph.cell_of_leaf;
    if (cell_of_leaf.empty() ? space.tree.contents.size() != space.graph.cells
                             : space.tree.contents.size() != cell_of_leaf.size())
        return wrong("there is not one leaf for each cell");
    for (const uint32_t cell : cell_of_leaf)
        if (cell >= space.graph.cells && cell != kNoCell) return wrong("a leaf has a cell that there is not");
    return success();
}

Status checkRegions(const CellSpace& space) {
    if (space.regions.size() != space.graph.cells) return wrong("there is not one region for each cell");
    for (const glm::dvec4& plane : space.planes)
        if (!isFinite(plane)) return wrong("a plane is not finite");
    for (size_t cell = 0; cell < space.regions.size(); ++cell) {
        const CellRegion& region = space.regions[cell];
        if (region.first_plane > space.planes.size() || space.planes.size() - region.first_plane < region.plane_count)
            return wrong("a cell has planes that there are not");
        if (cell != space.outside && !region.bounds.finite()) return wrong("a cell has no bounds");
    }
    return success();
}

/// A space whose cells are a tree's leaves, and their rows, too.
CellSpace spaceOfViews(LeafTree tree) {
    CellSpace space;
    space.graph.cells = static_cast<uint32_t>(tree.contents.size());
    for (uint32_t leaf = 0; leaf < space.graph.cells; ++leaf) {
        space.graph.cell_of_leaf.push_back(leaf);
        space.row_of_cell.push_back(leaf);
    }
    space.tree = std::move(tree);
    return space;
}

}  // namespace

AttachedViews::AttachedViews(const VisibilityFile& file, Memory* memory)
    : graph(spaceOfViews(file.viewTree()), memory),
      from(file.viewRows()),
      objects(static_cast<uint32_t>(file.objects().size())) {}

Status checkSpace(const CellSpace& space, const VisibleRows* visible) {
    if (space.graph.cells == 0) return wrong("there are none");
    if (Status status = checkPortals(space); !status) return status;
    if (Status status = space.ofTree() ? checkTree(space.tree) : checkRegions(space); !status) return status;
    if (Status status = checkLeaves(space); !status) return status;
    if (space.outside != kNoCell && space.outside >= space.graph.cells) return wrong("there is no such outside");
    if (!(space.tolerance >= 0 && std::isfinite(space.tolerance))) return wrong("the tolerance is not a distance");
    if (!space.row_of_cell.empty() && space.row_of_cell.size() != space.graph.cells)
        return wrong("there is not one row for each cell");
    if (visible)
        for (const uint32_t row : space.row_of_cell)
            if (row != kNoCell && row >= visible->cells()) return wrong("a cell has a row that there is not");
    return success();
}

AttachedCells::AttachedCells(const CellSpace& space, const VisibleRows* visible, Memory* memory)
    : graph(space, memory), doors(memory), first_of_row(memory), cell_of_row(memory), without_row(memory) {
    Box3d box;
    if (space.ofTree()) box = space.tree.bounds;
    else
        for (const CellRegion& region : space.regions)
            if (region.bounds.finite()) box.grow(region.bounds);
    if (box.finite()) origin = box.center();
    for (const CellDoor& door : space.doors) doors.emplace_back(door.name.begin(), door.name.end());
    if (!visible || space.row_of_cell.empty()) return;
    rows.from = *visible;
    first_of_row.assign(visible->cells() + 1, 0);
    for (const uint32_t row : space.row_of_cell)
        if (row != kNoCell) ++first_of_row[row + 1];
    for (uint32_t row = 0; row < visible->cells(); ++row) first_of_row[row + 1] += first_of_row[row];
    cell_of_row.resize(first_of_row.back());
    Array<uint32_t> next(first_of_row, memory);
    for (uint32_t cell = 0; cell < space.row_of_cell.size(); ++cell) {
        const uint32_t row = space.row_of_cell[cell];
        if (row == kNoCell) without_row.push_back(cell);
        else cell_of_row[next[row]++] = cell;
    }
    SIGHTLINE_DEBUG_ASSERT(cell_of_row.size() + without_row.size() == space.row_of_cell.size());
}

uint32_t AttachedCells::objectOf(uint64_t key, const Box3d& box) const {
    if (objects.size() == 0) return kNone;
    const auto [first, end] = objects.find(key);
    SIGHTLINE_DEBUG_ASSERT(first <= end && end <= objects.size());
    if (end - first != 1) return kNone;
    const Box3d baked = objects.bounds(first);
    for (int axis = 0; axis < 3; ++axis) {
        const double rounding = 0x1p-44 * std::max(std::abs(baked.min[axis]), std::abs(baked.max[axis]));
        if (!(std::abs(box.min[axis] - baked.min[axis]) <= rounding) ||
            !(std::abs(box.max[axis] - baked.max[axis]) <= rounding))
            return kNone;
    }
    return static_cast<uint32_t>(first);
}

}  // namespace sightline::detail
