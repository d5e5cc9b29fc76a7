// The solids that procedural scenes are built from: boxes, prisms, walls with recesses, turned shapes.
// SPDX-License-Identifier: MIT
//
// Gary Meisters. Polygons Have Ears. 1975.
#include "sightline/tools/scene/solids.h"

#include <cmath>
#include <utility>

#include "sightline/base/assert.h"

namespace sightline::tools::city {
namespace {

constexpr double kSill = 0.75, kLintel = 1.25;  // left open under and over a pane  [metres]

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

/// A corner of a body's plan, and the material of the face that follows it.
struct PlanCorner {
    glm::dvec2 at;
    uint32_t material;
};

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
        mesh.primitives.push_back(
            {static_cast<uint32_t>(mesh.triangles()), static_cast<uint32_t>(list.size() / 3), material});
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

Frame fifthFrame(int fifth) {
    constexpr double kCos[] = {1, 0.30901699437494742, -0.80901699437494742, -0.80901699437494742, 0.30901699437494742};
    constexpr double kSin[] = {0, 0.95105651629515357, 0.58778525229247313, -0.58778525229247313, -0.95105651629515357};
    const glm::dvec3 outward(kCos[fifth], 0, kSin[fifth]), up(0, 1, 0);
    return {{0, 0, 0}, outward, up, glm::cross(outward, up)};
}

std::vector<glm::dvec2> regularPolygon(int sides) {
    constexpr double kHalfRoot2 = 0.70710678118654752440, kHalfRoot3 = 0.86602540378443864676;
    constexpr double kCos22 = 0.92387953251128675613, kSin22 = 0.38268343236508977173;
    if (sides == 3) return {{1, 0}, {-0.5, kHalfRoot3}, {-0.5, -kHalfRoot3}};
    if (sides == 4)
        return {
            {kHalfRoot2, kHalfRoot2}, {-kHalfRoot2, kHalfRoot2}, {-kHalfRoot2, -kHalfRoot2}, {kHalfRoot2, -kHalfRoot2}};
    if (sides == 6)
        return {{1, 0}, {0.5, kHalfRoot3}, {-0.5, kHalfRoot3}, {-1, 0}, {-0.5, -kHalfRoot3}, {0.5, -kHalfRoot3}};
    if (sides == 12)
        return {{1, 0},  {kHalfRoot3, 0.5},   {0.5, kHalfRoot3},   {0, 1},  {-0.5, kHalfRoot3}, {-kHalfRoot3, 0.5},
                {-1, 0}, {-kHalfRoot3, -0.5}, {-0.5, -kHalfRoot3}, {0, -1}, {0.5, -kHalfRoot3}, {kHalfRoot3, -0.5}};
    if (sides == 16)
        return {{1, 0},  {kCos22, kSin22},   {kHalfRoot2, kHalfRoot2},   {kSin22, kCos22},
                {0, 1},  {-kSin22, kCos22},  {-kHalfRoot2, kHalfRoot2},  {-kCos22, kSin22},
                {-1, 0}, {-kCos22, -kSin22}, {-kHalfRoot2, -kHalfRoot2}, {-kSin22, -kCos22},
                {0, -1}, {kSin22, -kCos22},  {kHalfRoot2, -kHalfRoot2},  {kCos22, -kSin22}};
    return {{1, 0},  {kHalfRoot2, kHalfRoot2},   {0, 1},  {-kHalfRoot2, kHalfRoot2},
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

void addBody(MeshBuilder& mesh, const BodyMaterials& materials, const std::vector<glm::dvec2>& outline, double foot,
             double eaves, const std::vector<Wall>& walls) {
    SIGHTLINE_ASSERT(walls.size() == outline.size() && foot < eaves);
    const auto stand = [](const glm::dvec2& at, double y) { return glm::dvec3(at.x, y, at.y); };
    std::vector<PlanCorner> plan;
    for (size_t i = 0; i < outline.size(); ++i) {
        const Wall& wall = walls[i];
        const glm::dvec2 &a = outline[i], &b = outline[(i + 1) % outline.size()];
        const double length = glm::length(b - a);
        const glm::dvec2 direction = (b - a) / length, inward(direction.y, -direction.x);
        plan.push_back({a, materials.wall});
        const double width = wall.bays > 0 ? (length - (wall.bays + 1) * wall.pier) / wall.bays : 1;
        SIGHTLINE_ASSERT(width > 0);
        for (int bay = 0; bay < wall.bays; ++bay) {
            const glm::dvec2 start = a + direction * (wall.pier + bay * (width + wall.pier));
            const glm::dvec2 end = start + direction * width, set_back = inward * (0.5 * wall.depth);
            plan.push_back({start, materials.bay});
            plan.push_back({start + inward * wall.depth, materials.bay});
            plan.push_back({end + inward * wall.depth, materials.bay});
            plan.push_back({end, materials.wall});
            if (!wall.glazed || wall.depth <= 0) continue;
            const double low = foot + kSill, high = eaves - kLintel;
            mesh.quad(materials.glass, stand(start + set_back, low), stand(end + set_back, low),
                      stand(end + set_back, high), stand(start + set_back, high));
        }
    }
    std::vector<glm::dvec2> rim;  // (z, x)
    for (size_t i = 0; i < plan.size(); ++i) {
        const glm::dvec2 &p = plan[i].at, &q = plan[(i + 1) % plan.size()].at;
        rim.push_back({p.y, p.x});
        mesh.quad(plan[i].material, stand(p, foot), stand(q, foot), stand(q, eaves), stand(p, eaves));
    }
    for (const auto& [a, b, c] : triangulate(rim)) {
        const glm::dvec2 &p = plan[a].at, &q = plan[b].at, &r = plan[c].at;
        mesh.triangle(materials.roof, stand(p, eaves), stand(q, eaves), stand(r, eaves));
        mesh.triangle(materials.wall, stand(p, foot), stand(r, foot), stand(q, foot));
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
        triangles.push_back({rest[(best + rest.size() - 1) % rest.size()], rest[best], rest[(best + 1) % rest.size()]});
        rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(best));
    }
    return triangles;
}

}  // namespace sightline::tools::city
