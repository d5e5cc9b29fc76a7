// Cells of any polygons: a sight line that meets no front goes from leaf to leaf by portals, and slits are seen through.
// SPDX-License-Identifier: MIT
#include "sightline/bake/soup/soup_cells.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sightline/bake/soup/soup_scale.h"
#include "sightline/base/random.h"
#include "sightline/cells/portal_graph.h"
#include "sightline/tools/import/scene_file.h"
#include "sightline/tools/scene/procedural.h"
#include "sightline/tools/truth/rays.h"
#include "tests/bake/aimed_points.h"
#include "tests/bake/any_triangles.h"
#include "tests/bake/far_things.h"
#include "tests/bake/marked/random_rooms.h"
#include "tests/bake/opaque_triangles.h"
#include "tests/bake/soup/slit_room.h"
#include "tests/tools/truth/test_scenes.h"

namespace sightline {
using namespace bake;
using namespace tools;
namespace {

using namespace test;

/// Where a line goes from one leaf into another.
struct Crossing {
    uint32_t from = 0, to = 0;
    double at = 0;       ///< along the line
    double grazing = 0;  ///< the cosine between the line and the plane's normal
};

/// The leaves that a line passes, by the tree's planes alone.
class LineWalk {
public:
    LineWalk(const CellSpace& space, const glm::dvec3& from, const glm::dvec3& along, double length)
        : space_(space), from_(from), along_(along) {
        down(0, 0, length, 1);
    }
    const std::vector<Crossing>& crossings() const { return crossings_; }

private:
    void down(uint32_t child, double begin, double end, double grazing) {
        if ((child & LeafTreeNode::kLeaf) != 0) {
            const uint32_t leaf = child & ~LeafTreeNode::kLeaf;
            if (any_ && leaf != leaf_) crossings_.push_back({leaf_, leaf, begin, grazing_});
            leaf_ = leaf;
            any_ = true;
            return;
        }
        const LeafTreeNode& node = space_.tree.nodes[child];
        const double height = glm::dot(glm::dvec3(node.plane), from_) + node.plane.w;
        const double rises = glm::dot(glm::dvec3(node.plane), along_);
        const double at = rises != 0 ? -height / rises : -1;
        const bool front = height + rises * (begin + end) / 2 >= 0;
        if (rises == 0 || at <= begin || at >= end) return down(node.child[front], begin, end, grazing);
        down(node.child[rises < 0], begin, at, grazing);
        grazing_ = std::abs(rises);
        down(node.child[rises > 0], at, end, grazing);
    }

    const CellSpace& space_;
    glm::dvec3 from_, along_;
    std::vector<Crossing> crossings_;
    uint32_t leaf_ = 0;
    double grazing_ = 1;
    bool any_ = false;
};

/// Whether a portal comes within `room` of a point: the outline goes round it, or passes by. Lines through edges would say
/// less: an edge may be as short as rounding, and point anywhere.
bool holds(const CellGraph& graph, const CellPortal& portal, const glm::dvec3& point, double room) {
    const auto outline = graph.outline(portal);
    const glm::dvec3 normal(portal.plane);
    const double height = glm::dot(normal, point) + portal.plane.w;
    if (std::abs(height) > room) return false;
    const glm::dvec3 foot = point - height * normal;
    double turn = 0;
    for (size_t i = 0; i < outline.size(); ++i) {
        const glm::dvec3 from = outline[i] - foot, to = outline[(i + 1) % outline.size()] - foot, edge = to - from;
        const double squared = glm::dot(edge, edge);
        const double nearest = squared > 0 ? std::clamp(-glm::dot(from, edge) / squared, 0.0, 1.0) : 0;
        if (glm::length(from + nearest * edge) <= room) return true;
        turn += std::atan2(glm::dot(normal, glm::cross(from, to)), glm::dot(from, to));
    }
    return std::abs(turn) > 3;
}

/// A portal, widened as a walk widens it, leads on there.
bool leads(const CellSpace& space, const Crossing& crossing, const glm::dvec3& point) {
    const auto cellOf = [&](uint32_t leaf) { return space.graph.cell_of_leaf[leaf]; };
    return std::any_of(space.graph.portals.begin(), space.graph.portals.end(), [&](const CellPortal& portal) {
        const bool there = portal.cells[0] == cellOf(crossing.from) && portal.cells[1] == cellOf(crossing.to);
        const bool back = portal.cells[1] == cellOf(crossing.from) && portal.cells[0] == cellOf(crossing.to);
        return (there || (back && !portal.one_way)) && holds(space.graph, portal, point, space.tolerance);
    });
}

/// How near a point is to the planes of the tree, but for the nearest.
double secondPlane(const LeafTree& tree, const glm::dvec3& point) {
    double nearest = INFINITY, second = INFINITY;
    for (const LeafTreeNode& node : tree.nodes) {
        const double height = std::abs(glm::dot(glm::dvec3(node.plane), point) + node.plane.w);
        if (height < nearest) second = nearest, nearest = height;
        else second = std::min(second, height);
    }
    return second;
}

struct Counts {
    uint64_t lines = 0, crossings = 0, walls = 0;
};

/// Shoots lines from anywhere to anywhere, half of them aimed: at the edges of portals and a little beside them.
void shoot(const Scene& scene, const SoupCells& cells, int lines, Random& random, Counts& counts) {
    const OpaqueTriangles truth(scene);
    const CellSpace& space = cells.space;
    Box3d box = worldBounds(scene);
    const double hole = cells.report.smallest_hole;
    for (int i = 0; i < lines; ++i) {
        glm::dvec3 from, target;
        for (int axis = 0; axis < 3; ++axis) {
            from[axis] = random.uniform(box.min[axis], box.max[axis]);
            target[axis] = random.uniform(box.min[axis], box.max[axis]);
        }
        if (i % 2 && !space.graph.portals.empty()) target = from + 2.0 * (pointAtPortal(space.graph, random) - from);
        const double length = glm::distance(from, target);
        if (!(length > 1e-6) || !std::isfinite(length)) continue;
        const glm::dvec3 along = (target - from) / length;
        ++counts.lines;
        const LineWalk walk(space, from, along, length);
        for (const Crossing& crossing : walk.crossings()) {
            const glm::dvec3 point = from + crossing.at * along;
            if (!contains(space.tree.bounds, point)) break;  // beyond them nothing is drawn
            if (crossing.grazing < 0.05) break;              // along a wall: within its thickness nothing is said
            const double reach = 2 * hole / crossing.grazing;
            if (truth.meets(from, along, 0, crossing.at + reach, hole)) {
                ++counts.walls;
                break;
            }
            ++counts.crossings;
            // What is near a second plane may belong to its other side.
            if (secondPlane(space.tree, point) < 8 * hole) continue;
            ASSERT_TRUE(leads(space, crossing, point))
                << "from (" << from.x << ", " << from.y << ", " << from.z << ") to (" << target.x << ", " << target.y
                << ", " << target.z << "): no portal at " << crossing.at << " of " << length;
        }
    }
}

TEST(SoupCells, LinesThatMeetNoFrontPassByPortals) {
    Random random(1);
    Counts counts;
    uint64_t one_way = 0, closed = 0, cells_made = 0;
    for (int round = 0; round < 40; ++round) {
        SCOPED_TRACE("round " + std::to_string(round));
        const MarkedRooms made = randomRooms(random, round);
        SoupCellSettings settings;
        settings.smallest_occluder = round % 4 == 0 ? 0.1 : -1;
        const SoupCells cells = cellsOfSoup(made.scene, settings);
        ASSERT_GT(cells.space.graph.cells, 1u);
        one_way += cells.report.one_way;
        closed += cells.report.closed;
        cells_made += cells.space.graph.cells;
        shoot(made.scene, cells, 4000, random, counts);
        if (HasFatalFailure()) return;
    }
    // None of it is there for nothing.
    EXPECT_GT(counts.lines, 100000u);
    EXPECT_GT(counts.crossings, 100000u);
    EXPECT_GT(counts.walls, 30000u);
    EXPECT_GT(one_way, 1000u);
    EXPECT_GT(closed, 10u);
    EXPECT_GT(cells_made, 400u);
}

TEST(SoupCells, HoldsFarFromTheOrigin) {
    Random random(6);
    Counts counts;
    for (int round = 0; round < 12; ++round) {
        SCOPED_TRACE("round " + std::to_string(round));
        MarkedRooms made = randomRooms(random, 0);
        const glm::dmat4 place = randomPlace(random, std::pow(10, 3 + round % 6));
        for (SceneObject& object : made.scene.objects) object.transform = place;
        const SoupCells cells = cellsOfSoup(made.scene);
        ASSERT_GT(cells.space.graph.cells, 1u);
        shoot(made.scene, cells, 2000, random, counts);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(counts.crossings, 20000u);
    EXPECT_GT(counts.walls, 5000u);
}

// Triangles anywhere: through one another, turned round, one-sided or not, large and small.
TEST(SoupCells, HoldsOfAnyTriangles) {
    Random random(2);
    Counts counts;
    for (int round = 0; round < 40; ++round) {
        SCOPED_TRACE("round " + std::to_string(round));
        const MarkedRooms made = anyTriangles(random);
        SoupCellSettings settings;
        settings.smallest_occluder = std::pow(10, random.uniform(-2, 0.5));
        const SoupCells cells = cellsOfSoup(made.scene, settings);
        if (cells.space.graph.cells == 0) continue;
        shoot(made.scene, cells, 2000, random, counts);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(counts.crossings, 50000u);
    EXPECT_GT(counts.walls, 10000u);
}

/// Lines through the middle of a slit, from hall to hall, both ways. Where they cross the wall there must be a portal.
/// @returns how many did
int lookThroughSlit(const MarkedRooms& made, size_t half_of, const SoupCells& cells, int lines, Random& random) {
    const OpaqueTriangles truth(made.scene);
    const Mesh &half = made.scene.meshes[half_of], &other = made.scene.meshes[half_of - 2];
    int seen = 0;
    for (int line = 0; line < lines; ++line) {
        glm::dvec3 from(random.uniform(1, 24), random.uniform(0.2, 2.8), random.uniform(1, 19));
        glm::dvec3 to(random.uniform(26, 49), random.uniform(0.2, 2.8), random.uniform(1, 19));
        if (line % 2) std::swap(from, to);
        const double part = random.uniform(0.3, 0.7);
        const glm::dvec3 aim = glm::mix(0.5 * (glm::dvec3(half.positions[0]) + glm::dvec3(other.positions[0])),
                                        0.5 * (glm::dvec3(half.positions[1]) + glm::dvec3(other.positions[1])), part);
        const glm::dvec3 along = glm::normalize(aim - from);
        const double length = glm::distance(from, aim) * 1.5;
        if (truth.meets(from, along, 0, glm::distance(from, aim) + 0.1, 0)) continue;
        const LineWalk walk(cells.space, from, along, length);
        for (const Crossing& crossing : walk.crossings()) {
            const glm::dvec3 point = from + crossing.at * along;
            if (std::abs(point.x - 25) > 1e-6) continue;
            ++seen;
            EXPECT_TRUE(leads(cells.space, crossing, point));
            if (::testing::Test::HasFailure()) return seen;
        }
    }
    return seen;
}

TEST(SoupCells, SlitsOf10And1AndATenthOfAMillimetreAreSeenThrough) {
    Random random(3);
    for (const double width : {1e-2, 1e-3, 1e-4})
        for (int round = 0; round < 12; ++round) {
            SCOPED_TRACE("slit of " + std::to_string(width) + ", round " + std::to_string(round));
            const MarkedRooms made = slitRoom(random, width, round % 2 ? random.uniform(0, 3.1) : 0);
            EXPECT_GT(lookThroughSlit(made, made.scene.meshes.size() - 1, cellsOfSoup(made.scene), 2000, random), 20);
            if (HasFailure()) return;
        }
}

TEST(SoupCells, SlitsAreSeenThroughWhateverLiesFarOff) {
    Random random(11);
    for (const FarThing what : kFarThings)
        for (const double far : {4e3, 1e4, 1e5, 1e6, 1e7})
            for (const double width : {1e-3, 1e-2, 0.2}) {
                SCOPED_TRACE("far thing " + std::to_string(int(what)) + " at " + std::to_string(far) + ", slit of " +
                             std::to_string(width));
                MarkedRooms made = slitRoom(random, width, random.uniform(0, 3.1));
                const size_t half = made.scene.meshes.size() - 1;
                addFarThing(made, what, far, random);
                SoupCellSettings settings;
                settings.smallest_occluder = what == FarThing::kChain ? 0.7 : -1;
                const SoupCells cells = cellsOfSoup(made.scene, settings);
                EXPECT_EQ(cells.report.aside.empty(), what == FarThing::kChain);
                EXPECT_GT(lookThroughSlit(made, half, cells, 2000, random), 20);
                if (HasFailure()) return;
            }
}

// The core is as large as a chain of triangles, each beyond the one before. The room's walls are as exact as without it.
TEST(SoupCells, WallsAreRoundedByTheirOwnCoordinates) {
    Random random(13);
    for (const double far : {1e4, 1e7, 1e9}) {
        SCOPED_TRACE(far);
        MarkedRooms made;
        made.room({{0, 0, 0}, {16, 16, 16}});
        const size_t walls = made.scene.objects.size();
        addFarThing(made, FarThing::kChain, far, random);
        const std::optional<SoupScale> scale = soupScaleOf(made.scene);
        ASSERT_TRUE(scale && scale->core.isWhole());
        const double doubles = 0x1p-48 * scale->diagonal;
        for (const WallTriangle& triangle : opaqueTriangles(made.scene, *scale, 0, {}))
            if (triangle.object < walls) { EXPECT_LE(triangle.rounding, std::max(0x1p-40 * 16, doubles)); }
        for (const WallTriangle& triangle : opaqueTriangles(made.scene, *scale, -1, {}))
            if (triangle.object < walls) { EXPECT_LE(triangle.rounding, std::max(0x1p-22 * 16, doubles)); }
    }
}

// A room whose walls are drawn from inside alone is shut from there, and open from outside.
TEST(SoupCells, AWallIsShutForThoseWhoSeeItsFront) {
    MarkedRooms made;
    made.room({{0, 0, 0}, {6, 3, 4}});
    const SoupCells cells = cellsOfSoup(made.scene);
    const CellSpace& space = cells.space;
    EXPECT_EQ(space.graph.cells, 7u);
    EXPECT_EQ(cells.report.walls.size(), 6u);
    const PortalGraph graph(space);
    Array<uint32_t> inside;
    const glm::dvec3 middle(3, 1.5, 2);
    ASSERT_TRUE(graph.cellsAround({&middle, 1}, 0, inside));
    ASSERT_EQ(inside.size(), 1u);
    EXPECT_TRUE(graph.portalsFrom(inside[0]).empty()) << "nothing leads out";
    size_t into = 0;
    for (uint32_t cell = 0; cell < graph.cells(); ++cell)
        for (const DirectedPortal& portal : graph.portalsFrom(cell)) into += portal.to == inside[0];
    EXPECT_EQ(into, 6u) << "from outside its walls are not drawn";
    EXPECT_EQ(cells.report.one_way, 6u);
}

TEST(SoupCells, OfNothingThereAreNoCells) {
    EXPECT_EQ(cellsOfSoup(Scene()).space.graph.cells, 0u);
    MarkedRooms made;
    made.wall(0, 0, {{0, 0}, {1, 1}}, 1);
    SoupCellSettings settings;
    settings.smallest_occluder = 10;
    EXPECT_EQ(cellsOfSoup(made.scene, settings).space.graph.cells, 0u) << "nothing is large enough";
    settings.smallest_occluder = 0;
    EXPECT_EQ(cellsOfSoup(made.scene, settings).space.graph.cells, 2u);
    settings.movable = {0};
    EXPECT_EQ(cellsOfSoup(made.scene, settings).space.graph.cells, 0u) << "what moves hides nothing";
    made.scene.objects[0].transform[3][0] = INFINITY;
    EXPECT_EQ(cellsOfSoup(made.scene).space.graph.cells, 0u);
}

// With places to look from, walls are taken as large as they may be.
TEST(SoupCells, TakesLargerWallsIfHardlyMoreIsSeen) {
    Random random(5);
    size_t coarser = 0;
    for (int round = 0; round < 12; ++round) {
        SCOPED_TRACE("round " + std::to_string(round));
        const MarkedRooms made = randomRooms(random, 3 * round);  // where they were made
        SoupCellSettings settings;
        settings.eyes = {{1, 1.5, 2}, {4, 1.5, 2}, {9, 2, 1}};
        const SoupCells cells = cellsOfSoup(made.scene, settings);
        const std::vector<SoupTrial>& trials = cells.report.trials;
        ASSERT_FALSE(trials.empty());
        EXPECT_EQ(cells.report.objects, made.scene.objects.size());
        size_t taken = trials.size();
        for (size_t i = 0; i < trials.size(); ++i) {
            EXPECT_EQ(trials[i].smallest_occluder, std::ldexp(trials[0].smallest_occluder, int(i)));
            EXPECT_LE(trials[i].objects_seen, double(made.scene.objects.size()));
            EXPECT_GT(trials[i].objects_seen, 0);
            if (trials[i].smallest_occluder == cells.report.smallest_occluder) taken = i;
        }
        ASSERT_LT(taken, trials.size());
        EXPECT_EQ(trials[taken].cells, cells.space.graph.cells);
        EXPECT_EQ(trials[taken].portals, cells.space.graph.portals.size());
        EXPECT_LE(trials[taken].objects_seen, 1.2 * trials[0].objects_seen);
        for (size_t i = taken + 1; i < trials.size(); ++i)
            EXPECT_GT(trials[i].objects_seen, 1.2 * trials[0].objects_seen);
        coarser += taken > 0;
        SoupCellSettings same;
        same.smallest_occluder = cells.report.smallest_occluder;
        EXPECT_EQ(cellsOfSoup(made.scene, same).space.graph.points, cells.space.graph.points);
    }
    EXPECT_GT(coarser, 0u);
}

TEST(SoupCells, MostCellsEndTheDivision) {
    Random random(4);
    const MarkedRooms made = randomRooms(random, 0);
    SoupCellSettings settings;
    const SoupCells all = cellsOfSoup(made.scene, settings);
    EXPECT_FALSE(all.report.full);
    settings.most_cells = 5;
    const SoupCells few = cellsOfSoup(made.scene, settings);
    EXPECT_TRUE(few.report.full);
    EXPECT_EQ(few.space.graph.cells, 5u);
    Counts counts;
    shoot(made.scene, few, 2000, random, counts);
}

// Far apart, so that nothing is nearly a wall of all and space is halved; halves end where boxes do.
TEST(SoupCells, WallsInThePlanesOfHalvesAreShut) {
    Scene scene = emptyScene();
    const uint32_t box = addBox(scene, glm::vec3(0.5f));
    constexpr int kSide = 6;
    constexpr double kApart = 9;
    std::vector<glm::dvec3> middles;
    for (int i = 0; i < kSide * kSide * kSide; ++i) {
        middles.push_back(kApart * glm::dvec3(i % kSide, i / kSide % kSide, i / kSide / kSide));
        addObject(scene, box, moved(middles.back()));
    }
    SoupCellSettings settings;
    settings.smallest_occluder = 0.5;
    const CellSpace space = cellsOfSoup(scene, settings).space;
    ASSERT_GT(space.graph.cells, 100u);
    uint64_t open = 0;
    for (const glm::dvec3& middle : middles)
        for (int axis = 0; axis < 3; ++axis)
            for (const double side : {-1.0, 1.0}) {
                glm::dvec3 on = middle + glm::dvec3(0.01, 0.02, 0.03), outward(0.0);
                on[axis] = middle[axis] + 0.5 * side;
                outward[axis] = side;
                const uint32_t before = space.graph.cell_of_leaf[leafOf(space.tree, on + 0.1 * outward)];
                const uint32_t behind = space.graph.cell_of_leaf[leafOf(space.tree, on - 0.1 * outward)];
                ASSERT_NE(before, behind);
                for (const CellPortal& portal : space.graph.portals) {
                    const bool leads = (portal.cells[0] == before && portal.cells[1] == behind) ||
                                       (!portal.one_way && portal.cells[1] == before && portal.cells[0] == behind);
                    open += leads && holds(space.graph, portal, on, 0.01);
                }
            }
    EXPECT_EQ(open, 0u);
}

}  // namespace
}  // namespace sightline
