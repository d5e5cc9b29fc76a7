// Rooms for tests: opaque rectangles with rectangular holes, cells and portals, all carried through one transform.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/base/random.h"
#include "sightline/tools/scene/marked_cells.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::test {
using namespace tools;

struct FlatRect {
    glm::dvec2 min{0}, max{0};
};

/// The middle of an axis, in 0, 1, 2, and which way a wall on it looks.
struct MarkedRooms {
    Scene scene;
    glm::dmat4 place{1.0};

    MarkedRooms() { scene.materials.emplace_back(); }

    static glm::dvec3 at(int axis, double height, double u, double v) {
        glm::dvec3 point;
        point[axis] = height;
        point[(axis + 1) % 3] = u;
        point[(axis + 2) % 3] = v;
        return point;
    }

    /// A rectangle across an axis that looks along +axis (front 1) or -axis (-1), with holes that do not overlap. Of strips that
    /// share their corners.
    void wall(int axis, double height, const FlatRect& rect, int front, std::vector<FlatRect> holes = {},
              uint32_t material = 0) {
        Mesh mesh;
        std::vector<double> us{rect.min.x, rect.max.x}, vs{rect.min.y, rect.max.y};
        for (const FlatRect& hole : holes) {
            us.insert(us.end(), {hole.min.x, hole.max.x});
            vs.insert(vs.end(), {hole.min.y, hole.max.y});
        }
        for (auto* list : {&us, &vs}) {
            std::sort(list->begin(), list->end());
            list->erase(std::unique(list->begin(), list->end()), list->end());
        }
        for (const double u : us)
            for (const double v : vs) mesh.positions.emplace_back(at(axis, height, u, v));
        const auto number = [&](size_t i, size_t k) { return static_cast<uint32_t>(i * vs.size() + k); };
        for (size_t i = 0; i + 1 < us.size(); ++i)
            for (size_t k = 0; k + 1 < vs.size(); ++k) {
                const glm::dvec2 middle(0.5 * (us[i] + us[i + 1]), 0.5 * (vs[k] + vs[k + 1]));
                const bool open = std::any_of(holes.begin(), holes.end(), [&](const FlatRect& hole) {
                    return middle.x > hole.min.x && middle.x < hole.max.x && middle.y > hole.min.y &&
                           middle.y < hole.max.y;
                });
                if (open) continue;
                uint32_t a = number(i, k), b = number(i + 1, k), c = number(i + 1, k + 1), d = number(i, k + 1);
                if (front < 0) std::swap(b, d);
                mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
            }
        add(std::move(mesh), material);
    }

    /// The six walls of a box, looking inward, but those whose bits are set (1: -x, 2: +x, 4: -y, ...).
    void room(const Box3d& box, int without = 0) {
        for (int axis = 0; axis < 3; ++axis) {
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            const FlatRect rect{{box.min[u], box.min[v]}, {box.max[u], box.max[v]}};
            if (!(without >> (2 * axis) & 1)) wall(axis, box.min[axis], rect, 1);
            if (!(without >> (2 * axis + 1) & 1)) wall(axis, box.max[axis], rect, -1);
        }
    }

    void add(Mesh mesh, uint32_t material) {
        for (const glm::vec3& point : mesh.positions) mesh.bounds.grow(glm::dvec3(point));
        mesh.primitives.push_back({0, static_cast<uint32_t>(mesh.triangles()), material});
        SceneObject object;
        object.key = 100 + scene.objects.size();
        object.mesh = static_cast<uint32_t>(scene.meshes.size());
        object.transform = place;
        object.name = "object " + std::to_string(scene.objects.size());
        scene.meshes.push_back(std::move(mesh));
        scene.objects.push_back(std::move(object));
    }

    uint32_t cell(const std::string& name, const Box3d& box) {
        scene.cells.push_back(cellOfBox(name, box, place));
        return static_cast<uint32_t>(scene.cells.size() - 1);
    }

    /// From the cell below the rectangle, on the axis, to the one above it.
    uint32_t portal(uint32_t below, uint32_t above, int axis, double height, const FlatRect& rect) {
        ScenePortal portal;
        portal.name = "portal " + std::to_string(scene.portals.size());
        portal.cells[0] = above;
        portal.cells[1] = below;
        for (const glm::dvec3& corner :
             {at(axis, height, rect.min.x, rect.min.y), at(axis, height, rect.max.x, rect.min.y),
              at(axis, height, rect.max.x, rect.max.y), at(axis, height, rect.min.x, rect.max.y)})
            portal.polygon.emplace_back(place * glm::dvec4(corner, 1));
        scene.portals.push_back(std::move(portal));
        return static_cast<uint32_t>(scene.portals.size() - 1);
    }

    glm::dvec3 placed(const glm::dvec3& point) const { return glm::dvec3(place * glm::dvec4(point, 1)); }
};

inline glm::dmat4 randomPlace(Random& random, double far) {
    glm::dvec3 x, y;
    const auto direction = [&] {
        for (;;) {
            const glm::dvec3 v(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
            if (const double length = glm::length(v); length > 0.1 && length < 1) return v / length;
        }
    };
    x = direction();
    do y = direction();
    while (std::abs(glm::dot(x, y)) > 0.9);
    y = glm::normalize(y - glm::dot(x, y) * x);
    glm::dmat4 place(1.0);
    place[0] = glm::dvec4(x, 0);
    place[1] = glm::dvec4(y, 0);
    place[2] = glm::dvec4(glm::cross(x, y), 0);
    place[3] = glm::dvec4(far * direction(), 1);
    return place;
}

}  // namespace sightline::test
