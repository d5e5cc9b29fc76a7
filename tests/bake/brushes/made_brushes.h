// Maps of boxes and other brushes, made in place.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "sightline/bake/brushes/brush_role.h"
#include "sightline/base/random.h"
#include "sightline/math/box.h"
#include "sightline/tools/scene/quake_map.h"

namespace sightline::test {
using namespace tools;

/// Grows a map entity by entity: brushes go to the last one.
class BrushMaker {
public:
    QuakeMap map;

    BrushMaker() { entity({{"classname", "worldspawn"}}); }

    void entity(const std::vector<std::pair<std::string, std::string>>& pairs) {
        QuakeMapEntity entity{.first_pair = static_cast<uint32_t>(map.pairs.size()),
                              .pair_count = static_cast<uint32_t>(pairs.size()),
                              .first_brush = static_cast<uint32_t>(map.brushes.size())};
        for (const auto& [key, value] : pairs) map.pairs.push_back({key, value});
        map.entities.push_back(entity);
    }

    /// @param planes  facing out
    void brush(const std::vector<glm::dvec4>& planes, const std::string& texture = "brick") {
        map.textures.push_back(texture);
        QuakeMapBrush brush{.first_side = static_cast<uint32_t>(map.sides.size()),
                            .side_count = static_cast<uint32_t>(planes.size())};
        for (const glm::dvec4& plane : planes) {
            const glm::dvec3 n(plane), at = -plane.w * n;
            const glm::dvec3 helper = std::abs(n.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
            const glm::dvec3 u = 16.0 * glm::normalize(glm::cross(helper, n)), v = glm::cross(n, u);
            // cross(points[0] - points[1], points[2] - points[1]) points along n.
            map.sides.push_back({{at + u, at, at + v}, static_cast<uint32_t>(map.textures.size() - 1), 0, 0});
        }
        map.brushes.push_back(brush);
        ++map.entities.back().brush_count;
    }

    void box(const glm::dvec3& low, const glm::dvec3& high, const std::string& texture = "brick",
             const glm::dmat3& turn = glm::dmat3(1.0)) {
        std::vector<glm::dvec4> planes;
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 n(0.0);
            n[axis] = 1;
            planes.emplace_back(turn * n, -high[axis]);
            planes.emplace_back(-(turn * n), low[axis]);
        }
        brush(planes, texture);
    }

    /// Six walls around a box, turned about the origin; one may be left out.
    void room(const glm::dvec3& low, const glm::dvec3& high, double thick, int left_out = -1,
              const glm::dmat3& turn = glm::dmat3(1.0)) {
        for (int wall = 0; wall < 6; ++wall) {
            if (wall == left_out) continue;
            glm::dvec3 a = low - thick, b = high + thick;
            const int axis = wall / 2;
            if (wall % 2 == 0) b[axis] = low[axis];
            else a[axis] = high[axis];
            box(a, b, "brick", turn);
        }
    }
};

/// The role of one brush.
inline bake::BrushRole roleOf(const QuakeMap& map, const QuakeMapBrush& brush) {
    return bake::brushRoles(map).roles[static_cast<size_t>(&brush - map.brushes.data())];
}

/// How far inside of a brush a point is; below 0: outside. [world units]
inline double depthIn(const QuakeMap& map, const QuakeMapBrush& brush, const glm::dvec3& point) {
    double depth = 1e30;
    for (const QuakeMapSide& side : map.sidesOf(brush)) {
        const glm::dvec3 normal =
            glm::normalize(glm::cross(side.points[0] - side.points[1], side.points[2] - side.points[1]));
        depth = std::min(depth, -glm::dot(normal, point - side.points[1]));
    }
    return depth;
}

}  // namespace sightline::test
