// Compiled maps on the command line: as scenes, in archives, and what info tells of them.
// SPDX-License-Identifier: MIT
#include <filesystem>
#include <string>

#include "tests/cli/tool.h"
#include "tests/tools/import/archive_files.h"
#include "tests/tools/import/map_files.h"

namespace sightline {
using namespace tools;
namespace {

using namespace test;

class Maps : public Tool {
protected:
    json info(const std::string& arguments) const { return answer("info " + arguments); }
};

TEST_F(Maps, EachFormatIsCulledWithoutFault) {
    for (const QuakeFormat format : kQuakeFormats) {
        MadeMap made;
        madeVisibility(format, false, made);
        write("m.bsp", mapBytes(format, made));
        const Outcome cull = succeed("cull m.bsp --frames 3 --size 64x64 --verify --rays 10000 --json -");
        EXPECT_EQ(json::parse(cull.out)["scene"]["objects"], 8);
        EXPECT_EQ(json::parse(cull.out)["verification"]["false_culls"], 0);
        const json facts = info("m.bsp");
        const json& map = facts["files"][0]["map"];
        EXPECT_EQ(map["format"], quakeFormatName(format));
        EXPECT_EQ(map["clusters"], 2);
        EXPECT_EQ(map["visible_pairs"], 2);
        EXPECT_EQ(map["entities"], 2);
        EXPECT_EQ(facts["triangles"]["occluding"], 12);
        EXPECT_EQ(facts["triangles"]["transmissive"], 3);
    }
    EXPECT_NE(run("info m.bsp").out.find("a cluster sees 1.0 others in the mean, 50.0 %"), std::string::npos);
}

TEST_F(Maps, ArchivesAreNamedWithTheMapInThem) {
    const std::string a = mapBytes(QuakeFormat::kQuake, {}), b = mapBytes(QuakeFormat::kQuake3, {});
    write("one.pak", pakBytes({{"maps/a.bsp", a}}));
    write("two.pk3", pk3Bytes({{"maps/a.bsp", a}, {"maps/b.bsp", b}}));
    EXPECT_EQ(info("one.pak")["files"][0]["map"]["name"], "one.pak:maps/a.bsp");
    const json facts = info("two.pk3:maps/b.bsp");
    EXPECT_EQ(facts["file"], "two.pk3:maps/b.bsp");
    EXPECT_EQ(facts["files"][0]["bytes"], std::filesystem::file_size(path("two.pk3")));
    EXPECT_EQ(facts["files"][0]["map"]["format"], "Quake 3 (IBSP 46)");
    EXPECT_EQ(run("info two.pk3:maps/a.bsp --objects").out.substr(0, 27), "0\t2\tworldspawn/wall1\n1\t2\two");
    EXPECT_EQ(run("info two.pk3:maps/a.bsp two.pk3:maps/b.bsp").exit_code, 0);
    expectError("info two.pk3", 3,
                "two.pk3: name one of its maps, as in two.pk3:maps/a.bsp: it has maps/a.bsp, maps/b.bsp");
    expectError("info two.pk3:maps/c.bsp", 3, "two.pk3: has no maps/c.bsp: it has maps/a.bsp, maps/b.bsp");
    expectError("info none.pk3:maps/c.bsp", 3, "none.pk3: no such file");
    expectError("cull two.pk3:maps/a.bsp --json two.pk3", 2, "--json: two.pk3 is taken by SCENE");
}

TEST_F(Maps, InfoTellsOfPortals) {
    write("m.prt",
          "PRT2\n3\n2\n2\n4 0 1 (8 0 0) (8 0 4) (8 4 4) (8 4 0)\n3 0 1 (0 0 0) (1 1 1) (2 2 2)\n0 2 -1\n1 -1\n");
    const json facts = info("m.prt")["portal_file"];
    EXPECT_EQ(facts["kind"], "PRT2");
    EXPECT_EQ(facts["leafs"], 3);
    EXPECT_EQ(facts["clusters"], 2);
    EXPECT_EQ(facts["portals"], 1);
    EXPECT_EQ(facts["without_area"], 1);
    EXPECT_NE(run("info m.prt").out.find("PRT2, the portals of a Quake-family map"), std::string::npos);
    write("bad.prt", "PRT1\n2\n1\n");
    expectError("info bad.prt", 3, "bad.prt: line 4: the file's end is no count of points");
    expectError("info m.prt --objects", 2, "--objects: a file of portals has none");
    expectError("cull m.prt", 3,
                "m.prt: holds a map's portals, which vis and info read, and is no scene: name the .bsp");
}

}  // namespace
}  // namespace sightline
