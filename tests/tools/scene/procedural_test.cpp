// Specifications of procedural scenes are read strictly.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/procedural.h"

#include <gtest/gtest.h>

namespace sightline {
using namespace tools;
namespace {

TEST(Procedural, KnowsItsNames) {
    EXPECT_TRUE(isProcedural("city:1:1000"));
    EXPECT_TRUE(isProcedural("city:"));
    EXPECT_TRUE(isProcedural("building:1:3"));
    EXPECT_TRUE(isProcedural("terrain:1:64"));
    EXPECT_TRUE(isProcedural("made:cycle"));
    EXPECT_FALSE(isProcedural("building"));
    EXPECT_FALSE(isProcedural("terrain.obj"));
    EXPECT_FALSE(isProcedural("made"));
    EXPECT_FALSE(isProcedural("city"));
    EXPECT_FALSE(isProcedural("city.glb"));
    EXPECT_FALSE(isProcedural("./city:1:1000"));
    EXPECT_FALSE(isProcedural("village:1:1000"));
    EXPECT_FALSE(isProcedural(""));
}

TEST(Procedural, MakesTheCityThatIsNamed) {
    const Result<Scene> scene = makeProcedural("city:18446744073709551615:37");
    ASSERT_TRUE(scene.ok()) << scene.error().message;
    EXPECT_EQ(scene->objects.size(), 37u);
    EXPECT_EQ(scene->name, "city:18446744073709551615:37");
}

TEST(Procedural, MakesBuildingsAndTerrains) {
    const Result<Scene> building = makeProcedural("building:0:1");
    ASSERT_TRUE(building.ok()) << building.error().message;
    EXPECT_EQ(building->name, "building:0:1");
    EXPECT_FALSE(building->cells.empty());
    const Result<Scene> terrain = makeProcedural("terrain:18446744073709551615:16");
    ASSERT_TRUE(terrain.ok()) << terrain.error().message;
    EXPECT_EQ(terrain->name, "terrain:18446744073709551615:16");
    EXPECT_GE(drawnTriangles(*terrain), 450u);
}

TEST(Procedural, RefusesAnythingElseAsUsage) {
    for (const char* spec : {"city:",
                             "city:1",
                             "city:1:",
                             "city::5",
                             "city:1:0",
                             "city:-1:5",
                             "city:1:-5",
                             "city:1:5:6",
                             "city:1:5 ",
                             "city: 1:5",
                             "city:+1:5",
                             "city:x:5",
                             "city:1:5x",
                             "city:1:1e3",
                             "city:1:10000001",
                             "city:1.5:5",
                             "city:18446744073709551616:5",
                             "city:1:18446744073709551617",
                             "building:",
                             "building:1",
                             "building:1:0",
                             "building:1:201",
                             "building:1:-1",
                             "building:x:1",
                             "building:1:2:3",
                             "terrain:1",
                             "terrain:1:15",
                             "terrain:1:8193",
                             "terrain:1:64.5",
                             "terrain::64",
                             "made:",
                             "made:circle",
                             "made:cycle:1",
                             "made:Cycle",
                             "village:1:5",
                             "",
                             "city"}) {
        const Result<Scene> scene = makeProcedural(spec);
        ASSERT_FALSE(scene.ok()) << spec;
        EXPECT_EQ(scene.error().kind, Error::Kind::kUsage) << spec;
        EXPECT_EQ(scene.error().message.rfind(std::string(spec) + ": ", 0), 0u) << scene.error().message;
    }
}

}  // namespace
}  // namespace sightline
