// The verb vis: maps of every kind in, lumps and visibility files out.
// SPDX-License-Identifier: MIT
#include <chrono>
#include <filesystem>
#include <string>

#include <fmt/format.h>

#include "tests/cli/tool.h"
#include "tests/tools/import/archive_files.h"
#include "tests/tools/import/map_files.h"

namespace sightline {
using namespace tools;
namespace {

using namespace test;

/// A corridor along y, in the file's axes, with two rooms on one side that do not see one another, and one on the
/// other.
const char* const kRooms =
    "PRT1\n4\n3\n"
    "4 0 1 (64 16 0) (64 16 16) (64 0 16) (64 0 0)\n"
    "4 1 2 (64 112 0) (64 112 16) (64 128 16) (64 128 0)\n"
    "4 1 3 (72 64 0) (72 64 16) (72 48 16) (72 48 0)\n";

class Vis : public Tool {
protected:
    json vis(const std::string& arguments) const { return answer("vis " + arguments); }
    std::string shared(const std::string& name) const { return fmt::format("{}/maps/{}", SIGHTLINE_SHARED_DIR, name); }
};

TEST_F(Vis, APortalFileGivesRowsAndFigures) {
    write("rooms.prt", kRooms);
    const json out = vis("rooms.prt -o rooms.see --verify --rays 20000");
    EXPECT_EQ(out["schema"], "sightline.vis/1");
    EXPECT_EQ(out["leafs"], 4);
    EXPECT_EQ(out["clusters"], 4);
    EXPECT_EQ(out["portals"], 3);
    EXPECT_EQ(out["visible_leaf_pairs"], 14);
    EXPECT_EQ(out["witnessed_pairs"], 14);
    EXPECT_EQ(out["unresolved_pairs"], 0);
    EXPECT_EQ(out["verification"]["false_negatives"], 0);
    const json other = vis("rooms.prt --verify --rays 20000 --seed 7")["verification"];
    EXPECT_EQ(other["false_negatives"], 0);
    EXPECT_NE(other["segments"], out["verification"]["segments"]) << "other rays";
    EXPECT_EQ(out["pvs_bytes"], std::filesystem::file_size(path("rooms.see")));
    EXPECT_GT(out["lump_bytes"], 0);
    EXPECT_GE(out["cpu_seconds"], 0);
    EXPECT_EQ(run("info rooms.see").exit_code, 0);
    EXPECT_FALSE(std::filesystem::exists(path("rooms.see.state")));
}

TEST_F(Vis, SightMayEndAtADistance) {
    write("rooms.prt", kRooms);
    const auto pairs = [&](const std::string& farthest) { return vis("rooms.prt --verify " + farthest); };
    EXPECT_EQ(pairs("")["farthest"], 0);
    EXPECT_EQ(pairs("--farthest 60")["visible_leaf_pairs"], 14);
    const json near = pairs("-visdist 40");  // the rooms across the corridor are 33 and 49 apart
    EXPECT_EQ(near["visible_leaf_pairs"], 12);
    EXPECT_EQ(near["farthest"], 40);
    EXPECT_EQ(near["verification"]["false_negatives"], 0);
    EXPECT_EQ(pairs("-maxdistance 20")["visible_leaf_pairs"], 10);

    std::string map =
        "{\n\"classname\" \"worldspawn\"\n\"_farplanedist\" \"512.5\"\n{\n"
        "( 0 0 0 ) ( 0 1 0 ) ( 0 0 1 ) w 0 0 0 1 1\n( 9 0 0 ) ( 9 0 1 ) ( 9 1 0 ) w 0 0 0 1 1\n"
        "( 0 0 0 ) ( 0 0 1 ) ( 1 0 0 ) w 0 0 0 1 1\n( 0 9 0 ) ( 1 9 0 ) ( 0 9 1 ) w 0 0 0 1 1\n"
        "( 0 0 0 ) ( 1 0 0 ) ( 0 1 0 ) w 0 0 0 1 1\n( 0 0 9 ) ( 0 1 9 ) ( 1 0 9 ) w 0 0 0 1 1\n}\n}\n";
    write("fog.map", map);
    EXPECT_EQ(vis("fog.map")["farthest"], 512.5);
    EXPECT_NE(run("vis fog.map").err.find("sight ends at 512.5 units, by the map's _farplanedist"), std::string::npos);
    EXPECT_EQ(vis("fog.map --farthest 0")["farthest"], 0);
    EXPECT_EQ(vis("fog.map --farthest 100")["farthest"], 100);
    EXPECT_NE(run("vis fog.map -o fog.see").err.find("_farplanedist has no effect"), std::string::npos);
    expectError("vis fog.map --farthest 100 -o fog.see", 2, "a visibility file holds at any distance");
    write("fog.map", map.replace(map.find("512.5"), 5, "dense"));
    EXPECT_EQ(vis("fog.map")["farthest"], 0);
}

// Its cells touch in edges, where the tolerance leaves portals narrower than points are known by: no openings.
TEST_F(Vis, ASourceIsHeldAgainstRays) {
    if (!std::filesystem::exists(shared("lq_e2m2.map"))) GTEST_SKIP() << "there is no such map";
    const json verified = vis(shared("lq_e2m2.map") + " --verify --rays 400000")["verification"];
    EXPECT_GT(verified["segments"], 300000);
    EXPECT_EQ(verified["false_negatives"], 0);
}

/// Two rooms of 256, 256 and 128 with a wall between them, of textures of their own.
std::string twoRooms(const std::string& room, const std::string& wall) {
    const auto box = [](int x0, int y0, int z0, int x1, int y1, int z1, const std::string& side) {
        const auto plane = [&](int axis, int at, bool up) {
            int points[3][3] = {};
            for (auto& point : points) point[axis] = at;
            points[up ? 1 : 2][(axis + 1) % 3] = 1;
            points[up ? 2 : 1][(axis + 2) % 3] = 1;
            std::string out;
            for (const auto& p : points) out += fmt::format("( {} {} {} ) ", p[0], p[1], p[2]);
            return out + side + "\n";
        };
        return "{\n" + plane(0, x1, false) + plane(0, x0, true) + plane(1, y1, false) + plane(1, y0, true) +
               plane(2, z1, false) + plane(2, z0, true) + "}\n";
    };
    std::string map = "{\n\"classname\" \"worldspawn\"\n";
    map += box(-272, -144, -16, 272, 144, 0, room) + box(-272, -144, 128, 272, 144, 144, room);
    map += box(-272, -144, 0, -256, 144, 128, room) + box(256, -144, 0, 272, 144, 128, room);
    map += box(-256, -144, 0, 256, -128, 128, room) + box(-256, 128, 0, 256, 144, 128, room);
    return map + box(-8, -128, 0, 8, 128, 128, wall) +
           "}\n{\n\"classname\" \"light\"\n\"origin\" \"128 0 48\"\n}\n"
           "{\n\"classname\" \"light\"\n\"origin\" \"-128 0 48\"\n}\n";
}

TEST_F(Vis, WhatIsNotKnownHidesNothingAndIsTold) {
    const std::string tail = " 0 0 0 1 1", flags = " 0 0 0 1 1 0 0 0";
    const auto pairs = [&](const std::string& options) {
        return vis("m.map " + options)["visible_leaf_pairs"].get<int>();
    };
    const auto said = [&] { return run("vis m.map").err; };
    // Names are the whole rule of Quake: no word of them.
    write("m.map", twoRooms("brick" + tail, "stone" + tail));
    EXPECT_EQ(pairs(""), 2);
    EXPECT_EQ(said().find("not known"), std::string::npos) << said();
    write("m.map", twoRooms("brick" + tail, "skip" + tail));
    EXPECT_EQ(pairs("--game quake"), 2);
    EXPECT_EQ(pairs("--game halflife"), 1);
    EXPECT_EQ(pairs(""), 1);
    EXPECT_NE(said().find("m.map: 1 brush hides nothing, because 1 texture is not known (skip); Quake or Half-Life is "
                          "assumed. --game NAME, "
                          "--shaders PATH (with the game's .shader or .wal files) or --solid PATTERN tells"),
              std::string::npos)
        << said();
    EXPECT_EQ(vis("m.map")["unknown_brushes"], nlohmann::json({{"count", 1}, {"textures", {"skip"}}}));
    // Flags are the rule of Quake 2.
    write("m.map", twoRooms("e1u1/floor 0 0 0 1 1 1 0 0", "e1u1/wall" + flags));
    EXPECT_EQ(pairs(""), 2);
    EXPECT_EQ(pairs("--game quake3 --solid e1u1/floor"), 1);
    // Shaders are the rule of Quake 3.
    write("m.map", twoRooms("common/caulk" + flags, "my/wall" + flags));
    EXPECT_EQ(pairs(""), 1);
    EXPECT_NE(said().find("(my/wall); Quake 3 is assumed"), std::string::npos) << said();
    EXPECT_EQ(pairs("--solid my/*"), 2);
    EXPECT_EQ(pairs("--solid common/caulk --solid Textures/MY/WALL"), 2);
    expectError("vis m.map --solid other", 2, "--solid other: m.map has no texture of such a name");
    for (const char* folder : {"scripts", "bad"}) std::filesystem::create_directories(path(folder));
    write("scripts/my.shader", "textures/my/wall\n{\n{\nmap a.tga\n}\n}\ntextures/my/glass\n{\nsurfaceparm trans\n}\n");
    EXPECT_EQ(pairs("--shaders scripts"), 2);
    EXPECT_EQ(pairs("--shaders scripts/my.shader"), 2);
    write("x.pk3", pk3Bytes({{"textures/my/wall.jpg", "", false}}));
    EXPECT_EQ(pairs("--shaders x.pk3"), 2);
    write("bad/bad.shader", "my/other\n");
    EXPECT_EQ(pairs("--shaders x.pk3 --shaders bad"), 1);
    EXPECT_NE(run("vis m.map --shaders bad").err.find("bad.shader: line 1: shader my/other has no body"),
              std::string::npos);
    write("m.map", twoRooms("common/caulk" + flags, "my/glass" + flags));
    EXPECT_EQ(pairs("--shaders scripts --solid my/glass"), 1);
    EXPECT_EQ(run("bake m.map --shaders scripts -o m.see").exit_code, 0);

    expectError("vis m.map --shaders none", 3, "none: does not exist");
    expectError("vis m.map --shaders bad/bad.shader", 3, "bad.shader: line 1: shader my/other has no body");
    expectError("vis m.map --game doom", 2, "doom");
    write("rooms.prt", kRooms);
    expectError("vis rooms.prt --game quake", 2, "--game, --shaders and --solid go with a .map");
    expectError("bake building:1:3 --solid wall -o b.see", 2, "--game, --shaders and --solid go with a .map");
}

TEST_F(Vis, BrushesJudgeTheirTree) {
    write("m.map", twoRooms("brick 0 0 0 1 1", "*water 0 0 0 1 1"));
    const json verified = vis("m.map --verify --rays 40000")["verification"];
    EXPECT_GT(verified["brushes"]["segments"], 5000);
    EXPECT_EQ(verified["brushes"]["false_negatives"], 0);
    EXPECT_EQ(verified["brushes"]["solid_leaves"], 0);
    EXPECT_NE(run("vis m.map --verify --rays 40000").out.find("verified by the brushes: "), std::string::npos);
    // Two sides on a line: the parser reads them, the witness does not, and says so.
    std::string joined = twoRooms("brick 0 0 0 1 1", "stone 0 0 0 1 1");
    joined.replace(joined.rfind("1 1\n}"), 5, "1 1 }");
    write("m.map", joined);
    EXPECT_NE(run("vis m.map --verify --rays 1000").err.find("the brushes are not judged: "), std::string::npos);
    write("rooms.prt", kRooms);
    EXPECT_FALSE(vis("rooms.prt --verify --rays 1000")["verification"].contains("brushes"));
}

TEST_F(Vis, BytesAreTheSameForAnyThreads) {
    write("rooms.prt", kRooms);
    for (const char* threads : {"1", "2", "8"})
        ASSERT_EQ(run(fmt::format("vis rooms.prt -o t{}.see --threads {}", threads, threads)).exit_code, 0);
    EXPECT_EQ(read(path("t1.see")), read(path("t2.see")));
    EXPECT_EQ(read(path("t1.see")), read(path("t8.see")));
}

TEST_F(Vis, MapsOfAllFormatsGetTheirLump) {
    for (const QuakeFormat format : kQuakeFormats) {
        MadeMap made;
        madeVisibility(format, false, made);
        write("m.bsp", mapBytes(format, made));
        const json out = vis("m.bsp -o n.bsp --verify --rays 20000 --objects");
        EXPECT_EQ(out["verification"]["false_negatives"], 0) << quakeFormatName(format);
        EXPECT_GT(out["objects"]["count"], 0);
        EXPECT_EQ(run("info n.bsp").exit_code, 0);
        // What is written is read again, and baked to the same.
        const json again = vis("n.bsp -o o.bsp");
        EXPECT_EQ(again["before"]["removed"], 0) << quakeFormatName(format);
        EXPECT_EQ(again["before"]["added"], 0) << quakeFormatName(format);
        EXPECT_GT(again["before"]["visible_pairs"], 0) << quakeFormatName(format);
        EXPECT_TRUE(out.contains("before"));
        EXPECT_EQ(again["visible_leaf_pairs"], out["visible_leaf_pairs"]) << quakeFormatName(format);
        EXPECT_EQ(read(path("n.bsp")), read(path("o.bsp"))) << quakeFormatName(format);
    }
    write("a.pak", pakBytes({{"maps/a.bsp", mapBytes(QuakeFormat::kQuake, {})}}));
    EXPECT_EQ(vis("a.pak --cells leaves")["leafs"], vis("a.pak:maps/a.bsp --cells groups")["leafs"]);
}

// Two rooms, one of them full of water.
TEST_F(Vis, WaterIsLookedThroughUnlessItIsSaidToBeOpaque) {
    write("m.bsp", mapBytes(QuakeFormat::kQuake, {}));
    const json clear = vis("m.bsp --cells leaves"), opaque = vis("m.bsp --cells leaves --opaque-water");
    EXPECT_EQ(clear["visible_leaf_pairs"], 4);
    EXPECT_EQ(opaque["visible_leaf_pairs"], 2) << "each room sees itself";
    write("rooms.prt", "PRT1\n2\n1\n4 0 1 (64 16 0) (64 16 16) (64 0 16) (64 0 0)\n");
    expectError("vis rooms.prt --opaque-water", 2, "--opaque-water needs a .bsp");
}

TEST_F(Vis, AMapIsWrittenInItsPlaceAsCompilersDo) {
    MadeMap made;
    madeVisibility(QuakeFormat::kQuake, false, made);
    const std::string bytes = mapBytes(QuakeFormat::kQuake, made);
    write("m.bsp", bytes);
    write("n.bsp", bytes);
    ASSERT_EQ(run("vis m.bsp -o out.bsp").exit_code, 0);
    EXPECT_NE(run("vis m.bsp").err.find("nothing was written"), std::string::npos);
    ASSERT_EQ(run("vis m.bsp -o m.bsp").exit_code, 0);
    EXPECT_NE(run("vis m.bsp -o out2.bsp").out.find("then, less 0 that are gone, and 0 new, are "), std::string::npos);
    EXPECT_EQ(read(path("m.bsp")), read(path("out.bsp")));
    // As a profile of an editor calls it.
    const Outcome outcome = run("vis -threads 2 -level 4 -fast -v n -o ./n.bsp");
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_EQ(read(path("n.bsp")), read(path("out.bsp")));
    EXPECT_NE(outcome.err.find("-level has no effect: rows are always as tight"), std::string::npos);
    expectError("vis -visdist -512 n.bsp", 2, "--farthest");
    expectError("vis n.bsp -threads", 2, "-threads: its value is missing");
    expectError("vis n.bsp -threads many", 2, "--threads");
    expectError("vis n.bsp --verify --seed -1", 2, "--seed");
    expectError("vis n.bsp -frobnicate", 2, "-frobnicate");
    expectError("vis n.bsp -o n.see --json n.bsp", 2, "is taken by");
    expectError("vis n.bsp -o n.bsp --json n.bsp", 2, "is taken by");
    expectError("vis none -o none.bsp", 3, "none");
    EXPECT_EQ(read(path("n.bsp")), read(path("out.bsp")));
}

TEST_F(Vis, AmbientSoundsAreWrittenAsOfOld) {
    MadeMap made;
    for (MadeFace& face : made.faces) face.texture = 0;
    made.faces[6].texture = 1;  // the sheet of water
    madeVisibility(QuakeFormat::kQuake, true, made);
    write("pool.bsp", mapBytes(QuakeFormat::kQuake, made));
    EXPECT_NE(succeed("vis pool.bsp -o heard.bsp").out.find("ambient sounds are heard in "), std::string::npos);
    const std::string heard = read(path("heard.bsp"));
    for (const char* silent : {"-noambient", "-noambientwater", "--no-ambient sky,water", "--no-ambient all"}) {
        const Outcome outcome = succeed(std::string("vis pool.bsp ") + silent + " -o silent.bsp");
        EXPECT_EQ(outcome.out.find("ambient"), std::string::npos) << silent;
        EXPECT_NE(read(path("silent.bsp")), heard) << silent;
    }
    for (const char* other : {"-noambientsky", "-noambientlava", "--no-ambient slime"}) {
        succeed(std::string("vis pool.bsp ") + other + " -o same.bsp");
        EXPECT_EQ(read(path("same.bsp")), heard) << other;
    }
    expectError("vis pool.bsp -o x.bsp --no-ambient wind", 2, "--no-ambient");
}

TEST_F(Vis, ASourceWithoutBrushesIsAnError) {
    write("empty.map", "{\n\"classname\" \"worldspawn\"\n}\n");
    expectError("vis empty.map -o empty.see", 3, "empty.map: has no brushes");
    EXPECT_FALSE(std::filesystem::exists(path("empty.see")));
}

TEST_F(Vis, ASourceThatLeaksTellsTheWay) {
    // A floor alone, and somebody who stands on it.
    write("open.map",
          "{\n\"classname\" \"worldspawn\"\n{\n"
          "( -64 -64 -16 ) ( -64 -63 -16 ) ( -64 -64 -15 ) a 0 0 0 1 1\n"
          "( -64 -64 -16 ) ( -64 -64 -15 ) ( -63 -64 -16 ) a 0 0 0 1 1\n"
          "( -64 -64 -16 ) ( -63 -64 -16 ) ( -64 -63 -16 ) a 0 0 0 1 1\n"
          "( 64 64 0 ) ( 64 65 0 ) ( 65 64 0 ) a 0 0 0 1 1\n"
          "( 64 64 0 ) ( 65 64 0 ) ( 64 64 1 ) a 0 0 0 1 1\n"
          "( 64 64 0 ) ( 64 64 1 ) ( 64 65 0 ) a 0 0 0 1 1\n"
          "}\n}\n{\n\"classname\" \"info_player_start\"\n\"origin\" \"0 0 32\"\n}\n");
    const json out = vis("open.map -o open.see --leak open.pts --verify --rays 20000");
    ASSERT_EQ(out["leaks"].size(), 1u);
    EXPECT_EQ(out["leaks"][0]["from"], "info_player_start");
    EXPECT_GT(out["clusters"], 0);
    EXPECT_EQ(out["verification"]["false_negatives"], 0);
    EXPECT_GT(std::filesystem::file_size(path("open.pts")), 0u);
    EXPECT_NE(run("vis open.map").out.find("leaks: from info_player_start at 0 0 32"), std::string::npos);
}

TEST_F(Vis, AReportHasItsPictures) {
    write("rooms.prt", kRooms);
    ASSERT_EQ(run("vis rooms.prt --report page").exit_code, 0);
    const std::string page = read(path("page/index.html"));
    for (const char* name : {"matrix", "graph", "most", "middle", "sightline"}) {
        EXPECT_NE(page.find(fmt::format("{{\"name\":\"{}\",\"image\":\"data:image/png", name)), std::string::npos)
            << name;
        EXPECT_TRUE(std::filesystem::exists(path(fmt::format("page/{}.png", name)))) << name;
    }
    EXPECT_EQ(json::parse(read(path("page/vis.json")))["clusters"], 4);
}

TEST_F(Vis, LimitsLeaveMoreVisible) {
    write("rooms.prt", kRooms);
    const json whole = vis("rooms.prt"), spent = vis("rooms.prt --budget 1");
    EXPECT_GE(spent["visible_leaf_pairs"], whole["visible_leaf_pairs"]);
    if (!std::filesystem::exists(shared("lq_e2m2.prt"))) GTEST_SKIP() << "the shared maps are not there";
    const json full = vis(shared("lq_e2m2.prt")), little = vis(shared("lq_e2m2.prt") + " --budget 20");
    EXPECT_GT(little["over_budget"], 0);
    EXPECT_GT(little["visible_leaf_pairs"], full["visible_leaf_pairs"]);
    const json stopped = vis(shared("lq_e2m2.prt") + " --time-limit 1e-9");
    EXPECT_EQ(stopped["stopped"], true);
    EXPECT_GT(stopped["visible_leaf_pairs"], full["visible_leaf_pairs"]);
}

TEST_F(Vis, AStateOfAnotherBakeIsPassedOver) {
    write("rooms.prt", kRooms);
    write("other.txt", "my notes");
    expectError("vis rooms.prt --state other.txt", 4, "other.txt: holds something else");
    EXPECT_EQ(read(path("other.txt")), "my notes");
    write("cut.state", "slsbake1 and cut off");
    const Outcome outcome = succeed("vis rooms.prt --state cut.state --json -");
    EXPECT_NE(outcome.err.find("cut.state: no state of a bake: the bake begins anew"), std::string::npos)
        << outcome.err;
    EXPECT_EQ(json::parse(outcome.out)["visible_leaf_pairs"], 14);
    EXPECT_FALSE(std::filesystem::exists(path("cut.state")));
}

TEST_F(Vis, AnInterruptedBakeGoesOnToTheSameBytes) {
    if (!std::filesystem::exists(shared("lq_e1m5.prt"))) GTEST_SKIP() << "the shared maps are not there";
    const auto start = std::chrono::steady_clock::now();
    ASSERT_EQ(run("vis " + shared("lq_e1m5.prt") + " --threads 1 -o whole.see").exit_code, 0);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    // Sooner or later it is interrupted in the midst of its flow, however fast the machine is.
    bool left = false;
    for (const double part : {0.25, 0.4, 0.55, 0.7, 0.8, 0.9}) {
        const std::string after = std::to_string(part * seconds);
        std::filesystem::remove(path("x.see"));
        const Outcome outcome = run("vis " + shared("lq_e1m5.prt") + " --threads 1 -o x.see & sleep " + after +
                                    "; kill -TERM $! ; wait $!");
        if (!std::filesystem::exists(path("x.see.state"))) continue;
        EXPECT_EQ(outcome.exit_code, 130);
        EXPECT_FALSE(std::filesystem::exists(path("x.see")));
        left = true;
        const Outcome rest = succeed("vis " + shared("lq_e1m5.prt") + " -o x.see");
        EXPECT_NE(rest.err.find("goes on from x.see.state"), std::string::npos) << rest.err;
        EXPECT_EQ(read(path("x.see")), read(path("whole.see")));
        EXPECT_FALSE(std::filesystem::exists(path("x.see.state")));
    }
    if (!left) GTEST_SKIP() << "the machine was too fast or too slow to interrupt it";
}

TEST_F(Vis, WhatCannotBeIsOneLine) {
    write("rooms.prt", kRooms);
    write("m.bsp", mapBytes(QuakeFormat::kQuake, {}));
    write("bad.prt", "PRT1\n4\n3\n4 0 9 (64 0 0) (64 0 16) (64 16 16) (64 16 0)\n");
    expectError("vis none.prt", 3, "none.prt");
    expectError("vis bad.prt", 3, "bad.prt");
    expectError("vis m.bsp --prt bad.prt", 3, "bad.prt");
    expectError("vis rooms.prt -o x.bsp", 2, "--bsp");
    expectError("vis rooms.prt --cells leaves", 2, "--cells");
    expectError("vis rooms.prt --prt rooms.prt", 2, "--prt");
    expectError("vis m.bsp --bsp m.bsp", 2, "--bsp");
    expectError("vis rooms.prt --objects", 2, "--objects");
    expectError("vis rooms.prt --in-place", 2, "--in-place");
    expectError("vis rooms.prt -o rooms.prt", 2, "rooms.prt");
    expectError("vis rooms.prt -o no-such-folder/x.see", 4, "no-such-folder");
    expectError("vis rooms.prt --cells rooms", 2, "--cells");
    expectError("vis rooms.prt -o new.map", 2, "new.map");
    expectError("vis rooms.prt --leak x.pts", 2, "--leak");
    expectError("vis m.bsp --prt rooms.prt", 3, "rooms.prt: has 4 leaves");
    expectError("vis rooms.prt --time-limit 0", 2, "--time-limit");
}

}  // namespace
}  // namespace sightline
