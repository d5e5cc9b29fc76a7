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
    refused("none.glb --from 1,2,3", 3, "none.glb");
    refused("made:walls --from 1,2,3 --visibility none.vis", 3, "none.vis");
}

}  // namespace
}  // namespace sightline
