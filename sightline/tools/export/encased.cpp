// Finds closed surfaces, and the triangles that lie within them.
// SPDX-License-Identifier: MIT
#include "sightline/tools/export/encased.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "sightline/tools/scene/joined_sets.h"
#include "sightline/tools/scene/welded.h"
#include "sightline/tree/bvh.h"

namespace sightline::tools {
namespace {

using Triangle = std::array<glm::dvec3, 3>;

/// Triangles of a mesh that hang together, all edges of which are shut.
struct Shell {
    std::vector<uint32_t> triangles;
    bool both_sides = true;  ///< each of them is drawn from both sides
};

/// Whether each edge is run through as often one way as the other.
bool isClosed(const Mesh& mesh, const std::vector<uint32_t>& welded, const std::vector<uint32_t>& triangles) {
    std::vector<std::pair<uint64_t, int>> edges;
    for (const uint32_t t : triangles)
        for (uint32_t k = 0; k < 3; ++k) {
            const uint32_t a = welded[mesh.indices[3 * size_t{t} + k]];
            const uint32_t b = welded[mesh.indices[3 * size_t{t} + (k + 1) % 3]];
            if (a != b) edges.emplace_back(uint64_t{std::min(a, b)} << 32 | std::max(a, b), a < b ? 1 : -1);
        }
    std::sort(edges.begin(), edges.end());
    for (size_t i = 0; i < edges.size();) {
        int sum = 0;
        const uint64_t edge = edges[i].first;
        for (; i < edges.size() && edges[i].first == edge; ++i) sum += edges[i].second;
        if (sum != 0) return false;
    }
    return !edges.empty();
}

std::vector<Shell> shellsOf(const Scene& scene, const Mesh& mesh) {
    std::vector<Shell> shells;
    if (mesh.deforms) return shells;
    const std::vector<uint32_t> welded = weldedPositions(mesh);
    JoinedSets sets(mesh.positions.size());
    const auto cornerOf = [&](uint32_t t, uint32_t k) { return welded[mesh.indices[3 * size_t{t} + k]]; };
    const auto forEachHiding = [&](auto&& visit) {
        for (const Primitive& primitive : mesh.primitives) {
            const Material& material = scene.materials[primitive.material];
            for (uint32_t i = 0; material.hides() && i < primitive.triangle_count; ++i)
                visit(primitive.first_triangle + i, material.double_sided);
        }
    };
    forEachHiding([&](uint32_t t, bool) {
        for (const uint32_t k : {1u, 2u}) sets.join(cornerOf(t, 0), cornerOf(t, k));
    });
    std::map<uint32_t, Shell> parts;
    forEachHiding([&](uint32_t t, bool both_sides) {
        Shell& part = parts[sets.find(cornerOf(t, 0))];
        part.triangles.push_back(t);
        part.both_sides &= both_sides;
    });
    for (auto& [first, part] : parts)
        if (isClosed(mesh, welded, part.triangles)) shells.push_back(std::move(part));
    return shells;
}

Triangle placed(const Mesh& mesh, const glm::dmat4& transform, uint32_t triangle) {
    Triangle out;
    for (uint32_t k = 0; k < 3; ++k)
        out[k] = transform * glm::dvec4(glm::dvec3(mesh.positions[mesh.indices[3 * size_t{triangle} + k]]), 1);
    return out;
}

Box3d boxOf(const Triangle& triangle) {
    Box3d box;
    for (const glm::dvec3& corner : triangle) box.grow(corner);
    return box;
}

/// Calls visit(item) for each item whose box may overlap another.
template <class Visit>
void forEachIn(const Bvh& tree, const Box3d& box, Visit&& visit) {
    if (tree.nodes.empty()) return;
    const Box3f asked = roundOutward(box, tree.origin);
    std::vector<uint32_t> open = {0};
    while (!open.empty()) {
        const BvhNode& node = tree.nodes[open.back()];
        open.pop_back();
        for (int slot = 0; slot < 8; ++slot) {
            if (node.count[slot] == 0) continue;
            bool apart = false;
            for (int axis = 0; axis < 3; ++axis)
                apart |= node.min[axis][slot] > asked.max[axis] || node.max[axis][slot] < asked.min[axis];
            if (apart) continue;
            if (node.child[slot] & BvhNode::kLeaf) visit(tree.order[node.child[slot] & ~BvhNode::kLeaf]);
            else open.push_back(node.child[slot]);
        }
    }
}

/// Whether some direction keeps two triangles farther apart than a distance.
bool areApart(const Triangle& a, const Triangle& b, double distance) {
    const auto keeps = [&](const glm::dvec3& axis) {
        const double length = glm::length(axis);
        if (!(length > 0)) return false;
        double least_a = std::numeric_limits<double>::infinity(), most_a = -least_a;
        double least_b = least_a, most_b = -least_a;
        for (int k = 0; k < 3; ++k) {
            const double at_a = glm::dot(axis, a[k] - a[0]), at_b = glm::dot(axis, b[k] - a[0]);
            least_a = std::min(least_a, at_a), most_a = std::max(most_a, at_a);
            least_b = std::min(least_b, at_b), most_b = std::max(most_b, at_b);
        }
        return std::max(least_a - most_b, least_b - most_a) > distance * length;
    };
    const glm::dvec3 normal_a = glm::cross(a[1] - a[0], a[2] - a[0]), normal_b = glm::cross(b[1] - b[0], b[2] - b[0]);
    if (keeps(normal_a) || keeps(normal_b)) return true;
    for (int i = 0; i < 3; ++i) {
        const glm::dvec3 edge_a = a[(i + 1) % 3] - a[i];
        for (int k = 0; k < 3; ++k)
            if (keeps(glm::cross(edge_a, b[(k + 1) % 3] - b[k]))) return true;
        // Triangles in one plane are told apart within it.
        if (keeps(glm::cross(edge_a, normal_a)) || keeps(glm::cross(b[(i + 1) % 3] - b[i], normal_b))) return true;
    }
    return false;
}

/// The sign of a sum of products, or 0 if rounding may have made it.
int sureSign(double sum, double size) { return std::abs(sum) > 0x1p-46 * size ? (sum > 0 ? 1 : -1) : 0; }

/// A shell in the world.
class PlacedShell {
public:
    PlacedShell(const Mesh& mesh, const glm::dmat4& transform, const Shell& shell) {
        for (const uint32_t t : shell.triangles) {
            triangles_.push_back(placed(mesh, transform, t));
            box_.grow(boxOf(triangles_.back()));
        }
        mirrored_ = glm::determinant(glm::dmat3(transform)) < 0;
    }

    const Box3d& box() const { return box_; }

    /// Before any of the questions below.
    void prepare() {
        std::vector<Box3d> boxes;
        for (const Triangle& triangle : triangles_) boxes.push_back(boxOf(triangle));
        tree_ = buildBvh(boxes);
    }

    bool isApart(const Triangle& triangle, double distance) const {
        Box3d box = boxOf(triangle);
        box.min -= glm::dvec3(distance);
        box.max += glm::dvec3(distance);
        bool apart = true;
        forEachIn(tree_, box, [&](uint32_t i) { apart = apart && areApart(triangles_[i], triangle, distance); });
        return apart;
    }

    /// How often the shell's fronts wind around a point that is not on it.
    int windsAround(const glm::dvec3& point) const {
        for (int axis = 0; axis < 3; ++axis)
            for (const int way : {1, -1})
                if (const std::optional<int> winds = countAlong(point, axis, way)) return mirrored_ ? -*winds : *winds;
        const int winds = static_cast<int>(std::lround(solidAngle(point)));
        return mirrored_ ? -winds : winds;
    }

private:
    /// Counts what a ray along an axis passes, one more for each back; none if it comes too near to an edge to be sure.
    std::optional<int> countAlong(const glm::dvec3& point, int axis, int way) const {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        Box3d ray;
        ray.grow(point);
        if (way > 0) ray.max[axis] = std::max(box_.max[axis], point[axis]);
        else ray.min[axis] = std::min(box_.min[axis], point[axis]);
        int count = 0;
        bool sure = true;
        forEachIn(tree_, ray, [&](uint32_t i) {
            if (!sure) return;
            std::array<glm::dvec3, 3> from;
            for (int k = 0; k < 3; ++k) from[k] = triangles_[i][k] - point;
            int left = 0, right = 0;
            for (int k = 0; k < 3; ++k) {
                const glm::dvec3 &a = from[k], &b = from[(k + 1) % 3];
                const int side = sureSign(a[u] * b[v] - a[v] * b[u], std::abs(a[u] * b[v]) + std::abs(a[v] * b[u]));
                left += side > 0;
                right += side < 0;
            }
            if (left > 0 && right > 0) return;  // beside it
            if (left < 3 && right < 3) {
                sure = false;
                return;
            }
            // Before the point or behind it: which side of the triangle's plane the point is on.
            const Triangle& t = triangles_[i];
            const glm::dvec3 first = t[1] - t[0], second = t[2] - t[0];
            const int side = sureSign(glm::dot(glm::cross(first, second), from[0]),
                                      glm::length(first) * glm::length(second) * glm::length(from[0]));
            if (side == 0) sure = false;
            // `left` means that the normal points along the axis; the plane is ahead if the point is before it.
            const int facing = left == 3 ? 1 : -1;
            if (side * way == facing) count += facing * way;
        });
        if (!sure) return std::nullopt;
        return count;
    }

    /// Adriaan van Oosterom, Jan Strackee. The Solid Angle of a Plane Triangle. 1983.
    /// @return in parts of the whole sphere
    double solidAngle(const glm::dvec3& point) const {
        double sum = 0;
        for (const Triangle& triangle : triangles_) {
            const glm::dvec3 a = triangle[0] - point, b = triangle[1] - point, c = triangle[2] - point;
            const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
            const double above = glm::dot(a, glm::cross(b, c));
            const double below = la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb;
            sum += 2 * std::atan2(above, below);
        }
        return sum / (4 * 3.14159265358979323846);
    }

    std::vector<Triangle> triangles_;
    Box3d box_;
    Bvh tree_;
    bool mirrored_ = false;
};

/// All drawn triangles of a scene in one tree.
class AllTriangles {
public:
    explicit AllTriangles(const Scene& scene) : scene_(scene) {
        std::vector<Box3d> boxes;
        for (uint32_t object = 0; object < scene.objects.size(); ++object) {
            const Mesh& mesh = scene.meshes[scene.objects[object].mesh];
            if (mesh.deforms || scene.objects[object].changes != 0) continue;
            for (uint32_t t = 0; t < mesh.triangles(); ++t) {
                items_.emplace_back(object, t);
                boxes.push_back(boxOf(placed(mesh, scene.objects[object].transform, t)));
            }
        }
        tree_ = buildBvh(boxes);
    }

    /// Triangles by object and number, in that order.
    using Item = std::pair<uint32_t, uint32_t>;

    std::vector<Item> within(const Box3d& box) const {
        std::vector<Item> out;
        forEachIn(tree_, box, [&](uint32_t i) { out.push_back(items_[i]); });
        std::sort(out.begin(), out.end());
        return out;
    }

    Triangle at(const Item& item) const {
        const SceneObject& object = scene_.objects[item.first];
        return placed(scene_.meshes[object.mesh], object.transform, item.second);
    }

private:
    const Scene& scene_;
    std::vector<Item> items_;
    Bvh tree_;
};

glm::dvec3 innerPoint(const Triangle& t) {
    // No corner and no middle, which lie in one line with those of neighbours.
    return t[0] * 0.371 + t[1] * 0.339 + t[2] * 0.29;
}

/// Numbers of items whose triangles share a corner, in sets.
JoinedSets hangingTogether(const Scene& scene, const std::vector<AllTriangles::Item>& items) {
    JoinedSets sets(items.size());
    std::map<std::array<float, 3>, uint32_t> first_at;
    for (uint32_t i = 0; i < items.size(); ++i) {
        if (i == 0 || items[i].first != items[i - 1].first) first_at.clear();
        const Mesh& mesh = scene.meshes[scene.objects[items[i].first].mesh];
        for (uint32_t k = 0; k < 3; ++k) {
            const glm::vec3& p = mesh.positions[mesh.indices[3 * size_t{items[i].second} + k]];
            sets.join(i, first_at.try_emplace({p.x + 0.0f, p.y + 0.0f, p.z + 0.0f}, i).first->second);
        }
    }
    return sets;
}

}  // namespace

Encased encasedTriangles(const Scene& scene, const std::function<bool(size_t, size_t)>& progress) {
    Encased out;
    out.triangles.resize(scene.objects.size());
    std::vector<std::vector<Shell>> shells;
    for (const Mesh& mesh : scene.meshes) shells.push_back(shellsOf(scene, mesh));
    std::vector<bool> opens(scene.objects.size());  // no shells
    for (size_t i = 0; i < opens.size(); ++i) opens[i] = scene.objects[i].changes != 0;
    for (const ScenePortal& portal : scene.portals)
        if (portal.door != ScenePortal::kNone) opens[portal.door] = true;
    size_t total = 0, done = 0;
    for (size_t i = 0; i < scene.objects.size(); ++i) total += opens[i] ? 0 : shells[scene.objects[i].mesh].size();
    out.shells = total;
    if (total == 0) return out;

    const AllTriangles all(scene);
    std::vector<std::vector<bool>> inside(scene.objects.size());
    const auto isInside = [&](const AllTriangles::Item& item) {
        return !inside[item.first].empty() && inside[item.first][item.second];
    };
    for (uint32_t i = 0; i < scene.objects.size(); ++i) {
        if (opens[i]) continue;
        const Mesh& mesh = scene.meshes[scene.objects[i].mesh];
        for (const Shell& shell : shells[scene.objects[i].mesh]) {
            if (progress && !progress(done, total)) return out;
            ++done;
            PlacedShell around(mesh, scene.objects[i].transform, shell);
            const glm::dvec3 reach = glm::max(glm::abs(around.box().min), glm::abs(around.box().max));
            const double distance = 1e-6 * std::max({reach.x, reach.y, reach.z});
            std::vector<AllTriangles::Item> items;
            for (const AllTriangles::Item& item : all.within(around.box())) {
                if (isInside(item)) continue;
                if (item.first == i && std::binary_search(shell.triangles.begin(), shell.triangles.end(), item.second))
                    continue;
                const Box3d box = boxOf(all.at(item));
                if (glm::all(glm::greaterThan(box.min, around.box().min)) &&
                    glm::all(glm::lessThan(box.max, around.box().max)))
                    items.push_back(item);
            }
            if (items.empty()) continue;
            around.prepare();
            std::erase_if(items,
                          [&](const AllTriangles::Item& item) { return !around.isApart(all.at(item), distance); });
            // The shell touches none of them, so that it winds equally around all that hang together.
            JoinedSets sets = hangingTogether(scene, items);
            std::map<uint32_t, bool> hidden;
            for (uint32_t k = 0; k < items.size(); ++k) {
                const auto [known, fresh] = hidden.try_emplace(sets.find(k));
                if (fresh) {
                    const int winds = around.windsAround(innerPoint(all.at(items[k])));
                    known->second = winds > 0 || (shell.both_sides && winds != 0);
                }
                if (!known->second) continue;
                std::vector<bool>& of_object = inside[items[k].first];
                if (of_object.empty()) of_object.resize(scene.meshes[scene.objects[items[k].first].mesh].triangles());
                of_object[items[k].second] = true;
            }
        }
    }
    for (size_t i = 0; i < inside.size(); ++i)
        for (uint32_t t = 0; t < inside[i].size(); ++t)
            if (inside[i][t]) out.triangles[i].push_back(t);
    return out;
}

}  // namespace sightline::tools
