// A game's files that say what textures are: shader scripts, .wal files, folders and archives of them.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/quake/map_materials_files.h"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "archive_files.h"
#include "map_check.h"
#include "mutated.h"
#include "sightline/base/random.h"
#include "tests/support/corpus.h"

namespace sightline {
using namespace tools;
namespace {

constexpr BrushRole kIsSolid = BrushRole::kSolid, kIsSky = BrushRole::kSky, kIsLiquid = BrushRole::kLiquid,
                    kIsUnknown = BrushRole::kUnknown, kIsNothing = BrushRole::kNothing;

/// The role of a shader with this body.
BrushRole shaderRole(const std::string& body) {
    MapMaterials materials;
    const Status read = parseShaderScript(test::bytesOf("textures/a/B\n{\n" + body + "\n}\n"), "s.shader", materials);
    EXPECT_TRUE(read.ok()) << body << ": " << read.error().message;
    EXPECT_EQ(materials.shaders.size(), 1u);
    return materials.shaders.at("a/b");
}

const std::string kLightmapped = "{\nmap $lightmap\nrgbGen identity\n}\n{\nmap textures/a/b.tga\nblendFunc filter\n}\n";
const std::string kPlain = "{\nmap textures/a/b.tga\n}\n";

TEST(ShaderScript, WallsAreSolid) {
    for (const std::string& body : std::vector<std::string>{
             kPlain, kLightmapped, "surfaceparm nodraw\nsurfaceparm nolightmap\nsurfaceparm nomarks",  // caulk
             "qer_trans 0.5\nsurfaceparm nodraw", "surfaceparm structural\n" + kPlain, "cull none\n" + kPlain,
             "cull disable\n" + kPlain, "surfaceparm woodsteps\nsurfaceparm nomarks\n" + kPlain,
             "q3map_surfacelight 100\nq3map_lightimage x.tga\nlight 1\n" + kPlain, "implicitMap -",
             "{\nmap a.tga\nblendFunc GL_ONE GL_ZERO\n}", "{\nanimMap 5 a b c\ntcMod scroll 1 0\n}",
             "SurfaceParm METALSTEPS\n{\nMAP a\n}", "// surfaceparm trans\n/* surfaceparm water\n */\n" + kPlain,
             kPlain + "{\nmap glow\nblendFunc add\nalphaFunc GT0\n}"})
        EXPECT_EQ(shaderRole(body), kIsSolid) << body;
}

TEST(ShaderScript, WhatIsSeenThroughIsNot) {
    for (const char* parm : {"fog",     "trans",      "nonsolid",      "nonopaque",   "detail",     "hint",
                             "skip",    "areaportal", "clusterportal", "donotenter",  "antiportal", "origin",
                             "trigger", "nodrop",     "playerclip",    "monsterclip", "botclip",    "shotclip",
                             "ladder",  "outside",    "alphashadow",   "forcefield"})
        for (const char* more : {"", "surfaceparm nodraw\n", "surfaceparm structural\n"})
            EXPECT_EQ(shaderRole(std::string("surfaceparm ") + parm + "\n" + more + kPlain), kIsNothing) << parm;
    for (const char* body :
         {"{\nmap a\nblendFunc blend\n}", "{ map a blendFunc add }", "{ map a rgbGen identity alphaFunc GT0\n}",
          "{\nmap a\nblendFunc add\n}", "{\nmap a\nblendfunc gl_src_alpha gl_one_minus_src_alpha\n}",
          "{\nmap a\nalphaFunc GE128\n}", "{\nmap a\ndepthFunc equal\n}", "{\nmap a\nblendFunc GL_ONE GL_ONE\n}",
          "{\nmap a\nBLENDFUNC\tADD\n}\n{\nmap b\n}"})
        EXPECT_EQ(shaderRole(body), kIsNothing) << body;
    for (const char* line : {"deformVertexes wave 100 sin 0 1 0 1", "portal", "cull back", "cull backsided",
                             "q3map_invert", "q3map_terrain", "fogparms ( 1 1 1 ) 100", "cull none surfaceparm trans",
                             "surfaceparm nomarks surfaceparm nonsolid", "sort 5 deformVertexes move 1 1 1 sin 0 1 0 1",
                             "implicitMask -", "implicitBlend a.tga"})
        EXPECT_EQ(shaderRole(line + ("\n" + kPlain)), kIsNothing) << line;
    for (const char* parm : {"water", "slime", "lava"})
        EXPECT_EQ(shaderRole(std::string("qer_trans .5\nsurfaceparm ") + parm + "\n{\nmap a\n}"), kIsLiquid) << parm;
    EXPECT_EQ(shaderRole("surfaceparm water\nsurfaceparm nonsolid\n" + kPlain), kIsNothing);
    EXPECT_EQ(shaderRole("surfaceparm sky\nskyparms env/x 512 -"), kIsSky);
    EXPECT_EQ(shaderRole("skyparms - 512 -\n" + kPlain), kIsSky);
}

TEST(ShaderScript, WhatItDoesNotKnowIsUnknown) {
    for (const std::string& body : std::vector<std::string>{
             "surfaceparm frobnicate\n" + kPlain, "surfaceparm\n" + kPlain, "q3map_remapShader textures/a/c\n" + kPlain,
             "q3map_baseShader textures/a/c\n" + kPlain, "dp_water 1 2 3\n" + kPlain, "diffusemap a.tga", "",
             "qer_editorimage x.tga", "qer_trans 0.4\n" + kPlain, "{\nmap a\nfrobnicate\n}", "{\nmap a\ndetail\n}",
             "{\nrgbGen identity\n}\n" + kPlain, "{\nsurfaceSprites vertical 1 1 1 1\nmap a\n}",
             "damageShader x 10\n" + kPlain, "{\nmap a\n{\n}\n}"})
        EXPECT_EQ(shaderRole(body), kIsUnknown) << body;
    EXPECT_EQ(shaderRole("frobnicate\nsurfaceparm trans\n" + kPlain), kIsNothing);
}

TEST(ShaderScript, TakesTheLayoutsThatGamesTake) {
    MapMaterials materials;
    const std::string text =
        "\xEF\xBB\xBF//x\ntextures/a/one { surfaceparm trans\r\n}\n\"textures/a/t wo\" { { map x } }\n"
        "textures/a/three\n{\n{ map x\nblendFunc add }\nsurfaceparm nomarks }\nmodels/x\n{\n}\n";
    ASSERT_TRUE(parseShaderScript(test::bytesOf(text), "s.shader", materials).ok());
    EXPECT_EQ(materials.shaders.size(), 4u);
    EXPECT_EQ(materials.shaders.at("a/one"), kIsNothing);
    EXPECT_EQ(materials.shaders.at("a/t wo"), kIsSolid);
    EXPECT_EQ(materials.shaders.at("a/three"), kIsNothing);
    EXPECT_EQ(materials.shaders.at("models/x"), kIsUnknown);
}

TEST(ShaderScript, RefusesWithTheLineAndKeepsWhatCameBefore) {
    const struct {
        std::string text, message;
    } cases[] = {
        {"{\n}\n", "s.shader: line 1: \"{\" where the name of a shader was expected"},
        {"a\n{\n" + kPlain + "}\n}\nb\n{\n}\n", "s.shader: line 7: \"}\" where the name of a shader was expected"},
        {"a\n{\n" + kPlain + "}\nb\nc\n", "s.shader: line 7: shader b has no body"},
        {"a\n{\n" + kPlain + "}\nb\n", "s.shader: line 7: shader b has no body"},
        {"a\n{\n" + kPlain + "}\nb\n{\n", "s.shader: line 9: the file ends within shader b"},
        {"a\n{\n" + kPlain + "}\nb\n{\n{\nmap x", "s.shader: line 10: the file ends within shader b"},
    };
    for (const auto& [text, message] : cases) {
        MapMaterials materials;
        const Status read = parseShaderScript(test::bytesOf(text), "s.shader", materials);
        ASSERT_FALSE(read.ok()) << text;
        EXPECT_EQ(read.error().message, message);
        EXPECT_EQ(materials.shaders.size(), text[0] == 'a' ? 1u : 0u) << text;
    }
}

/// A .wal of Quake 2 of 16 by 16 pixels.
std::string walBytes(uint32_t contents, uint32_t surface) {
    std::string out(32, '\0');
    const auto put = [&](uint32_t value) {
        for (int i = 0; i < 4; ++i) out += static_cast<char>(value >> 8 * i);
    };
    for (const uint32_t value : {16u, 16u, 100u, 356u, 420u, 436u}) put(value);
    out += std::string(32, '\0');
    for (const uint32_t value : {surface, contents, 0u}) put(value);
    return out + std::string(340, '\1');
}

TEST(Wal, HasFlags) {
    const Result<MapFlags> flags = parseWal(test::bytesOf(walBytes(2, 0x10)), "a.wal");
    ASSERT_TRUE(flags.ok()) << flags.error().message;
    EXPECT_EQ(flags->contents, 2u);
    EXPECT_EQ(flags->surface, 0x10u);
    EXPECT_EQ(parseWal(test::bytesOf(walBytes(0, 0).substr(0, 99)), "a.wal").error().message,
              "a.wal: is no .wal: it is shorter than a header of 100 bytes");
    for (const std::string& spoiled : {walBytes(0, 0).substr(0, 430), "\3" + walBytes(0, 0), std::string(200, '\0')})
        EXPECT_EQ(parseWal(test::bytesOf(spoiled), "a.wal").error().message,
                  "a.wal: is no .wal of Quake 2: its picture is not where its header says");
}

class MapMaterialsFiles : public ::testing::Test {
protected:
    void SetUp() override {
        folder = std::filesystem::path(testing::TempDir()) /
                 ("materials_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
        std::filesystem::remove_all(folder);
        std::filesystem::create_directories(folder);
    }
    void TearDown() override { std::filesystem::remove_all(folder); }
    void write(const std::string& name, const std::string& bytes) const {
        ASSERT_TRUE(test::writeBytes(folder / name, bytes));
    }
    MapMaterials read(const std::string& name = "") const {
        MapMaterials out;
        const Status done = readMapMaterials((name.empty() ? folder : folder / name).string(), out);
        EXPECT_TRUE(done.ok()) << done.error().message;
        return out;
    }
    std::string fault(const std::string& name) const {
        MapMaterials out;
        const Status done = readMapMaterials((folder / name).string(), out);
        return done.ok() ? "" : done.error().message.substr(folder.string().size() + 1);
    }

    std::filesystem::path folder;
};

TEST_F(MapMaterialsFiles, FoldersAreReadWhole) {
    write("scripts/a.shader", "textures/a/b\n{\n" + kPlain + "}\n");
    write("scripts/readme.txt", "{ {");
    write("Textures/E1U1/Wall.WAL", walBytes(0, 4));
    write("textures/a/picture.tga", "");
    write("textures/a/other.v2.jpg", "");
    write("x/pak0.pk3", test::pk3Bytes({{"scripts/c.shader", "textures/c/d\n{\nsurfaceparm trans\n}\n", true},
                                        {"textures/c/packed.JPG", "x", false},
                                        {"textures/c/flags.wal", walBytes(8, 0), true}}));
    write("x/pak1.pak", test::pakBytes({{"textures/e1u2/clip.wal", walBytes(0x10000, 0), false}}));
    const MapMaterials out = read();
    EXPECT_TRUE(out.faults.empty()) << out.faults[0];
    EXPECT_EQ(out.shaders.size(), 2u);
    EXPECT_EQ(out.shaders.at("a/b"), kIsSolid);
    EXPECT_EQ(out.shaders.at("c/d"), kIsNothing);
    EXPECT_EQ(out.wals.size(), 3u);
    EXPECT_EQ(out.wals.at("e1u1/wall").surface, 4u);
    EXPECT_EQ(out.wals.at("c/flags").contents, 8u);
    EXPECT_EQ(out.wals.at("e1u2/clip").contents, 0x10000u);
    EXPECT_EQ(out.pictures, (std::unordered_set<std::string>{"a/picture", "a/other.v2", "c/packed"}));
    EXPECT_EQ(read("x/pak0.pk3").shaders.size(), 1u);
    EXPECT_EQ(read("x").wals.size(), 2u);
    EXPECT_EQ(read("scripts/a.shader").shaders.size(), 1u);
    EXPECT_EQ(read("Textures/E1U1").wals.count("e1u1/wall"), 1u);
    EXPECT_EQ(read("Textures/E1U1/Wall.WAL").wals.count("e1u1/wall"), 1u);
}

TEST_F(MapMaterialsFiles, NamesBeginInTheFolderWithoutTextures) {
    write("a/b/wall.wal", walBytes(0, 0));
    EXPECT_EQ(read("a").wals.count("b/wall"), 1u);
    EXPECT_EQ(read("a/b").wals.count("wall"), 1u);
    EXPECT_EQ(read("a/b/wall.wal").wals.count("wall"), 1u);
}

TEST_F(MapMaterialsFiles, WhatIsSpoiledIsTold) {
    write("g/good.shader", "textures/a/b\n{\n" + kPlain + "}\n");
    write("g/bad.shader", "textures/a/c\n{\n" + kPlain + "}\ntextures/a/d\n");
    write("g/bad.wal", "x");
    write("g/bad.pk3", "no archive");
    write("empty/readme.txt", "");
    write("list.txt", "");
    const MapMaterials out = read("g");
    EXPECT_EQ(out.shaders.size(), 2u);
    ASSERT_EQ(out.faults.size(), 3u);
    EXPECT_NE(out.faults[0].find("bad.pk3: is neither"), std::string::npos) << out.faults[0];
    EXPECT_NE(out.faults[1].find("bad.shader: line 7: shader a/d has no body"), std::string::npos) << out.faults[1];
    EXPECT_NE(out.faults[2].find("bad.wal: is no .wal"), std::string::npos) << out.faults[2];
    EXPECT_EQ(fault("g/bad.shader"), "g/bad.shader: line 7: shader a/d has no body");
    EXPECT_EQ(fault("g/bad.wal"), "g/bad.wal: is no .wal: it is shorter than a header of 100 bytes");
    EXPECT_EQ(fault("none"), "none: does not exist");
    EXPECT_EQ(fault("list.txt"), "list.txt: is no folder, .shader, .wal, .pk3 or .pak");
    EXPECT_EQ(fault("empty"), "empty: holds no shader script, .wal or picture");
}

using Fault = std::string (*)(const std::string&);
void expectSound(const std::string& corpus, Fault fault, uint64_t mutants) {
    size_t spoiled = 0;
    test::forCorpus(corpus, 3, [&](const std::string& name, const std::string& bytes) {
        EXPECT_EQ(fault(bytes), "") << name;
        for (uint64_t seed = 0; seed < mutants; ++seed) {
            Random random(mixSeed(seed, bytes.size()));
            ASSERT_EQ(fault(test::mutated(bytes, random)), "") << name << ", seed " << seed;
            ++spoiled;
        }
    });
    EXPECT_GT(spoiled, 2 * mutants);
}

TEST(MapMaterialsMutation, SpoiledScriptsAreSoundOrRefused) { expectSound("shader", test::shaderFault, 4000); }
TEST(MapMaterialsMutation, SpoiledWalsAreSoundOrRefused) { expectSound("wal", test::walFault, 4000); }

TEST(MapMaterialsMutation, WordsLeftOutNeverMakeMoreSolidThanTheyMay) {
    // Of a shader that is seen through by one word alone, only the loss of that word makes a wall.
    const std::string body = "surfaceparm nomarks\nsurfaceparm trans\nq3map_surfacelight 10\n" + kPlain;
    EXPECT_EQ(shaderRole(body), kIsNothing);
    for (size_t i = 0; i < body.size(); ++i) {
        std::string spoiled = body;
        if (spoiled[i] < 'a' || spoiled[i] > 'z') continue;
        spoiled[i] = '~';
        const BrushRole role = shaderRole(spoiled);
        EXPECT_GE(role, kIsUnknown) << spoiled;
    }
}

}  // namespace
}  // namespace sightline
