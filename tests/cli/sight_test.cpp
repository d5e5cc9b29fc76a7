// The verb `sight`: lines between points, and what a region sees by a file.
// SPDX-License-Identifier: MIT
#include "tests/cli/tool.h"

namespace sightline {
namespace {

class SightVerb : public Tool {
protected:
    json answer(const std::string& words) const {
        const Outcome told = run("sight " + words + " --json -");
        EXPECT_EQ(told.exit_code, 0) << told.err;
        return json::parse(told.out);
    }
};

TEST_F(SightVerb, TellsWhoStandsBetweenTwoPoints) {
    // Eight walls, one behind the other, from z = -2 to -9. The line meets the middle of the first.
    const std::string before = " --from 0,0,1", behind = " --to 0,0,-20";
    const json blocked = answer("made:walls" + before + behind);
    EXPECT_EQ(blocked["blocked"], true);
    EXPECT_FALSE(blocked["by"]["name"].get<std::string>().empty());
    const json open = answer("made:walls" + before + " --to 0,0,9");
    EXPECT_EQ(open["blocked"], false);
    EXPECT_FALSE(open.contains("by"));
    const Outcome text = run("sight made:walls" + before + behind);
    EXPECT_EQ(text.out.rfind("blocked: ", 0), 0u) << text.out;
}

TEST_F(SightVerb, TellsWhatMayBeSeenFromARegion) {
    const Outcome baked = run("bake building:1:1 -o house.vis");
    ASSERT_EQ(baked.exit_code, 0) << baked.err;
    const json all = answer("building:1:1 --from -15,1.5,4");
    EXPECT_EQ(all["known"], false);
    const json one = answer("building:1:1 --from -15,1.5,4 --visibility house.vis");
    const json more = answer("building:1:1 --from -15,1.5,4 --within 0.3 --visibility house.vis");
    EXPECT_EQ(one["known"], true);
    EXPECT_EQ(more["known"], true);
    EXPECT_LT(one["objects"].size(), all["objects"].size());
    EXPECT_LE(one["objects"].size(), more["objects"].size());
    const Outcome text = run("sight building:1:1 --from -15,1.5,4 --visibility house.vis");
    EXPECT_NE(text.out.find(" objects may be seen from there\n"), std::string::npos) << text.out;
    EXPECT_NE(run("sight building:1:1 --from -15,1.5,4").out.find("not known: "), std::string::npos);
}

TEST_F(SightVerb, TellsTheWayThatOneCanGo) {
    const Outcome baked = run("bake building:1:1 -o house.vis");
    ASSERT_EQ(baked.exit_code, 0) << baked.err;
    const std::string question = "building:1:1 --from -15,1.5,4 --to 10,1.5,-4 --visibility house.vis";
    EXPECT_FALSE(answer("building:1:1 --from -15,1.5,4 --to 10,1.5,-4").contains("way")) << "without a file";
    const json way = answer(question)["way"];
    EXPECT_EQ(way["known"], true);
    ASSERT_EQ(way["connected"], true);
    ASSERT_GE(way["points"].size(), 2u);
    EXPECT_EQ(way["points"].front(), (json{-15, 1.5, 4}));
    EXPECT_EQ(way["points"].back(), (json{10, 1.5, -4}));
    EXPECT_GE(way["distance"], std::hypot(25, 8));
    EXPECT_GT(way["narrowest"], 0);
    EXPECT_GE(way["cells"].size(), 2u);
    const Outcome text = run("sight " + question);
    EXPECT_NE(text.out.find("\na way: "), std::string::npos) << text.out;
    EXPECT_NE(text.out.find("\n  through '"), std::string::npos) << text.out;
    const Outcome none = run("sight " + question + " --narrowest 50");
    EXPECT_NE(none.out.find("\nno way: walls and narrower holes part them\n"), std::string::npos) << none.out;
    const Outcome beyond = run("sight building:1:1 --from -15,1.5,4 --to 0,1.5,nan --visibility house.vis");
    EXPECT_EQ(beyond.exit_code, 2);
}

TEST_F(SightVerb, RefusesWhatIsNoQuestion) {
    const auto refused = [&](const std::string& words, int code, const std::string& part) {
        const Outcome told = run("sight " + words);
        EXPECT_EQ(told.exit_code, code) << words << told.err;
        EXPECT_NE(told.err.find(part), std::string::npos) << told.err;
        EXPECT_EQ(told.out, "");
    };
    refused("made:walls", 2, "--from");
    refused("made:walls --from 1,2", 2, "--from 1,2: not X,Y,Z of a point");
    refused("made:walls --from 1,2,nan", 2, "not X,Y,Z of a point");
    refused("made:walls --from 1,2,3 --to 4,5,x", 2, "--to 4,5,x: not X,Y,Z of a point");
    refused("made:walls --from 1,2,3 --to 4,5,6 --within 2", 2, "--to");
    refused("made:walls --from 1,2,3 --within -1", 2, "--within");
    refused("made:walls --from 1,2,3 --to 4,5,6 --narrowest 1", 2, "--visibility");
    refused("made:walls --from 1,2,3 --to 4,5,6 --narrowest -1 --visibility none.vis", 2, "--narrowest");
    refused("none.glb --from 1,2,3", 3, "none.glb");
    refused("made:walls --from 1,2,3 --visibility none.vis", 3, "none.vis");
}

}  // namespace
}  // namespace sightline
