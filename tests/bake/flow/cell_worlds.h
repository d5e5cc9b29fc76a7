// Graphs of cells to bake: rooms with doors, tubes of tilted portals, trees of random planes.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "sightline/base/random.h"
#include "sightline/cells/cells.h"

namespace sightline::test {

struct RoomSettings {
    int rooms[3] = {4, 4, 1};
    double doors = 0.75;   ///< share of the walls that have one
    bool upright = false;  ///< doors are as high as the rooms are, so that truth is that of the plan
    glm::dvec3 origin{0.0};
    double size = 1;  ///< of a room  [world units]
};

/// Rooms in a grid with a rectangular door, nowhere at a wall's end, in most walls. Rooms lie along x, y and z.
inline CellGraph gridOfRooms(uint64_t seed, const RoomSettings& settings) {
    Random random(seed);
    CellGraph graph;
    const int* n = settings.rooms;
    graph.cells = static_cast<uint32_t>(n[0] * n[1] * n[2]);
    const auto roomAt = [&](const int at[3]) { return static_cast<uint32_t>((at[2] * n[1] + at[1]) * n[0] + at[0]); };
    int at[3];
    for (at[2] = 0; at[2] < n[2]; ++at[2])
        for (at[1] = 0; at[1] < n[1]; ++at[1])
            for (at[0] = 0; at[0] < n[0]; ++at[0])
                for (int axis = 0; axis < 3; ++axis) {
                    if (at[axis] + 1 == n[axis] || random.uniform() >= settings.doors) continue;
                    const uint32_t behind = roomAt(at);
                    int next[3] = {at[0], at[1], at[2]};
                    ++next[axis];
                    glm::dvec3 low(at[0], at[1], at[2]), high = low;
                    low[axis] = high[axis] = next[axis];
                    for (int i = 0; i < 3; ++i) {
                        if (i == axis) continue;
                        double ends[2] = {random.uniform(0.03, 0.97), random.uniform(0.03, 0.97)};
                        if (ends[0] > ends[1]) std::swap(ends[0], ends[1]);
                        if (ends[1] - ends[0] < 0.02) ends[0] = 0.02, ends[1] = 0.98;
                        if (settings.upright && i == 2) ends[0] = 0, ends[1] = 1;
                        low[i] += ends[0];
                        high[i] = std::floor(high[i]) + ends[1];
                    }
                    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
                    std::vector<glm::dvec3> outline(4, low);  // about +axis: as seen from the next room
                    outline[1][u] = outline[2][u] = high[u];
                    outline[2][v] = outline[3][v] = high[v];
                    for (glm::dvec3& point : outline) point = settings.origin + settings.size * point;
                    graph.addPortal(roomAt(next), behind, outline);
                }
    return graph;
}

/// A convex polygon about a center, its corners on a circle.
inline std::vector<glm::dvec3> disc(Random& random, const glm::dvec3& center, const glm::dvec3& normal, double radius,
                                    uint32_t corners) {
    const glm::dvec3 helper = std::abs(normal.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 u = glm::normalize(glm::cross(normal, helper)), v = glm::cross(normal, u);
    std::vector<double> angles(corners);
    for (uint32_t i = 0; i < corners; ++i) angles[i] = 6.283185307179586 * (i + 0.8 * random.uniform()) / corners;
    std::vector<glm::dvec3> outline;
    for (const double angle : angles) outline.push_back(center + radius * (std::cos(angle) * u + std::sin(angle) * v));
    return outline;
}

/// Cells one after the other, joined by tilted polygons that lie along a way that bends.
inline CellGraph bentTube(uint64_t seed, uint32_t cells, double bend, uint32_t corners = 0) {
    Random random(seed);
    CellGraph graph;
    graph.cells = cells;
    glm::dvec3 at(0.0), way(1, 0, 0);
    for (uint32_t i = 0; i + 1 < cells; ++i) {
        const auto off = [&](double by) {
            const double x = random.uniform(-by, by), y = random.uniform(-by, by);
            return glm::dvec3(x, y, random.uniform(-by, by));
        };
        way = glm::normalize(way + off(bend));
        at += random.uniform(1, 2) * way + off(0.2);
        const glm::dvec3 normal = glm::normalize(way + off(0.4));
        const uint32_t count = corners ? corners : 3 + static_cast<uint32_t>(random.below(5));
        // Counter-clockwise about the normal, that points into the next one.
        graph.addPortal(i + 1, i, disc(random, at, normal, random.uniform(0.2, 0.7), count));
    }
    return graph;
}

/// No coordinate is larger.
inline double largestCoordinate(const CellGraph& graph) {
    double largest = 0;
    for (const glm::dvec3& point : graph.points)
        for (int i = 0; i < 3; ++i) largest = std::max(largest, std::abs(point[i]));
    return largest;
}

}  // namespace sightline::test
