// Files are known by their content where it is sure, and refused in words that help.
// SPDX-License-Identifier: MIT
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "foreign_files.h"
#include "foreign_reading.h"
#include "gltf_builder.h"
#include "sightline/tools/import/scene_kind.h"

namespace sightline {
using namespace tools;
namespace {

using namespace test;
using namespace std::string_literals;

using SceneKinds = SceneFiles;

TEST_F(SceneKinds, WhatIsNotReadIsRefusedWithWhatToDo) {
    const std::vector<std::pair<std::string, std::pair<std::string, std::string>>> cases = {
        {"house.zip", {"PK\3\4xxxxxxxxxx", "is a zip archive: unpack it first"}},
        {"house.obj", {"PK\3\4xxxxxxxxxx", "is a zip archive: unpack it first"}},
        {"house.gltf.gz", {"\x1f\x8b\x08xxxxx", "gzip: unpack it first (gunzip)"}},
        {"house.glb", {"\x1f\x8b\x08xxxxx", "gzip"}},
        {"house.zst", {"\x28\xb5\x2f\xfdxxxxx", "unpack it first (unzstd)"}},
        {"house.xz",
         {"\xfd"
          "7zXZ\0xxxx"s,
          "unpack it first (unxz)"}},
        {"house.bz2", {"BZh91AY&SY", "unpack it first (bunzip2)"}},
        {"house.7z", {"7z\xbc\xaf\x27\x1cxxxx", "is a 7z archive: unpack it first"}},
        {"house.rar", {"Rar!\x1a\x07xxxx", "is a RAR archive: unpack it first"}},
        {"house.tar",
         {std::string(257, '\0') + "ustar\0"s + std::string(300, '\0'), "is a tar archive: unpack it first"}},
        {"house.usdz", {"PK\3\4xxxxxxxxxx", "is USD, which is not read: export it as glTF"}},
        {"house.usdc", {"PXR-USDCxxxxx", "is USD"}},
        {"house.usd", {"#usda 1.0\n", "is USD"}},
        {"house.step", {"ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('AUTOMOTIVE_DESIGN'));", "is STEP"}},
        {"house.ifc", {"ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('CONFIG_CONTROL_DESIGN'));", "is STEP"}},
        {"house.igs", {"x", "is IGES"}},
        {"house.rvt", {"x", "export it as IFC or glTF"}},
        {"house.skp", {"x", "is a SketchUp model"}},
        {"house.dwg", {"AC1032xxxx", "AutoCAD drawing"}},
        {"house.blend", {"BLENDER-v293RENDH", "is of Blender 2.93, which is not read: export it as glTF"}},
        {"house.blend", {"BLENDER-v402RENDH", "is of Blender 4.2, which"}},
        {"house.blend", {"BLENDER17-01v0500REND", "is of Blender 5.0, which"}},
        {"house.max", {"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1xxxx", "3ds Max"}},
        {"house.ma", {"//Maya ASCII 2020 scene", "Maya"}},
        {"house.mb", {"FOR8xxxx", "Maya"}},
        {"house.c4d", {"xxxx", "Cinema 4D"}},
        {"house.glb", {"<!DOCTYPE html><html><body>404</body></html>", "is a web page"}},
        {"house.obj", {"\n<html lang=\"en\">", "is a web page"}},
        {"house.glb", {"version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n", "run git lfs pull"}},
        {"house.glb", {"", "is empty"}},
        {"house.obj", {"", "is empty"}},
        {"house.obj", {"Dear reader, this is a letter.\n", "is not what its suffix .obj says"}},
        {"house.ply", {"solid x\n", "is not what its suffix .ply says"}},
        {"house.stl", {"v 0 0 0\nv 1 1 1\n", "is not what its suffix .stl says"}},
        {"house.ifc", {"hello", "is not what its suffix .ifc says"}},
        {"house.3mf", {"hello", "is not what its suffix .3mf says"}},
        {"house.glb", {"hello", "is not what its suffix .glb says"}},
        {"path.json",
         {R"({"fov_y_degrees": 60, "frames": []})", "is a camera path, not a scene: give it with --cameras"}},
        {"path.gltf", {R"({"frames": []})", "is a camera path"}},
        {"result.json", {R"({"schema": "sightline.cull/1"})", "is a result of Sightline"}},
        {"city.json", {R"({"type": "CityJSON"})", "is CityJSON"}},
        {"some.json", {"{}", "is JSON, but not glTF"}},
        {"level.bsp", {"\x1d\0\0\0xxxx"s, "truncated: it ends within its list of lumps"}},
        {"level.bsp", {"\x11\0\0\0xxxx"s, "is not what its suffix .bsp says"}},
        {"level.bsp", {"IBSP\x2f\0\0\0"s, "is a map of another format (IBSP version 47)"}},
        {"level.bsp", {"VBSP\x14\0\0\0"s, "is a map of Source, which is not read"}},
        {"level.pk3", {"hello", "is not what its suffix .pk3 says"}},
        {"level.pak", {"PACKxxxxxxxx", "truncated: its list ends beyond the file"}},
        {"level.map", {"x", "game map"}},
        {"level.prt", {"PRT1\n", "portals"}},
        {"house.mtl", {"newmtl a", "name that file instead"}},
        {"picture.png", {"\x89PNG\r\n\x1a\n", "is a picture"}},
        {"scan.las", {"LASFxxxx", "is a point cloud"}},
        {"house.xyz9", {"hello", "not a scene that can be read: .glb, .obj, .ply, .stl, .fbx, .ifc"}},
        {"house", {"hello", "not a scene that can be read"}},
    };
    for (const auto& [name, file] : cases) {
        SCOPED_TRACE(name + ": " + file.second);
        expectRefused(write(name, file.first), file.second);
    }
    expectRefused(path("none.obj"), "no such file");
    std::filesystem::create_directory(path("folder.obj"));
    expectRefused(path("folder.obj"), "is a directory");
}

TEST_F(SceneKinds, GltfIsReadWhateverItsSuffix) {
    GltfBuilder builder = GltfBuilder::triangle();
    for (const char* name : {"a.glb", "a.gltf", "a.obj", "a.bin", "a", "a.GLB", "a.json"}) {
        EXPECT_TRUE(load(write(name, builder.glb())).ok()) << name;
        EXPECT_TRUE(load(write(name, builder.gltf())).ok()) << name;
        EXPECT_TRUE(load(write(name, "\xef\xbb\xbf \n" + builder.gltf())).ok()) << name;
    }
}

TEST_F(SceneKinds, ContentDecidesWhereItIsSure) {
    for (const ForeignFile& file : foreignFiles(twoBoxes())) {
        const std::string suffix = std::filesystem::path(file.name).extension().string().substr(1);
        const SceneKind kind = sceneKind(file.name, file.bytes, file.bytes.size());
        ASSERT_TRUE(kind.format) << file.name << kind.refusal;
        EXPECT_EQ(kind.suffix, suffix);
        const SceneKind loud =
            sceneKind("HOUSE." + std::string(suffix == "obj" ? "OBJ" : suffix), file.bytes, file.bytes.size());
        EXPECT_EQ(loud.suffix, suffix);
        for (const char* sure : {"bytes.fbx", "text.ply", "bytes.ply", "bytes.stl", "boxes.x", "boxes.dae", "boxes.x3d",
                                 "boxes.amf", "boxes.ac", "boxes.3mf"})
            EXPECT_TRUE(file.name != sure || sceneKind("a.obj", file.bytes, file.bytes.size()).suffix == suffix)
                << sure;
    }
    EXPECT_EQ(sceneKind("a.step", ifcText("IFC4"), 10000).suffix, "ifc");
}

#ifdef SIGHTLINE_IMPORT_PROGRAM
TEST_F(SceneKinds, AWrongSuffixIsReadByItsContent) {
    const std::string file = write("boxes.obj", plyBytes(twoBoxes()));
    const Result<Scene> scene = load(file);
    ASSERT_TRUE(scene.ok()) << scene.error().message;
    EXPECT_EQ(drawnTriangles(*scene), 24u);
    EXPECT_EQ(scene->name, file);
}
#endif

TEST_F(SceneKinds, AMissingReaderSaysWhatToInstall) {
    // Beside this test there is none, unless it was installed.
    settings_.worker = "";
    const std::string file = write("boxes.obj", objText(twoBoxes()));
    const Result<Scene> scene = load(file);
    if (scene.ok()) GTEST_SKIP() << "sightline-import is installed on this machine";
    EXPECT_EQ(scene.error().message,
              file +
                  ": sightline-import, which reads .obj files, is not beside this program: `./run.sh info FILE.obj` "
                  "builds it, if libassimp-dev is installed");
}

}  // namespace
}  // namespace sightline
