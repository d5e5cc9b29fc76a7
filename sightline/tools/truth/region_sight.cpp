// Rays from random points of a box: anywhere, and at random points of triangles.
// SPDX-License-Identifier: MIT
#include "sightline/tools/truth/region_sight.h"

#include <algorithm>
#include <limits>

namespace sightline::tools {
namespace {

glm::dvec3 pointIn(const Box3d& box, Random& random) {
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    return box.min + glm::dvec3(x, y, z) * box.size();
}

glm::dvec3 pointOn(const Mesh& mesh, const glm::dmat4& transform, Random& random) {
    const size_t triangle = random.below(mesh.triangles());
    double a = random.uniform(), b = random.uniform();
    if (a + b > 1) a = 1 - a, b = 1 - b;
    const auto corner = [&](size_t i) { return glm::dvec3(mesh.positions[mesh.indices[3 * triangle + i]]); };
    const glm::dvec3 local = corner(0) + a * (corner(1) - corner(0)) + b * (corner(2) - corner(0));
    return glm::dvec3(transform * glm::dvec4(local, 1));
}

}  // namespace

void RegionSight::look(const Box3d& box, std::span<const uint32_t> objects, const RegionRays& rays, Random& random,
                       std::vector<uint8_t>& seen) const {
    RaySighting sighting;
    const auto lookAlong = [&](const glm::dvec3& eye, const glm::dvec3& direction) {
        const double length = glm::length(direction);
        if (!(length > 0)) return;
        const SightRay ray{glm::dvec3(0.0), direction / length, 0, std::numeric_limits<double>::infinity()};
        rays_.look(ray, eye, sighting);
        if (sighting.object != RaySighting::kNone) seen[sighting.object] = 1;
        for (const RaySighting::Passed& passed : sighting.passed)
            if (sighting.object == RaySighting::kNone || passed.t < sighting.t) seen[passed.object] = 1;
    };
    const Box3d around{glm::dvec3(-1), glm::dvec3(1)};
    for (uint32_t ray = 0; ray < rays.around; ++ray) {
        const glm::dvec3 eye = pointIn(box, random);
        lookAlong(eye, pointIn(around, random));
    }
    for (const uint32_t object : objects) {
        const Mesh& mesh = facts_.mesh(object);
        if (mesh.triangles() == 0 || facts_.box(object).empty()) continue;
        for (uint32_t ray = 0; ray < rays.at_object && !seen[object]; ++ray) {
            const glm::dvec3 eye = pointIn(box, random);
            lookAlong(eye, pointOn(mesh, scene_.objects[object].transform, random) - eye);
        }
    }
}

BitMatrix seenOfRows(const Scene& scene, const LeafTree& tree, std::span<const uint32_t> object_of,
                     const BitMatrix& rows, const RowRaysSettings& settings) {
    const RegionSight sight(scene);
    const std::vector<Box3d> boxes = leafBoxes(tree);
    BitMatrix out(rows.rows(), rows.columns());
    const auto count = static_cast<uint32_t>(boxes.size());
    constexpr uint32_t kTogether = 64;  // cells between two questions whether to stop
    for (uint32_t begin = 0; begin < count && !(settings.stop && settings.stop()); begin += kTogether) {
        runJobs(settings.jobs, std::min(kTogether, count - begin), [&](uint32_t i) {
            const uint32_t leaf = begin + i;
            if (boxes[leaf].empty() || !boxes[leaf].finite()) return;
            std::vector<uint32_t> objects;
            for (uint32_t column = 0; column < rows.columns(); ++column)
                if (rows.at(leaf, column)) objects.push_back(object_of[column]);
            RegionRays rays{settings.rays / 2, 0};
            if (!objects.empty())
                rays.at_object = std::max(1u, (settings.rays - rays.around) / static_cast<uint32_t>(objects.size()));
            std::vector<uint8_t> seen(scene.objects.size(), 0);
            Random random(mixSeed(settings.seed, leaf));
            sight.look(boxes[leaf], objects, rays, random, seen);
            for (uint32_t column = 0; column < rows.columns(); ++column)
                if (rows.at(leaf, column) && seen[object_of[column]]) out.set(leaf, column);
        });
        if (settings.progress) settings.progress(std::min(1.0, double(begin + kTogether) / count));
    }
    return out;
}

}  // namespace sightline::tools
