// Marked cells are checked against the walls: holes that nobody marked are found, however small; nothing else is.
// SPDX-License-Identifier: MIT
#include "sightline/bake/marked/scene_cells.h"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sightline/base/random.h"
#include "sightline/tools/scene/procedural.h"
#include "tests/bake/marked/made_rooms.h"

namespace sightline {
using namespace bake;
using namespace tools;
namespace {

using namespace test;

constexpr uint32_t kNoCell = CellGraph::kNoCell;
const Box3d kHall{{0, 0, 0}, {6, 3, 4}};
const FlatRect kDoor{{0, 1}, {2, 2}};  // across x: y from 0 to 2, z from 1 to 2

std::string textsOf(const SceneCells& cells) {
    std::string out;
    for (const CellFinding& finding : cells.report.findings) out += finding.text + "\n";
    return out;
}

size_t count(const SceneCells& cells, CellFindingKind kind) {
    size_t n = 0;
    for (const CellFinding& finding : cells.report.findings) n += finding.kind == kind;
    return n;
}

/// How far a point is inside of a portal's outline; negative: outside.
double insideBy(const CellGraph& graph, const CellPortal& portal, const glm::dvec3& point) {
    const auto outline = graph.outline(portal);
    const glm::dvec3 normal(portal.plane);
    double least = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < outline.size(); ++i) {
        const glm::dvec3 edge = outline[(i + 1) % outline.size()] - outline[i];
        least = std::min(least, glm::dot(glm::cross(normal, edge), point - outline[i]) / glm::length(edge));
    }
    return least;
}

glm::dmat4 placeOf(Random& random, int round) {
    return round == 0 ? glm::dmat4(1.0) : randomPlace(random, round % 2 ? 0 : std::pow(10, random.uniform(0, 5)));
}

TEST(SceneCells, AClosedRoomHasNoHole) {
    Random random(1);
    for (int round = 0; round < 50; ++round) {
        MarkedRooms made;
        made.place = placeOf(random, round);
        made.room(kHall);
        made.cell("hall", kHall);
        const SceneCells cells = cellsOfScene(made.scene);
        EXPECT_TRUE(cells.report.findings.empty()) << "round " << round << "\n" << textsOf(cells);
        EXPECT_EQ(cells.space.graph.cells, 1u);
        EXPECT_TRUE(cells.space.graph.portals.empty());
        EXPECT_EQ(cells.space.outside, kNoCell);
        EXPECT_EQ(cells.report.walls.size(), 6u);
        EXPECT_EQ(cells.report.faces, 6u);
    }
}

// Holes of a centimetre, a millimetre and a tenth of one in the wall of a room.
TEST(SceneCells, FindsHolesOf10And1AndATenthOfAMillimetre) {
    Random random(2);
    for (const double size : {1e-2, 1e-3, 1e-4})
        for (int round = 0; round < 20; ++round) {
            SCOPED_TRACE("hole of " + std::to_string(size) + ", round " + std::to_string(round));
            MarkedRooms made;
            made.place = placeOf(random, round);
            // Within the float grid of the mesh, so that it is as large as it says.
            const glm::dvec2 low(0x1p-9 * std::floor(random.uniform(100, 1400)),
                                 0x1p-9 * std::floor(random.uniform(100, 1900)));
            const double side = 0x1p-20 * std::round(size * 0x1p20);
            const FlatRect hole{low, low + side};
            made.room(kHall, 2);
            made.wall(0, 6, {{0, 0}, {3, 4}}, -1, {hole});
            made.cell("hall", kHall);
            const SceneCells cells = cellsOfScene(made.scene);
            ASSERT_EQ(cells.report.holes, 1u) << textsOf(cells);
            ASSERT_EQ(cells.report.findings.size(), 1u) << textsOf(cells);
            const CellFinding& finding = cells.report.findings[0];
            EXPECT_EQ(finding.cells[0], 0u);
            EXPECT_EQ(finding.cells[1], kNoCell);
            const glm::dvec3 middle = made.placed(MarkedRooms::at(0, 6, low.x + side / 2, low.y + side / 2));
            EXPECT_LE(glm::length(finding.place - middle), 2 * cells.report.slit);
            EXPECT_NEAR(std::sqrt(finding.size), side, 2 * cells.report.slit);
            ASSERT_EQ(cells.space.graph.portals.size(), 1u);
            EXPECT_EQ(cells.space.graph.portals[0].cells[1], cells.space.outside);
            for (const glm::dvec2& corner : {hole.min, hole.max})
                EXPECT_GE(insideBy(cells.space.graph, cells.space.graph.portals[0],
                                   made.placed(MarkedRooms::at(0, 6, corner.x, corner.y))),
                          cells.report.slit / 2)
                    << "the portal holds the hole";
            for (const glm::dvec3& corner : cells.space.graph.points)
                EXPECT_LE(glm::length(corner - middle), side + 4 * cells.report.bend) << "and little more";
        }
}

// A hair between a wall and the next, all along the room.
TEST(SceneCells, FindsAHairBetweenWalls) {
    MarkedRooms made;
    made.room(kHall, 2);
    made.wall(0, 6, {{0, 0}, {3, 4 - 0x1p-13}}, -1);
    made.cell("hall", kHall);
    const SceneCells cells = cellsOfScene(made.scene);
    ASSERT_EQ(cells.report.holes, 1u) << textsOf(cells);
    EXPECT_NEAR(cells.report.hole_area, 3 * 0x1p-13, 6 * cells.report.bend);
}

// Walls of a fine grid in no order, with one square left out.
TEST(SceneCells, FindsWhatIsMissingOfManyTriangles) {
    Random random(3);
    for (int round = 0; round < 4; ++round) {
        MarkedRooms made;
        made.place = placeOf(random, round);
        made.room(kHall, 2);
        const uint64_t missing = random.below(24 * 32);
        for (uint64_t i = 0; i < 24 * 32; ++i) {
            const uint64_t square = i * 433 % (24 * 32);
            const glm::dvec2 low(0.125 * double(square % 24), 0.125 * double(square / 24));
            if (square != missing) made.wall(0, 6, {low, low + 0.125}, -1);
        }
        made.cell("hall", kHall);
        const SceneCells cells = cellsOfScene(made.scene);
        ASSERT_EQ(cells.report.holes, 1u) << textsOf(cells);
        EXPECT_NEAR(cells.report.hole_area, 1.0 / 64, 1e-4);
        const glm::dvec2 low(0.125 * double(missing % 24), 0.125 * double(missing / 24));
        EXPECT_LE(glm::length(cells.report.findings[0].place -
                              made.placed(MarkedRooms::at(0, 6, low.x + 0.0625, low.y + 0.0625))),
                  1e-3);
    }
}

TEST(SceneCells, WhatDoesNotHideIsAHole) {
    const auto holesWith = [](auto&& change, uint32_t material) {
        MarkedRooms made;
        made.scene.materials.resize(4);
        made.scene.materials[1].alpha_mode = AlphaMode::kBlend;
        made.scene.materials[2].alpha_mode = AlphaMode::kMask;
        made.scene.materials[3].transmissive = true;
        made.room(kHall, 2);
        made.wall(0, 6, {{0, 0}, {3, 4}}, -1, {}, material);
        made.cell("hall", kHall);
        SceneCellSettings settings;
        change(made, settings);
        return cellsOfScene(made.scene, settings).report.hole_area;
    };
    const auto nothing = [](MarkedRooms&, SceneCellSettings&) {};
    EXPECT_EQ(holesWith(nothing, 0), 0);
    for (uint32_t material = 1; material < 4; ++material) EXPECT_NEAR(holesWith(nothing, material), 12, 3e-3);
    EXPECT_NEAR(holesWith([](MarkedRooms& made, auto&) { made.scene.meshes.back().deforms = true; }, 0), 12, 3e-3);
    EXPECT_NEAR(holesWith([](MarkedRooms&, SceneCellSettings& settings) { settings.movable = {5}; }, 0), 12, 3e-3);
    const auto turned = [](MarkedRooms& made, auto&) {
        std::vector<uint32_t>& indices = made.scene.meshes.back().indices;
        std::reverse(indices.begin(), indices.end());
    };
    EXPECT_NEAR(holesWith(turned, 0), 12, 3e-3) << "a back is not drawn";
    EXPECT_EQ(holesWith(
                  [&](MarkedRooms& made, SceneCellSettings& settings) {
                      turned(made, settings);
                      made.scene.materials[0].double_sided = true;
                  },
                  0),
              0);
    const auto mirrored = [](MarkedRooms& made, auto&) {
        made.scene.objects.back().transform[0][0] = -1;
        made.scene.objects.back().transform[3][0] = 12;
    };
    EXPECT_NEAR(holesWith(mirrored, 0), 12, 3e-3) << "a mirror turns it round";
    const auto door = [](MarkedRooms& made, auto&) {
        made.cell("kitchen", {{6, 0, 0}, {8, 3, 4}});
        made.portal(0, 1, 0, 6, kDoor);
        made.scene.portals[0].door = 5;
    };
    EXPECT_GT(holesWith(door, 0), 9.9) << "doors open";
}

/// Two rooms with a wall between them, 0.25 thick, and a door's hole through it; marked as they are.
MarkedRooms twoRooms(const glm::dmat4& place, bool jambs = true, bool marked = true) {
    MarkedRooms made;
    made.place = place;
    const Box3d kitchen{{6.25, 0, 0}, {10, 3, 4}};
    made.room(kHall, 2);
    made.room(kitchen, 1);
    made.wall(0, 6, {{0, 0}, {3, 4}}, -1, {kDoor});
    made.wall(0, 6.25, {{0, 0}, {3, 4}}, 1, {kDoor});
    if (jambs) made.room({{6, 0, 1}, {6.25, 2, 2}}, 3);
    if (!marked) return made;
    made.cell("hall", kHall);
    made.cell("kitchen", kitchen);
    return made;
}

TEST(SceneCells, WallsGetTheirThickness) {
    Random random(4);
    for (int round = 0; round < 20; ++round)
        for (const double at : {6.0, 6.125, 6.25}) {
            SCOPED_TRACE("round " + std::to_string(round) + ", portal at " + std::to_string(at));
            MarkedRooms made = twoRooms(placeOf(random, round));
            made.portal(0, 1, 0, at, kDoor);
            const SceneCells cells = cellsOfScene(made.scene);
            EXPECT_TRUE(cells.report.findings.empty()) << textsOf(cells);
            EXPECT_EQ(cells.report.passages, 1u);
            EXPECT_EQ(cells.space.graph.cells, 3u);
            EXPECT_EQ(cells.space.graph.portals.size(), 2u);
            EXPECT_EQ(cells.space.outside, kNoCell);
        }
}

// A leaf in the midst of a wall is seen from both sides when it is shut.
TEST(SceneCells, ADoorInsideAWallHasAPassageOnEitherSide) {
    MarkedRooms made = twoRooms(glm::dmat4(1.0));
    const uint32_t portal = made.portal(0, 1, 0, 6.125, kDoor);
    made.wall(0, 6.125, kDoor, 1);
    made.scene.portals[portal].door = static_cast<uint32_t>(made.scene.objects.size() - 1);
    made.scene.portals[portal].slide = {0, 0, 1};
    const SceneCells cells = cellsOfScene(made.scene);
    EXPECT_TRUE(cells.report.findings.empty()) << textsOf(cells);
    EXPECT_EQ(cells.space.graph.cells, 4u);
    ASSERT_EQ(cells.space.graph.portals.size(), 3u);
    ASSERT_EQ(cells.space.doors.size(), 1u);
    EXPECT_EQ(cells.space.doors[0].key, made.scene.objects.back().key);
    EXPECT_EQ(cells.space.doors[0].slide, glm::dvec3(0, 0, 1));
    int shut = 0;
    for (const CellPortal& found : cells.space.graph.portals) {
        if (found.door == CellPortal::kNone) continue;
        ++shut;
        EXPECT_EQ(found.cells[0] + found.cells[1], 2u + 3u) << "between the passages";
    }
    EXPECT_EQ(shut, 1);
}

// Without jambs one sees between the sheets of the wall.
TEST(SceneCells, WallsWithoutJambsAreHollow) {
    MarkedRooms made = twoRooms(glm::dmat4(1.0), false);
    made.portal(0, 1, 0, 6, kDoor);
    const SceneCells cells = cellsOfScene(made.scene);
    EXPECT_EQ(cells.report.holes, 4u) << textsOf(cells);
    EXPECT_NEAR(cells.report.hole_area, 0.25 * 6, 3e-3);
    EXPECT_TRUE(cells.report.outside);
}

TEST(SceneCells, FacesFollowTheWallsThatAreMeant) {
    Random random(5);
    for (int round = 0; round < 20; ++round) {
        MarkedRooms made = twoRooms(placeOf(random, round), true, false);
        const auto drawn = [&](Box3d box) {
            for (int axis = 0; axis < 3; ++axis) {
                box.min[axis] += random.uniform(-0.1, 0.1);
                box.max[axis] += random.uniform(-0.1, 0.1);
            }
            return box;
        };
        made.cell("hall", drawn(kHall));
        made.cell("kitchen", drawn({{6.25, 0, 0}, {10, 3, 4}}));
        made.portal(0, 1, 0, random.uniform(5.95, 6.3), kDoor);
        const SceneCells cells = cellsOfScene(made.scene);
        EXPECT_TRUE(cells.report.findings.empty()) << "round " << round << "\n" << textsOf(cells);
        EXPECT_EQ(cells.report.moved_faces, 12u);
        EXPECT_EQ(cells.report.passages, 1u);
    }
}

TEST(SceneCells, CellsThatTouchWithoutAWallAreJoined) {
    Random random(6);
    for (int round = 0; round < 20; ++round) {
        MarkedRooms made;
        made.place = placeOf(random, round);
        made.room({{0, 0, 0}, {10, 3, 4}});
        made.cell("west", {{0, 0, 0}, {6, 3, 4}});
        made.cell("east", {{6, 0, 0}, {10, 3, 4}});
        const SceneCells cells = cellsOfScene(made.scene);
        ASSERT_EQ(cells.report.holes, 1u) << "round " << round << "\n" << textsOf(cells);
        EXPECT_NEAR(cells.report.hole_area, 12, 3e-3);
        EXPECT_EQ(cells.report.findings[0].cells[0], 0u);
        EXPECT_EQ(cells.report.findings[0].cells[1], 1u);
        EXPECT_EQ(cells.space.graph.portals.size(), 1u) << "not one from each side";
        EXPECT_EQ(cells.space.outside, kNoCell);
    }
}

// A hole that is partly before another cell, and partly before none.
TEST(SceneCells, HolesLeadWhereTheyLead) {
    MarkedRooms made;
    made.room(kHall, 2);
    made.wall(0, 6, {{0, 0}, {3, 4}}, -1, {{{1, 1}, {2, 3}}});
    made.room({{6, 0, 0}, {10, 3, 2}}, 1);
    made.cell("hall", kHall);
    made.cell("closet", {{6, 0, 0}, {10, 3, 2}});
    const SceneCells cells = cellsOfScene(made.scene);
    double to_closet = 0, to_outside = 0;
    for (const CellFinding& finding : cells.report.findings) {
        if (finding.cells[0] != 0) continue;
        (finding.cells[1] == 1 ? to_closet : to_outside) += finding.size;
    }
    EXPECT_NEAR(to_closet, 1, 1e-3) << textsOf(cells);
    EXPECT_NEAR(to_outside, 1, 1e-3) << textsOf(cells);
}

TEST(SceneCells, WhatIsNoConvexSolidIsOutside) {
    MarkedRooms made;
    made.room(kHall, 2);
    made.room({{6, 0, 0}, {10, 3, 4}}, 1);
    made.cell("hall", kHall);
    made.cell("odd", {{6, 0, 0}, {10, 3, 4}});
    made.scene.cells[1].overhang = 0.5;
    made.portal(0, 1, 0, 6, kDoor);
    const SceneCells cells = cellsOfScene(made.scene);
    EXPECT_EQ(count(cells, CellFindingKind::kNoCell), 1u);
    EXPECT_EQ(cells.report.findings[0].cells[0], 1u);
    EXPECT_NEAR(cells.report.hole_area, 12, 3e-3) << "all of the wall between them, outside";
    ASSERT_EQ(cells.space.graph.portals.size(), 1u);
    EXPECT_EQ(cells.space.graph.portals[0].cells[1], cells.space.outside);
    EXPECT_EQ(cells.space.outside, 2u) << "cells keep their numbers";
    for (const glm::dvec4& plane : cells.space.planesOf(cells.space.regions[1]))
        EXPECT_LT(plane.w, -10) << "nothing is in it";
}

TEST(SceneCells, TellsOfCellsThatOverlap) {
    MarkedRooms made;
    made.room({{0, 0, 0}, {10, 3, 4}});
    made.cell("west", {{0, 0, 0}, {6, 3, 4}});
    made.cell("east", {{5, 0, 0}, {10, 3, 4}});
    const SceneCells cells = cellsOfScene(made.scene);
    ASSERT_EQ(cells.report.overlaps, 1u) << textsOf(cells);
    EXPECT_LE(glm::length(cells.report.findings[0].place - glm::dvec3(5.5, 1.5, 2)), 1e-6);
    EXPECT_EQ(cells.report.holes, 2u) << "each is entered where the other ends";
    EXPECT_EQ(cells.space.outside, kNoCell);
}

TEST(SceneCells, StrayPortalsAreLeftOutAndTheirHolesFound) {
    const auto make = [](double at, const FlatRect& rect) {
        MarkedRooms made = twoRooms(glm::dmat4(1.0));
        made.portal(0, 1, 0, at, rect);
        return made;
    };
    for (const auto& [at, rect] : {std::pair{3.0, kDoor}, {6.0, FlatRect{{0, 11}, {2, 12}}}}) {
        MarkedRooms made = make(at, rect);
        const SceneCells cells = cellsOfScene(made.scene);
        EXPECT_EQ(cells.report.stray_portals, 1u) << textsOf(cells);
        EXPECT_EQ(cells.report.holes, 2u) << textsOf(cells);
        EXPECT_NEAR(cells.report.hole_area, 4, 1e-3);
    }
    MarkedRooms unknown = make(6, kDoor);
    unknown.scene.portals[0].cells[1] = ScenePortal::kNone;
    EXPECT_EQ(cellsOfScene(unknown.scene).report.stray_portals, 1u);
    MarkedRooms line = make(6, {{1, 1}, {1, 2}});
    EXPECT_EQ(cellsOfScene(line.scene).report.stray_portals, 1u);
    MarkedRooms bent = make(6, kDoor);
    bent.scene.portals[0].polygon[2].x += 0.05;
    const SceneCells cells = cellsOfScene(bent.scene);
    EXPECT_EQ(cells.report.bent_portals, 1u) << textsOf(cells);
    EXPECT_EQ(cells.report.stray_portals, 0u) << textsOf(cells);
}

// A portal smaller than the door's hole leaves a hole around it.
TEST(SceneCells, PortalsCoverNoMoreThanTheyAre) {
    MarkedRooms made;
    made.room(kHall, 2);
    made.room({{6, 0, 0}, {10, 3, 4}}, 1);
    made.wall(0, 6, {{0, 0}, {3, 4}}, -1, {kDoor});
    made.wall(0, 6, {{0, 0}, {3, 4}}, 1, {kDoor});
    made.cell("hall", kHall);
    made.cell("kitchen", {{6, 0, 0}, {10, 3, 4}});
    made.portal(0, 1, 0, 6, {{0, 1}, {2, 1.75}});
    const SceneCells cells = cellsOfScene(made.scene);
    EXPECT_EQ(cells.report.holes, 1u) << textsOf(cells);
    EXPECT_NEAR(cells.report.hole_area, 0.5, 1e-3);
}

TEST(SceneCells, DoorsThatStandElsewhereDoNotShut) {
    MarkedRooms made = twoRooms(glm::dmat4(1.0));
    const uint32_t portal = made.portal(0, 1, 0, 6, kDoor);
    made.wall(2, 2, {{1, 1}, {2, 2}}, 1);
    made.scene.portals[portal].door = static_cast<uint32_t>(made.scene.objects.size() - 1);
    const SceneCells cells = cellsOfScene(made.scene);
    EXPECT_EQ(cells.report.stray_doors, 1u) << textsOf(cells);
    EXPECT_TRUE(cells.space.doors.empty());
    made.scene.portals[portal].door = ScenePortal::kNone;
    made.scene.portals[portal].door_name = "not there";
    EXPECT_EQ(cellsOfScene(made.scene).report.stray_doors, 1u);
}

TEST(SceneCells, ManyHolesBecomeTheirHull) {
    MarkedRooms made;
    std::vector<FlatRect> holes;
    for (int i = 0; i < 10; ++i)
        for (int k = 0; k < 10; ++k) {
            const glm::dvec2 low(0.5 + 0.125 * i, 0.5 + 0.125 * k);
            holes.push_back({low, low + 0.0625});
        }
    made.room(kHall, 2);
    made.wall(0, 6, {{0, 0}, {3, 4}}, -1, holes);
    made.cell("hall", kHall);
    SceneCellSettings settings;
    settings.most_holes = 100;
    const SceneCells apart = cellsOfScene(made.scene, settings);
    EXPECT_EQ(apart.report.holes, 100u);
    EXPECT_EQ(apart.report.merged_faces, 0u);
    EXPECT_NEAR(apart.report.hole_area, 100.0 / 256, 1e-3);
    settings.most_holes = 99;
    const SceneCells one = cellsOfScene(made.scene, settings);
    ASSERT_EQ(one.report.holes, 1u);
    EXPECT_EQ(one.report.merged_faces, 1u);
    EXPECT_NEAR(one.report.hole_area, 100.0 / 256, 1e-3) << "of the holes themselves";
    ASSERT_EQ(one.space.graph.portals.size(), 1u);
    for (const FlatRect& hole : holes)
        EXPECT_GT(insideBy(one.space.graph, one.space.graph.portals[0],
                           made.placed(MarkedRooms::at(0, 6, hole.min.x, hole.max.y))),
                  0);
}

TEST(SceneCells, TrustedCellsAreAsTheyAreMarked) {
    MarkedRooms made;  // without any wall
    made.cell("hall", kHall);
    made.cell("kitchen", {{6, 0, 0}, {10, 3, 4}});
    made.cell("odd", {{10, 0, 0}, {12, 3, 4}});
    made.scene.cells[2].overhang = 1;
    made.portal(0, 1, 0, 6, kDoor);
    made.portal(1, 2, 0, 10, kDoor);
    SceneCellSettings settings;
    settings.trusted = true;
    const SceneCells cells = cellsOfScene(made.scene, settings);
    EXPECT_EQ(cells.report.holes, 0u);
    EXPECT_EQ(cells.report.no_cells, 1u);
    ASSERT_EQ(cells.space.graph.portals.size(), 2u);
    EXPECT_EQ(cells.space.graph.portals[1].cells[1], cells.space.outside);
}

TEST(SceneCells, ASceneWithoutCellsHasNone) {
    MarkedRooms made;
    made.room(kHall);
    const SceneCells cells = cellsOfScene(made.scene);
    EXPECT_EQ(cells.space.graph.cells, 0u);
    EXPECT_TRUE(cells.report.findings.empty());
}

// Its rooms are closed but for what its plan says; the air around it is open to the sky.
TEST(SceneCells, ABuildingHasNoHolesButToTheSky) {
    const Result<Scene> scene = makeProcedural("building:5:2");
    ASSERT_TRUE(scene.ok());
    const SceneCells cells = cellsOfScene(*scene);
    EXPECT_EQ(cells.report.holes, cells.report.findings.size()) << textsOf(cells);
    EXPECT_GT(cells.report.holes, 0u);
    for (const CellFinding& finding : cells.report.findings) {
        EXPECT_TRUE(cells.space.names[finding.cells[0]].starts_with("Outside")) << finding.text;
        EXPECT_EQ(finding.cells[1], kNoCell) << finding.text;
    }
    EXPECT_EQ(cells.space.graph.portals.size(), scene->portals.size() + cells.report.holes);
    EXPECT_EQ(cells.report.moved_faces, 0u);
    EXPECT_EQ(cells.report.passages, 0u);
}

}  // namespace
}  // namespace sightline
