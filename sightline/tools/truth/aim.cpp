// Where to aim: points on culled objects that would be seen first if one of them was culled wrongly.
// SPDX-License-Identifier: MIT
#include "sightline/tools/truth/aim.h"

#include <algorithm>
#include <cmath>

namespace sightline::tools {
namespace {

constexpr uint64_t kFewestRays = 4;
constexpr int kTries = 12;

/// Proportional to the width in the image; a box that holds the eye is as wide as any.
double apparentWidth(const Box3d& box, const SightLines& sight) {
    const double size = glm::length(box.size());
    if (sight.orthographic()) return size;
    const glm::dvec3 nearest = glm::clamp(sight.eye(), box.min, box.max);
    const double distance = glm::length(nearest - sight.eye());
    return size < distance ? size / distance : 1.0;
}

uint32_t pickTriangle(const MeshFacts& facts, Random& random) {
    const uint64_t count = facts.area_sum.size();
    if (random.below(2) == 0) return static_cast<uint32_t>(random.below(count));
    const double place = random.uniform() * facts.area_sum.back();
    const auto found = std::upper_bound(facts.area_sum.begin(), facts.area_sum.end(), place);
    return static_cast<uint32_t>(std::min<uint64_t>(found - facts.area_sum.begin(), count - 1));
}

glm::dvec3 pickPoint(const glm::dvec3 (&corners)[3], Random& random) {
    const uint64_t kind = random.below(4), corner = random.below(3);
    if (kind == 0) return corners[corner];
    double u = random.uniform(), v = random.uniform();
    if (kind == 1) return corners[corner] + u * (corners[(corner + 1) % 3] - corners[corner]);
    if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
    }
    return corners[0] + u * (corners[1] - corners[0]) + v * (corners[2] - corners[0]);
}

}  // namespace

std::vector<Aim> chooseAims(const SceneFacts& facts, const SightLines& sight, std::span<const uint8_t> culled,
                            uint64_t budget) {
    struct Candidate {
        double width = 0;
        uint32_t object = 0;
    };
    std::vector<Candidate> candidates;
    facts.objects().walk([&](const Box3d& box) { return sight.touches(box); },
                         [&](uint32_t object) {
                             if (culled[object] && sight.touches(facts.box(object)))
                                 candidates.push_back({apparentWidth(facts.box(object), sight), object});
                         });
    std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
        return a.width > b.width || (a.width == b.width && a.object < b.object);
    });
    const uint64_t count = std::min<uint64_t>(candidates.size(), budget / (2 * kFewestRays));
    if (count == 0) return {};
    candidates.resize(count);
    double total = 0;
    for (const Candidate& candidate : candidates) total += candidate.width;
    const uint64_t evenly = budget / 2 / count;
    std::vector<Aim> aims;
    for (const Candidate& candidate : candidates) {
        const double share = total > 0 ? candidate.width / total : 0.0;
        const uint64_t rays = evenly + static_cast<uint64_t>(share * static_cast<double>(budget / 2));
        aims.push_back({candidate.object, static_cast<uint32_t>(rays)});
    }
    return aims;
}

bool aimAt(const SceneFacts& facts, const SightLines& sight, const ExactSight& exact, uint32_t object, Random& random,
           Target& target) {
    const MeshFacts& mesh = facts.facts(object);
    for (int i = 0; i < kTries; ++i) {
        target.triangle = pickTriangle(mesh, random);
        glm::dvec3 corners[3];
        exact.corners(object, target.triangle, corners);
        target.point = pickPoint(corners, random);
        if (!sight.project(target.point, target.place)) continue;
        if (mesh.double_sided[target.triangle]) return true;
        const glm::dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
        if (glm::dot(normal, sight.rayThrough(target.place).direction) < 0) return true;
    }
    return false;
}

}  // namespace sightline::tools
