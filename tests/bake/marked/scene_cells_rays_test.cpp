// Rays out of checked cells: what leaves a cell meets a wall there, or goes through a portal into what is behind it.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sightline/bake/marked/scene_cells.h"
#include "sightline/base/random.h"
#include "sightline/tools/import/scene_file.h"
#include "sightline/tools/scene/procedural.h"
#include "sightline/tools/truth/rays.h"
#include "tests/bake/aimed_points.h"
#include "tests/bake/far_things.h"
#include "tests/bake/marked/random_rooms.h"
#include "tests/bake/opaque_triangles.h"

namespace sightline {
using namespace bake;
using namespace tools;
namespace {

using namespace test;

constexpr double kFar = std::numeric_limits<double>::infinity();

double insideBy(const CellSpace& space, uint32_t cell, const glm::dvec3& point) {
    double least = cell == space.outside ? -kFar : kFar;
    for (const glm::dvec4& plane : space.planesOf(space.regions[cell]))
        least = std::min(least, glm::dot(glm::dvec3(plane), point) + plane.w);
    return least;
}

bool holds(const CellGraph& graph, const CellPortal& portal, const glm::dvec3& point, double room) {
    const auto outline = graph.outline(portal);
    const glm::dvec3 normal(portal.plane);
    if (std::abs(glm::dot(normal, point) + portal.plane.w) > room) return false;
    for (size_t i = 0; i < outline.size(); ++i) {
        const glm::dvec3 edge = outline[(i + 1) % outline.size()] - outline[i];
        if (glm::dot(glm::cross(normal, edge), point - outline[i]) < -1e-9 * glm::length(edge)) return false;
    }
    return true;
}

struct Counts {
    uint64_t rays = 0, walls = 0, ways = 0;
};

/// Whether a ray meets an opaque front between two distances, or before.
using Meets = std::function<bool(const glm::dvec3& from, const glm::dvec3& along, double first, double last)>;

/// One ray out of a cell. Empty, or what is wrong.
std::string follow(const SceneCells& cells, const Meets& meets, uint32_t cell, const glm::dvec3& from,
                   const glm::dvec3& along, Counts& counts) {
    const CellSpace& space = cells.space;
    const double bend = std::max(cells.report.slit, cells.report.bend);
    double exit = kFar, grazing = 0;
    for (const glm::dvec4& plane : space.planesOf(space.regions[cell])) {
        const double height = glm::dot(glm::dvec3(plane), from) + plane.w, falls = glm::dot(glm::dvec3(plane), along);
        if (falls < 0 && -height / falls < exit) exit = -height / falls, grazing = -falls;
    }
    if (grazing < 0.05) return "";  // passes along a wall: within its thickness nothing is said
    ++counts.rays;
    const glm::dvec3 point = from + exit * along;
    const double reach = 2 * bend / grazing;
    std::vector<uint32_t> through;
    for (const CellPortal& portal : space.graph.portals) {
        const int side = portal.cells[0] == cell ? 0 : 1;
        if (portal.cells[side] == cell && holds(space.graph, portal, point, 2 * bend))
            through.push_back(portal.cells[1 - side]);
    }
    const bool blocked = meets(from, along, exit - reach, exit + reach);
    counts.walls += blocked;
    counts.ways += !through.empty();
    if (blocked) return "";
    if (through.empty()) return "leaves by no portal and meets no wall";
    const glm::dvec3 beyond = point + 4 * reach * along;
    bool somewhere = false;
    for (uint32_t other = 0; other < space.graph.cells; ++other) {
        if (other == space.outside) continue;
        // Near an edge it may have entered a cell and left it through a side.
        const bool entered = std::find(through.begin(), through.end(), other) != through.end();
        if (insideBy(space, other, beyond) < (entered ? -4 * reach : 0)) continue;
        somewhere = true;
        if (other == cell || insideBy(space, other, beyond) < 8 * reach) continue;  // it may have left that already
        if (!entered) return "no portal leads into '" + space.names[other] + "'";
    }
    if (!somewhere && std::find(through.begin(), through.end(), space.outside) == through.end())
        return "no portal leads outside";
    return "";
}

/// Rays out of all cells, half of them aimed: at the edges of portals and a little beside them.
/// @param surely  is asked where something seems wrong; empty: `meets` is sure
void shoot(const SceneCells& cells, const Meets& meets, const Meets& surely, int rays, Random& random, Counts& counts) {
    const CellSpace& space = cells.space;
    for (uint32_t cell = 0; cell < space.graph.cells; ++cell) {
        if (cell == space.outside) continue;
        const Box3d& bounds = space.regions[cell].bounds;
        for (int ray = 0; ray < rays; ++ray) {
            glm::dvec3 from, target;
            for (int axis = 0; axis < 3; ++axis) {
                from[axis] = random.uniform(bounds.min[axis], bounds.max[axis]);
                target[axis] = random.uniform(bounds.min[axis], bounds.max[axis]);
            }
            if (insideBy(space, cell, from) < 4 * cells.report.bend) continue;
            if (ray % 2 && !space.graph.portals.empty()) target = pointAtPortal(space.graph, random);
            const glm::dvec3 along = target - from;
            if (!(glm::length(along) > 1e-6)) continue;
            std::string wrong = follow(cells, meets, cell, from, glm::normalize(along), counts);
            if (!wrong.empty() && surely) wrong = follow(cells, surely, cell, from, glm::normalize(along), counts);
            ASSERT_EQ(wrong, "") << "out of '" << space.names[cell] << "' from (" << from.x << ", " << from.y << ", "
                                 << from.z << ") to (" << target.x << ", " << target.y << ", " << target.z << ")";
        }
    }
}

TEST(SceneCellRays, LeaveByPortalsOrMeetWalls) {
    Random random(1);
    Counts counts;
    uint64_t holes = 0, passages = 0, outside = 0, moved = 0;
    for (int round = 0; round < 60; ++round) {
        SCOPED_TRACE("round " + std::to_string(round));
        const MarkedRooms made = randomRooms(random, round);
        const SceneCells cells = cellsOfScene(made.scene);
        const OpaqueTriangles truth(made.scene);
        const auto meets = [&](const glm::dvec3& from, const glm::dvec3& along, double first, double last) {
            // What closes a slit narrower than the declared one counts as a wall.
            return truth.meets(from, along, first, last, cells.report.slit);
        };
        holes += cells.report.holes;
        passages += cells.report.passages;
        outside += cells.report.outside;
        moved += cells.report.moved_faces;
        shoot(cells, meets, {}, 1500, random, counts);
        if (HasFatalFailure()) return;
    }
    // None of it is there for nothing.
    EXPECT_GT(counts.rays, 100000u);
    EXPECT_GT(counts.walls, 30000u);
    EXPECT_GT(counts.ways, 5000u);
    EXPECT_GT(holes, 60u);
    EXPECT_GT(passages, 10u);
    EXPECT_GT(outside, 10u);
    EXPECT_GT(moved, 60u);
}

// Triangles far off, a cell far off, or a large one beside the rooms, from 10^3 to 10^7 units: no hole is taken for a seam.
TEST(SceneCellRays, LeaveByPortalsOrMeetWallsWhateverLiesFarOff) {
    Random random(9);
    Counts counts;
    for (int round = 0; round < 45; ++round) {
        const double far = std::pow(10, 3 + round % 5);
        const FarThing what = kFarThings[round / 5 % 3];
        const bool beside = round >= 30;
        SCOPED_TRACE("round " + std::to_string(round) + ", " + std::to_string(int(what)) + " at " +
                     std::to_string(far));
        MarkedRooms made = randomRooms(random, 3 * (round % 10));
        const SceneCells plain = cellsOfScene(made.scene);
        addFarThing(made, what, far, random);
        const double x = beside ? made.scene.cells.back().bounds.max.x : 0.5 * far;
        made.cell("far", {{x, -far, -far}, {x + far, far, far}});
        const SceneCells cells = cellsOfScene(made.scene);
        EXPECT_LT(cells.report.slit, 1e-3);
        EXPECT_LT(cells.report.bend, 1e-3);
        if (!beside) {
            const auto ofRooms = [](const SceneCells& of) {
                return std::count_if(of.space.graph.portals.begin(), of.space.graph.portals.end(), [&](const auto& p) {
                    return of.space.names[p.cells[0]] != "far" && of.space.names[p.cells[1]] != "far";
                });
            };
            EXPECT_EQ(ofRooms(cells), ofRooms(plain));
        }
        const OpaqueTriangles truth(made.scene);
        const auto meets = [&](const glm::dvec3& from, const glm::dvec3& along, double first, double last) {
            return truth.meets(from, along, first, last, cells.report.slit);
        };
        shoot(cells, meets, {}, 1000, random, counts);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(counts.rays, 50000u);
    EXPECT_GT(counts.walls, 15000u);
    EXPECT_GT(counts.ways, 2500u);
}

/// Whole scenes, held against rays by Embree; where these meet no wall, against each triangle in double. No slit is
/// allowed for.
void judgeScene(const Scene& scene, int rays, uint64_t seed, SceneCellSettings settings = {}) {
    settings.slit = settings.bend = 0;
    const SceneCells cells = cellsOfScene(scene, settings);
    Scene without = scene;  // doors open
    std::vector<bool> leaf(scene.objects.size(), false);
    for (const ScenePortal& portal : scene.portals)
        if (portal.door < leaf.size()) leaf[portal.door] = true;
    std::erase_if(without.objects, [&](const SceneObject& object) {
        return leaf[static_cast<size_t>(std::find_if(scene.objects.begin(), scene.objects.end(),
                                                     [&](const SceneObject& o) { return o.key == object.key; }) -
                                        scene.objects.begin())];
    });
    const SceneFacts facts(without);
    const RayScene truth(facts);
    const OpaqueTriangles triangles(without);
    const auto meets = [&](const glm::dvec3& from, const glm::dvec3& along, double, double last) {
        RaySighting sighting;
        truth.look({glm::dvec3(0), along, 0, std::numeric_limits<double>::infinity()}, from, sighting);
        return sighting.object != RaySighting::kNone && sighting.t <= last + 4 * sighting.rounding;
    };
    const auto surely = [&](const glm::dvec3& from, const glm::dvec3& along, double first, double last) {
        return triangles.meets(from, along, first, last, 1e-9);
    };
    Random random(seed);
    Counts counts;
    shoot(cells, meets, surely, rays, random, counts);
    EXPECT_GT(counts.rays, uint64_t(rays));
    EXPECT_GT(counts.walls, counts.rays / 4);
    EXPECT_GT(counts.ways, counts.rays / 20);
}

TEST(SceneCellRays, OutOfABuilding) {
    const Result<Scene> scene = makeProcedural("building:3:2");
    ASSERT_TRUE(scene.ok());
    judgeScene(*scene, 400, 1);
}

Result<Scene> smallHouse() {
    Result<Scene> house = loadSceneFile(SIGHTLINE_SHARED_DIR "/scenes/aws-small-house.glb");
    Result<Scene> cells = loadSceneFile(SIGHTLINE_EXAMPLES_DIR "/small-house-cells.gltf");
    if (!house || !cells) return house ? cells : house;
    std::vector<Scene> both;
    both.push_back(std::move(*house));
    both.push_back(std::move(*cells));
    return joinScenes(std::move(both));
}

TEST(SceneCellRays, OutOfAHouseMarkedByHand) {
    if (!std::filesystem::exists(SIGHTLINE_SHARED_DIR "/scenes"))
        GTEST_SKIP() << "the shared scenes are not there: " SIGHTLINE_SHARED_DIR "/scenes";
    const Result<Scene> scene = smallHouse();
    ASSERT_TRUE(scene.ok()) << scene.error().message;
    judgeScene(*scene, 10000, 2);
}

// Its walls have no holes but windows, it has no ceilings, and its entrance leads out.
TEST(SceneCells, AHouseMarkedByHandIsDividedByItsWalls) {
    if (!std::filesystem::exists(SIGHTLINE_SHARED_DIR "/scenes"))
        GTEST_SKIP() << "the shared scenes are not there: " SIGHTLINE_SHARED_DIR "/scenes";
    const Result<Scene> scene = smallHouse();
    ASSERT_TRUE(scene.ok()) << scene.error().message;
    const SceneCells cells = cellsOfScene(*scene);
    EXPECT_EQ(cells.report.passages, 2u);
    EXPECT_EQ(cells.report.holes, cells.report.findings.size());
    EXPECT_EQ(cells.report.holes, 11u);
    for (const CellFinding& finding : cells.report.findings) {
        EXPECT_EQ(finding.cells[1], CellGraph::kNoCell) << finding.text;
        EXPECT_GT(finding.size, 1) << finding.text;
    }
    ASSERT_EQ(cells.space.doors.size(), 1u);
    EXPECT_EQ(cells.space.doors[0].key, 54u);
}

}  // namespace
}  // namespace sightline
