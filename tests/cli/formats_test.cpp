// Files of all formats on the command line: several at once, units and axes, what info tells, limits.
// SPDX-License-Identifier: MIT
#include <cstdlib>
#include <string>
#include <vector>

#include "sightline/base/sanitized.h"
#include "tests/cli/tool.h"
#include "tests/tools/import/foreign_files.h"
#include "tests/tools/import/ifc_files.h"

namespace sightline {
namespace {

using namespace test;

class Formats : public Tool {
protected:
    void SetUp() override {
        Tool::SetUp();
        write("arch.glb", glbBytes(twoBoxes()));
        write("mep.glb", glbBytes({twoBoxes()[1]}));
    }
    json info(const std::string& arguments) const { return answer("info " + arguments); }
};

TEST_F(Formats, SeveralFilesAreOneScene) {
    const json facts = info("arch.glb mep.glb made:cycle");
    EXPECT_EQ(facts["file"], "arch.glb + mep.glb + made:cycle");
    ASSERT_EQ(facts["files"].size(), 3u);
    EXPECT_EQ(facts["files"][0]["first_key"], 0);
    EXPECT_EQ(facts["files"][1]["first_key"], 2);
    EXPECT_EQ(facts["files"][2]["first_key"], 3);
    EXPECT_EQ(facts["files"][0]["reader"], "sightline");
    EXPECT_EQ(facts["files"][0]["format"], "glTF 2.0");
    EXPECT_EQ(facts["files"][2]["format"], "procedural");
    const Outcome objects = run("info arch.glb mep.glb --objects");
    EXPECT_EQ(objects.out, "0\t12\tarch/Large\n1\t12\tarch/Small\n2\t12\tmep/Small\n");
    EXPECT_EQ(answer("cull arch.glb mep.glb --frames 2 --size 64x64 --verify --rays 10000")["scene"]["objects"], 3);
    expectError("info arch.glb missing.glb", 3, "missing.glb");
}

TEST_F(Formats, InfoTellsOfTheTree) {
    const json facts = info("arch.glb");
    EXPECT_EQ(facts["nodes"]["count"], 2);
    EXPECT_EQ(facts["nodes"]["named"], 2);
    EXPECT_EQ(facts["nodes"]["depth"], 1);
    EXPECT_EQ(info("arch.glb mep.glb")["nodes"]["depth"], 2);
    EXPECT_EQ(facts["cells"], 0);
    EXPECT_EQ(facts["portals"], 0);
    EXPECT_EQ(facts["largest_meshes"].size(), 2u);
    const Outcome words = run("info arch.glb");
    for (const char* word : {"glTF 2.0 (read by sightline)", "2 named, 1 deep", "cells", "portals", "largest meshes"})
        EXPECT_NE(words.out.find(word), std::string::npos) << word << "\n" << words.out;
}

TEST_F(Formats, UnitsAndAxesHold) {
    const json bounds = info("arch.glb --unit mm --up z")["bounds"];
    EXPECT_NEAR(bounds["min"][0].get<double>(), -0.007, 1e-9);
    EXPECT_NEAR(bounds["max"][1].get<double>(), 0.010, 1e-9);
    EXPECT_NEAR(bounds["min"][2].get<double>(), -0.0045, 1e-9);
    EXPECT_NEAR(info("arch.glb --unit 10")["bounds"]["max"][0].get<double>(), 50, 1e-9);
    EXPECT_NEAR(info("arch.glb --unit ft")["bounds"]["max"][0].get<double>(), 1.524, 1e-9);
    EXPECT_EQ(info("arch.glb --sides both")["triangles"]["double_sided"], 24);
    EXPECT_EQ(info("arch.glb --sides one")["triangles"]["double_sided"], 0);
    for (const char* wrong :
         {"--unit 0", "--unit -1", "--unit parsec", "--unit nan", "--unit 1m", "--up w", "--sides all",
          "--import-memory none", "--import-memory 8X", "--import-memory 1K", "--import-time 0", "--import-time soon"})
        expectError(std::string("info arch.glb ") + wrong, 2,
                    std::string(wrong).substr(0, std::string(wrong).find(' ')));
    expectError("info city:1:10 --unit mm", 2, "--unit");
}

TEST_F(Formats, ListsWhatCanBeRead) {
    const Outcome words = succeed("info --formats");
    for (const char* word : {"glb gltf", "obj", "Industry Foundation Classes"})
        EXPECT_NE(words.out.find(word), std::string::npos) << word;
    const json list = json::parse(run("info --formats --json -").out);
    EXPECT_EQ(list["schema"], "sightline.formats/1");
    EXPECT_EQ(list["formats"][0]["suffixes"], "glb gltf");
    EXPECT_EQ(list["formats"][0]["available"], true);
    expectError("info", 2, "SCENE");
#ifdef SIGHTLINE_HAS_ASSIMP
    const std::string search = std::getenv("PATH") ? std::getenv("PATH") : "";
    ::setenv("PATH", path("").c_str(), 1);
    const Outcome without = succeed("info --formats");
    ::setenv("PATH", search.c_str(), 1);
    EXPECT_NE(without.out.find("IFC is read by Node.js, which is not installed: install it"), std::string::npos);
#endif
}

TEST_F(Formats, WhatIsNotReadIsRefusedInWords) {
    write("house.zip", "PK\3\4 and so on");
    write("path.json", R"({"frames": []})");
    write("house.rvt", "x");
    expectError("cull house.zip", 3, "house.zip: is a zip archive: unpack it first");
    expectError("cull path.json", 3, "path.json: is a camera path, not a scene: give it with --cameras");
    expectError("verify house.rvt", 3, "export it as IFC or glTF");
}

#ifdef SIGHTLINE_HAS_ASSIMP

TEST_F(Formats, OfManyFilesThreeAreNamed) {
    std::string files;
    for (int i = 0; i < 20; ++i) {
        const std::string name = "part" + std::to_string(i) + ".obj";
        write(name, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
        files += " " + name;
    }
    const Outcome words = run("info" + files);
    EXPECT_EQ(words.exit_code, 0) << words.err;
    EXPECT_TRUE(words.out.starts_with("part0.obj + part1.obj + part2.obj + 17 more\n")) << words.out;
    EXPECT_EQ(words.out.find("part19.obj"), std::string::npos) << words.out;
    EXPECT_EQ(info(files)["files"].size(), 20u);
}

TEST_F(Formats, WhatAnImporterSaysStandsBesideWhatToDo) {
    write("broken.fbx", std::string("Kaydara FBX Binary  \0\x1a\0\xe8\x1c\0\0", 27) + std::string(140, 'x'));
    const Outcome broken = run("info broken.fbx");
    EXPECT_EQ(broken.exit_code, 3);
    for (const char* words : {"broken.fbx: ", "at offset 0x1", "the importer says \"", "save it anew"})
        EXPECT_NE(broken.err.find(words), std::string::npos) << words << "\n" << broken.err;
    EXPECT_EQ(broken.errorLines(), 1u) << broken.err;
}

TEST_F(Formats, ForeignFilesAreSeenAsGltfIs) {
    // Far enough from the boxes to see both; the small one is hidden by the large one in the second frame.
    write("path.json", R"({"fov_y_degrees": 60, "near": 0.1, "frames": [
        {"eye": [-20, 3, 20], "target": [0, 2, 0]}, {"eye": [30, 3, 20], "target": [-6.75, 0.75, -2]},
        {"eye": [0, 40, 3], "target": [0, 0, 3], "up": [1, 0, 0]}]})");
    const auto visible = [&](const std::string& file) {
        std::vector<json> out;
        const json result = answer("cull " + file + " --cameras path.json --size 160x120 --verify --rays 10000");
        for (const json& frame : result["frames"]) out.push_back(frame["visible"]);
        return out;
    };
    const std::vector<json> expected = visible("arch.glb");
    for (const ForeignFile& file : foreignFiles(twoBoxes())) {
        write(file.name, file.bytes);
        const std::vector<json> seen = visible(file.name);
        if (!file.objects) continue;
        EXPECT_EQ(seen, expected) << file.name;
    }
}

TEST_F(Formats, IfcIsAScene) {
    write("wall.ifc", ifcText("IFC2X3"));
    const Outcome first = run("info wall.ifc --json -");
    if (first.err.find("IFC is read by") != std::string::npos) GTEST_SKIP() << first.err;
    const json facts = json::parse(first.out);
    EXPECT_EQ(facts["files"][0]["reader"], "web-ifc");
    EXPECT_EQ(facts["triangles"]["double_sided"], 12);
    EXPECT_TRUE(facts["rooms"].empty());
    EXPECT_NE(first.err.find("wall.ifc: read 1 of 1 products with a shape"), std::string::npos) << first.err;
    EXPECT_NE(run("info wall.ifc --objects").out.find("0\t12\tSite/House/Level 1/IfcWallStandardCase North wall"),
              std::string::npos);
    write("boxes.obj", objText(twoBoxes()));
    succeed("cull wall.ifc boxes.obj arch.glb --frames 3 --size 64x64 --verify --rays 10000");

    IfcFile file;
    file.solid("IFCWALL", "", file.brep({0, 0, 0}, {4, 1, 3}), ",$,$");
    for (const char* name : {"Hall", "Kitchen"})
        file.solid("IFCSPACE", name, file.brep({0, 1, 0}, {4, 3, 2.5}), ",$,$,$");
    write("rooms.ifc", file.text());
    const json rooms = info("rooms.ifc --unit 2")["rooms"];
    ASSERT_EQ(rooms.size(), 2u);
    EXPECT_EQ(rooms[1]["name"], "IfcSpace Kitchen");
    EXPECT_NEAR(rooms[1]["bounds"]["min"][2].get<double>(), -8, 1e-5);
    EXPECT_NE(run("info rooms.ifc").out.find("rooms                            2  IfcSpace Hall, IfcSpace Kitchen"),
              std::string::npos);
    write("cut.ifc", file.text().substr(0, file.text().size() / 2));
    expectError("cull cut.ifc", 3, "cut.ifc: ");
}

TEST_F(Formats, LimitsOfReadersAreOneLine) {
    std::string text;
    for (int i = 0; i < 300000; ++i) text.append("v ").append(std::to_string(i)).append(" 0 0\n");
    write("large.obj", text + "f 1 2 3\n");
    expectError("info large.obj --import-time 0.001", 3, "large.obj: took longer than 0.001 s to read (--import-time)");
    if (!kSanitized)  // sanitizers reserve all of the address space
        expectError("info large.obj --import-memory 40M", 3,
                    "large.obj: needs more memory than 40 MiB (--import-memory)");
    write("broken.fbx", "; FBX 7.4.0 project file\nObjects: {\n");
    expectError("cull broken.fbx", 3, "broken.fbx: ");
}

#endif

}  // namespace
}  // namespace sightline
