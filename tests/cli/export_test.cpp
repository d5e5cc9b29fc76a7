// The verb `export`: what it writes is the scene, cut and without what is proved unseen; what it cannot do, it refuses.
// SPDX-License-Identifier: MIT
#include <string>

#include "tests/cli/tool.h"
#include "tests/tools/import/foreign_files.h"

namespace sightline {
namespace {

using namespace test;

class Export : public Tool {
protected:
    json info(const std::string& file) const { return answer("info " + file); }
};

TEST_F(Export, WritesWhatItSays) {
    const json told = answer("export city:1:50 -o city.glb");
    EXPECT_EQ(told["schema"], "sightline.export/1");
    EXPECT_EQ(told["written"]["objects"], told["scene"]["objects"]);
    EXPECT_EQ(told["written"]["textures"], false);
    const json city = info("city:1:50"), file = info("city.glb");
    for (const char* key : {"objects", "bounds", "materials"}) EXPECT_EQ(file[key], city[key]) << key;
    EXPECT_EQ(file["triangles"]["drawn"], city["triangles"]["drawn"]);
    const Outcome words = succeed("export city:1:50 -o again.glb");
    EXPECT_NE(words.out.find("again.glb: 50 objects, where there were 50"), std::string::npos) << words.out;
    EXPECT_EQ(read(path("again.glb")), read(path("city.glb"))) << "the same each time";
    EXPECT_TRUE(succeed("export city:1:50 -o again.glb --quiet").out.empty());
}

TEST_F(Export, CutsAFileAndKeepsItsNodes) {
    write("boxes.glb", glbBytes(twoBoxes()));
    const json told = answer("export boxes.glb --split grid:2 -o cut.glb");
    EXPECT_EQ(told["written"]["textures"], true);
    EXPECT_EQ(told["written"]["triangles"], 24);
    const Outcome objects = succeed("info cut.glb --objects");
    EXPECT_NE(objects.out.find("Large/cube 0 0 0"), std::string::npos) << objects.out;
    // With a unit it is a scene like any other.
    EXPECT_EQ(answer("export boxes.glb --unit cm -o small.glb")["written"]["textures"], false);
    EXPECT_NEAR(info("small.glb")["bounds"]["max"][0].get<double>(),
                info("boxes.glb")["bounds"]["max"][0].get<double>() / 100, 1e-9);
}

TEST_F(Export, LeavesOutWhatClosedSurfacesEncase) {
    // A box, and the same at half its size about its own centre.
    Surface outer = twoBoxes()[0], inner = outer;
    glm::vec3 centre(0);
    for (const glm::vec3& p : outer.positions) centre += p / static_cast<float>(outer.positions.size());
    for (glm::vec3& p : inner.positions) p = centre + 0.5f * (p - centre);
    write("nested.glb", glbBytes({outer, inner}));
    const json told = answer("export nested.glb --outside -o hull.glb");
    EXPECT_EQ(told["outside"]["triangles_left_out"], 12);
    EXPECT_EQ(told["outside"]["closed_surfaces"], 2);
    EXPECT_EQ(told["outside"]["proved"], true);
    EXPECT_EQ(info("hull.glb")["triangles"]["drawn"], 12);
    EXPECT_EQ(answer("export nested.glb -o all.glb")["written"]["triangles"], 24);
}

TEST_F(Export, LeavesOutWhatNoRegionSees) {
    succeed("bake building:1:1 -o house.vis");
    const std::string regions = " --from-node 'corridor ?.?' --inset 0.1 --visibility house.vis";
    const json unseen = answer("sight building:1:1" + regions)["unseen"];
    for (const std::string split : {"", " --split grid:2"}) {
        const json told = answer("export building:1:1 -o part.glb" + split + regions);
        ASSERT_EQ(told["left_out"].size(), unseen.size());
        for (size_t i = 0; i < unseen.size(); ++i) EXPECT_EQ(told["left_out"][i]["key"], unseen[i]["key"]);
        EXPECT_GT(told["regions"]["triangles_left_out"], 0);
        EXPECT_EQ(told["written"]["triangles"].get<uint64_t>() + told["regions"]["triangles_left_out"].get<uint64_t>(),
                  told["scene"]["triangles"]);
    }
    const Outcome text = succeed("export building:1:1 --list -o part.glb" + regions);
    EXPECT_NE(text.out.find(unseen[0]["path"].get<std::string>() + "\n"), std::string::npos) << text.out;
    expectError("export building:1:1 -o a.glb --visibility house.vis", 2, "--from-node");
    expectError("export building:1:1 -o a.glb --from-node 'corridor*'", 2, "--visibility");
}

TEST_F(Export, LeavesOutWhatAPathDoesNotSee) {
    const json told = answer("export city:1:200 --from-path --path walk --frames 3 --seed 4 -o walk.glb");
    EXPECT_EQ(told["path"]["frames"], 3);
    EXPECT_LT(told["written"]["objects"].get<int>(), 200);
    EXPECT_EQ(told["written"]["triangles"].get<int>() + told["path"]["triangles_left_out"].get<int>(),
              told["scene"]["triangles"].get<int>());
    // What is left looks the same along the path.
    const json path = answer("cull city:1:200 --path walk --frames 3 --seed 4");
    size_t seen = 0;
    for (const json& frame : path["frames"]) seen = std::max(seen, frame["visible"].size());
    EXPECT_GE(told["written"]["objects"].get<size_t>(), seen);
}

TEST_F(Export, RefusesWhatItCannotWrite) {
    expectError("export city:1:10", 2, "--output");
    expectError("export city:1:10 -o city.obj", 2, ".glb");
    expectError("export city:1:10 -o city.glb --frames 3", 2, "--from-path");
    expectError("export city:1:10 -o missing/city.glb", 4, "missing");
    expectError("export missing.glb -o city.glb", 3, "missing.glb");
    write("boxes.glb", glbBytes(twoBoxes()));
    expectError("export boxes.glb -o boxes.glb", 2, "boxes.glb");
    EXPECT_EQ(read(path("boxes.glb")), glbBytes(twoBoxes()));
}

}  // namespace
}  // namespace sightline
