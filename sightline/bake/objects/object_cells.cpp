// Sorts the triangles of each object into cells, by their planes or down a tree.
// SPDX-License-Identifier: MIT
#include "sightline/bake/objects/object_cells.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sightline/tree/bvh.h"

namespace sightline::bake {
using namespace tools;
namespace {

constexpr uint32_t kNoCell = CellGraph::kNoCell;

double largest(const glm::dvec3& p) { return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}); }

double heightOf(const glm::dvec4& plane, const glm::dvec3& p) { return glm::dot(glm::dvec3(plane), p) + plane.w; }

/// The least and the largest height of a box above a plane.
glm::dvec2 heightsOf(const glm::dvec4& plane, const Box3d& box) {
    const glm::dvec3 half = 0.5 * box.size();
    const double middle = heightOf(plane, box.center()), reach = glm::dot(glm::abs(glm::dvec3(plane)), half);
    return {middle - reach, middle + reach};
}

using Polygon = std::vector<glm::dvec3>;

/// The part of a polygon that is no deeper than `depth` below a plane; a point is a polygon too.
void clip(const Polygon& in, const glm::dvec4& plane, double depth, Polygon& out) {
    out.clear();
    for (size_t i = 0; i < in.size(); ++i) {
        const glm::dvec3 &a = in[i], &b = in[i + 1 == in.size() ? 0 : i + 1];
        const double above_a = heightOf(plane, a) + depth, above_b = heightOf(plane, b) + depth;
        if (above_a >= 0) out.push_back(a);
        if ((above_a >= 0) != (above_b >= 0)) out.push_back(a + above_a / (above_a - above_b) * (b - a));
    }
}

Box3d boundsOf(const Polygon& polygon, double margin) {
    Box3d box;
    for (const glm::dvec3& point : polygon) box.grow(point);
    return {box.min - margin, box.max + margin};
}

/// What of an object is in a cell.
struct Piece {
    uint32_t cell;
    Box3d box;
};
using Pieces = std::vector<Piece>;

/// In the order of cells, one for each.
void mergePieces(Pieces& pieces) {
    std::sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) { return a.cell < b.cell; });
    size_t kept = 0;
    for (const Piece& piece : pieces) {
        if (kept > 0 && pieces[kept - 1].cell == piece.cell) pieces[kept - 1].box.grow(piece.box);
        else pieces[kept++] = piece;
    }
    pieces.resize(kept);
}

/// One object in the world: its triangles, or its box if it deforms or has no triangles.
struct Body {
    Box3d box;
    std::vector<glm::dvec3> corners;  ///< three a triangle
};

class Placer {
public:
    Placer(const CellSpace& space, double margin) : space_(space), margin_(std::max(margin, space.tolerance)) {
        for (const LeafTreeNode& node : space.tree.nodes) {
            const double length = glm::length(glm::dvec3(node.plane));
            planes_.push_back(node.plane / length);
            reach_ = std::max(reach_, std::abs(planes_.back().w));
        }
        for (const glm::dvec4& plane : space.planes) reach_ = std::max(reach_, std::abs(plane.w));
        if (space.ofTree()) return;
        std::vector<Box3d> boxes;
        for (uint32_t cell = 0; cell < space.graph.cells; ++cell)
            if (cell != space.outside && space.regions[cell].bounds.finite()) {
                cell_of_box_.push_back(cell);
                boxes.push_back(space.regions[cell].bounds);
            }
        regions_ = buildBvh(boxes);
    }

    /// @returns whether it may be somewhere in no cell
    bool place(const Body& body, Pieces& pieces) const {
        double far = reach_;
        for (const glm::dvec3& corner : {body.box.min, body.box.max}) far = std::max(far, largest(corner));
        const double depth = margin_ + 0x1p-40 * far;
        // A sight line to what lies beyond the bounds leaves them, and beyond them there are no portals.
        const Box3d& bounds = space_.tree.bounds;
        if (space_.ofTree() && !bounds.empty() && !Box3d{bounds.min - depth, bounds.max + depth}.holds(body.box))
            return true;
        bool in_no_cell = false;
        if (!space_.ofTree()) in_no_cell = !placeInRegions(body, depth, pieces);
        else if (body.corners.empty()) placeBox(body.box, depth, pieces);
        else placeTriangles(body, depth, pieces);
        mergePieces(pieces);
        return in_no_cell || (space_.ofTree() && pieces.empty());
    }

private:
    void arrive(uint32_t child, const Box3d& box, Pieces& pieces) const {
        const uint32_t cell = space_.graph.cell_of_leaf[child ^ LeafTreeNode::kLeaf];
        if (cell != kNoCell) pieces.push_back({cell, box});
    }
    uint32_t root() const { return space_.tree.nodes.empty() ? LeafTreeNode::kLeaf : 0; }

    void placeBox(const Box3d& box, double depth, Pieces& pieces) const {
        std::vector<uint32_t> stack = {root()};
        while (!stack.empty()) {
            const uint32_t at = stack.back();
            stack.pop_back();
            if ((at & LeafTreeNode::kLeaf) != 0) {
                arrive(at, {box.min - depth, box.max + depth}, pieces);
                continue;
            }
            const glm::dvec2 heights = heightsOf(planes_[at], box);
            if (heights.x <= depth) stack.push_back(space_.tree.nodes[at].child[0]);
            if (heights.y >= -depth) stack.push_back(space_.tree.nodes[at].child[1]);
        }
    }

    void placeTriangles(const Body& body, double depth, Pieces& pieces) const {
        struct Part {
            uint32_t child;
            Polygon polygon;
        };
        std::vector<Part> stack;
        for (size_t i = 0; i < body.corners.size(); i += 3) {
            stack.push_back({root(), Polygon(body.corners.begin() + static_cast<std::ptrdiff_t>(i),
                                             body.corners.begin() + static_cast<std::ptrdiff_t>(i + 3))});
            while (!stack.empty()) {
                Part at = std::move(stack.back());
                stack.pop_back();
                while ((at.child & LeafTreeNode::kLeaf) == 0) {
                    const LeafTreeNode& node = space_.tree.nodes[at.child];
                    const glm::dvec4& plane = planes_[at.child];
                    double low = heightOf(plane, at.polygon[0]), high = low;
                    for (const glm::dvec3& point : at.polygon) {
                        low = std::min(low, heightOf(plane, point));
                        high = std::max(high, heightOf(plane, point));
                    }
                    if (low > depth || high < -depth) {
                        at.child = node.child[low > depth];
                        continue;
                    }
                    Polygon front;
                    clip(at.polygon, plane, depth, front);
                    if (!front.empty()) stack.push_back({node.child[1], std::move(front)});
                    Polygon back;
                    clip(at.polygon, -plane, depth, back);
                    at.polygon = std::move(back);
                    at.child = node.child[0];
                    if (at.polygon.empty()) break;
                }
                if (!at.polygon.empty()) arrive(at.child, boundsOf(at.polygon, depth), pieces);
            }
        }
    }

    template <class Visit>
    void visitRegions(const Box3d& box, Visit&& visit) const {
        if (regions_.nodes.empty()) return;
        const Box3f around = roundOutward(box, regions_.origin);
        std::vector<uint32_t> stack = {0};
        while (!stack.empty()) {
            const BvhNode& node = regions_.nodes[stack.back()];
            stack.pop_back();
            for (uint32_t slot = 0; slot < 8; ++slot) {
                bool meets = node.count[slot] != 0;
                for (int axis = 0; axis < 3 && meets; ++axis)
                    meets = node.min[axis][slot] <= around.max[axis] && node.max[axis][slot] >= around.min[axis];
                if (!meets) continue;
                const uint32_t child = node.child[slot];
                if ((child & BvhNode::kLeaf) == 0) stack.push_back(child);
                else visit(cell_of_box_[regions_.order[child ^ BvhNode::kLeaf]]);
            }
        }
    }

    bool isInside(std::span<const glm::dvec4> planes, std::span<const glm::dvec3> points, double depth) const {
        for (const glm::dvec4& plane : planes)
            for (const glm::dvec3& point : points)
                if (!(heightOf(plane, point) > depth)) return false;
        return true;
    }

    /// @returns whether it is wholly inside of cells, triangle for triangle
    bool placeInRegions(const Body& body, double depth, Pieces& pieces) const {
        std::vector<uint32_t> met;
        visitRegions({body.box.min - depth, body.box.max + depth}, [&](uint32_t cell) { met.push_back(cell); });
        bool inside = false;
        for (const uint32_t cell : met) {
            double least = 2 * depth + 1, most = least;  // of the box's heights above the region's planes
            for (const glm::dvec4& plane : space_.planesOf(space_.regions[cell])) {
                const glm::dvec2 heights = heightsOf(plane, body.box);
                least = std::min(least, heights.x);
                most = std::min(most, heights.y);
            }
            if (most < -depth) continue;
            inside = inside || least > depth;
            if (least >= -depth || body.corners.empty() || meets(body, cell, depth))
                pieces.push_back({cell, {body.box.min - depth, body.box.max + depth}});
        }
        if (inside || space_.outside == kNoCell) return inside || !pieces.empty();
        for (size_t i = 0; i < body.corners.size(); i += 3) {
            const std::span<const glm::dvec3> triangle(body.corners.data() + i, 3);
            if (std::none_of(pieces.begin(), pieces.end(), [&](const Piece& piece) {
                    return isInside(space_.planesOf(space_.regions[piece.cell]), triangle, depth);
                }))
                return false;
        }
        return !body.corners.empty();
    }

    /// Whether some triangle comes within the depth of a region.
    bool meets(const Body& body, uint32_t cell, double depth) const {
        Polygon polygon, left;
        for (size_t i = 0; i < body.corners.size(); i += 3) {
            polygon.assign(body.corners.begin() + static_cast<std::ptrdiff_t>(i),
                           body.corners.begin() + static_cast<std::ptrdiff_t>(i + 3));
            for (const glm::dvec4& plane : space_.planesOf(space_.regions[cell])) {
                clip(polygon, plane, depth, left);
                polygon.swap(left);
                if (polygon.empty()) break;
            }
            if (!polygon.empty()) return true;
        }
        return false;
    }

    const CellSpace& space_;
    double margin_ = 0, reach_ = 0;
    std::vector<glm::dvec4> planes_;  // per node, its normal of length 1
    Bvh regions_;
    std::vector<uint32_t> cell_of_box_;
};

Body bodyOf(const Scene& scene, const SceneObject& object, const Box3d& box) {
    const Mesh& mesh = scene.meshes[object.mesh];
    Body body;
    body.box = box;
    if (mesh.deforms) return body;
    body.corners.reserve(mesh.indices.size());
    for (const uint32_t index : mesh.indices)
        body.corners.push_back(glm::dvec3(object.transform * glm::dvec4(glm::dvec3(mesh.positions[index]), 1)));
    return body;
}

}  // namespace

ObjectCells cellsOfObjects(const Scene& scene, const CellSpace& space, const ObjectCellSettings& settings) {
    constexpr uint32_t kTogether = 64;  // objects that one task places
    ObjectCells out;
    std::vector<Box3d> boxes;
    std::vector<uint32_t>& placed = out.object_of;
    for (uint32_t i = 0; i < scene.objects.size(); ++i) {
        const SceneObject& object = scene.objects[i];
        boxes.push_back(transformBox(scene.meshes[object.mesh].bounds, object.transform));
        if (!settings.moves.empty() && settings.moves[i]) ++out.moving;
        else if (boxes[i].empty() || !boxes[i].finite()) ++out.unbounded;
        else placed.push_back(i);
    }
    std::stable_sort(placed.begin(), placed.end(),
                     [&](uint32_t a, uint32_t b) { return scene.objects[a].key < scene.objects[b].key; });
    struct Place {
        Pieces pieces;
        bool in_no_cell = false;
    };
    std::vector<Place> found(placed.size());
    const Placer placer(space, settings.margin);
    const uint32_t tasks = static_cast<uint32_t>((placed.size() + kTogether - 1) / kTogether);
    constexpr uint32_t kTasks = 64;  // between two reports of the progress
    for (uint32_t begin = 0; begin < tasks; begin += kTasks) {
        runJobs(settings.jobs, std::min(kTasks, tasks - begin), [&](uint32_t task) {
            const size_t first = size_t{begin + task} * kTogether;
            for (size_t i = first; i < std::min(first + kTogether, placed.size()); ++i) {
                const Body body = bodyOf(scene, scene.objects[placed[i]], boxes[placed[i]]);
                found[i].in_no_cell = placer.place(body, found[i].pieces);
            }
        });
        if (settings.progress)
            settings.progress(std::min(size_t{begin + kTasks} * kTogether, placed.size()), placed.size());
    }
    std::vector<bool> is_wall(scene.objects.size(), false);
    for (const uint32_t wall : settings.walls) is_wall[wall] = true;
    std::vector<uint32_t> cells;
    for (size_t i = 0; i < placed.size(); ++i) {
        Place& place = found[i];
        const SceneObject& object = scene.objects[placed[i]];
        if (place.in_no_cell && space.outside != kNoCell) {
            place.pieces.push_back({space.outside, boxes[placed[i]]});
            mergePieces(place.pieces);
            ++out.outside;
        }
        cells.clear();
        for (const Piece& piece : place.pieces) {
            cells.push_back(piece.cell);
            out.pieces.push_back(piece.box);
        }
        const bool everywhere = cells.empty();
        out.everywhere += everywhere;
        out.by_box += scene.meshes[object.mesh].deforms || scene.meshes[object.mesh].indices.empty();
        out.places.add(object.key, boxes[placed[i]], cells, everywhere, is_wall[placed[i]]);
    }
    return out;
}

}  // namespace sightline::bake
