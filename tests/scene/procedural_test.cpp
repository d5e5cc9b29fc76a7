// Specifications of procedural scenes are read strictly.
// SPDX-License-Identifier: MIT
#include "sightline/scene/procedural.h"

#include <gtest/gtest.h>

namespace sightline {
namespace {

TEST(Procedural, KnowsItsNames) {
    EXPECT_TRUE(isProcedural("city:1:1000"));
    EXPECT_TRUE(isProcedural("city:"));
    EXPECT_TRUE(isProcedural("made:cycle"));
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
