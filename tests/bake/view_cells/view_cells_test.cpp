// View cells: no line from a cell comes to an object that the cell's row leaves out, in made rooms and real buildings.
// SPDX-License-Identifier: MIT
#include "sightline/bake/view_cells/view_cells.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "sightline/bake/bake.h"
#include "sightline/bake/soup/soup_scale.h"
#include "sightline/bake/view_cells/flat_hiders.h"
#include "sightline/base/random.h"
#include "sightline/base/thread_pool.h"
#include "sightline/tools/scene/procedural.h"
#include "tests/bake/aimed_points.h"
#include "tests/bake/far_things.h"
#include "tests/bake/marked/random_rooms.h"
#include "tests/bake/opaque_triangles.h"

namespace sightline {
using namespace bake;
using namespace tools;
namespace {

using namespace test;

/// A point on one of an object's triangles, often at its edge.
glm::dvec3 pointOn(const Scene& scene, const SceneObject& object, Random& random) {
    const Mesh& mesh = scene.meshes[object.mesh];
    const size_t t = random.below(mesh.triangles());
    double a = random.uniform(), b = random.uniform();
    if (a + b > 1) a = 1 - a, b = 1 - b;
    if (random.below(3) == 0) b = 0;
    const auto corner = [&](size_t c) { return glm::dvec3(mesh.positions[mesh.indices[3 * t + c]]); };
    const glm::dvec3 point = (1 - a - b) * corner(0) + a * corner(1) + b * corner(2);
    return glm::dvec3(object.transform * glm::dvec4(point, 1));
}

struct Judged {
    uint64_t hidden = 0, pairs = 0;
};

/// Looks from anywhere at points of objects that are said to be hidden from there.
/// @param hole  how wide holes may be that are shut; negative: as the coordinates say
void judge(const Scene& scene, const ViewCells& cells, int lines, Random& random, Judged& judged, double hole = -1) {
    const OpaqueTriangles truth(scene);
    if (hole < 0) hole = largestHole(opaqueTriangles(scene, *soupScaleOf(scene), -1, {}));
    for (int i = 0; i < lines; ++i) {
        const glm::dvec3 eye = pointIn(cells.tree.bounds, random);
        const uint32_t leaf = leafOf(cells.tree, eye);
        for (int k = 0; k < 4; ++k) {
            const auto object = static_cast<uint32_t>(random.below(scene.objects.size()));
            ++judged.pairs;
            if (cells.visible.at(leaf, object) || scene.meshes[scene.objects[object].mesh].triangles() == 0) continue;
            ++judged.hidden;
            const glm::dvec3 to = pointOn(scene, scene.objects[object], random);
            const double length = glm::distance(eye, to);
            ASSERT_TRUE(truth.meets(eye, (to - eye) / length, 0, length, hole, object))
                << "from (" << eye.x << ", " << eye.y << ", " << eye.z << ") object " << object << " is seen at ("
                << to.x << ", " << to.y << ", " << to.z << ")";
        }
    }
}

TEST(ViewCells, LeaveOutNothingThatALineComesTo) {
    Random random(7);
    Judged judged;
    for (int round = 0; round < 24; ++round) {
        const MarkedRooms made = randomRooms(random, round);
        ViewCellSettings settings;
        settings.most_cells = 200;
        settings.least_hidden = 0;
        settings.smallest_occluder = round % 2 ? -1 : 0.3;
        const ViewCells cells = viewCellsOf(made.scene, settings);
        ASSERT_GT(cells.tree.contents.size(), 100u);
        judge(made.scene, cells, 2000, random, judged);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(judged.hidden, judged.pairs / 20);
}

TEST(ViewCells, AreFinerWhereEyesAre) {
    Random random(9);
    const Scene scene = *makeProcedural("building:1:1");
    const Box3d bounds = worldBounds(scene);
    const Box3d part{bounds.min, bounds.min + 0.4 * bounds.size()};
    ViewCellSettings settings;
    settings.most_cells = 200;
    settings.least_hidden = 0;
    const auto cellsIn = [&](const ViewCells& cells) {
        const std::vector<Box3d> boxes = leafBoxes(cells.tree);
        return std::count_if(boxes.begin(), boxes.end(), [&](const Box3d& box) {
            const glm::dvec3 middle = box.center();
            return glm::all(glm::greaterThan(middle, part.min)) && glm::all(glm::lessThan(middle, part.max));
        });
    };
    const auto anywhere = cellsIn(viewCellsOf(scene, settings));
    for (int i = 0; i < 300; ++i) settings.eyes.push_back(pointIn(part, random));
    const ViewCells cells = viewCellsOf(scene, settings);
    EXPECT_GT(cellsIn(cells), 2 * anywhere);
    Judged judged;
    judge(scene, cells, 300, random, judged);
    EXPECT_GT(judged.hidden, 10u);
}

TEST(ViewCells, HoldInABuildingAndACity) {
    Random random(8);
    for (const char* name : {"building:1:1", "city:1:300"}) {
        SCOPED_TRACE(name);
        const Scene scene = *makeProcedural(name);
        ViewCellSettings settings;
        settings.most_cells = 100;
        settings.least_hidden = 0;
        const ViewCells cells = viewCellsOf(scene, settings);
        Judged judged;
        judge(scene, cells, 300, random, judged);
        EXPECT_GT(judged.hidden, 10u);
        EXPECT_FALSE(cells.walls.empty());
        // From outside of the scene all is seen.
        for (size_t object = 0; object < scene.objects.size(); ++object) EXPECT_TRUE(cells.visible.at(0, object));
        EXPECT_EQ(leafOf(cells.tree, glm::dvec3(1e9, 0, 0)), 0u);
    }
}

/// View cells whose rows portals have narrowed, as a bake makes them.
ViewCells narrowed(const Scene& scene, const ViewCellSettings& settings) {
    BakeCells cells = openToBake(scene, "narrowed");
    addViewCells(cells, scene, settings);
    Result<Baked> baked = bake::bake(std::move(cells), scene);
    EXPECT_TRUE(baked.ok());
    if (!baked) return {};
    ViewCells out = std::move(*baked->cells.views);
    for (size_t row = 0; row < out.visible.rows(); ++row)
        for (size_t place = 0; place < baked->objects.object_of.size(); ++place)
            if (!baked->view_rows.at(row, place)) out.visible.clear(row, baked->objects.object_of[place]);
    return out;
}

TEST(ViewCells, NarrowedByPortalsLeaveOutNothingThatALineComesTo) {
    Random random(6);
    Judged by_shadows, by_both;
    for (int round = 0; round < 16; ++round) {
        SCOPED_TRACE("round " + std::to_string(round));
        const MarkedRooms made = randomRooms(random, round);
        ViewCellSettings settings;
        settings.most_cells = 64;
        settings.least_hidden = 0;
        const ViewCells shadows = viewCellsOf(made.scene, settings), both = narrowed(made.scene, settings);
        ASSERT_EQ(both.visible.rows(), shadows.visible.rows());
        for (size_t row = 0; row < both.visible.rows(); ++row)
            for (size_t object = 0; object < both.visible.columns(); ++object) {
                by_shadows.hidden += !shadows.visible.at(row, object);
                by_both.hidden += !both.visible.at(row, object);
            }
        Judged judged;
        judge(made.scene, both, 4000, random, judged);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(by_both.hidden, by_shadows.hidden + by_shadows.hidden / 25);
}

/// A cell before a wall sees through its window alone, and not what is behind the wall.
TEST(ViewCells, OfARoomSeeLittleThroughASmallWindow) {
    MarkedRooms made;
    const FlatRect section{{0, 0}, {3, 4}}, window{{1.4, 1.9}, {1.6, 2.1}};
    made.room({{0, 0, 0}, {4, 3, 4}}, 2);
    made.wall(0, 4, section, -1, {window});
    made.room({{4, window.min.x, window.min.y}, {4.25, window.max.x, window.max.y}}, 3);
    made.wall(0, 4.25, section, 1, {window});
    made.room({{4.25, 0, 0}, {8.25, 3, 4}}, 1);
    const auto first = static_cast<uint32_t>(made.scene.objects.size());
    Random random(7);
    for (int i = 0; i < 60; ++i) {
        const double y = random.uniform(0.1, 2.8), z = random.uniform(0.1, 3.8);
        made.wall(0, random.uniform(4.5, 8), {{y, z}, {y + 0.1, z + 0.1}}, -1);
    }
    ViewCellSettings settings;
    settings.most_cells = 256;
    settings.least_hidden = 0;
    const ViewCells cells = narrowed(made.scene, settings);
    const std::vector<Box3d> boxes = leafBoxes(cells.tree);
    double seen = 0, asked = 0;
    for (uint32_t leaf = 1; leaf < boxes.size(); ++leaf) {
        const glm::dvec3 middle = boxes[leaf].center();
        if (!contains({{0, 0, 0}, {4, 3, 4}}, middle) || boxes[leaf].size().x < 0.1) continue;
        for (uint32_t object = first; object < made.scene.objects.size(); ++object, ++asked)
            seen += cells.visible.at(leaf, object);
    }
    EXPECT_GT(asked, 1000);
    EXPECT_GT(seen, 0);
    EXPECT_LT(seen, 0.3 * asked);
    RecordProperty("share", std::to_string(seen / asked));
}

TEST(ViewCells, AreTheSameWithAnyThreads) {
    const Scene scene = *makeProcedural("building:1:1");
    ViewCellSettings settings;
    settings.most_cells = 48;
    settings.least_hidden = 0;
    const ViewCells alone = viewCellsOf(scene, settings);
    ThreadPool pool(3);
    settings.jobs = &pool;
    const ViewCells shared = viewCellsOf(scene, settings);
    EXPECT_EQ(alone.visible, shared.visible);
    EXPECT_EQ(alone.walls, shared.walls);
    EXPECT_EQ(alone.tree.contents.size(), shared.tree.contents.size());
}

TEST(ViewCells, ABudgetLeavesMoreVisible) {
    const Scene scene = *makeProcedural("building:1:1");
    ViewCellSettings settings;
    settings.most_cells = 64;
    settings.budget = 100;
    settings.least_hidden = 0;
    const ViewCells cells = viewCellsOf(scene, settings);
    EXPECT_GT(cells.over_budget, 1u);
    Random random(9);
    Judged judged;
    judge(scene, cells, 100, random, judged);
}

TEST(ViewCells, OfNothingThereAreNone) {
    EXPECT_TRUE(viewCellsOf(Scene()).tree.contents.empty());
    ViewCellSettings settings;
    settings.smallest_occluder = 1e6;
    EXPECT_TRUE(viewCellsOf(*makeProcedural("building:1:1"), settings).tree.contents.empty());
}

TEST(ViewCells, ThatHideTooLittleAreLeftOut) {
    const Scene scene = *makeProcedural("city:1:100");
    ViewCellSettings settings;
    settings.most_cells = 64;
    settings.least_hidden = 1;
    const ViewCells cells = viewCellsOf(scene, settings);
    EXPECT_TRUE(cells.tree.contents.empty() && cells.walls.empty());
    EXPECT_EQ(cells.visible.rows(), 0u);
    EXPECT_GE(cells.hidden, 0);
    EXPECT_LT(cells.hidden, 1);
}

TEST(ViewCells, HideNothingForWhatLiesFarOff) {
    Random random(12);
    for (const FarThing what : kFarThings)
        for (const double far : {1e3, 1e5, 1e7}) {
            SCOPED_TRACE("far thing " + std::to_string(int(what)) + " at " + std::to_string(far));
            MarkedRooms made = randomRooms(random, 0);
            const Box3d near = worldBounds(made.scene);
            addFarThing(made, what, far, random);
            ViewCellSettings settings;
            settings.most_cells = 64;
            settings.least_hidden = 0;
            if (what == FarThing::kChain) settings.smallest_occluder = settings.smallest_cell = 0.1;
            const ViewCells cells = viewCellsOf(made.scene, settings);
            ASSERT_FALSE(cells.tree.contents.empty());
            Judged judged;
            judge(made.scene, cells, 4000, random, judged, 1e-4);
            if (HasFatalFailure()) return;
            if (what == FarThing::kChain) continue;  // its cells are where eyes are not
            EXPECT_LT(glm::length(cells.tree.bounds.size()), 2 * glm::length(near.size()));
            EXPECT_GT(judged.hidden, 0u);
        }
}

/// Walls with windows and doors of any shape: hiders are covered, and most of what could hide does.
TEST(FlatHiders, AreCoveredByFrontsAndCoverMostOfTheWalls) {
    Random random(10);
    for (int round = 0; round < 24; ++round) {
        const MarkedRooms made = randomRooms(random, round);
        FlatHiderSettings settings;
        settings.least_area = 0.04;
        const SoupWalls walls =
            sheetsOf(opaqueTriangles(made.scene, *soupScaleOf(made.scene), -1, {}), settings.least_area);
        const double hole = largestHole(walls.triangles);
        const std::vector<FlatHider> hiders = flatHiders(walls, settings);
        ASSERT_GT(hiders.size(), 10u);
        const OpaqueTriangles truth(made.scene);
        double area = 0, whole = 0;
        for (const WallSheet& sheet : walls.sheets) whole += sheet.largest;
        for (const FlatHider& hider : hiders) {
            area += hider.area;
            const glm::dvec3 normal(hider.plane);
            for (int k = 0; k < 40; ++k) {
                glm::dvec3 point(0.0);
                double weights = 0;
                for (const glm::dvec3& corner : hider.corners) {
                    const double weight = std::pow(random.uniform(), 4);
                    point += weight * corner;
                    weights += weight;
                }
                point /= weights;
                ASSERT_TRUE(truth.meets(point + normal, -normal, 1 - 2 * hole, 1 + 2 * hole, hole))
                    << "round " << round;
            }
        }
        EXPECT_GT(area, 0.6 * whole);
    }
}

}  // namespace
}  // namespace sightline
