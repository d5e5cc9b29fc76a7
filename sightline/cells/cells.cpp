// Cell graphs: planes of portals, and what may be wrong with them.
// SPDX-License-Identifier: MIT
#include "sightline/cells/cells.h"

#include <algorithm>
#include <cmath>

#include "sightline/base/assert.h"
#include "sightline/geom/outline_hull.h"

namespace sightline {
namespace {

/// Twice the area, as a vector along the normal: seen from its tip the outline runs counter-clockwise.
glm::dvec3 areaOf(std::span<const glm::dvec3> outline) {
    glm::dvec3 area(0);
    for (size_t i = 1; i + 1 < outline.size(); ++i)
        area += glm::cross(outline[i] - outline[0], outline[i + 1] - outline[0]);
    return area;
}

/// The area of the largest triangle with the first point and the one farthest from it.
glm::dvec3 largestTriangle(std::span<const glm::dvec3> outline) {
    glm::dvec3 far(0), best(0);
    for (const glm::dvec3& point : outline)
        if (glm::length(point - outline[0]) > glm::length(far)) far = point - outline[0];
    for (const glm::dvec3& point : outline)
        if (const glm::dvec3 area = glm::cross(far, point - outline[0]); glm::length(area) > glm::length(best))
            best = area;
    return best;
}

double heightOf(const glm::dvec4& plane, const glm::dvec3& point) {
    return glm::dot(glm::dvec3(plane), point) + plane.w;
}

/// How far the outline turns inward at a corner, at most; 0 of a convex one.
double concavityOf(std::span<const glm::dvec3> outline, const glm::dvec3& normal) {
    double worst = 0;
    for (size_t i = 0; i < outline.size(); ++i) {
        const glm::dvec3 edge = outline[(i + 1) % outline.size()] - outline[i];
        const double length = glm::length(edge);
        if (length == 0) continue;
        const glm::dvec3 inward = glm::cross(normal, edge) / length;
        for (const glm::dvec3& point : outline) worst = std::max(worst, -glm::dot(inward, point - outline[i]));
    }
    return worst;
}

}  // namespace

bool CellGraph::addPortal(uint32_t a, uint32_t b, std::span<const glm::dvec3> outline, uint32_t door) {
    const glm::dvec3 area = outline.size() < 3 ? glm::dvec3(0) : areaOf(outline);
    const double length = glm::length(area);
    if (length == 0)
        if (const glm::dvec3 across = largestTriangle(outline); glm::length(across) > 0) {
            std::vector<glm::dvec3> hull = outlineHull(outline, across);
            if (hull.size() < 3 || !(glm::length(areaOf(hull)) > 0)) return false;
            const bool added = addPortal(a, b, hull, door);
            std::reverse(hull.begin(), hull.end());
            return addPortal(a, b, hull, door) || added;
        }
    if (!(length > 0) || !std::isfinite(length)) return false;
    const glm::dvec3 normal = area / length;
    glm::dvec3 middle(0);
    for (const glm::dvec3& point : outline) middle += point - outline[0];
    middle = outline[0] + middle / static_cast<double>(outline.size());
    const glm::dvec4 plane(normal, -glm::dot(normal, middle));
    if (!std::isfinite(plane.w)) return false;
    addPortal(a, b, outline, plane);
    portals.back().door = door;
    return true;
}

void CellGraph::addPortal(uint32_t a, uint32_t b, std::span<const glm::dvec3> outline, const glm::dvec4& plane) {
    SIGHTLINE_DEBUG_ASSERT(outline.size() >= 3);
    CellPortal portal;
    portal.cells[0] = a;
    portal.cells[1] = b;
    portal.first = static_cast<uint32_t>(points.size());
    portal.count = static_cast<uint32_t>(outline.size());
    portal.plane = plane;
    for (const glm::dvec3& point : outline)
        portal.thickness = std::max(portal.thickness, std::abs(heightOf(plane, point)));
    points.insert(points.end(), outline.begin(), outline.end());
    portals.push_back(portal);
}

CellFaults checkCells(const CellGraph& graph, double tolerance) {
    CellFaults faults;
    std::vector<std::vector<uint32_t>> of_cell(graph.cells);
    for (uint32_t i = 0; i < graph.portals.size(); ++i) {
        const CellPortal& portal = graph.portals[i];
        SIGHTLINE_DEBUG_ASSERT(portal.cells[0] < graph.cells && portal.cells[1] < graph.cells);
        SIGHTLINE_DEBUG_ASSERT(size_t{portal.first} + portal.count <= graph.points.size());
        for (const uint32_t cell : portal.cells) of_cell[cell].push_back(i);
        faults.bent_portals += portal.thickness > tolerance;
        faults.worst_bend = std::max(faults.worst_bend, portal.thickness);
        faults.concave_portals += concavityOf(graph.outline(portal), glm::dvec3(portal.plane)) > tolerance;
    }
    for (uint32_t cell = 0; cell < graph.cells; ++cell) {
        double worst = 0;
        for (const uint32_t wall : of_cell[cell]) {
            const CellPortal& portal = graph.portals[wall];
            const double side = portal.cells[0] == cell ? 1 : -1;
            for (const uint32_t other : of_cell[cell])
                for (const glm::dvec3& point : graph.outline(graph.portals[other]))
                    worst = std::max(worst, -side * heightOf(portal.plane, point));
        }
        faults.concave_cells += worst > tolerance;
        if (worst > faults.worst_concavity) {
            faults.worst_concavity = worst;
            faults.worst_cell = cell;
        }
    }
    return faults;
}

}  // namespace sightline
