// The verb `sight`: lines between points, and what a region sees by a file.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <set>

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

// What is never seen from any corridor: a witness that stands in one sees none of it.
TEST_F(SightVerb, TellsWhatNoRegionSees) {
    ASSERT_EQ(run("bake building:1:1 -o house.vis").exit_code, 0);
    const std::string of = "building:1:1 --from-node 'corridor ?.?' --inset 0.1 --visibility house.vis";
    const json said = answer(of);
    EXPECT_EQ(said["known"], true);
    std::set<uint64_t> unseen;
    for (const json& object : said["unseen"]) unseen.insert(object["key"].get<uint64_t>());
    EXPECT_GT(unseen.size(), 50u);
    EXPECT_EQ(unseen.size() + said["objects"].size(), 1052u);
    ASSERT_FALSE(said["regions"].empty());
    json frames = json::array();
    for (const json& region : said["regions"])
        for (const double part : {0.1, 0.5, 0.9})
            for (const double along : {-1.0, 1.0}) {
                const double x = region["min"][0], z = region["min"][2];
                const double wide = region["max"][0].get<double>() - x, deep = region["max"][2].get<double>() - z;
                const json eye = {x + part * wide, 1.6, z + part * deep};
                frames.push_back({{"eye", eye}, {"target", {eye[0].get<double>() + along, 1.6, eye[2]}}});
                frames.push_back({{"eye", eye}, {"target", {eye[0], 1.6, eye[2].get<double>() + along}}});
            }
    write("eyes.json", json{{"fov_y_degrees", 90}, {"near", 0.05}, {"frames", frames}}.dump());
    const Outcome culled =
        run("cull building:1:1 --cameras eyes.json --size 160x160 --repeat 1 --verify --rays 20000 --json -");
    const json seen = json::parse(culled.out);
    size_t judged = 0;
    for (const json& frame : seen["frames"]) {
        const std::vector<uint64_t> hidden = frame["verification"]["kept_unseen"];
        for (const uint64_t key : frame["visible"].get<std::vector<uint64_t>>()) {
            if (std::binary_search(hidden.begin(), hidden.end(), key)) continue;
            EXPECT_FALSE(unseen.contains(key)) << key;
            ++judged;
        }
    }
    EXPECT_GT(judged, 200u);

    // The list in words, and the same by a box.
    const Outcome text = run("sight " + of + " --unseen");
    EXPECT_NE(text.out.find(std::to_string(unseen.size()) + " from none\nnever seen:\n"), std::string::npos)
        << text.out;
    EXPECT_EQ(std::count(text.out.begin(), text.out.end(), '\n'), unseen.size() + 2);
    const json& first = said["regions"][0];
    std::string box;
    for (const char* corner : {"min", "max"})
        for (const json& number : first[corner]) box += (box.empty() ? "" : ",") + number.dump();
    EXPECT_GE(answer("building:1:1 --from-box " + box + " --visibility house.vis")["unseen"].size(), unseen.size());
    EXPECT_EQ(answer("building:1:1 --from-node 'corridor ?.?'")["known"], false);
    // A node, here with all that hangs below it.
    EXPECT_EQ(answer("building:1:1 --from-node 'floor 0/outside'")["regions"].size(), 1u);
    expectError("sight building:1:1 --from-node 'attic*'", 2, "no cell and no node");
    expectError("sight building:1:1 --from-box 1,2,3", 2, "--from-box 1,2,3");
    expectError("sight building:1:1 --from-box 1,1,1,0,0,0", 2, "--from-box");
    expectError("sight building:1:1 --from 1,1,1 --from-node 'floor*'", 2, "--from excludes");
    expectError("sight building:1:1", 2, "--from is required");
    expectError("sight building:1:1 --from-node 'corridor*' --inset 99", 2, "nothing is left");
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
    // A door that is shut blocks sight, and is no wall of the cells.
    const Outcome shut =
        run("sight building:1:1 --from -12.47,0.5,-1.246 --to -14.353,0.5,-2.359 --visibility house.vis");
    EXPECT_NE(shut.out.find("blocked: 'Floor 0/Office 0.03/Door 1 (shut)'"), std::string::npos) << shut.out;
    EXPECT_NE(shut.out.find("straight through open cells and portals, for what stands in cells is no wall to it"),
              std::string::npos)
        << shut.out;
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
