// A procedural building is closed, furnished within its rooms, and its cells meet through its portals alone.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/building/building.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "sightline/base/random.h"
#include "sightline/tools/scene/building/library.h"
#include "sightline/tools/scene/building/plan.h"
#include "sightline/tools/scene/building/shell.h"
#include "tests/support/random.h"
#include "tests/tools/scene/scene_hash.h"

namespace sightline {
using namespace tools;
namespace {

using Position = std::array<float, 3>;
using Edges = std::map<std::pair<Position, Position>, int>;

Position bits(const glm::vec3& p) { return {p.x, p.y, p.z}; }

void countEdges(const Mesh& mesh, size_t first, size_t end, Edges& edges) {
    for (size_t i = 3 * first; i < 3 * end; i += 3)
        for (int k = 0; k < 3; ++k)
            ++edges[{bits(mesh.positions[mesh.indices[i + k]]), bits(mesh.positions[mesh.indices[i + (k + 1) % 3]])}];
}

/// Of triangles `first` to `end`, if they are closed.
double volumeOf(const Mesh& mesh, size_t first, size_t end) {
    double sum = 0;
    for (size_t i = 3 * first; i < 3 * end; i += 3) {
        const auto corner = [&](size_t k) { return glm::dvec3(mesh.positions[mesh.indices[i + k]]); };
        sum += glm::dot(corner(0), glm::cross(corner(1), corner(2))) / 6;
    }
    return sum;
}

double volumeOf(const Box3d& box) { return box.size().x * box.size().y * box.size().z; }

/// Triangles in the world that stop a segment, from either side.
using Triangles = std::vector<std::array<glm::dvec3, 3>>;

void addTriangles(const Scene& scene, const SceneObject& object, Triangles& out) {
    const Mesh& mesh = scene.meshes[object.mesh];
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
        const auto corner = [&](size_t k) {
            return glm::dvec3(object.transform * glm::dvec4(glm::dvec3(mesh.positions[mesh.indices[i + k]]), 1));
        };
        out.push_back({corner(0), corner(1), corner(2)});
    }
}

bool meets(const glm::dvec3& p, const glm::dvec3& q, const std::array<glm::dvec3, 3>& t) {
    const glm::dvec3 d = q - p;
    const auto side = [&](const glm::dvec3& a, const glm::dvec3& b) { return glm::dot(d, glm::cross(a - p, b - p)); };
    const double u = side(t[0], t[1]), v = side(t[1], t[2]), w = side(t[2], t[0]);
    if (!((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0))) return false;
    const glm::dvec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]);
    const double a = glm::dot(normal, p - t[0]), b = glm::dot(normal, q - t[0]);
    return (a >= 0) != (b >= 0);
}

bool blocked(const glm::dvec3& p, const glm::dvec3& q, const Triangles& triangles) {
    return std::any_of(triangles.begin(), triangles.end(), [&](const auto& t) { return meets(p, q, t); });
}

/// What is built: the objects that are no instances of the library.
Triangles shellOf(const Scene& scene) {
    Triangles triangles;
    for (const SceneObject& object : scene.objects)
        if (object.mesh >= building::kItemCount) addTriangles(scene, object, triangles);
    return triangles;
}

bool holds(const Box3d& box, const glm::dvec3& p, double slack = 0) {
    for (int axis = 0; axis < 3; ++axis)
        if (p[axis] < box.min[axis] - slack || p[axis] > box.max[axis] + slack) return false;
    return true;
}

TEST(Building, IsTheSameOnEveryMachine) {
    EXPECT_EQ(hashOfScene(makeBuilding(1, 2)), 4543485280988107021ull);
    EXPECT_EQ(hashOfScene(makeBuilding(18446744073709551615ull, 1)), 7570422113408510267ull);
    EXPECT_EQ(hashOfScene(makeBuilding(7, 3)), hashOfScene(makeBuilding(7, 3)));
    EXPECT_NE(hashOfScene(makeBuilding(7, 1)), hashOfScene(makeBuilding(8, 1)));
}

TEST(Building, IsFurnished) {
    const Scene scene = makeBuilding(1, 10);
    EXPECT_GE(drawnTriangles(scene), 250'000u);
    EXPECT_GE(scene.objects.size(), 5'000u);
    EXPECT_LE(scene.objects.size(), 15'000u);
    EXPECT_GE(scene.cameras.size(), 16u);
    const Scene tall = makeBuilding(1, 60);
    EXPECT_GT(drawnTriangles(tall), 5 * drawnTriangles(scene));
    EXPECT_TRUE(worldBounds(tall).finite());
}

TEST(Building, NoFridgeFillsThePictureOfAKitchen) {
    int kitchens = 0;
    for (uint64_t seed = 1; seed <= 12; ++seed) {
        const Scene scene = makeBuilding(seed, 3);
        for (const SceneCamera& camera : scene.cameras) {
            if (camera.name.find("Kitchen") == std::string::npos) continue;
            ++kitchens;
            const glm::dvec3 eye(camera.transform[3]), ahead(-camera.transform[2]);
            for (const SceneObject& object : scene.objects) {
                if (object.name.rfind("Fridge", 0) != 0) continue;
                const Box3d box = transformBox(scene.meshes[object.mesh].bounds, object.transform);
                const glm::dvec3 away = glm::clamp(eye, box.min, box.max) - eye;
                EXPECT_FALSE(glm::length(away) < 1 && glm::dot(away, ahead) > 0.7 * glm::length(away))
                    << "seed " << seed << ", " << camera.name << ", " << objectPath(scene, object);
            }
        }
    }
    EXPECT_GE(kitchens, 12);
}

TEST(Building, GivesEveryObjectAPathOfItsOwn) {
    const Scene scene = makeBuilding(3, 4);
    std::set<std::string> paths;
    bool desk = false;
    for (size_t i = 0; i < scene.objects.size(); ++i) {
        const SceneObject& object = scene.objects[i];
        ASSERT_EQ(object.key, i);
        const std::string path = objectPath(scene, object);
        EXPECT_TRUE(paths.insert(path).second) << path;
        desk = desk || (path.rfind("Floor 3/Office 3.", 0) == 0 && path.find("/Desk 1") != std::string::npos);
    }
    EXPECT_TRUE(desk);
}

TEST(Building, WallsAreOneClosedSurface) {
    for (const uint64_t seed : {1, 2, 7, 99}) {
        const building::Plan plan = building::makePlan(seed, 3);
        Edges edges;
        double solid = 0;
        for (const building::ShellPart& part : building::makeShell(plan)) {
            countEdges(part.mesh, 0, part.mesh.triangles(), edges);
            solid += volumeOf(part.mesh, 0, part.mesh.triangles());
            for (size_t i = 0; i < part.mesh.indices.size(); i += 3) {
                const auto corner = [&](size_t k) { return glm::dvec3(part.mesh.positions[part.mesh.indices[i + k]]); };
                ASSERT_GT(glm::length(glm::cross(corner(1) - corner(0), corner(2) - corner(0))), 0) << part.name;
            }
        }
        for (const auto& [edge, count] : edges) {
            const auto back = edges.find({edge.second, edge.first});
            ASSERT_TRUE(count == 1 && back != edges.end() && back->second == 1)
                << "seed " << seed << ": " << edge.first[0] << " " << edge.first[1] << " " << edge.first[2] << " to "
                << edge.second[0] << " " << edge.second[1] << " " << edge.second[2];
        }
        // What is solid and what lies in cells fill the plot: nothing is counted twice, nothing forgotten.
        const Scene scene = makeBuilding(seed, 3);
        double air = 0;
        for (const SceneCell& cell : scene.cells) air += volumeOf(cell.bounds);
        const glm::dvec2 plot = plan.plot.max - plan.plot.min;
        EXPECT_NEAR(solid + air, plot.x * plot.y * (plan.air + building::kSlab), 1e-6);
    }
}

TEST(Building, StockIsClosedAndFacesOutward) {
    const Pieces library = building::makeLibrary();
    for (const Mesh& mesh : library.meshes) {
        Edges edges;
        double volume = 0;
        for (const Primitive& primitive : mesh.primitives) {
            if (library.materials[primitive.material].double_sided) continue;  // leaves
            const size_t first = primitive.first_triangle, end = first + primitive.triangle_count;
            countEdges(mesh, first, end, edges);
            volume += volumeOf(mesh, first, end);
        }
        for (const auto& [edge, count] : edges) {
            const auto back = edges.find({edge.second, edge.first});
            ASSERT_TRUE(back != edges.end() && back->second == count)
                << mesh.name << ": " << edge.first[0] << " " << edge.first[1] << " " << edge.first[2];
        }
        EXPECT_GT(volume, 0) << mesh.name;
    }
}

TEST(Building, CellsAreConvexAndDisjoint) {
    for (const uint64_t seed : {1, 5}) {
        const Scene scene = makeBuilding(seed, 4);
        ASSERT_GT(scene.cells.size(), 200u);
        std::set<std::string> names;
        for (const SceneCell& cell : scene.cells) {
            EXPECT_TRUE(names.insert(cell.name).second) << cell.name;
            ASSERT_EQ(cell.planes.size(), 6u);
            ASSERT_GT(volumeOf(cell.bounds), 0) << cell.name;
            for (const glm::dvec4& plane : cell.planes) {
                EXPECT_EQ(glm::length(glm::dvec3(plane)), 1);
                // Every corner is inside, and some lie on the plane.
                double least = 1e9;
                for (int corner = 0; corner < 8; ++corner) {
                    const glm::dvec3 at(corner & 1 ? cell.bounds.max.x : cell.bounds.min.x,
                                        corner & 2 ? cell.bounds.max.y : cell.bounds.min.y,
                                        corner & 4 ? cell.bounds.max.z : cell.bounds.min.z);
                    least = std::min(least, glm::dot(glm::dvec3(plane), at) + plane.w);
                }
                EXPECT_EQ(least, 0) << cell.name;
            }
        }
        for (size_t i = 0; i < scene.cells.size(); ++i) {
            for (size_t k = 0; k < i; ++k) {
                const Box3d &a = scene.cells[i].bounds, &b = scene.cells[k].bounds;
                const glm::dvec3 common = glm::min(a.max, b.max) - glm::max(a.min, b.min);
                ASSERT_LE(glm::min(common.x, glm::min(common.y, common.z)), 0)
                    << scene.cells[i].name << " and " << scene.cells[k].name;
            }
        }
    }
}

/// The area in which two boxes touch.
double contact(const Box3d& a, const Box3d& b) {
    const glm::dvec3 common = glm::min(a.max, b.max) - glm::max(a.min, b.min);
    for (int axis = 0; axis < 3; ++axis)
        if (common[axis] == 0 && common[(axis + 1) % 3] > 0 && common[(axis + 2) % 3] > 0)
            return common[(axis + 1) % 3] * common[(axis + 2) % 3];
    return 0;
}

TEST(Building, PortalsAreAllThatCellsShare) {
    const Scene scene = makeBuilding(4, 4);
    std::map<std::pair<uint32_t, uint32_t>, double> areas;
    for (const ScenePortal& portal : scene.portals) {
        ASSERT_NE(portal.cells[0], portal.cells[1]);
        ASSERT_EQ(portal.polygon.size(), 4u);
        const SceneCell& first = scene.cells[portal.cells[0]];
        const glm::dvec3 normal =
            glm::cross(portal.polygon[1] - portal.polygon[0], portal.polygon[2] - portal.polygon[0]);
        const glm::dvec3 unit = glm::normalize(normal);
        // Counter-clockwise as seen from the first cell: the normal points into it.
        EXPECT_GT(glm::dot(unit, first.bounds.center() - portal.polygon[0]), 0) << portal.name;
        double area = 0;
        for (size_t i = 0; i < 4; ++i) {
            const glm::dvec3 &a = portal.polygon[i], &b = portal.polygon[(i + 1) % 4], &c = portal.polygon[(i + 2) % 4];
            EXPECT_EQ(glm::dot(unit, a - portal.polygon[0]), 0) << portal.name;
            EXPECT_GT(glm::dot(glm::cross(b - a, c - b), unit), 0) << portal.name;
            area += 0.5 * glm::dot(glm::cross(a - portal.polygon[0], b - portal.polygon[0]), unit);
            for (const uint32_t cell : portal.cells) EXPECT_TRUE(holds(scene.cells[cell].bounds, a)) << portal.name;
        }
        const auto key = std::minmax(portal.cells[0], portal.cells[1]);
        EXPECT_TRUE(areas.try_emplace({key.first, key.second}, area).second) << portal.name;
    }
    for (uint32_t i = 0; i < scene.cells.size(); ++i) {
        for (uint32_t k = i + 1; k < scene.cells.size(); ++k) {
            const double expected = contact(scene.cells[i].bounds, scene.cells[k].bounds);
            const auto found = areas.find({i, k});
            ASSERT_NEAR(found == areas.end() ? 0 : found->second, expected, 1e-9)
                << scene.cells[i].name << " and " << scene.cells[k].name;
        }
    }
}

TEST(Building, EveryCellIsReachedFromTheLobby) {
    const Scene scene = makeBuilding(6, 5);
    std::vector<bool> reached(scene.cells.size());
    for (size_t i = 0; i < scene.cells.size(); ++i) reached[i] = scene.cells[i].name == "Lobby 0";
    ASSERT_EQ(std::count(reached.begin(), reached.end(), true), 1);
    for (bool again = true; again;) {
        again = false;
        for (const ScenePortal& portal : scene.portals) {
            if (reached[portal.cells[0]] == reached[portal.cells[1]]) continue;
            reached[portal.cells[0]] = reached[portal.cells[1]] = true;
            again = true;
        }
    }
    for (size_t i = 0; i < reached.size(); ++i) EXPECT_TRUE(reached[i]) << scene.cells[i].name;
}

/// Cells that belong to a node: its own and those of its openings; shafts and the outside are one each.
std::vector<Box3d> cellsOf(const Scene& scene, const std::string& node) {
    const std::string kind = node.substr(0, node.find(' '));
    const bool shaft = kind == "Stairs" || kind == "Lift", outside = kind == "Outside" || kind == "Terrace";
    std::vector<Box3d> boxes;
    for (const SceneCell& cell : scene.cells) {
        const bool own = cell.name == node || cell.name.rfind(node + " ", 0) == 0;
        const bool same_shaft = shaft && cell.name.rfind(kind + " ", 0) == 0;
        const bool air = outside && (cell.name.rfind("Outside", 0) == 0 || cell.name == "Terrace");
        if (own || same_shaft || air) boxes.push_back(cell.bounds);
    }
    return boxes;
}

TEST(Building, FurnitureStaysInItsRoom) {
    for (const uint64_t seed : {1, 2, 3}) {
        const Scene scene = makeBuilding(seed, 3);
        std::map<uint32_t, std::vector<Box3d>> cells;
        for (const SceneObject& object : scene.objects) {
            const auto [entry, added] = cells.try_emplace(object.node);
            if (added) entry->second = cellsOf(scene, scene.nodes[object.node].name);
            const std::string path = objectPath(scene, object);
            // A leaf moves from one cell into another: Building.DoorsHangInTheirPortals.
            if (object.mesh >= building::kDoorLeaf && object.mesh <= building::kLiftLeaf) continue;
            if (object.mesh >= building::kItemCount) {
                // Walls look into the air of their room, doorways and recesses; the ground has an underside.
                if (scene.nodes[object.node].name == "Outside") continue;
                for (const glm::vec3& p : scene.meshes[object.mesh].positions)
                    EXPECT_TRUE(std::any_of(entry->second.begin(), entry->second.end(),
                                            [&](const Box3d& box) { return holds(box, glm::dvec3(p)); }))
                        << "seed " << seed << ": " << path;
                continue;
            }
            const Box3d bounds = transformBox(scene.meshes[object.mesh].bounds, object.transform);
            glm::dvec3 low = bounds.min, size = bounds.size();
            double held = 0;
            // A flat thing, as a wall is, has an area instead of a volume: it is made a micrometre thick.
            for (int axis = 0; axis < 3; ++axis) size[axis] = std::max(size[axis], 1e-6);
            for (const Box3d& box : entry->second) {
                const glm::dvec3 common = glm::min(box.max + 1e-6, low + size) - glm::max(box.min - 1e-6, low);
                if (common.x > 0 && common.y > 0 && common.z > 0) held += common.x * common.y * common.z;
            }
            EXPECT_GE(held, size.x * size.y * size.z * (1 - 1e-4)) << "seed " << seed << ": " << path;
        }
    }
}

TEST(Building, DoorsHangInTheirPortals) {
    std::map<std::string, int> states;
    for (const uint64_t seed : {1, 2}) {
        const Scene scene = makeBuilding(seed, 3);
        Random random(seed);
        for (const ScenePortal& portal : scene.portals) {
            if (portal.door == ~0u) continue;
            ASSERT_LT(portal.door, scene.objects.size());
            const SceneObject& door = scene.objects[portal.door];
            const std::string state = door.name.substr(door.name.find('('));
            ++states[state];
            Triangles leaf;
            addTriangles(scene, door, leaf);
            const Box3d &room = scene.cells[portal.cells[0]].bounds, &hole = scene.cells[portal.cells[1]].bounds;
            for (const auto& triangle : leaf)
                for (const glm::dvec3& p : triangle)
                    EXPECT_TRUE(holds(room, p, 1e-9) || holds(hole, p, 1e-9)) << portal.name << ", " << door.name;
            // A straight way through the portal, a hand's breadth to either side.
            const glm::dvec3 u = portal.polygon[1] - portal.polygon[0], v = portal.polygon[3] - portal.polygon[0];
            const glm::dvec3 through = glm::normalize(glm::cross(u, v)) * 0.12;
            int stopped = 0;
            for (int i = 0; i < 100; ++i) {
                const double s = random.uniform(), t = random.uniform();
                const glm::dvec3 at = portal.polygon[0] + u * s + v * t;
                stopped += blocked(at + through, at - through, leaf);
            }
            if (state == "(shut)") EXPECT_EQ(stopped, 100) << portal.name;
            else EXPECT_LT(stopped, 40) << portal.name;
        }
    }
    EXPECT_GT(states["(shut)"], 10);
    EXPECT_GT(states["(half open)"], 5);
    EXPECT_GT(states["(open)"], 5);
}

/// Walks a free segment from cell to cell; false where it leaves one beside all portals.
bool passesThroughPortals(const Scene& scene, const std::vector<std::vector<uint32_t>>& portals_of, uint32_t cell,
                          const glm::dvec3& p, const glm::dvec3& q, int& crossings) {
    const glm::dvec3 d = q - p;
    for (int steps = 0; steps < 1000; ++steps) {
        const Box3d& box = scene.cells[cell].bounds;
        if (holds(box, q)) return true;
        double exit = 1;
        for (int axis = 0; axis < 3; ++axis)
            if (d[axis] != 0)
                exit = std::min(exit, ((d[axis] > 0 ? box.max[axis] : box.min[axis]) - p[axis]) / d[axis]);
        const glm::dvec3 at = p + d * exit;
        uint32_t next = cell;
        for (const uint32_t index : portals_of[cell]) {
            const ScenePortal& portal = scene.portals[index];
            Box3d hole;
            for (const glm::dvec3& corner : portal.polygon) hole.grow(corner);
            const uint32_t other = portal.cells[0] == cell ? portal.cells[1] : portal.cells[0];
            // It goes on into the cell beyond.
            if (holds(hole, at, 1e-9) && holds(scene.cells[other].bounds, at + d * 1e-7, 1e-9)) next = other;
        }
        if (next == cell) return false;
        cell = next;
        ++crossings;
    }
    return false;
}

TEST(Building, SightPassesThroughPortalsOnly) {
    for (const uint64_t seed : {1, 2}) {
        const Scene scene = makeBuilding(seed, 2);
        const Triangles walls = shellOf(scene);
        std::vector<std::vector<uint32_t>> portals_of(scene.cells.size());
        for (uint32_t i = 0; i < scene.portals.size(); ++i)
            for (const uint32_t cell : scene.portals[i].cells) portals_of[cell].push_back(i);
        Random random(seed + 100);
        int seen = 0, crossings = 0;
        for (int tries = 0; tries < 4000; ++tries) {
            const auto from = static_cast<uint32_t>(random.below(scene.cells.size()));
            // A cell some portals away: sight between any two is rare.
            uint32_t to = from;
            for (uint64_t steps = 1 + random.below(5); steps > 0; --steps) {
                const ScenePortal& portal = scene.portals[portals_of[to][random.below(portals_of[to].size())]];
                to = portal.cells[0] == to ? portal.cells[1] : portal.cells[0];
            }
            const glm::dvec3 p = test::randomIn(random, scene.cells[from].bounds),
                             q = test::randomIn(random, scene.cells[to].bounds);
            if (blocked(p, q, walls)) continue;
            ++seen;
            ASSERT_TRUE(passesThroughPortals(scene, portals_of, from, p, q, crossings))
                << "seed " << seed << ", try " << tries << ": " << scene.cells[from].name << " to "
                << scene.cells[to].name;
        }
        EXPECT_GT(seen, 400) << "seed " << seed;
        EXPECT_GT(crossings, 400) << "seed " << seed;
    }
}

TEST(Building, TriangulatesOutlinesWithStraightCorners) {
    Random random(5);
    for (int tries = 0; tries < 500; ++tries) {
        const double x = random.uniform(0.5, 9), y = random.uniform(0.5, 9);
        const auto along = [&](const glm::dvec2& a, const glm::dvec2& b, std::vector<glm::dvec2>& out) {
            std::vector<double> shares{0};
            for (uint64_t i = random.below(6); i > 0; --i) shares.push_back(random.uniform(0.01, 0.99));
            std::sort(shares.begin(), shares.end());
            for (const double share : shares) {
                glm::dvec2 p = a;
                if (a.x != b.x) p.x += share * (b.x - a.x);
                else p.y += share * (b.y - a.y);
                out.push_back(p);
            }
        };
        std::vector<glm::dvec2> outline;
        along({0, 0}, {x, 0}, outline);
        along({x, 0}, {x, y}, outline);
        along({x, y}, {0, y}, outline);
        along({0, y}, {0, 0}, outline);
        double area = 0;
        for (const auto& [a, b, c] : building::triangulateConvex(outline)) {
            const glm::dvec2 p = outline[b] - outline[a], q = outline[c] - outline[a];
            const double twice = p.x * q.y - p.y * q.x;
            ASSERT_GT(twice, 0) << "try " << tries;
            area += 0.5 * twice;
        }
        EXPECT_NEAR(area, x * y, 1e-9) << "try " << tries;
    }
}

}  // namespace
}  // namespace sightline
