// Seeded cameras that stand near surfaces and look at front faces, as a visitor would, and the rays that tell them where.
// SPDX-License-Identifier: MIT
#include "sightline/tools/load/seeded_cameras.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "sightline/base/random.h"
#include "sightline/math/curves.h"
#include "sightline/tools/scene/scene_core.h"

namespace sightline::tools {
namespace {

constexpr uint32_t kLeafSize = 4;
constexpr double kNever = std::numeric_limits<double>::infinity();

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

constexpr double kTan30 = 0.57735026918962576451;
constexpr double kAspect = 16.0 / 9.0;
constexpr int kRaysWide = 8, kRaysHigh = 4, kRays = kRaysWide * kRaysHigh;
constexpr int kFirmTries = 64;   // tries that insist on most rays
constexpr int kMostTries = 192;  // then the wish fades, down to nothing here

/// Running sums for choosing in proportion to weights.
struct Wheel {
    std::vector<double> sums;

    void add(double weight) { sums.push_back((sums.empty() ? 0 : sums.back()) + weight); }
    double total() const { return sums.empty() ? 0 : sums.back(); }
    uint32_t choose(Random& random) const {
        const double at = random.uniform() * total();
        const auto found = static_cast<size_t>(std::upper_bound(sums.begin(), sums.end(), at) - sums.begin());
        return static_cast<uint32_t>(std::min(found, sums.size() - 1));
    }
};

/// What a linear map does to normals times areas.
glm::dmat3 cofactors(const glm::dmat3& m) {
    return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

/// The Frobenius norm: no vector grows by more.
double norm(const glm::dmat3& m) {
    return std::sqrt(glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2]));
}

struct SurfacePoint {
    glm::dvec3 position, normal;
};

/// Points on all drawn triangles by their area in the world, without visiting every instance's triangles: an
/// instance is chosen by a bound on its area (the mesh's own times the norm of the cofactors) and the triangle by its
/// own area; the choice stands with the probability of the true area within the bound.
class Surface {
public:
    Surface(const Scene& scene, const SceneCore& core) : scene_(scene), triangles_(scene.meshes.size()) {
        for (uint32_t i = 0; i < scene.objects.size(); ++i) {
            const SceneObject& object = scene.objects[i];
            const bool aside = std::binary_search(core.aside.begin(), core.aside.end(), i);
            const Wheel& mesh = aside ? wheelWithin(core.bounds, i) : meshWheel(object.mesh);
            const double weight = norm(cofactors(glm::dmat3(object.transform))) * mesh.total();
            objects_.add(std::isfinite(weight) ? weight : 0);
        }
    }

    bool empty() const { return !(objects_.total() > 0) || !std::isfinite(objects_.total()); }

    SurfacePoint choose(Random& random) const {
        for (int tries = 0;; ++tries) {
            const auto number = static_cast<uint32_t>(objects_.choose(random));
            const SceneObject& object = scene_.objects[number];
            const Mesh& mesh = scene_.meshes[object.mesh];
            const auto part = parts_.find(number);
            const uint32_t triangle = (part == parts_.end() ? triangles_[object.mesh] : part->second).choose(random);
            const double chance = random.uniform();
            double u = random.uniform();
            double v = random.uniform();
            if (u + v > 1) {
                u = 1 - u;
                v = 1 - v;
            }
            const auto corner = [&](uint32_t k) { return glm::dvec3(mesh.positions[mesh.indices[3 * triangle + k]]); };
            const glm::dvec3 a = corner(0), ab = corner(1) - a, ac = corner(2) - a, normal = glm::cross(ab, ac);
            const glm::dmat3 linear(object.transform), map = cofactors(linear);
            const glm::dvec3 mapped = map * normal;
            const double length = glm::length(mapped);
            // A transform that flattens all its triangles would be refused for ever.
            if (chance * norm(map) * glm::length(normal) > length && tries < 1000) continue;
            if (!(length > 0)) return {glm::dvec3(object.transform * glm::dvec4(a, 1)), {0, 1, 0}};
            const double side = glm::determinant(linear) < 0 ? -1 : 1;
            return {glm::dvec3(object.transform * glm::dvec4(a + u * ab + v * ac, 1)), mapped * (side / length)};
        }
    }

private:
    const Wheel& meshWheel(uint32_t index) {
        Wheel& wheel = triangles_[index];
        const Mesh& mesh = scene_.meshes[index];
        if (!wheel.sums.empty() || mesh.triangles() == 0) return wheel;
        wheel.sums.reserve(mesh.triangles());
        for (size_t i = 0; i < mesh.indices.size(); i += 3) {
            const auto corner = [&](size_t k) { return glm::dvec3(mesh.positions[mesh.indices[i + k]]); };
            const glm::dvec3 a = corner(0);
            wheel.add(glm::length(glm::cross(corner(1) - a, corner(2) - a)));
        }
        return wheel;
    }

    /// Of an object that reaches beyond a box: its triangles there have no weight.
    const Wheel& wheelWithin(const Box3d& box, uint32_t number) {
        const SceneObject& object = scene_.objects[number];
        const Mesh& mesh = scene_.meshes[object.mesh];
        Wheel& wheel = parts_[number];
        for (size_t i = 0; i < mesh.indices.size(); i += 3) {
            Box3d own;
            glm::dvec3 corners[3];
            for (size_t k = 0; k < 3; ++k) {
                corners[k] = glm::dvec3(mesh.positions[mesh.indices[i + k]]);
                own.grow(glm::dvec3(object.transform * glm::dvec4(corners[k], 1.0)));
            }
            wheel.add(box.holds(own) ? glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0])) : 0);
        }
        return wheel;
    }

    const Scene& scene_;
    std::vector<Wheel> triangles_;               ///< by mesh
    std::unordered_map<uint32_t, Wheel> parts_;  ///< by object: of those that reach beyond the core
    Wheel objects_;
};

/// Anywhere around, and at most 30 degrees up or down.
glm::dvec3 drawDirection(Random& random) {
    double x = 0, z = 0, length2 = 0;
    do {
        x = random.uniform(-1, 1);
        z = random.uniform(-1, 1);
        length2 = x * x + z * z;
    } while (!(length2 > 1e-4 && length2 <= 1));
    const double rise = random.uniform(-0.5, 0.5);
    const double flat = std::sqrt((1 - rise * rise) / length2);
    return {x * flat, rise, z * flat};
}

/// How many of the rays through the image meet a front face, or either face of a double-sided one, farther away
/// than `nearest`.
int goodRays(const Scene& scene, const RayProbe& probe, const glm::dvec3& eye, const glm::dvec3& direction,
             double nearest) {
    const glm::dvec3 flat(-direction.z, 0, direction.x), right = flat / glm::length(flat);
    const glm::dvec3 up = glm::cross(right, direction);
    int good = 0;
    for (int i = 0; i < kRays; ++i) {
        const double x = ((i % kRaysWide + 0.5) / kRaysWide * 2 - 1) * kTan30 * kAspect;
        const double y = (static_cast<double>(i / kRaysWide) + 0.5) / kRaysHigh * 2 * kTan30 - kTan30;
        const glm::dvec3 aim = direction + right * x + up * y;
        const std::optional<ProbeHit> hit = probe.nearest({eye, aim / glm::length(aim)});
        if (!hit || !(hit->t > nearest)) continue;
        const Mesh& mesh = scene.meshes[scene.objects[hit->object].mesh];
        const auto primitive = std::find_if(mesh.primitives.begin(), mesh.primitives.end(), [&](const Primitive& p) {
            return hit->triangle - p.first_triangle < p.triangle_count;
        });
        const bool both = primitive != mesh.primitives.end() && scene.materials[primitive->material].double_sided;
        if (hit->front || both) ++good;
    }
    return good;
}

/// How many good rays a camera must have at its n-th try.
int wishedRays(int tries) {
    const int most = kRays / 2 + 1;
    if (tries < kFirmTries) return most;
    return std::max(0, most - most * (tries - kFirmTries) / (kMostTries - kFirmTries));
}

CameraFrame frameAt(const glm::dvec3& eye, const glm::dvec3& direction, double near) {
    CameraFrame frame;
    frame.eye = eye;
    frame.target = eye + direction * std::max(1.0, 100 * near);
    frame.z_near = near;
    return frame;
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

std::optional<ProbeHit> RayProbe::nearest(const ProbeRay& ray, double from, const Counts& counts) const {
    if (scene_->objects.empty()) return std::nullopt;
    ProbeHit best;
    walk(*objects_, ray, best.t, [&](uint32_t object) { meet(object, ray, from, counts, best); });
    if (best.t == kNever) return std::nullopt;
    return best;
}

glm::dvec3 RayProbe::normal(const ProbeHit& hit) const {
    const SceneObject& object = scene_->objects[hit.object];
    const Mesh& mesh = scene_->meshes[object.mesh];
    const auto corner = [&](uint32_t k) { return glm::dvec3(mesh.positions[mesh.indices[3 * hit.triangle + k]]); };
    const glm::dvec3 a = corner(0);
    const glm::dmat3 linear(object.transform);
    const glm::dvec3 mapped = cofactors(linear) * glm::cross(corner(1) - a, corner(2) - a);
    const double length = glm::length(mapped);
    return length > 0 ? mapped * ((glm::determinant(linear) < 0 ? -1 : 1) / length) : glm::dvec3(0);
}

void RayProbe::meet(uint32_t object, const ProbeRay& ray, double from, const Counts& counts, ProbeHit& best) const {
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
        const ProbeHit hit{t, object, triangle, determinant > 0};
        if (!counts || counts(hit)) best = hit;
    });
}

CameraPath seededCameras(const Scene& scene, uint32_t count, uint64_t seed) {
    CameraPath path;
    path.frames.reserve(count);
    const SceneCore core = coreOf(scene);
    const Surface surface(scene, core);
    const double diagonal = core.diagonal();
    if (surface.empty() || !(diagonal > 0)) {
        for (uint32_t i = 0; i < count; ++i) {
            Random random(mixSeed(seed, i));
            const glm::dvec3 direction = drawDirection(random);
            path.frames.push_back(frameAt(-direction, direction, 0.1));
        }
        return path;
    }
    const RayProbe probe(scene);
    const double near = std::min(0.0005 * diagonal, 0.1);
    for (uint32_t i = 0; i < count; ++i) {
        Random random(mixSeed(seed, i));
        for (int tries = 0;; ++tries) {
            const SurfacePoint point = surface.choose(random);
            const double distance = random.uniform(0.003, 0.06) * diagonal;
            const glm::dvec3 eye = point.position + point.normal * distance;
            const glm::dvec3 direction = drawDirection(random);
            const int wished = wishedRays(tries);
            if (wished > 0 && goodRays(scene, probe, eye, direction, 0.002 * diagonal) < wished) continue;
            path.frames.push_back(frameAt(eye, direction, near));
            break;
        }
    }
    return path;
}

}  // namespace sightline::tools
