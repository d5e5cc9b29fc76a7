// The verb bake: buildings and maps become files that hold their cells.
// SPDX-License-Identifier: MIT
#include <chrono>
#include <filesystem>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "sightline/base/random.h"
#include "sightline/bsp/tree_portals.h"
#include "sightline/tools/import/quake/map_source.h"
#include "sightline/tools/import/quake/quake_scene.h"
#include "sightline/visfile/visibility_file.h"
#include "tests/cli/tool.h"
#include "tests/tools/import/archive_files.h"
#include "tests/tools/import/map_files.h"

namespace sightline {
using namespace tools;
namespace {

using namespace test;

bool isIn(const PlacedObjects& objects, size_t object, uint32_t cell) {
    const PlacedNumbers<uint32_t> cells = objects.cells(object);
    for (size_t i = 0; i < cells.size(); ++i)
        if (cells[i] == cell) return true;
    return objects.seenFromEverywhere(object);
}

class Bake : public Tool {
protected:
    json bake(const std::string& arguments) const { return answer("bake " + arguments); }
    json info(const std::string& file) const { return answer("info " + file); }
};

// A building whose marks are not looked at, and a city that never had any.
TEST_F(Bake, AScenesOwnWallsAreCells) {
    for (const std::string scene : {"building:1:1", "city:1:300"}) {
        const std::string walls = scene[0] == 'b' ? " --cells walls" : " --smallest-occluder 2";
        const json out = bake(scene + walls + " -o own.see --threads 1");
        EXPECT_EQ(out["cells_are"], "of its own walls") << scene;
        EXPECT_GT(out["cells"], 50) << scene;
        EXPECT_GT(out["walls"]["one_way"], 100) << scene;
        EXPECT_EQ(out["rows"], 0) << scene;
        EXPECT_EQ(out["walls"]["trials"].empty(), scene[0] == 'c') << "a size that was asked for is not tried";
        const std::string bytes = read(path("own.see"));
        bake(scene + walls + " -o again.see --threads 3");
        EXPECT_EQ(read(path("again.see")), bytes) << "the same bytes for any number of threads";
        const json told = info("own.see");
        EXPECT_EQ(told["places"]["cells"], out["cells"]) << scene;
        EXPECT_EQ(told["places"]["cells_are"], "leaves of a tree") << scene;
        EXPECT_EQ(told["places"]["portals"], out["portals"]) << scene;
        const std::string views = "verify " + scene + " --path scatter --frames 6 --size 640x360 --rays 20000";
        const json plain = answer(views), divided = answer(views + " --visibility own.see");
        EXPECT_EQ(divided["verification"]["false_culls"], 0) << scene;
        EXPECT_LE(divided["verification"]["reported"], plain["verification"]["reported"]) << scene;
        uint64_t culled = 0;
        for (const json& frame : divided["frames"])
            for (const json& stage : frame["stages"])
                if (stage["name"] == "portals") culled += stage["culled"].get<uint64_t>();
        EXPECT_GT(culled, 100u) << scene;
    }
    const Outcome text = succeed("bake building:1:1 --cells walls");
    EXPECT_NE(text.out.find("faces between cells are shut"), std::string::npos) << text.out;
    EXPECT_NE(text.out.find(", taken\n"), std::string::npos) << text.out;
    EXPECT_EQ(bake("building:1:1 --cells walls --smallest-occluder 2")["walls"]["smallest_occluder"], 2);
}

TEST_F(Bake, WhatMovesHidesNothing) {
    const std::string scene = "bake building:1:1 --cells walls --smallest-occluder 0.3";
    const auto wallsOf = [&](const std::string& moves) {
        const json out = answer(scene + moves + " -o moves.see");
        EXPECT_EQ(answer("verify building:1:1 --path scatter --frames 3 --size 320x180 --rays 20000 --visibility "
                         "moves.see")["verification"]["false_culls"],
                  0);
        const std::string bytes = read(path("moves.see"));
        const Result<VisibilityFile> file = VisibilityFile::open(bytes, "moves.see");
        EXPECT_TRUE(file.ok()) << file.error().message;
        std::set<uint64_t> walls;
        for (size_t i = 0; file.ok() && i < file->objects().size(); ++i)
            if (file->objects().isWall(i)) walls.insert(file->objects().key(i));
        return std::pair(out["objects"]["movable"].get<size_t>(), walls);
    };
    const auto [doors, walls] = wallsOf("");
    EXPECT_GT(doors, 10u) << "the leaves of its doors";
    ASSERT_GT(walls.size(), 10u);
    const std::string one = std::to_string(*walls.begin());
    const auto [with_one, other] = wallsOf(" --moves " + one);
    EXPECT_EQ(with_one, doors + 1);
    EXPECT_EQ(other.count(*walls.begin()), 0u);
    const auto [many, rest] = wallsOf(" --moves WALL --moves " + one);
    EXPECT_GT(many, with_one);
    EXPECT_LT(rest.size(), walls.size());
    EXPECT_NE(succeed(scene + " --moves " + one).out.find(" may move, and hide nothing\n"), std::string::npos);
    expectError(scene + " --moves no-such", 2, "--moves no-such: ");
}

TEST_F(Bake, GapsBetweenWallsAreListed) {
    const json walls = bake("building:1:1 --cells walls --smallest-occluder 0.3 --widest-gap 0.05")["walls"];
    EXPECT_EQ(walls["widest_gap"], 0.05);
    ASSERT_GT(walls["gaps"].size(), 8u);
    for (const json& gap : walls["gaps"]) {
        EXPECT_GT(gap["width"], 0);
        EXPECT_LE(gap["width"], 0.05);
        EXPECT_NE(gap["from"], gap["to"]);
        ASSERT_EQ(gap["objects"].size(), 2u);
        EXPECT_NE(gap["objects"][0]["name"], "");
    }
    EXPECT_TRUE(bake("building:1:1 --cells walls --smallest-occluder 0.3 --widest-gap 0")["walls"]["gaps"].empty());
    const Outcome text = succeed("bake building:1:1 --cells walls --smallest-occluder 0.3 --widest-gap 0.05");
    EXPECT_NE(text.out.find("gaps between walls, up to 0.05 wide: "), std::string::npos) << text.out;
    EXPECT_NE(text.out.find(" smaller ones (--json lists them)"), std::string::npos) << text.out;
}

// All of space as one cell, and boxes of it with a row each.
TEST_F(Bake, ViewCellsHaveRowsOfObjects) {
    const json out =
        bake("building:1:1 --cells none --view-cells 256 -o views.see --threads 1 --report page --height 2");
    EXPECT_NE(read(path("page/index.html")).find("cut at the height 2"), std::string::npos);
    EXPECT_EQ(json::parse(read(path("page/bake.json")))["view_cells"]["count"], 256);
    EXPECT_EQ(out["cells"], 1);
    EXPECT_EQ(out["portals"], 0);
    EXPECT_EQ(out["cells_are"], "all of space");
    EXPECT_EQ(out["view_cells"]["count"], 256);
    EXPECT_GT(out["view_cells"]["used"], 50);
    EXPECT_GT(out["view_cells"]["hidden"], 0.25);
    const std::string bytes = read(path("views.see"));
    bake("building:1:1 --cells none --view-cells 256 -o again.see --threads 3");
    EXPECT_EQ(read(path("again.see")), bytes) << "the same bytes for any number of threads";
    EXPECT_EQ(info("views.see")["places"]["view_cells"], 256);
    const json judged =
        answer("verify building:1:1 --path scatter --frames 6 --size 640x360 --rays 20000 --visibility views.see");
    EXPECT_EQ(judged["verification"]["false_culls"], 0);
    uint64_t culled = 0;
    for (const json& frame : judged["frames"])
        for (const json& stage : frame["stages"])
            if (stage["name"] == "pvs") culled += stage["culled"].get<uint64_t>();
    EXPECT_GT(culled, 100u);
    const Outcome text = succeed("bake building:1:1 --cells none --view-cells 192 --rays 1000 --json rays.json");
    EXPECT_NE(text.out.find("view cells: "), std::string::npos) << text.out;
    EXPECT_NE(text.out.find(" of what 1,000 rays see"), std::string::npos) << text.out;
    const json looked = json::parse(read(path("rays.json")))["view_cells"];
    EXPECT_GT(looked["witnessed_pairs"], 64);
    EXPECT_LT(looked["witnessed_pairs"], looked["visible_pairs"]);
    EXPECT_GT(looked["median_looseness"], 1);
    expectError("bake building:1:1 --rays 5", 2, "--rays goes with --view-cells");
    const json few = bake("city:1:50 --view-cells 8 -o city.see");
    EXPECT_EQ(few["view_cells"]["count"], 0) << "from so much room too little is hidden";
    EXPECT_EQ(info("city.see")["places"]["view_cells"], 0);
}

// A bake of view cells that is ended goes on to the same bytes, whatever it was doing.
TEST_F(Bake, InterruptedViewCellsGoOnToTheSameBytes) {
    const std::string verb = "bake building:1:1 --cells none --view-cells 128 --threads 1 -o ";
    const auto start = std::chrono::steady_clock::now();
    ASSERT_EQ(run(verb + "whole.see").exit_code, 0);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    bool left = false;
    for (const double part : {0.2, 0.35, 0.5, 0.65, 0.8}) {
        std::filesystem::remove(path("x.see"));
        const Outcome outcome =
            run(verb + "x.see & sleep " + std::to_string(part * seconds) + "; kill -TERM $! ; wait $!");
        if (!std::filesystem::exists(path("x.see.state"))) continue;
        EXPECT_EQ(outcome.exit_code, 130);
        EXPECT_FALSE(std::filesystem::exists(path("x.see")));
        left = true;
        const Outcome rest = succeed(verb + "x.see");
        EXPECT_NE(rest.err.find("goes on from x.see.state"), std::string::npos) << rest.err;
        EXPECT_EQ(read(path("x.see")), read(path("whole.see")));
        EXPECT_FALSE(std::filesystem::exists(path("x.see.state")));
    }
    write("notes.state", "my notes");
    expectError(verb + "y.see --state notes.state", 4, "notes.state: holds something else");
    write("cut.state", "slsbrow1 and cut off");
    const Outcome anew = succeed(verb + "y.see --state cut.state");
    EXPECT_NE(anew.err.find("cut.state: damaged: the bake begins anew"), std::string::npos) << anew.err;
    EXPECT_EQ(read(path("y.see")), read(path("whole.see")));
    if (!left) GTEST_SKIP() << "the machine was too fast or too slow to interrupt it";
}

// What is prepared once is in the file, and answers are what they are without it.
TEST_F(Bake, PreparedMeshesAreTakenFromTheFile) {
    bake("building:1:1 -o plain.see");
    const json out = bake("building:1:1 -o b.see --prepare inner,clusters,lods --threads 2");
    bake("building:1:1 -o again.see --prepare inner,clusters,lods --threads 1");
    EXPECT_EQ(read(path("again.see")), read(path("b.see"))) << "the same bytes for any number of threads";
    const json told = info("b.see");
    EXPECT_GT(told["prepared"]["meshes"], 10);
    EXPECT_GT(told["prepared"]["occluder_triangles"], 1000);
    EXPECT_GT(told["prepared"]["inner_occluders"], 0);
    EXPECT_GT(told["prepared"]["clusters"], 100);
    EXPECT_GT(told["prepared"]["levels"], 10);
    EXPECT_FALSE(info("plain.see").contains("prepared"));
    const Outcome text = succeed("info b.see");
    EXPECT_NE(text.out.find("prepared meshes"), std::string::npos) << text.out;
    for (const std::string more :
         {"", " --occluder-error 4 --use pvs,portals,frustum,occlusion,clusters", " --lod-error 2"}) {
        SCOPED_TRACE(more);
        const std::string asked =
            "cull building:1:1 --path scatter --frames 4 --size 640x360" + more + " --visibility ";
        json before = answer(asked + "plain.see"), after = answer(asked + "b.see");
        ASSERT_EQ(before["frames"].size(), after["frames"].size());
        for (size_t i = 0; i < before["frames"].size(); ++i) {
            EXPECT_EQ(before["frames"][i]["visible"], after["frames"][i]["visible"]);
            EXPECT_EQ(before["frames"][i]["stages"].size(), after["frames"][i]["stages"].size());
            for (size_t s = 0; s < before["frames"][i]["stages"].size(); ++s)
                EXPECT_EQ(before["frames"][i]["stages"][s]["culled"], after["frames"][i]["stages"][s]["culled"]);
        }
    }
    expectError("bake building:1:1 --prepare walls", 2, "--prepare");
}

TEST_F(Bake, ABuildingBecomesAFileThatHoldsItsCells) {
    const json out = bake("building:1:1 -o b.see --objects");
    EXPECT_EQ(out["schema"], "sightline.bake/1");
    EXPECT_GT(out["cells"], 50);
    EXPECT_GE(out["portals"], out["cells"]);
    EXPECT_GT(out["doors"], 5);
    EXPECT_EQ(out["rows"], out["cells"]);
    EXPECT_GT(out["objects"]["count"], 500);
    EXPECT_LT(out["object_rows"]["visible_pairs"], out["object_rows"]["pairs_by_cells"]);
    EXPECT_EQ(out["bytes"], std::filesystem::file_size(path("b.see")));
    EXPECT_FALSE(std::filesystem::exists(path("b.see.state")));
    const json told = info("b.see");
    EXPECT_EQ(told["map"], "building:1:1");
    EXPECT_EQ(told["map_hash"], out["hash"]);
    EXPECT_EQ(told["cells"], out["rows"]);
    EXPECT_EQ(told["places"]["cells"], out["cells"]);
    EXPECT_EQ(told["places"]["cells_are"], "regions");
    EXPECT_EQ(told["places"]["portals"], out["portals"]);
    EXPECT_EQ(told["places"]["doors"], out["doors"]);
    EXPECT_EQ(told["objects"]["count"], out["objects"]["count"]);
    EXPECT_EQ(told["objects"]["places"], out["objects"]["places"]);
    EXPECT_EQ(told["visible_cell_pairs"], out["visible_pairs"]);
    EXPECT_EQ(told["visible_object_pairs"], out["object_rows"]["visible_pairs"]);
    const Outcome text = run("info b.see");
    EXPECT_NE(text.out.find("cells as places"), std::string::npos) << text.out;
    EXPECT_NE(text.out.find("visible objects"), std::string::npos) << text.out;
}

TEST_F(Bake, ARowSeesTheObjectsOfItsCellsAndNoneBeyondThoseThatItSees) {
    ASSERT_EQ(run("bake building:1:2 -o b.see --objects").exit_code, 0);
    const std::string bytes = read(path("b.see"));
    const Result<VisibilityFile> file = VisibilityFile::open(bytes, "b.see");
    ASSERT_TRUE(file.ok()) << file.error().message;
    const CellSpace space = file->cellSpace();
    const PlacedObjects& objects = file->objects();
    std::vector<uint64_t> row((objects.size() + 63) / 64);
    uint64_t seen = 0, hidden = 0;
    for (uint32_t cell = 0; cell < space.graph.cells; ++cell) {
        ASSERT_EQ(space.row_of_cell[cell], cell);
        file->objectRow(cell, row);
        for (size_t i = 0; i < objects.size(); ++i) {
            const bool in_row = (row[i / 64] >> i % 64 & 1) != 0;
            bool here = false, in_seen = false;
            for (size_t k = 0; k < objects.cells(i).size(); ++k) {
                here = here || objects.cells(i)[k] == cell;
                in_seen = in_seen || file->rows().sees(cell, objects.cells(i)[k]);
            }
            ASSERT_TRUE(in_row || (!here && !objects.seenFromEverywhere(i))) << cell << " " << i;
            ASSERT_TRUE(!in_row || in_seen || objects.seenFromEverywhere(i)) << cell << " " << i;
            seen += in_row;
            hidden += in_seen && !in_row;
        }
    }
    EXPECT_GT(seen, 10000u);
    EXPECT_GT(hidden, 10000u);
}

TEST_F(Bake, BytesAreTheSameForAnyThreads) {
    for (const char* threads : {"1", "2", "8"})
        ASSERT_EQ(run(fmt::format("bake building:1:1 -o t{}.see --objects --threads {}", threads, threads)).exit_code,
                  0);
    EXPECT_EQ(read(path("t1.see")), read(path("t2.see")));
    EXPECT_EQ(read(path("t1.see")), read(path("t8.see")));
    ASSERT_FALSE(read(path("t1.see")).empty());
    const std::string packed = read(path("t1.see"));
    ASSERT_EQ(run("bake building:1:1 -o p.see --objects --in-place").exit_code, 0);
    const std::string in_place = read(path("p.see"));
    EXPECT_GT(in_place.size(), packed.size());
    const Array<char> again = packedFile(*VisibilityFile::open(in_place, "p.see"));
    EXPECT_EQ(std::string(again.begin(), again.end()), packed);
}

TEST_F(Bake, MapsOfAllFormatsKeepTheirTreeAndFaces) {
    for (const QuakeFormat format : kQuakeFormats) {
        SCOPED_TRACE(quakeFormatName(format));
        MadeMap made;
        madeVisibility(format, false, made);
        const std::string bytes = mapBytes(format, made);
        write("m.bsp", bytes);
        const json out = bake("m.bsp -o m.see --objects");
        EXPECT_EQ(out["rows"], out["cells"]);  // two rooms
        const std::string file = read(path("m.see"));
        const Result<VisibilityFile> opened = VisibilityFile::open(file, "m.see");
        ASSERT_TRUE(opened.ok()) << opened.error().message;
        const QuakeMapFile map =
            *parseQuakeBsp({reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()}, "m.bsp");
        const CellSpace space = opened->cellSpace();
        EXPECT_EQ(space.tree.nodes.size(), map.tree.nodes.size());
        EXPECT_EQ(space.tree.contents, map.tree.contents);
        EXPECT_EQ(space.graph.cell_of_leaf, cellsOfTree(map.tree).cell_of_leaf);
        for (uint32_t leaf = 0; leaf < opened->leaves(); ++leaf)
            if (const uint32_t cell = space.graph.cell_of_leaf[leaf]; cell != CellGraph::kNoCell) {
                EXPECT_EQ(space.row_of_cell[cell], opened->cellOfLeaf(leaf));
            }
        // Each face of the world, in the cells around its middle; what moves is not in the file.
        const PlacedObjects& objects = opened->objects();
        const Scene scene = *quakeScene(map, "m.bsp");
        uint64_t still = 0;
        for (const SceneObject& object : scene.objects) {
            const auto [begin, end] = objects.find(object.key);
            const bool moves = map.faces[object.key].model != 0;
            still += !moves;
            ASSERT_EQ(end - begin, moves ? 0u : 1u) << object.key;
            if (moves) continue;
            const Box3d box = transformBox(scene.meshes[object.mesh].bounds, object.transform);
            EXPECT_EQ(objects.bounds(begin).min, box.min);
            EXPECT_EQ(objects.bounds(begin).max, box.max);
            for (int i = 0; i < 6; ++i) {  // the leaves around its middle
                glm::dvec3 p = box.center();
                p[i % 3] += i < 3 ? 0.1 : -0.1;
                const uint32_t cell = space.graph.cell_of_leaf[leafAt(map.tree, p)];
                EXPECT_TRUE(cell == CellGraph::kNoCell || isIn(objects, begin, cell)) << object.key << " in " << cell;
            }
        }
        EXPECT_EQ(objects.size(), still);
        EXPECT_EQ(out["objects"]["moving"], scene.objects.size() - still);
    }
    write("a.pak", pakBytes({{"maps/a.bsp", mapBytes(QuakeFormat::kQuake, {})}}));
    EXPECT_EQ(bake("a.pak --cells leaves")["cells"], bake("a.pak:maps/a.bsp --cells groups")["cells"]);
}

TEST_F(Bake, FacesOfARealMapAreInTheLeavesAroundTheirPoints) {
    const std::string name = SIGHTLINE_SHARED_DIR "/maps/lq_e2m2.vis.bsp";
    if (!std::filesystem::exists(name)) GTEST_SKIP() << "no " << name;
    ASSERT_EQ(run(fmt::format("bake {} -o m.see --budget 1 --cells groups", name)).exit_code, 0);
    const std::string file = read(path("m.see"));
    const Result<VisibilityFile> opened = VisibilityFile::open(file, "m.see");
    ASSERT_TRUE(opened.ok()) << opened.error().message;
    const CellSpace space = opened->cellSpace();
    const QuakeMapFile map = *readQuakeMap(name);
    const Scene scene = *quakeScene(map, name);
    Random random(4);
    uint64_t asked = 0, missing = 0;
    for (const SceneObject& object : scene.objects) {
        const auto [begin, end] = opened->objects().find(object.key);
        if (begin == end) continue;  // it moves
        const Mesh& mesh = scene.meshes[object.mesh];
        for (size_t t = 0; t < mesh.indices.size(); t += 3) {
            const auto corner = [&](size_t k) { return glm::dvec3(mesh.positions[mesh.indices[t + k]]); };
            const double a = random.uniform(), b = random.uniform() * (1 - a);
            glm::dvec3 p = corner(0) + a * (corner(1) - corner(0)) + b * (corner(2) - corner(0));
            for (int axis = 0; axis < 3; ++axis) p[axis] += random.uniform(-0.14, 0.14);
            const uint32_t cell = space.graph.cell_of_leaf[leafAt(map.tree, p)];
            if (cell == CellGraph::kNoCell) continue;
            ++asked;
            missing += !isIn(opened->objects(), begin, cell);
        }
    }
    EXPECT_GT(asked, 5000u);
    EXPECT_EQ(missing, 0u);
}

TEST_F(Bake, ASourceHasTheCellsOfItsBrushes) {
    std::string walls;
    const auto brush = [&](int x0, int y0, int z0, int x1, int y1, int z1) {
        const auto side = [&](int ax, int ay, int az, int bx, int by, int bz, int cx, int cy, int cz) {
            walls +=
                fmt::format("( {} {} {} ) ( {} {} {} ) ( {} {} {} ) w 0 0 0 1 1\n", ax, ay, az, bx, by, bz, cx, cy, cz);
        };
        walls += "{\n";
        side(x0, y0, z0, x0, y1, z0, x0, y0, z1);
        side(x1, y0, z0, x1, y0, z1, x1, y1, z0);
        side(x0, y0, z0, x0, y0, z1, x1, y0, z0);
        side(x0, y1, z0, x1, y1, z0, x0, y1, z1);
        side(x0, y0, z0, x1, y0, z0, x0, y1, z0);
        side(x0, y0, z1, x0, y1, z1, x1, y0, z1);
        walls += "}\n";
    };
    brush(-80, -80, -80, -64, 80, 80), brush(64, -80, -80, 80, 80, 80), brush(-64, -80, -80, 64, -64, 80);
    brush(-64, 64, -80, 64, 80, 80), brush(-64, -64, -80, 64, 64, -64), brush(-64, -64, 64, 64, 64, 80);
    brush(-8, -64, -64, 8, 32, 64);
    write("room.map", "{\n\"classname\" \"worldspawn\"\n" + walls +
                          "}\n{\n\"classname\" \"info_player_start\"\n\"origin\" \"-32 0 0\"\n}\n");
    const json out = bake("room.map -o room.see");
    EXPECT_GE(out["cells"], 2);
    EXPECT_EQ(out["rows"], out["cells"]);
    EXPECT_EQ(out["leaks"], false);
    EXPECT_EQ(out["objects"]["count"], 0);
    EXPECT_EQ(info("room.see")["places"]["cells_are"], "leaves of a tree");
    expectError("bake room.map --cells leaves", 2, "room.map");
    expectError("bake room.map --prepare occluders", 2, "--prepare: of scenes");
}

TEST_F(Bake, WhatCannotBeBakedIsALine) {
    expectError("bake city:1:10 --smallest-occluder 1e6", 3, "city:1:10: has no cells, and no opaque surface");
    expectError("bake building:1:1 --cells none --objects", 2, "--objects: these cells have no rows");
    expectError("bake city:1:10 --objects", 2, "--objects: these cells have no rows");
    expectError("bake building:1:1 --smallest-hole 0.001", 2, "the scene has marked cells");
    expectError("bake building:1:1 --widest-gap 0.01", 2, "the scene has marked cells");
    expectError("bake building:1:1 --report page --height 2", 2, "--height goes with --report, of a scene without");
    expectError("bake city:1:10 --height 2", 2, "--height goes with --report");
    expectError("bake room.map --cells walls", 2, "room.map: a map has cells of its own");
    expectError("bake room.map --view-cells 8", 2, "room.map: a map has cells of its own");
    expectError("bake m.bsp --smallest-occluder 4", 2, "m.bsp: a map has cells of its own");
    expectError("vis room.map --cells walls", 2, "--cells");
    expectError("bake no-such.bsp", 3, "no-such.bsp");
    expectError("bake no-such.glb", 3, "no-such.glb");
    write("rooms.prt", "PRT1\n2\n1\n4 0 1 (64 16 0) (64 16 16) (64 0 16) (64 0 0)\n");
    expectError("bake rooms.prt -o r.see", 2, "rooms.prt");
    expectError("bake building:1:1 --cells leaves", 2, "--cells");
    expectError("bake building:1:1 --in-place", 2, "--in-place");
    expectError("bake building:1:1 -o no-such-folder/b.see", 4, "no-such-folder");
    write("broken.bsp", "IBSP and nothing else");
    expectError("bake broken.bsp", 3, "broken.bsp");
    write("m.bsp", mapBytes(QuakeFormat::kQuake, {}));
    expectError("bake m.bsp -o m.bsp", 2, "m.bsp");
    expectError("bake m.bsp building:1:1", 2, "m.bsp");
    expectError("bake building:1:1 -o b.see --json b.see", 2, "b.see");
}

}  // namespace
}  // namespace sightline
