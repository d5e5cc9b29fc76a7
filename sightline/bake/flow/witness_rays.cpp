// Follows a line through the portals of a graph, both ways from one of them.
// SPDX-License-Identifier: MIT
#include "sightline/bake/flow/witness_rays.h"

#include <cmath>

namespace sightline::bake {
namespace {

constexpr double kLeastSlope = 1e-5;

}  // namespace

WitnessRays::WitnessRays(const FlowPortals& directed)
    : directed_(directed), edges_(directed.points.size()), margin_(16 * directed.precision) {
    for (uint32_t p = 0; p < directed.size(); ++p) {
        const std::span<const glm::dvec3> outline = directed.outline(p);
        for (size_t i = 0; i < outline.size(); ++i) {
            const glm::dvec3 edge = outline[(i + 1) % outline.size()] - outline[i];
            const glm::dvec3 inward = glm::cross(directed.portals[p].normal, edge);
            const double length = glm::length(inward);
            // An edge without length leaves nothing inside: such a portal witnesses nothing.
            const glm::dvec3 unit = length > 0 ? inward / length : glm::dvec3(0);
            edges_[directed.portals[p].first + i] = glm::dvec4(unit, -glm::dot(unit, outline[i]) - margin_);
        }
    }
}

bool WitnessRays::passes(uint32_t portal, const glm::dvec3& at, const glm::dvec3& direction, double& along) const {
    const FlowPortal& next = directed_.portals[portal];
    const double speed = glm::dot(next.normal, direction);
    // Where a line that runs along the plane crosses it is not known well.
    if (!(speed > 0) || speed * speed < kLeastSlope * kLeastSlope * glm::dot(direction, direction)) return false;
    along = -next.height(at) / speed;
    const glm::dvec3 crossing = at + along * direction;
    if (glm::dot(crossing - next.center, crossing - next.center) > next.radius * next.radius) return false;
    for (uint32_t i = next.first; i < next.first + next.count; ++i)
        if (!(glm::dot(glm::dvec3(edges_[i]), crossing) + edges_[i].w >= 0)) return false;
    return true;
}

void WitnessRays::through(uint32_t portal, const glm::dvec3& at, const glm::dvec3& direction,
                          std::vector<uint32_t>& cells) const {
    cells.clear();
    double along;
    if (!passes(portal, at, direction, along)) return;
    walk(directed_.portals[portal].reverse, at, -direction, cells);
    walk(portal, at, direction, cells);
}

void WitnessRays::walk(uint32_t portal, const glm::dvec3& at, const glm::dvec3& direction,
                       std::vector<uint32_t>& cells) const {
    double before = 0;
    const double least = margin_ / glm::length(direction);
    // A line passes each plane once, so its way has no more steps than there are planes. It may meet a cell that is not
    // convex twice.
    for (uint32_t steps = 0; steps <= directed_.size(); ++steps) {
        const uint32_t cell = directed_.portals[portal].to;
        cells.push_back(cell);
        uint32_t next = directed_.size();
        double nearest = 0;
        for (uint32_t q = directed_.first_of_cell[cell]; q < directed_.first_of_cell[cell + 1]; ++q) {
            double along;
            if (!passes(q, at, direction, along) || along < before + least) continue;
            if (next == directed_.size() || along < nearest) {
                next = q;
                nearest = along;
            }
        }
        if (next == directed_.size()) return;
        portal = next;
        before = nearest;
    }
}

}  // namespace sightline::bake
