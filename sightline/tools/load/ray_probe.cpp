// The nearest surface that a ray meets in a scene: enough to judge where a camera stands.
// SPDX-License-Identifier: MIT
//
// Christian Lauterbach, Michael Garland, Shubhabrata Sengupta, David Luebke, Dinesh Manocha. Fast BVH
// Construction on GPUs. 2009.
// Tomas Moller, Ben Trumbore. Fast, Minimum Storage Ray/Triangle Intersection. 1997.
#include "sightline/tools/load/ray_probe.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <tuple>

namespace sightline::tools {
namespace {

constexpr uint32_t kLeafSize = 4;
constexpr double kNever = std::numeric_limits<double>::infinity();

/// Spreads 21 bits to every third bit.
uint64_t spread(uint64_t v) {
    v = (v | v << 32) & 0x1f00000000ffffull;
    v = (v | v << 16) & 0x1f0000ff0000ffull;
    v = (v | v << 8) & 0x100f00f00f00f00full;
    v = (v | v << 4) & 0x10c30c30c30c30c3ull;
    v = (v | v << 2) & 0x1249249249249249ull;
    return v;
}

uint64_t mortonCode(const glm::dvec3& point, const Box3d& around) {
    uint64_t code = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double size = around.max[axis] - around.min[axis];
        const double share = size > 0 ? (point[axis] - around.min[axis]) / size : 0;
        code |= spread(static_cast<uint64_t>(std::clamp(share, 0.0, 1.0) * 0x1fffff)) << axis;
    }
    return code;
}

/// Where the ray enters a box, or infinity if it misses it or enters beyond the limit.
double enterBox(const Box3d& box, const glm::dvec3& origin, const glm::dvec3& inverse, double limit) {
    double enter = 0, leave = limit;
    for (int axis = 0; axis < 3; ++axis) {
        const double a = (box.min[axis] - origin[axis]) * inverse[axis];
        const double b = (box.max[axis] - origin[axis]) * inverse[axis];
        // A NaN (0 times infinity: the ray runs in the slab's face) leaves enter and leave as they are.
        const double low = a < b ? a : b, high = a < b ? b : a;
        if (low > enter) enter = low;
        if (high < leave) leave = high;
    }
    return enter <= leave ? enter : kNever;
}

/// Calls visit(box) for every box that the ray may meet before the limit, roughly nearest first; visit may
/// lower the limit.
template <class Visit>
void walk(const ProbeTree& tree, const ProbeRay& ray, const double& limit, Visit&& visit) {
    struct Entry {
        double t;
        uint32_t node;
    };
    Entry stack[ProbeTree::kMaxDepth + 2];
    uint32_t size = 0;
    const glm::dvec3 inverse = 1.0 / ray.direction;
    const auto push = [&](double t, uint32_t node) {
        if (t < kNever) stack[size++] = {t, node};
    };
    push(enterBox(tree.nodes()[0].bounds, ray.origin, inverse, limit), 0);
    while (size > 0) {
        const Entry entry = stack[--size];
        if (entry.t > limit) continue;
        const ProbeTree::Node& node = tree.nodes()[entry.node];
        if (node.count > 0) {
            for (uint32_t i = 0; i < node.count; ++i) visit(tree.order()[node.first + i]);
            continue;
        }
        const uint32_t left = node.first, right = node.first + 1;
        const double at_left = enterBox(tree.nodes()[left].bounds, ray.origin, inverse, limit);
        const double at_right = enterBox(tree.nodes()[right].bounds, ray.origin, inverse, limit);
        if (at_left <= at_right) {
            push(at_right, right);
            push(at_left, left);
        } else {
            push(at_left, left);
            push(at_right, right);
        }
    }
}

}  // namespace

ProbeTree::ProbeTree(std::span<const Box3d> boxes) {
    if (boxes.empty()) return;
    Box3d centers;
    for (const Box3d& box : boxes) centers.grow(box.center());
    std::vector<Coded> coded(boxes.size());
    for (uint32_t i = 0; i < coded.size(); ++i) coded[i] = {mortonCode(boxes[i].center(), centers), i};
    std::sort(coded.begin(), coded.end(),
              [](const Coded& a, const Coded& b) { return std::tie(a.code, a.box) < std::tie(b.code, b.box); });
    order_.resize(coded.size());
    for (size_t i = 0; i < coded.size(); ++i) order_[i] = coded[i].box;
    nodes_.reserve(coded.size());
    nodes_.resize(1);
    build(0, 0, static_cast<uint32_t>(coded.size()), coded, boxes);
}

void ProbeTree::build(uint32_t node, uint32_t first, uint32_t last, std::span<const Coded> coded,
                      std::span<const Box3d> boxes) {
    Box3d bounds;
    if (last - first <= kLeafSize) {
        for (uint32_t i = first; i < last; ++i) bounds.grow(boxes[coded[i].box]);
        nodes_[node] = {bounds, first, last - first};
        return;
    }
    uint32_t middle = first + (last - first) / 2;
    const uint64_t different = coded[first].code ^ coded[last - 1].code;
    if (different != 0) {
        const uint64_t bit = std::bit_floor(different);
        const auto split = std::partition_point(coded.begin() + first, coded.begin() + last,
                                                [&](const Coded& c) { return (c.code & bit) == 0; });
        middle = static_cast<uint32_t>(split - coded.begin());
    }
    const auto children = static_cast<uint32_t>(nodes_.size());
    nodes_.resize(nodes_.size() + 2);
    build(children, first, middle, coded, boxes);
    build(children + 1, middle, last, coded, boxes);
    bounds.grow(nodes_[children].bounds);
    bounds.grow(nodes_[children + 1].bounds);
    nodes_[node] = {bounds, children, 0};
}

RayProbe::RayProbe(const Scene& scene) : scene_(&scene), meshes_(scene.meshes.size()) {
    std::vector<Box3d> boxes;
    for (const SceneObject& object : scene.objects) {
        const Mesh& mesh = scene.meshes[object.mesh];
        if (meshes_[object.mesh] || mesh.triangles() == 0) continue;
        boxes.assign(mesh.triangles(), {});
        for (size_t i = 0; i < mesh.indices.size(); ++i) boxes[i / 3].grow(glm::dvec3(mesh.positions[mesh.indices[i]]));
        meshes_[object.mesh] = std::make_unique<ProbeTree>(boxes);
    }
    boxes.clear();
    boxes.reserve(scene.objects.size());
    for (const SceneObject& object : scene.objects)
        boxes.push_back(transformBox(scene.meshes[object.mesh].bounds, object.transform));
    // Objects without triangles have empty boxes; a point keeps the tree's arithmetic finite.
    for (Box3d& box : boxes)
        if (box.empty()) box.grow(glm::dvec3(0));
    objects_ = std::make_unique<ProbeTree>(boxes);
}

std::optional<ProbeHit> RayProbe::nearest(const ProbeRay& ray, double from) const {
    if (scene_->objects.empty()) return std::nullopt;
    ProbeHit best;
    walk(*objects_, ray, best.t, [&](uint32_t object) { meet(object, ray, from, best); });
    if (best.t == kNever) return std::nullopt;
    return best;
}

void RayProbe::meet(uint32_t object, const ProbeRay& ray, double from, ProbeHit& best) const {
    const SceneObject& placed = scene_->objects[object];
    if (!meshes_[placed.mesh]) return;
    const glm::dmat3 linear(placed.transform);
    if (!(std::abs(glm::determinant(linear)) > 0)) return;
    const Mesh& mesh = scene_->meshes[placed.mesh];
    const glm::dmat3 inverse = glm::inverse(linear);
    const ProbeRay local{inverse * (ray.origin - glm::dvec3(placed.transform[3])), inverse * ray.direction};
    walk(*meshes_[placed.mesh], local, best.t, [&](uint32_t triangle) {
        const auto corner = [&](uint32_t k) { return glm::dvec3(mesh.positions[mesh.indices[3 * triangle + k]]); };
        const glm::dvec3 a = corner(0), ab = corner(1) - a, ac = corner(2) - a, from_a = local.origin - a;
        const glm::dvec3 p = glm::cross(local.direction, ac);
        const double determinant = glm::dot(ab, p);
        if (determinant == 0) return;
        const double u = glm::dot(from_a, p) / determinant;
        const glm::dvec3 q = glm::cross(from_a, ab);
        const double v = glm::dot(local.direction, q) / determinant;
        if (!(u >= 0 && v >= 0 && u + v <= 1)) return;
        const double t = glm::dot(ac, q) / determinant;
        if (!(t > from && t <= best.t)) return;
        if (t == best.t && std::tie(object, triangle) > std::tie(best.object, best.triangle)) return;
        best = {t, object, triangle, determinant > 0};
    });
}

}  // namespace sightline::tools
