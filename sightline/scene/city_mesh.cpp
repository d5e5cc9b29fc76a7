// The solids that the procedural city is built from: boxes, prisms, walls with recesses, turned shapes.
// SPDX-License-Identifier: MIT
//
// Gary Meisters. Polygons Have Ears. 1975.
#include "sightline/scene/city_mesh.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sightline/base/assert.h"

namespace sightline::city {
namespace {

constexpr double kTransom = 0.25;  // half the height left open between panes  [metres]
constexpr int kMostPanes = 4;     // in a bay

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

/// Twice the signed area of a triangle.
double area(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) { return cross(b - a, c - a); }

/// True if p lies in the closed triangle and is none of its corners.
bool blocks(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    if (p == a || p == b || p == c) return false;
    return area(a, b, p) >= 0 && area(b, c, p) >= 0 && area(c, a, p) >= 0;
}

glm::dvec3 place(const Frame& frame, const glm::dvec2& point, double along) {
    return frame.origin + frame.u * point.x + frame.v * point.y + frame.w * along;
}

/// The positions along a wall of the given length where bays begin and end.
std::vector<double> bayCuts(const Wall& wall, double length) {
    std::vector<double> cuts{0};
    if (wall.bays > 0) {
        const double width = (length - (wall.bays + 1) * wall.pier) / wall.bays;
        SIGHTLINE_ASSERT(width > 0);
        for (int bay = 0; bay < wall.bays; ++bay) {
            const double start = wall.pier + bay * (width + wall.pier);
            cuts.push_back(start);
            cuts.push_back(start + width);
        }
    }
    cuts.push_back(length);
    return cuts;
}

/// A niche (or, with negative depth, an oriel) in the cell a b c d of a wall with outward normal n.
void addBay(MeshBuilder& mesh, const BodyMaterials& materials, const std::array<glm::dvec3, 4>& cell,
            const glm::dvec3& normal, const Wall& wall) {
    std::array<glm::dvec3, 4> inner = cell;
    for (glm::dvec3& corner : inner) corner -= normal * wall.depth;
    for (int i = 0; i < 4; ++i) {
        const int next = (i + 1) % 4;
        mesh.quad(materials.bay, cell[i], cell[next], inner[next], inner[i]);
    }
    mesh.quad(materials.bay, inner[0], inner[1], inner[2], inner[3]);
    if (!wall.glazed || wall.depth <= 0) return;
    const double height = cell[3].y - cell[0].y;
    const int panes = std::clamp(static_cast<int>(height / kStorey + 0.5), 1, kMostPanes);
    const glm::dvec3 set_back = normal * (0.5 * wall.depth);
    for (int pane = 0; pane < panes; ++pane) {
        const double low = height * pane / panes + kTransom, high = height * (pane + 1) / panes - kTransom;
        const auto at = [&](int corner, double y) { return cell[corner] - set_back + glm::dvec3(0, y, 0); };
        mesh.quad(materials.glass, at(0, low), at(1, low), at(1, high), at(0, high));
    }
}

}  // namespace

uint32_t MeshBuilder::vertex(const glm::dvec3& position) {
    std::array<float, 3> key;
    for (int axis = 0; axis < 3; ++axis)
        key[axis] = static_cast<float>(std::nearbyint(position[axis] * 1024.0) / 1024.0 + 0.0);
    const auto [entry, added] = numbers_.try_emplace(key, static_cast<uint32_t>(positions_.size()));
    if (added) positions_.push_back({key[0], key[1], key[2]});
    return entry->second;
}

void MeshBuilder::triangle(uint32_t material, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    std::vector<uint32_t>& list = indices_[material];
    for (const glm::dvec3* corner : {&a, &b, &c}) list.push_back(vertex(*corner));
}

void MeshBuilder::quad(uint32_t material, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                       const glm::dvec3& d) {
    triangle(material, a, b, c);
    triangle(material, a, c, d);
}

Mesh MeshBuilder::finish(std::string name) const {
    Mesh mesh;
    mesh.name = std::move(name);
    mesh.positions = positions_;
    for (const auto& [material, list] : indices_) {
        mesh.primitives.push_back({static_cast<uint32_t>(mesh.triangles()), static_cast<uint32_t>(list.size() / 3),
                                   material});
        mesh.indices.insert(mesh.indices.end(), list.begin(), list.end());
    }
    for (const glm::vec3& position : mesh.positions) mesh.bounds.grow(glm::dvec3(position));
    return mesh;
}

void addBox(MeshBuilder& mesh, uint32_t material, const glm::dvec3& min, const glm::dvec3& max) {
    addPrism(mesh, material, kUpright, {{min.z, min.x}, {max.z, min.x}, {max.z, max.x}, {min.z, max.x}}, min.y, max.y);
}

void addPrism(MeshBuilder& mesh, uint32_t material, const Frame& frame, const std::vector<glm::dvec2>& outline,
              double low, double high) {
    const size_t count = outline.size();
    for (size_t i = 0; i < count; ++i) {
        const glm::dvec2 &a = outline[i], &b = outline[(i + 1) % count];
        mesh.quad(material, place(frame, a, low), place(frame, b, low), place(frame, b, high), place(frame, a, high));
    }
    for (const auto& [a, b, c] : triangulate(outline)) {
        mesh.triangle(material, place(frame, outline[a], high), place(frame, outline[b], high),
                      place(frame, outline[c], high));
        mesh.triangle(material, place(frame, outline[a], low), place(frame, outline[c], low),
                      place(frame, outline[b], low));
    }
}

std::vector<glm::dvec2> regularPolygon(int sides) {
    constexpr double kHalfRoot2 = 0.70710678118654752440, kHalfRoot3 = 0.86602540378443864676;
    if (sides == 6)
        return {{1, 0}, {0.5, kHalfRoot3}, {-0.5, kHalfRoot3}, {-1, 0}, {-0.5, -kHalfRoot3}, {0.5, -kHalfRoot3}};
    return {{1, 0}, {kHalfRoot2, kHalfRoot2}, {0, 1}, {-kHalfRoot2, kHalfRoot2},
            {-1, 0}, {-kHalfRoot2, -kHalfRoot2}, {0, -1}, {kHalfRoot2, -kHalfRoot2}};
}

void addTurned(MeshBuilder& mesh, uint32_t material, const glm::dvec3& center, int sides,
               const std::vector<Ring>& rings) {
    const std::vector<glm::dvec2> circle = regularPolygon(sides);
    const auto point = [&](const Ring& ring, int side) {
        const glm::dvec2& c = circle[side % sides];
        return center + glm::dvec3(ring.radius * c.y, ring.y, ring.radius * c.x);
    };
    for (size_t r = 0; r + 1 < rings.size(); ++r) {
        const Ring &below = rings[r], &above = rings[r + 1];
        for (int i = 0; i < sides; ++i) {
            if (below.radius > 0) mesh.triangle(material, point(below, i), point(below, i + 1), point(above, i + 1));
            if (above.radius > 0) mesh.triangle(material, point(below, i), point(above, i + 1), point(above, i));
        }
    }
    const Ring &bottom = rings.front(), &top = rings.back();
    for (int i = 1; i + 1 < sides; ++i) {
        if (bottom.radius > 0) mesh.triangle(material, point(bottom, 0), point(bottom, i + 1), point(bottom, i));
        if (top.radius > 0) mesh.triangle(material, point(top, 0), point(top, i), point(top, i + 1));
    }
}

void addBody(MeshBuilder& mesh, const BodyMaterials& materials, const std::vector<glm::dvec2>& outline,
             const std::vector<double>& levels, const std::vector<Wall>& walls) {
    SIGHTLINE_ASSERT(levels.size() >= 2 && levels.size() % 2 == 0 && walls.size() == outline.size());
    std::vector<glm::dvec2> rim;  // (z, x): all the vertices along the foot and the eaves
    for (size_t i = 0; i < outline.size(); ++i) {
        const glm::dvec2 &a = outline[i], &b = outline[(i + 1) % outline.size()];
        const double length = glm::length(b - a);
        const glm::dvec2 direction = (b - a) / length;
        const glm::dvec3 normal(-direction.y, 0, direction.x);
        const std::vector<double> cuts = bayCuts(walls[i], length);
        const auto corner = [&](size_t column, size_t level) {
            // The last corner is the next wall's first, bit for bit.
            const glm::dvec2 at = column + 1 == cuts.size() ? b : a + direction * cuts[column];
            return glm::dvec3(at.x, levels[level], at.y);
        };
        for (size_t column = 0; column + 1 < cuts.size(); ++column) {
            const glm::dvec3 foot = corner(column, 0);
            rim.push_back({foot.z, foot.x});
            for (size_t level = 0; level + 1 < levels.size(); ++level) {
                const std::array<glm::dvec3, 4> cell{corner(column, level), corner(column + 1, level),
                                                     corner(column + 1, level + 1), corner(column, level + 1)};
                if (column % 2 == 1 && level % 2 == 1) addBay(mesh, materials, cell, normal, walls[i]);
                else mesh.quad(materials.wall, cell[0], cell[1], cell[2], cell[3]);
            }
        }
    }
    const double foot = levels.front(), eaves = levels.back();
    for (const auto& [a, b, c] : triangulate(rim)) {
        const glm::dvec2 &p = rim[a], &q = rim[b], &r = rim[c];
        mesh.triangle(materials.roof, {p.y, eaves, p.x}, {q.y, eaves, q.x}, {r.y, eaves, r.x});
        mesh.triangle(materials.wall, {p.y, foot, p.x}, {r.y, foot, r.x}, {q.y, foot, q.x});
    }
}

std::vector<std::array<uint32_t, 3>> triangulate(const std::vector<glm::dvec2>& outline) {
    std::vector<std::array<uint32_t, 3>> triangles;
    std::vector<uint32_t> rest(outline.size());
    for (uint32_t i = 0; i < rest.size(); ++i) rest[i] = i;
    while (rest.size() >= 3) {
        // Of all ears the one with the shortest cut: slivers stay few, and the result is unique.
        size_t best = rest.size();
        double best_length = 0;
        for (size_t i = 0; i < rest.size(); ++i) {
            const uint32_t before = rest[(i + rest.size() - 1) % rest.size()], after = rest[(i + 1) % rest.size()];
            const glm::dvec2 &a = outline[before], &b = outline[rest[i]], &c = outline[after];
            if (!(area(a, b, c) > 1e-9)) continue;
            const glm::dvec2 cut = c - a;
            const double length = glm::dot(cut, cut);
            if (best < rest.size() && length >= best_length) continue;
            bool ear = true;
            for (const uint32_t other : rest) ear = ear && !blocks(outline[other], a, b, c);
            if (!ear) continue;
            best = i;
            best_length = length;
        }
        SIGHTLINE_ASSERT(best < rest.size());  // a simple polygon has an ear
        triangles.push_back({rest[(best + rest.size() - 1) % rest.size()], rest[best],
                             rest[(best + 1) % rest.size()]});
        rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(best));
    }
    return triangles;
}

}  // namespace sightline::city
