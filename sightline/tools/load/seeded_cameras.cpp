// Seeded cameras that stand near surfaces and look at front faces, as a visitor would.
// SPDX-License-Identifier: MIT
#include "sightline/tools/load/seeded_cameras.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "sightline/base/random.h"
#include "sightline/tools/load/ray_probe.h"

namespace sightline::tools {
namespace {

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
    explicit Surface(const Scene& scene) : scene_(scene), triangles_(scene.meshes.size()) {
        for (const SceneObject& object : scene.objects) {
            const Wheel& mesh = meshWheel(object.mesh);
            const double weight = norm(cofactors(glm::dmat3(object.transform))) * mesh.total();
            objects_.add(std::isfinite(weight) ? weight : 0);
        }
    }

    bool empty() const { return !(objects_.total() > 0) || !std::isfinite(objects_.total()); }

    SurfacePoint choose(Random& random) const {
        for (int tries = 0;; ++tries) {
            const SceneObject& object = scene_.objects[objects_.choose(random)];
            const Mesh& mesh = scene_.meshes[object.mesh];
            const uint32_t triangle = triangles_[object.mesh].choose(random);
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

    const Scene& scene_;
    std::vector<Wheel> triangles_;  ///< by mesh
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

CameraPath seededCameras(const Scene& scene, uint32_t count, uint64_t seed) {
    CameraPath path;
    path.frames.reserve(count);
    const Surface surface(scene);
    const Box3d bounds = worldBounds(scene);
    const double diagonal = bounds.finite() ? glm::length(bounds.size()) : 0;
    if (surface.empty() || !(diagonal > 0) || !std::isfinite(diagonal)) {
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

Result<CameraPath> choosePath(const Scene& scene, const PathChoice& choice) {
    if (!choice.file.empty()) return readCameraPath(choice.file);
    if (choice.frames > 0) return seededCameras(scene, choice.frames, choice.seed);
    if (!scene.cameras.empty()) return sceneCameras(scene);
    return seededCameras(scene, 16, choice.seed);
}

}  // namespace sightline::tools
